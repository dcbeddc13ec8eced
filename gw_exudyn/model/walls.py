"""Walls that the wire can touch: the vessel's outline and the catheter, as segments and corners. Catheter's frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.model.outline import Outline
from gw_exudyn.model.patches import Patch, divided, friction_at

Floats = NDArray[np.float64]

_SHARP_FROM = 1e-7
"""Turn, rad, from which a corner counts as one."""

_SHARED_TO = 0.1
"""Turn, rad, of a pocket up to which its two walls share a contact, half and half at the joint, so that a bend of many
facets is no stiffer than one wall. In a sharper pocket each wall pushes in full."""

_REACH_PAST_POCKET = 0.3e-3
"""How far, m, a wall reaches on past a corner that points away from the lumen, for Newton's trial places to meet it."""


@dataclass(frozen=True)
class Walls:
    """Wall segments and corners that point into the lumen.

    start : (w, 2), m. tangent : (w, 2), unit, the lumen on its left. length : (w,), m.
    lo, hi : (w,), m along the tangent, where node contact has faded out. fade_lo, fade_hi : (w,), m, over which it
        fades.
    sharp : (w,), bit 0: the start points into the lumen (a corner takes over there), bit 1: the end does.
    friction : (w,). tube : (w,) bool, the catheter's rather than the vessel's.
    corner : (k, 2), m. corner_friction : (k,). corner_tube : (k,) bool, a lip of the catheter.
    """

    start: Floats
    tangent: Floats
    length: Floats
    lo: Floats
    hi: Floats
    fade_lo: Floats
    fade_hi: Floats
    sharp: NDArray[np.int32]
    friction: Floats
    tube: NDArray[np.bool_]
    corner: Floats
    corner_friction: Floats
    corner_tube: NDArray[np.bool_]

    @property
    def normal(self) -> Floats:
        """(w, 2), unit, into the lumen."""
        return np.column_stack([-self.tangent[:, 1], self.tangent[:, 0]])


@dataclass(frozen=True)
class _Polyline:
    """Wall pieces in a row, the lumen on the left.

    sharp_ends : whether its two ends are sharp. free_ends : whether they stand free, each a corner of its own.
    ends_reach : how far, m, a blunt end reaches on. All of an open line only.
    """

    points: Floats
    closed: bool
    tube: bool
    sharp_ends: tuple[bool, bool] = (False, False)
    free_ends: tuple[bool, bool] = (False, False)
    ends_reach: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class Tube:
    """The catheter in its own frame: the axis along +x, the exit at the origin. bore, length : m.

    walled : it has walls to touch; one that is not there has none.
    """

    bore: float
    length: float
    walled: bool = True


def build_walls(
    outline: Outline,
    tube: Tube,
    radius: float,
    friction: float,
    tube_friction: float,
    seam_reach: float,
    patches: Sequence[Patch] = (),
) -> Walls:
    """All walls for a wire of `radius` (m). seam_reach : m, by which walls that run flush past the exit overlap.
    patches : of the vessel, with a friction of their own; walls are divided where one begins or ends."""
    lines = vessel_polylines(outline, tube)
    flush = [not tube.walled or _is_flush(lines, lip) for lip in _lips(tube)]
    shortest = radius / 4
    polylines = [
        _vessel_line(divided(line, patches, shortest, closed=closed), closed, tube, seam_reach)
        for line, closed in lines
    ]
    if tube.walled:
        polylines += _tube_polylines(tube, flush, seam_reach)
    if not polylines:
        return _no_walls()
    parts = [_segments(line, radius) for line in polylines]
    corners = [_corners(line) for line in polylines]
    lips = np.array([lip for lip, is_flush in zip(_lips(tube), flush, strict=True) if not is_flush]).reshape(-1, 2)
    corner = np.concatenate([*corners, lips])
    corner_tube = np.arange(len(corner)) >= len(corner) - len(lips)
    joined = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    middle = joined["start"] + joined["tangent"] * joined["length"][:, None] / 2
    return Walls(
        **joined,
        friction=np.where(joined["tube"], tube_friction, friction_at(middle, patches, friction)),
        corner=corner,
        corner_friction=np.where(corner_tube, tube_friction, friction_at(corner, patches, friction)),
        corner_tube=corner_tube,
    )


