"""Where along the wire it touched, when, and how hard."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.plots.scene import deepest
from gw_exudyn.plots.style import (
    CATHETER_COLOUR,
    VERMILLION,
    axis_label,
    new_figure,
    set_title,
    shown,
    tidy,
    warn_untrusted,
    wire_words,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gw_exudyn.result import Floats, Result


def plot_contact_map(result: Result) -> Figure:
    """Draw every contact as a dot over time and place along the wire (tip below), coloured by its normal force; the
    catheter's grey.

    The scale of colours is logarithmic: the contacts of a run differ by orders of magnitude.
    """
    figure = new_figure(7.6, 4.8)
    axes = figure.add_subplot()
    tidy(axes)
    time, place, force, owner = _contacts(result)
    length_unit, length_factor = shown("contact_arc_length", place)
    time_unit, time_factor = shown("time", result.time)
    first, last = result.time[[0, -1]] * time_factor
    margin = 0.01 * max(last - first, 1e-9)
    axes.set_xlim(first - margin, last + margin)
    axes.set_xlabel(axis_label("time", time_unit))
    axes.set_ylabel(axis_label("place along the wire, from the tip", length_unit))
    catheter = owner == 1
    axes.plot(
        time[catheter] * time_factor,
        place[catheter] * length_factor,
        ".",
        color=CATHETER_COLOUR,
        markersize=3.0,
        label="catheter",
        zorder=2,
    )
    loaded = (owner == 0) & (force > 0)
    if loaded.any():
        _draw_loaded(figure, time[loaded] * time_factor, place[loaded] * length_factor, force[loaded])
    else:
        axes.annotate(
            "no contact with the vessel",
            (0.5, 0.5),
            xycoords="axes fraction",
            ha="center",
            va="center",
            color=VERMILLION,
        )
    top = max(float(place[np.isfinite(place)].max(initial=0.0)), deepest(result), 1e-3)
    axes.set_ylim(-0.03 * top * length_factor, 1.04 * top * length_factor)
    if catheter.any():
        axes.legend(loc="upper left", fontsize=9, markerscale=2.5, framealpha=0.9)
    set_title(axes, result, wire_words(result))
    warn_untrusted(axes, result)
    return figure


def _contacts(result: Result) -> tuple[Floats, Floats, Floats, Floats]:
    """Time (s), place from the tip (m), normal force (N) and owner of every contact of the run, all flat."""
    owner = result.values("contact_owner")
    there = owner >= 0
    time = np.broadcast_to(result.time[:, None], owner.shape)
    return (
        time[there],
        result.values("contact_arc_length")[there],
        result.values("contact_normal_force")[there],
        owner[there],
    )


def _draw_loaded(figure: Figure, time: Floats, place: Floats, force: Floats) -> None:
    from matplotlib import colormaps
    from matplotlib.colors import ListedColormap, LogNorm
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    axes = figure.axes[0]
    unit, factor = shown("contact_normal_force", force)
    largest = float(force.max()) * factor
    norm = LogNorm(max(float(force.min()) * factor, largest * 1e-3), largest * (1 + 1e-9), clip=True)
    order = np.argsort(force, kind="stable")  # the strong ones on top
    # The map's bright end vanishes on white.
    colours = ListedColormap(colormaps["viridis_r"](np.linspace(0.1, 1.0, 256)))
    dots = axes.scatter(
        time[order], place[order], c=force[order] * factor, s=9, cmap=colours, norm=norm, linewidths=0, zorder=3
    )
    bar = figure.colorbar(dots, ax=axes, pad=0.02, extend="min" if force.min() * factor < norm.vmin else "neither")
    bar.set_label(axis_label("normal force on the vessel", unit))
    bar.ax.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    bar.ax.yaxis.set_minor_locator(NullLocator())
    bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
