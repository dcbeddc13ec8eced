"""Push force and wall forces against insertion depth and against time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PURPLE,
    VERMILLION,
    as_results,
    axis_label,
    new_figure,
    set_title,
    shown,
    tidy,
    warn_untrusted,
    wire_words,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from gw_exudyn.result import Floats, Result


def plot_forces(results: Result | Sequence[Result]) -> Figure:
    """Draw push force, force on the vessel and force on the tip, over insertion depth (above) and time (below);
    results side by side, one scale.

    Snap-through events are marked in time.
    """
    from matplotlib.ticker import MaxNLocator

    several = as_results(results)
    unit, factor = shown("push_force", *(values for result in several for _, values, _, _ in _lines(result)))
    figure = new_figure(1.0 + 5.2 * len(several), 6.6)
    grid = figure.subplots(2, len(several), sharey=True, squeeze=False)
    for column, result in enumerate(several):
        for axes, abscissa in zip(grid[:, column], ("insertion_depth", "time"), strict=True):
            _draw(axes, result, abscissa, factor)
            axes.yaxis.set_major_locator(MaxNLocator(6))
            if column == 0:
                axes.set_ylabel(axis_label("force", unit))
        _mark_snaps(grid[1, column], result)
        set_title(grid[0, column], result, wire_words(result))
        warn_untrusted(grid[0, column], result)
    handles, labels = grid[1, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=9, frameon=False, columnspacing=1.3)
    return figure


def _lines(result: Result) -> list[tuple[str, Floats, str, str]]:
    """Label, force (N), colour and line style of each line."""
    resultant = np.hypot(result.values("wall_force_x"), result.values("wall_force_y"))
    return [
        ("push force", result.values("push_force"), BLUE, "-"),
        ("resultant force on the vessel", resultant, VERMILLION, "-"),
        ("largest single contact", result.values("wall_force_max"), ORANGE, "--"),
        ("force on the tip", result.values("tip_force"), GREEN, "-."),
        ("catheter (normal forces)", result.values("catheter_force_normal"), PURPLE, ":"),
    ]


def _draw(axes: Axes, result: Result, abscissa: str, factor: float) -> None:
    tidy(axes)
    unit, scale = shown(abscissa, result.values(abscissa))
    for label, values, colour, style in _lines(result):
        axes.plot(
            result.values(abscissa) * scale, values * factor, color=colour, linestyle=style, linewidth=1.5, label=label
        )
    axes.axhline(0.0, color=BLACK, linewidth=0.6)
    axes.set_xlabel(axis_label(abscissa.replace("_", " "), unit))
    axes.margins(x=0.01)


def _mark_snaps(axes: Axes, result: Result) -> None:
    _, scale = shown("time", result.time)
    for number, snap in enumerate(result.snaps):
        axes.axvline(
            snap.time * scale,
            color=BLACK,
            linewidth=0.8,
            linestyle=(0, (1, 2)),
            zorder=1,
            label="snap-through" if number == 0 else None,
        )
