"""The path of the tip through the vessel."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.plots.branch_names import draw_branch_names
from gw_exudyn.plots.scene import common_views, deepest, draw_vessel, panel_size, same_vessel, set_view, view
from gw_exudyn.plots.style import (
    LINE_STYLES,
    RESULT_COLOURS,
    as_results,
    label_places,
    new_figure,
    place_factor,
    points_from_axes,
    set_title,
    tidy,
    warn_untrusted,
    wire_words,
)
from gw_exudyn.quantities import display

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from gw_exudyn.result import Floats, Result

_MARKS = 8


def plot_tip_path(results: Result | Sequence[Result]) -> Figure:
    """Draw where the tip went, with a mark at every round depth of insertion; results of one vessel in one panel,
    else side by side.
    """
    several = as_results(results)
    together = len(several) > 1 and same_vessel(several)
    groups = [several] if together else [[result] for result in several]
    limits = common_views(
        [group[0] for group in groups], [view(group[0], np.concatenate([_path(r) for r in group])) for group in groups]
    )
    width, height = panel_size(limits[0])
    step = _round_step(max(deepest(result) for result in several) / _MARKS)
    figure = new_figure(width * len(groups) + 0.9, height + 1.5)
    for number, (group, limit) in enumerate(zip(groups, limits, strict=True)):
        axes = figure.add_subplot(1, len(groups), number + 1)
        tidy(axes)
        draw_vessel(axes, group[0])
        draw_branch_names(axes, group[0], limit, np.concatenate([_path(r) for r in group]))
        for place, result in enumerate(group):
            _draw(axes, result, place, step)
            warn_untrusted(axes, result)
        set_view(axes, limit)
        label_places(axes, y=number == 0)
        _finish(axes, group, step)
    return figure


def _path(result: Result) -> Floats:
    return np.column_stack([result.values("tip_x"), result.values("tip_y")])


def _draw(axes: Axes, result: Result, number: int, step: float) -> None:
    path = _path(result) * place_factor()
    colour, style = RESULT_COLOURS[number % len(RESULT_COLOURS)], LINE_STYLES[number % len(LINE_STYLES)]
    axes.plot(
        *path.T,
        color=colour,
        linestyle=style,
        linewidth=1.7,
        label=f"{result.scenario.name} ({wire_words(result)})",
        zorder=5,
    )
    marks = path[_instants_of_steps(result, step)]
    marker = "osD^v"[number % 5]
    axes.plot(
        *marks.T,
        linestyle="none",
        marker=marker,
        markersize=5.5,
        markerfacecolor="white",
        markeredgecolor=colour,
        zorder=6,
    )
    axes.plot(*path[-1:].T, linestyle="none", marker=marker, markersize=7.5, color=colour, zorder=7)


def _instants_of_steps(result: Result, step: float) -> list[int]:
    """Output instants (indices) at which each multiple of `step` (m) was first reached, from zero."""
    depth = result.values("insertion_depth")
    wanted = np.arange(0.0, deepest(result) + 1e-9, step)
    return [int(np.argmax(depth >= one - 1e-9)) for one in wanted]


def _round_step(length: float) -> float:
    """The smallest of 1, 2 and 5 times a power of ten that is not below the length; a millimetre for a wire that
    never moved.
    """
    if not length > 0:
        return 1e-3
    power = 10.0 ** math.floor(math.log10(length))
    return min(one * power for one in (1, 2, 5, 10) if one * power >= length * (1 - 1e-9))


def _finish(axes: Axes, group: Sequence[Result], step: float) -> None:
    words = f"marks every {display('insertion_depth', step)} of insertion, filled at the end"
    if len(group) == 1:
        set_title(axes, group[0], wire_words(group[0]), words)
        return
    axes.set_title(f"Path of the tip\n{words}", fontsize=9.5, loc="left")
    axes.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        bbox_transform=points_from_axes(axes, 0.0, -34.0),
        frameon=False,
        fontsize=9,
        handlelength=3.5,
    )
