"""The main figure: the wire in the vessel at several depths, with the forces of its contacts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from gw_exudyn.metrics import metrics
from gw_exudyn.plots.arrows import BUNDLE, LONGEST_ARROW, ForceScale, arrow_lengths, bundles, draw_arrows, round_down
from gw_exudyn.plots.branch_names import draw_branch_names
from gw_exudyn.plots.contact_vectors import vessel_contacts
from gw_exudyn.plots.scene import (
    beyond_exit,
    centreline,
    common_views,
    deepest,
    draw_vessel,
    panel_size,
    set_view,
    view,
    wire_area,
)
from gw_exudyn.plots.style import (
    BLUE,
    FORCE_COLOUR,
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

# Arrows shorter than this part of the longest are left out: they would be dots.
_SHORTEST_ARROW = 0.04
# How far below the panel the legend begins and the arrow of the key lies; typographic points.
_LEGEND_DEPTH = 34.0
_KEY_DEPTH = 82.0
# Brings the arrow and its words together into the middle; typographic points.
_KEY_SHIFT = 35.0

Arrows = Literal["each", "last", "none"]


@dataclass(frozen=True)
class _Panel:
    """One result with what is drawn of it: output instants (indices) from shallow to deep, and the contacts of those
    that show arrows.
    """

    result: Result
    instants: list[int]
    contacts: dict[int, tuple[Floats, Floats]]

    @property
    def largest_force(self) -> float:
        return max(
            (float(np.linalg.norm(forces, axis=1).max(initial=0.0)) for _, forces in self.contacts.values()),
            default=0.0,
        )


def plot_insertion(
    results: Result | Sequence[Result],
    *,
    depths: int | Sequence[float] = 4,
    arrows: Arrows = "each",
    force_scale: ForceScale = "auto",
) -> Figure:
    """Draw the wire in the vessel at several depths, faint to strong, with the contact forces on the walls as arrows;
    results side by side.

    depths : int or floats
        How many depths, evenly up to the deepest, or the depths themselves (m). Each is shown as it was when first
        reached.
    arrows : "each", "last" or "none"
        At which depths forces are drawn. An arrow starts at the contact and shows the force of the wire on the wall;
        the smallest are left out, and close neighbours share an arrow, their resultant.
    force_scale : "common", "own" or "auto"
        One length of arrow per newton in all panels, one for each, or the first unless forces differ by more than five
        times (the key says which).

    Lengths have one scale in all panels.
    """
    panels = [_panel(result, depths, arrows) for result in as_results(results)]
    found = [view(p.result, np.concatenate([beyond_exit(p.result, i) for i in p.instants])) for p in panels]
    size = max(float(np.diff(one, axis=0).max()) for one in found)
    panels = [_bundled(p, size * BUNDLE) for p in panels]
    per_newton = arrow_lengths([p.largest_force for p in panels], size * LONGEST_ARROW, force_scale)
    found = [_with_arrows(p, one, length) for p, one, length in zip(panels, found, per_newton, strict=True)]
    limits = common_views([p.result for p in panels], found)
    figure, all_axes = _layout(len(panels), limits[0])
    own = len(set(per_newton)) > 1
    for axes, panel, limit, length in zip(all_axes, panels, limits, per_newton, strict=True):
        _draw(axes, panel, limit, length, own)
        set_view(axes, limit)
    return figure


def _panel(result: Result, depths: int | Sequence[float], arrows: Arrows) -> _Panel:
    instants = _instants(result, depths)
    with_arrows = {"each": instants, "last": instants[-1:], "none": []}[arrows]
    return _Panel(result, instants, {instant: vessel_contacts(result, instant) for instant in with_arrows})


def _bundled(panel: _Panel, spacing: float) -> _Panel:
    """The panel with contacts closer than `spacing` (m) to each other put together."""
    contacts = {instant: bundles(points, forces, spacing) for instant, (points, forces) in panel.contacts.items()}
    return replace(panel, contacts=contacts)


def _instants(result: Result, depths: int | Sequence[float]) -> list[int]:
    """Output instants (indices) at which the depths were first reached; a depth that never was is left out, the
    deepest instead of none.
    """
    depth = result.values("insertion_depth")
    reach = deepest(result)
    wanted = (
        reach * np.arange(1, depths + 1) / depths
        if isinstance(depths, int)
        else np.sort(np.asarray(depths, dtype=float))
    )
    reached = [int(np.argmax(depth >= one - 1e-9)) for one in wanted if one <= reach + 1e-9]
    return list(dict.fromkeys(reached)) or [int(np.argmax(np.nan_to_num(depth)))]


def _with_arrows(panel: _Panel, limits: Floats, per_newton: float) -> Floats:
    """Limits widened to hold the arrows."""
    tips = [points + per_newton * forces for points, forces in panel.contacts.values() if len(points)]
    if not tips:
        return limits
    ends = np.concatenate(tips)
    margin = 0.02 * float(np.diff(limits, axis=0).max())
    return np.array(
        [np.minimum(limits[0], ends.min(axis=0) - margin), np.maximum(limits[1], ends.max(axis=0) + margin)]
    )


def _layout(count: int, limits: Floats) -> tuple[Figure, list[Axes]]:
    """Panels beside each other; wide ones below each other. Rows of three at most."""
    width, height = panel_size(limits)
    columns = 1 if width > 1.8 * height else min(count, 3)
    rows = math.ceil(count / columns)
    figure = new_figure(width * columns + 0.9, (height + 2.1) * rows)
    axes = [figure.add_subplot(rows, columns, number + 1) for number in range(count)]
    for number, one in enumerate(axes):
        tidy(one)
        label_places(one, x=number + columns >= count, y=number % columns == 0)
    return figure, axes


def _draw(axes: Axes, panel: _Panel, limits: Floats, per_newton: float, own_scale: bool) -> None:
    draw_vessel(axes, panel.result)
    draw_branch_names(axes, panel.result, limits, _arrow_points(panel, per_newton))
    _draw_wires(axes, panel)
    _draw_forces(axes, panel, per_newton)
    _draw_key(axes, panel, limits, per_newton, own_scale)
    set_title(axes, panel.result, wire_words(panel.result), _largest_force_words(panel.result))
    warn_untrusted(axes, panel.result)


def _arrow_points(panel: _Panel, per_newton: float) -> Floats:
    """(k, 2), m. Beginning, middle and end of every arrow."""
    ends = [points + share * per_newton * forces for points, forces in panel.contacts.values() for share in (0, 0.5, 1)]
    return np.concatenate([np.empty((0, 2)), *ends])


def _shade(number: int, count: int) -> tuple[float, float, float]:
    """Blue mixed with white: faint for the first depth, pure for the last."""
    from matplotlib.colors import to_rgb

    strength = 1.0 if count == 1 else 0.3 + 0.7 * number / (count - 1)
    red, green, blue = (1 - strength * (1 - channel) for channel in to_rgb(BLUE))
    return red, green, blue


def _draw_wires(axes: Axes, panel: _Panel) -> None:
    depth = panel.result.values("insertion_depth")
    for number, instant in enumerate(panel.instants):
        area = wire_area(centreline(panel.result, instant), panel.result.scenario.wire.diameter)
        if area is None:
            continue
        colour = _shade(number, len(panel.instants))
        label = display("insertion_depth", depth[instant])
        axes.fill(
            *(area * place_factor()).T,
            facecolor=colour,
            edgecolor=colour,
            linewidth=0.8,
            zorder=5 + 0.1 * number,
            label=label,
        )
    _draw_legend(axes)


def _draw_legend(axes: Axes) -> None:
    handles, labels = axes.get_legend_handles_labels()
    if not handles:  # no wire that is finite
        return
    axes.legend(
        handles,
        labels,
        title="insertion depth",
        title_fontsize=9,
        fontsize=9,
        ncols=4,
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        bbox_transform=points_from_axes(axes, 0.0, -_LEGEND_DEPTH),
        frameon=False,
        handlelength=1.4,
        handleheight=0.5,
        columnspacing=1.4,
    )


def _draw_forces(axes: Axes, panel: _Panel, per_newton: float) -> None:
    from matplotlib.colors import to_rgb

    for number, instant in enumerate(panel.instants):
        if instant not in panel.contacts:
            continue
        points, forces = panel.contacts[instant]
        kept = np.linalg.norm(forces, axis=1) > _SHORTEST_ARROW * panel.largest_force
        strength = 1.0 if number == len(panel.instants) - 1 else 0.45
        colour = tuple(1 - strength * (1 - channel) for channel in to_rgb(FORCE_COLOUR))
        draw_arrows(axes, points[kept], per_newton * forces[kept], colour, 7 + 0.1 * number)


def _draw_key(axes: Axes, panel: _Panel, limits: Floats, per_newton: float, own_scale: bool) -> None:
    """An arrow of a round force below the legend, in the middle."""
    if per_newton <= 0 or panel.largest_force <= 0:
        return
    force = round_down(panel.largest_force)
    middle = float(limits[:, 0].mean()) * place_factor()
    left = middle - force * per_newton * place_factor()
    below = points_from_axes(axes, -_KEY_SHIFT, -_KEY_DEPTH, data_x=True)
    arrow = {
        "arrowstyle": "-|>,head_width=0.25,head_length=0.5",
        "color": FORCE_COLOUR,
        "linewidth": 1.6,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    axes.annotate(
        "", (middle, 0.0), xytext=(left, 0.0), xycoords=below, textcoords=below, arrowprops=arrow, annotation_clip=False
    )
    words = f"  {display('push_force', force)} on the wall{' (own scale)' if own_scale else ''}"
    axes.text(middle, 0.0, words, transform=below, ha="left", va="center", fontsize=9)


def _largest_force_words(result: Result) -> str:
    found = metrics(result)
    force, time = found["wall_force_max"].value, found["wall_force_max_time"].value
    if not force > 0:
        return "no contact with the vessel"
    depth = float(np.interp(time, result.time, result.values("insertion_depth")))
    return f"largest contact force {display('wall_force_max', force)}, at {display('insertion_depth', depth)}"