def _no_walls() -> Walls:
    plane, line = np.zeros((0, 2)), np.zeros(0)
    no, none = np.zeros(0, np.bool_), np.zeros(0, np.int32)
    return Walls(plane, plane, line, line, line, line, line, none, line, no, plane, line, no)


def vessel_polylines(outline: Outline, tube: Tube) -> list[tuple[Floats, bool]]:
    """The vessel's walls as (points, closed): the outline without its open ends and without what the catheter fills."""
    count = len(outline.points)
    pieces: list[tuple[Floats, Floats]] = []
    for i in range(count):
        if i not in outline.open_edges:
            pieces += _outside_tube(outline.points[i], outline.points[(i + 1) % count], tube)
    return _chained(pieces)


def corners_into(outline: Outline) -> int:
    """Number of the outline's corners that point into the lumen."""
    return int(np.count_nonzero(_turns(_Polyline(outline.points, True, False)) < -_SHARP_FROM))


def tube_polylines(tube: Tube) -> list[Floats]:
    """The catheter's two walls, the bore on their left: (2, 2) each, m."""
    h = tube.bore / 2
    return [np.array([[-tube.length, -h], [0.0, -h]]), np.array([[0.0, h], [-tube.length, h]])]


def _outside_tube(a: Floats, b: Floats, tube: Tube) -> list[tuple[Floats, Floats]]:
    """The pieces of an edge outside the catheter's bore and mouth (Liang and Barsky's clipping against a rectangle).

    The rectangle is a hair narrower than the bore, so that walls flush with the catheter stay, and reaches a hair past
    the exit, so that a wall across the mouth goes.
    """
    hair = 1e-9
    low, high = np.array([-tube.length, -tube.bore / 2 + hair]), np.array([hair, tube.bore / 2 - hair])
    d, enter, leave = b - a, 0.0, 1.0
    for axis in range(2):
        if d[axis] == 0:
            if not low[axis] < a[axis] < high[axis]:
                return [(a, b)]
            continue
        t0, t1 = sorted(((low[axis] - a[axis]) / d[axis], (high[axis] - a[axis]) / d[axis]))
        enter, leave = max(enter, t0), min(leave, t1)
    if enter >= leave:
        return [(a, b)]
    pieces = [(a, a + enter * d), (a + leave * d, b)]
    return [(p, q) for p, q in pieces if np.hypot(*(q - p)) > 2 * hair]


def _chained(pieces: Sequence[tuple[Floats, Floats]]) -> list[tuple[Floats, bool]]:
    """Pieces in outline order joined where one begins at the end of the other; the last may join on to the first."""
    lines: list[list[Floats]] = []
    for a, b in pieces:
        if lines and np.array_equal(lines[-1][-1], a):
            lines[-1].append(b)
        else:
            lines.append([a, b])
    if not lines:
        return []
    if np.array_equal(lines[-1][-1], lines[0][0]):
        if len(lines) == 1:
            return [(np.array(lines[0][:-1]), True)]
        lines[0] = lines.pop() + lines[0][1:]
    return [(np.array(line), False) for line in lines]


def _lips(tube: Tube) -> list[Floats]:
    return [np.array([0.0, -tube.bore / 2]), np.array([0.0, tube.bore / 2])]


def _is_flush(lines: Sequence[tuple[Floats, bool]], lip: Floats) -> bool:
    """A wall of the vessel runs on from this lip along the axis, so that the lip is no corner."""
    for points, closed in lines:
        ends = np.roll(points, -1, axis=0) if closed else points[1:]
        for a, b in zip(points, ends, strict=False):
            along = abs(b[1] - a[1]) < 1e-9 * abs(b[0] - a[0]) and max(a[0], b[0]) > 1e-6
            if along and abs(a[1] - lip[1]) < 2e-9 and min(a[0], b[0]) <= 2e-9:
                return True
    return False


