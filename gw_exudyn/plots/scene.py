"""The vessel, the catheter and the wire as drawn in the plane."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.plots.style import CATHETER_COLOUR, LUMEN_COLOUR, WALL_COLOUR, place_factor

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from gw_exudyn.result import Floats, Result


def draw_vessel(axes: Axes, result: Result) -> None:
    """Walls as lines, the lumen tinted where the walls enclose one, and the catheter over it."""
    scale = place_factor()
    lumen = enclosed(result.vessel_outline)
    if lumen is not None:
        axes.fill(*(lumen * scale).T, facecolor=LUMEN_COLOUR, edgecolor="none", zorder=0)
    for line in result.vessel_outline:
        axes.plot(*(line * scale).T, color=WALL_COLOUR, linewidth=1.4, solid_joinstyle="round", zorder=2)
    tube = enclosed(result.catheter_outline)
    if tube is not None:
        axes.fill(*(tube * scale).T, facecolor=CATHETER_COLOUR, edgecolor="none", alpha=0.45, zorder=1)
    for line in result.catheter_outline:
        axes.plot(*(line * scale).T, color=CATHETER_COLOUR, linewidth=2.0, solid_capstyle="butt", zorder=3)
    for centre, radius in _discs(result):
        turn = np.linspace(0.0, 2 * np.pi, 65)
        rim = (centre + radius * np.column_stack([np.cos(turn), np.sin(turn)])) * scale
        axes.fill(*rim.T, facecolor=CATHETER_COLOUR, edgecolor=WALL_COLOUR, linewidth=1.0, zorder=3)


def _discs(result: Result) -> list[tuple[Floats, float]]:
    """Centre and radius, m, of the supports, and of the nose where it is at the end."""
    discs = [(np.array(support.at), support.radius) for support in result.scenario.supports]
    nose = result.scenario.nose
    if nose is not None:
        way = np.array([np.cos(nose.direction), np.sin(nose.direction)]) * result.values("nose_travel")[-1]
        discs.append((np.array(nose.at) + way, nose.radius))
    return discs


def enclosed(lines: Sequence[Floats]) -> Floats | None:
    """(k, 2) outline of the area between polylines, end joined to the nearest next end; None where that gives no
    simple polygon.
    """
    from shapely import Polygon

    remaining = [line for line in lines if len(line) > 1]
    if not remaining:
        return None
    outline = remaining.pop(0)
    while remaining:
        ends = [
            (np.linalg.norm(outline[-1] - line[end]), i, end) for i, line in enumerate(remaining) for end in (0, -1)
        ]
        _, nearest, end = min(ends)
        line = remaining.pop(nearest)
        outline = np.concatenate([outline, line if end == 0 else line[::-1]])
    if len(outline) < 3 or not Polygon(outline).is_valid:
        return None
    return outline


def deepest(result: Result) -> float:
    """Deepest insertion (m); zero where no depth is finite."""
    depth = result.values("insertion_depth")
    return float(depth[np.isfinite(depth)].max(initial=0.0))


def wire_area(centreline: Floats, diameter: float) -> Floats | None:
    """(k, 2) outline of a wire of true width with a round tip; None where the centreline is not finite anywhere."""
    from shapely import LineString, Polygon

    points = centreline[np.isfinite(centreline).all(axis=1)]
    if len(points) < 2:
        return None
    area = LineString(points).buffer(diameter / 2, quad_segs=8)
    return np.asarray(area.exterior.coords) if isinstance(area, Polygon) else None


def centreline(result: Result, instant: int) -> Floats:
    """(n + 1, 2) float, m. Nodes of the wire at an output instant, proximal end first."""
    return np.column_stack([result.values("node_x")[instant], result.values("node_y")[instant]])


def beyond_exit(result: Result, instant: int) -> Floats:
    """(k, 2) float, m. Nodes that have left the catheter, the tip at least.

    They are the distal part of the wire, as long as it is inserted.
    """
    place, depth = result.values("node_arc_length"), result.values("insertion_depth")[instant]
    nodes: Floats = centreline(result, instant)[place <= max(depth, place[-1])]
    return nodes


def view(result: Result, points: Floats) -> Floats:
    """Limits [[x0, y0], [x1, y1]], m, that show the points (k, 2), as much of the vessel as does not make them small,
    and a bit of the catheter.
    """
    points = points[np.isfinite(points).all(axis=1)]
    walls = np.concatenate(result.vessel_outline) if result.vessel_outline else points
    if not len(points):
        points = walls if len(walls) else np.zeros((1, 2))
    low, high = points.min(axis=0), points.max(axis=0)
    reach = max(float((high - low).max()), 10e-3)
    if len(walls):
        # The whole vessel where it fits in about twice the wire's reach, else its part within 0.4 of it.
        room = reach * (1.0 if np.ptp(walls, axis=0).max() < 2.2 * reach else 0.4)
        low, high = _stretched(low, high, walls, room)
    if result.catheter_outline:
        low, high = _stretched(low, high, np.concatenate(result.catheter_outline), 0.08 * float((high - low).max()))
    margin = 0.03 * max(float((high - low).max()), 5e-3)
    return np.array([low - margin, high + margin])


def _stretched(low: Floats, high: Floats, points: Floats, room: float) -> tuple[Floats, Floats]:
    """Limits stretched to hold the points, by no more than `room` to any side."""
    return np.minimum(low, np.maximum(points.min(axis=0), low - room)), np.maximum(
        high, np.minimum(points.max(axis=0), high + room)
    )


def same_vessel(results: Sequence[Result]) -> bool:
    """Whether all results have the same vessel walls."""
    first = results[0].vessel_outline
    return all(
        len(first) == len(other.vessel_outline)
        and all(np.array_equal(a, b) for a, b in zip(first, other.vessel_outline, strict=True))
        for other in results[1:]
    )


def common_views(results: Sequence[Result], views: Sequence[Floats]) -> list[Floats]:
    """Views of equal size, so that panels of equal size have one scale; one and the same view where the vessel is the
    same.
    """
    if same_vessel(results):
        stacked = np.stack(views)
        return [np.array([stacked[:, 0].min(axis=0), stacked[:, 1].max(axis=0)])] * len(views)
    half = np.max([np.diff(one, axis=0)[0] / 2 for one in views], axis=0)
    return [np.array([one.mean(axis=0) - half, one.mean(axis=0) + half]) for one in views]


def set_view(axes: Axes, limits: Floats) -> None:
    """Show the limits with equal scales in x and y."""
    (x0, y0), (x1, y1) = limits * place_factor()
    axes.set_aspect("equal")
    axes.set_xlim(x0, x1)
    axes.set_ylim(y0, y1)


def panel_size(limits: Floats) -> tuple[float, float]:
    """Width and height in inches of a panel that shows the limits, within what fits on a page."""
    width, height = np.diff(limits, axis=0)[0]
    inches = min(5.2 / width, 5.2 / height) if width < 2.5 * height else 9.5 / width
    return max(float(width * inches), 3.6), max(float(height * inches), 1.4)
