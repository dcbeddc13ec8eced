"""Two courses over each other: paths, forces, and how far apart the tips are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gw_exudyn.comparison import PATH, Course, common_time, course_of, distance, drawn_rows
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
from gw_exudyn.result import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from gw_exudyn.result import Floats

_FORCES = ("push_force", "wall_force_x", "wall_force_y", "wall_force_normal", "tip_force")
_MOST_PANELS = 3


def plot_comparison(first: Result, second: Result | Course) -> Figure:
    """Draw both paths in the vessel, the forces that both have, and the distance of the tips over time.

    second : another run, or a measured course, which is drawn as dots. The vessel is the first's; where the second's is
    another, its walls are dashed.
    """
    courses = course_of(first), second if isinstance(second, Course) else course_of(second)
    paths = [all(name in course.values for name in PATH) for course in courses]
    forces = _forces(courses)
    panels = len(forces) + all(paths)
    figure = new_figure(11.0, 2.0 + 1.7 * max(panels, 2))
    grid = figure.add_gridspec(max(panels, 1), 2, width_ratios=(1.15, 1.0))
    _draw_paths(figure.add_subplot(grid[:, 0]), first, second, courses)
    axes = [figure.add_subplot(grid[row, 1]) for row in range(panels)]
    for one, (words, curves) in zip(axes, forces, strict=False):
        _draw_force(one, words, curves, courses)
    if all(paths):
        _draw_distance(axes[-1], courses)
    if axes:
        unit, _ = shown("time", *(course.time for course in courses))
        axes[-1].set_xlabel(axis_label("time", unit))
        figure.align_ylabels(axes)
    return figure


def _forces(courses: tuple[Course, Course]) -> list[tuple[str, list[Floats]]]:
    """Label and curves of the forces that both have: the push force and the resultant on the vessel before all."""
    both = [name for name in _FORCES if all(name in course.values for course in courses)]
    found = []
    if {"wall_force_x", "wall_force_y"} <= set(both):
        resultants = [np.hypot(c.values["wall_force_x"], c.values["wall_force_y"]) for c in courses]
        found.append(("force on the vessel", resultants))
        both = [name for name in both if name not in ("wall_force_x", "wall_force_y", "wall_force_normal")]
    single = [(name.replace("_", " "), [course.values[name] for course in courses]) for name in both]
    return (single[:1] + found + single[1:])[: _MOST_PANELS - 1]


def _draw_paths(axes: Axes, first: Result, second: Result | Course, courses: tuple[Course, Course]) -> None:
    tidy(axes)
    draw_vessel(axes, first)
    scale = place_factor()
    if isinstance(second, Result) and not same_vessel([first, second]):
        for line in second.vessel_outline:
            axes.plot(*(line * scale).T, color=RESULT_COLOURS[1], linewidth=0.9, linestyle="--", zorder=2)
    drawn = []
    for number, course in enumerate(courses):
        if not all(name in course.values for name in PATH):
            continue
        path = np.column_stack([course.values[name] for name in PATH])
        axes.plot(*(path * scale).T, **_style(number, second), label=_name(number, courses), zorder=5 + number)
        ends = path[np.isfinite(path).all(axis=1)][-1:]
        axes.plot(*(ends * scale).T, "osD"[number], color=RESULT_COLOURS[number], markersize=6, zorder=7)
        drawn.append(path)
    for result in (first, second):
        if isinstance(result, Result):
            warn_untrusted(axes, result)
    set_view(axes, view(first, np.concatenate(drawn)))
    label_places(axes)
    axes.set_title("Paths of the tips, a mark at the end", fontsize=9.5, loc="left")
    axes.legend(loc="best", fontsize=9, framealpha=0.9)


def _name(number: int, courses: Sequence[Course]) -> str:
    """The course's name, numbered where both have the same."""
    alike = courses[0].name == courses[1].name
    return f"{courses[number].name} ({number + 1})" if alike else courses[number].name


def _style(number: int, second: Result | Course) -> dict[str, Any]:
    if number and isinstance(second, Course):
        return {"color": RESULT_COLOURS[number], "linestyle": "none", "marker": ".", "markersize": 4}
    return {"color": RESULT_COLOURS[number], "linestyle": LINE_STYLES[number], "linewidth": 1.6}


def _draw_force(axes: Axes, words: str, curves: list[Floats], courses: tuple[Course, Course]) -> None:
    tidy(axes)
    unit, factor = shown("push_force", *curves)
    _, seconds = shown("time", *(course.time for course in courses))
    for number, (course, force) in enumerate(zip(courses, curves, strict=True)):
        colour, line = RESULT_COLOURS[number], LINE_STYLES[number]
        rows = drawn_rows(course.time, force)
        axes.plot(course.time[rows] * seconds, force[rows] * factor, color=colour, linestyle=line, linewidth=1.5)
    axes.axhline(0.0, color=BLACK, linewidth=0.6)
    axes.set_ylabel(axis_label(words, unit))
    axes.margins(x=0.01)


def _draw_distance(axes: Axes, courses: tuple[Course, Course]) -> None:
    tidy(axes)
    time = common_time(*courses)
    apart = distance(*courses, time)
    unit, factor = shown("tip_x", apart)
    _, seconds = shown("time", *(course.time for course in courses))
    axes.plot(time * seconds, apart * factor, color=BLACK, linewidth=1.4)
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel(axis_label("distance of the tips", unit))
    axes.margins(x=0.01)
