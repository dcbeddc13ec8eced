"""Where the work of the drive went, and whether the balance closes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    NOTE_COLOUR,
    ORANGE,
    PURPLE,
    SKY_BLUE,
    VERMILLION,
    YELLOW,
    axis_label,
    new_figure,
    set_title,
    shown,
    tidy,
    warn_untrusted,
    wire_words,
)
from gw_exudyn.quantities import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from gw_exudyn.result import Floats, Result

_TERMS = (
    ("elastic_energy", BLUE),
    ("wall_energy", SKY_BLUE),
    ("kinetic_energy", GREEN),
    ("friction_loss", ORANGE),
    ("damping_loss", PURPLE),
    ("numerical_loss", YELLOW),
)
# What the balance may leave over, as a part of the largest work.
_ALLOWED_PERCENT = 1.0


def plot_energy(result: Result) -> Figure:
    """Draw the stored and lost energies stacked on each other over time, with the work of drive and loads as a line
    that meets their sum.

    Terms below zero are stacked downwards. Below: what the balance leaves over, in percent of the largest work, with
    the band that is allowed.
    """
    figure = new_figure(7.2, 6.2)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3.2, 1.0))
    _draw_terms(above, result)
    _draw_error(below, result)
    set_title(above, result, wire_words(result))
    warn_untrusted(above, result)
    return figure


def _draw_terms(axes: Axes, result: Result) -> None:
    tidy(axes)
    work = _work(result)
    terms = {name: np.nan_to_num(result.values(name)) for name, _ in _TERMS}
    unit, factor = shown("insertion_work", work, sum(terms.values(), np.zeros_like(work)))
    up, down = np.zeros_like(work), np.zeros_like(work)
    for name, colour in _TERMS:
        values = terms[name] * factor
        label = QUANTITIES[name].label
        axes.fill_between(result.time, up, up + np.maximum(values, 0), color=colour, linewidth=0, label=label)
        axes.fill_between(result.time, down, down + np.minimum(values, 0), color=colour, linewidth=0)
        up, down = up + np.maximum(values, 0), down + np.minimum(values, 0)
    axes.plot(result.time, work * factor, color=BLACK, linewidth=1.6, label=_work_label(result))
    axes.axhline(0.0, color=BLACK, linewidth=0.6)
    axes.set_ylabel(axis_label("energy", unit))
    axes.margins(x=0.0)
    if not min(down.min(), work.min() * factor) < 0:
        axes.set_ylim(bottom=0.0)
    axes.figure.legend(
        *axes.get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize=9, frameon=False
    )


def _draw_error(axes: Axes, result: Result) -> None:
    tidy(axes)
    percent = _error_percent(result)
    axes.axhspan(-_ALLOWED_PERCENT, _ALLOWED_PERCENT, color="#E9E9E9", linewidth=0)
    axes.plot(result.time, percent, color=VERMILLION, linewidth=1.4)
    inside = (0.01, 0.92 * _ALLOWED_PERCENT)
    axes.annotate(
        f"allowed: ±{_ALLOWED_PERCENT:g} %",
        inside,
        xycoords=axes.get_yaxis_transform(),
        va="top",
        fontsize=8.5,
        color=NOTE_COLOUR,
    )
    largest = float(np.max(np.abs(percent[np.isfinite(percent)]), initial=0.0))
    axes.set_ylim(-1.25 * max(_ALLOWED_PERCENT, largest), 1.25 * max(_ALLOWED_PERCENT, largest))
    axes.set_ylabel("energy error\n[% of largest work]", fontsize=9)
    axes.set_xlabel(axis_label("time", QUANTITIES["time"].unit))
    axes.margins(x=0.0)


def _work(result: Result) -> Floats:
    """(t,) float, J. What drive and loads have put in."""
    return result.values("insertion_work") + result.values("load_work")


def _work_label(result: Result) -> str:
    return "work of drive and loads" if result.values("load_work").any() else QUANTITIES["insertion_work"].label


def _error_percent(result: Result) -> Floats:
    """(t,) float, percent. Zero throughout where no work was done."""
    work, error = _work(result), result.values("energy_error")
    largest = float(np.max(np.abs(work[np.isfinite(work)]), initial=0.0))
    return 100.0 * error / largest if largest > 0 else np.zeros_like(error)
