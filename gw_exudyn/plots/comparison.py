"""Two runs over each other: paths, forces, and how far apart the tips are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gw_exudyn.comparison import common_time, course_of, distance
from gw_exudyn.plots.scene import draw_vessel, same_vessel, set_view, view
from gw_exudyn.plots.style import (
    BLACK,
    LINE_STYLES,
    RESULT_COLOURS,
    axis_label,
    label_places,
    new_figure,
    place_factor,
    shown,
    tidy,
    warn_untrusted,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from gw_exudyn.result import Floats, Result


def plot_comparison(first: Result, second: Result) -> Figure:
    """Draw the paths of both tips, both push forces, both resultants on the vessel, and the distance of the tips over
    time.

    The vessel is the first's; where the second's is another, its walls are dashed.
    """
    figure = new_figure(11.0, 7.0)
    grid = figure.add_gridspec(3, 2, width_ratios=(1.15, 1.0))
    _draw_paths(figure.add_subplot(grid[:, 0]), first, second)
    axes = [figure.add_subplot(grid[row, 1]) for row in range(3)]
    _draw_force(axes[0], "push force", [_push(result) for result in (first, second)], (first, second))
    _draw_force(axes[1], "force on the vessel", [_on_vessel(result) for result in (first, second)], (first, second))
    _draw_distance(axes[2], first, second)
    unit, _ = shown("time", first.time, second.time)
    axes[-1].set_xlabel(axis_label("time", unit))
    figure.align_ylabels(axes)
    return figure


def _push(result: Result) -> Floats:
    return result.values("push_force")


def _on_vessel(result: Result) -> Floats:
    return np.hypot(result.values("wall_force_x"), result.values("wall_force_y"))


def _draw_paths(axes: Axes, first: Result, second: Result) -> None:
    tidy(axes)
    draw_vessel(axes, first)
    scale = place_factor()
    if not same_vessel([first, second]):
        for line in second.vessel_outline:
            axes.plot(*(line * scale).T, color=RESULT_COLOURS[1], linewidth=0.9, linestyle="--", zorder=2)
    paths = [np.column_stack([r.values("tip_x"), r.values("tip_y")]) for r in (first, second)]
    for number, (result, path) in enumerate(zip((first, second), paths, strict=True)):
        axes.plot(*(path * scale).T, **_style(number), label=_name(result, number, first, second), zorder=5 + number)
        axes.plot(*(path[-1:] * scale).T, "osD"[number], color=RESULT_COLOURS[number], markersize=6, zorder=7)
        warn_untrusted(axes, result)
    set_view(axes, view(first, np.concatenate(paths)))
    label_places(axes)
    axes.set_title("Paths of the tips, a mark at the end", fontsize=9.5, loc="left")
    axes.legend(loc="best", fontsize=9, framealpha=0.9)


def _name(result: Result, number: int, *both: Result) -> str:
    """The run's name, numbered where both have the same."""
    alike = both[0].scenario.name == both[1].scenario.name
    return f"{result.scenario.name} ({number + 1})" if alike else result.scenario.name


def _style(number: int) -> dict[str, Any]:
    return {"color": RESULT_COLOURS[number], "linestyle": LINE_STYLES[number], "linewidth": 1.6}


def _draw_force(axes: Axes, words: str, forces: list[Floats], results: tuple[Result, Result]) -> None:
    tidy(axes)
    unit, factor = shown("push_force", *forces)
    _, seconds = shown("time", *(result.time for result in results))
    for number, (result, force) in enumerate(zip(results, forces, strict=True)):
        axes.plot(result.time * seconds, force * factor, **_style(number))
    axes.axhline(0.0, color=BLACK, linewidth=0.6)
    axes.set_ylabel(axis_label(words, unit))
    axes.margins(x=0.01)


def _draw_distance(axes: Axes, first: Result, second: Result) -> None:
    tidy(axes)
    courses = course_of(first), course_of(second)
    time = common_time(*courses)
    apart = distance(*courses, time)
    unit, factor = shown("tip_x", apart)
    _, seconds = shown("time", first.time, second.time)
    axes.plot(time * seconds, apart * factor, color=BLACK, linewidth=1.4)
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel(axis_label("distance of the tips", unit))
    axes.margins(x=0.01)