def _vessel_line(points: Floats, closed: bool, tube: Tube, seam_reach: float) -> _Polyline:
    """A wall of the vessel. Where it begins or ends flush at the exit, it reaches back over the catheter's; where it
    does so at a lip, the lip is the corner; any other end stands free, at an open end of the vessel.
    """
    if closed:
        return _Polyline(points, closed, tube=False)
    h = tube.bore / 2

    def at_lip(point: Floats) -> bool:
        return bool(abs(point[0]) < 2e-9 and abs(abs(point[1]) - h) < 4e-9)

    def at_seam(point: Floats, neighbour: Floats) -> bool:
        return at_lip(point) and bool(abs(neighbour[1] - point[1]) < 1e-9 * abs(neighbour[0] - point[0]))

    lips = at_lip(points[0]), at_lip(points[-1])
    seams = at_seam(points[0], points[1]), at_seam(points[-1], points[-2])
    return _Polyline(
        points,
        closed,
        tube=False,
        sharp_ends=(not seams[0], not seams[1]),
        free_ends=(not lips[0], not lips[1]),
        ends_reach=(seam_reach * seams[0], seam_reach * seams[1]),
    )


def _tube_polylines(tube: Tube, flush: Sequence[bool], seam_reach: float) -> list[_Polyline]:
    lower, upper = tube_polylines(tube)
    low_reach, high_reach = (seam_reach if is_flush else 0.0 for is_flush in flush)
    return [
        _Polyline(lower, False, True, (False, not flush[0]), (False, False), (0.0, low_reach)),
        _Polyline(upper, False, True, (not flush[1], False), (False, False), (high_reach, 0.0)),
    ]


def _turns(line: _Polyline) -> Floats:
    """Turn at each point, rad: positive for a pocket, negative where the corner points into the lumen; 0 at ends."""
    after = np.roll(line.points, -1, axis=0) - line.points
    before = np.roll(after, 1, axis=0)
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turns: Floats = np.arctan2(cross, (before * after).sum(axis=1))
    if not line.closed:
        turns[[0, -1]] = 0.0
    return turns


def _corners(line: _Polyline) -> Floats:
    pointed = _turns(line) < -_SHARP_FROM
    if not line.closed:
        pointed[[0, -1]] = line.free_ends
    found: Floats = line.points[pointed]
    return found


def _segments(line: _Polyline, radius: float) -> dict[str, NDArray[Any]]:
    points, turns = line.points, _turns(line)
    count = len(points) if line.closed else len(points) - 1
    edge = (np.roll(points, -1, axis=0) - points)[:count]
    length = np.hypot(*edge.T)
    ends = [_end(turns[i], radius, float(min(length[i - 1], length[i % count]))) for i in range(len(points))]
    before, after = ends[:count], [ends[(i + 1) % len(points)] for i in range(count)]
    if not line.closed:
        before[0] = _End(line.sharp_ends[0], line.ends_reach[0])
        after[-1] = _End(line.sharp_ends[1], line.ends_reach[1])
    return {
        "start": points[:count],
        "tangent": edge / length[:, None],
        "length": length,
        "lo": np.array([-end.reach for end in before]),
        "hi": length + [end.reach for end in after],
        "fade_lo": np.array([end.fade(radius, x) for end, x in zip(before, length, strict=True)]),
        "fade_hi": np.array([end.fade(radius, x) for end, x in zip(after, length, strict=True)]),
        "sharp": np.array([a.sharp + 2 * b.sharp for a, b in zip(before, after, strict=True)], np.int32),
        "tube": np.full(count, line.tube),
    }


@dataclass(frozen=True)
class _End:
    """An end of a wall. sharp : it points into the lumen. reach : m, how far the wall reaches on. shared : within twice
    the reach it hands over to its neighbour, the two weights summing to one."""

    sharp: bool
    reach: float
    shared: bool = False

    def fade(self, radius: float, length: float) -> float:
        """Width, m, over which the contact with a wall of `length` (m) fades."""
        if self.shared:
            return 2 * self.reach
        fade = min(radius / 2, length / 3)
        return min(fade, self.reach) if self.reach > 0 else fade


def _end(turn: float, radius: float, shorter: float) -> _End:
    """The end of a wall at a corner whose shorter wall has the length `shorter`, m.

    At a pocket a wall reaches on, but never deeper than half a radius behind its neighbour: across a thin septum its
    end would else stand in the next lumen.
    """
    if turn < -_SHARP_FROM:
        return _End(True, 0.0)
    if turn < _SHARED_TO:
        return _End(False, min(radius / 2, shorter / 3), shared=True)
    sine = math.sin(min(turn, math.pi / 2))
    return _End(False, min(_REACH_PAST_POCKET, radius / 2 / max(sine, 1e-9)))
