"""The lumen of a tree of branches: their union with rounded corners, as a closed outline with its open ends.

All areas are put on a grid of a picometre, so that walls which lie on each other make no slivers; what is smaller than
CLEAN of the smallest diameter is smoothed away at the end.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.scenario.vessels.branch_course import Course, arc_facets

if TYPE_CHECKING:
    import shapely

Floats = NDArray[np.float64]

GRID = 1e-12
"""Grid of all areas, m."""

CLEAN = 2.5e-3
"""Detail over the smallest diameter that the outline does not keep."""

_STEP = 0.05
"""Height over the smallest diameter of steps in a wall that the outline does not keep."""

_CORNER = math.radians(5)
"""Turn from which a corner into the lumen is one that a fillet rounds, and no facet of a curve."""

_PAST_AXIS = 0.25
"""How far past its parent's axis a branch begins, over the parent's radius."""

_SAME_PLACE = 1e-6
"""Ends of branches closer than this, m, meet in one joint."""


@dataclass(frozen=True)
class Branch:
    """One branch to unite.

    name : for messages. course : its centre line and radius. fillet : m, of corners into the lumen where it meets a
        branch before it, and of its own bends. ends_open : its beginning, its end; None where it depends on whether
        another branch joins there. side : for a branch that leaves in the middle of another: a point (2,) on that
        one's axis, the axis' heading, rad, and the other's radius, m; what lies well beyond the axis is cut off.
    """

    name: str
    course: Course
    fillet: float
    ends_open: tuple[bool | None, bool | None]
    side: tuple[Floats, float, float] | None = None


@dataclass(frozen=True)
class Fault:
    """What keeps branches from making a lumen. branch : index, or None for all. key : what to look at, may be empty."""

    branch: int | None
    key: str
    message: str


@dataclass(frozen=True)
class Lumen:
    """points : ((x, y), ...), m, counter-clockwise, the first not repeated. open_edges : indices, rising. regions : an
    outline (k, 2), m, of each branch for itself.
    """

    points: tuple[tuple[float, float], ...]
    open_edges: tuple[int, ...]
    regions: tuple[Floats, ...]


@dataclass(frozen=True)
class _End:
    branch: int
    end: int
    cap: Floats
    is_open: bool
    joined: bool

    @property
    def words(self) -> str:
        return "beginning" if self.end == 0 else "end"


def unite(branches: Sequence[Branch]) -> Lumen | list[Fault]:
    """The lumen of the branches, or what keeps them from making one."""
    import shapely

    areas = [_area(branch) for branch in branches]
    ends, joints = _ends_and_joints(branches)
    parts = shapely.get_parts(shapely.union_all([*areas, *joints], grid_size=GRID))
    if len(parts) > 1:
        return _apart(branches, areas)
    lumen = parts[0]
    clean = CLEAN * min(2 * float(branch.course.radius.min()) for branch in branches)
    lumen = _filleted(lumen, branches, areas, clean)
    lumen, loops = _without_specks(lumen, clean)
    faults = [_loop_fault(branches, areas, loop) for loop in loops] + _end_faults(branches, areas, lumen, ends, clean)
    if faults:
        return faults
    caps = [end.cap for end in ends if end.is_open]
    points = _without_steps(_cleaned(lumen, clean, caps), caps, _STEP / CLEAN * clean)
    return Lumen(
        tuple((float(x), float(y)) for x, y in points),
        _open_edges(points, caps, 2 * clean),
        tuple(np.asarray(area.exterior.coords)[:-1] for area in areas),
    )


def _area(branch: Branch) -> shapely.Polygon:
    """The area of a branch. Raises CourseError where it folds."""
    import shapely

    pieces = [shapely.Polygon(quad) for quad in branch.course.quads()]
    if branch.side is None:
        return shapely.union_all(pieces, grid_size=GRID)
    origin, axis, parent_radius = branch.side
    point, heading, radius = branch.course.at(0.0)
    # Both walls run back to the parent's axis and a little on, so that branches to either side overlap.
    beyond = _PAST_AXIS * parent_radius
    back = radius / abs(math.tan(heading - axis)) + beyond / abs(math.sin(heading - axis)) + radius
    along, across = np.array([math.cos(heading), math.sin(heading)]), np.diff(branch.course.cap(0), axis=0)[0] / 2
    root = shapely.Polygon(
        [point - across - back * along, point - across, point + across, point + across - back * along]
    )
    reach = 2 * (branch.course.length + back + 2 * float(branch.course.radius.max()))
    left = np.array([-math.sin(axis), math.cos(axis)]) * math.copysign(1.0, math.sin(heading - axis))
    origin = origin - beyond * left
    forward = reach * np.array([math.cos(axis), math.sin(axis)])
    half = shapely.Polygon(
        [origin - forward, origin + forward, origin + forward + reach * left, origin - forward + reach * left]
    )
    whole = shapely.union_all([root, *pieces], grid_size=GRID)
    return shapely.intersection(whole, half, grid_size=GRID)


def _ends_and_joints(branches: Sequence[Branch]) -> tuple[list[_End], list[shapely.Polygon]]:
    """Every end, and the areas that close the wedge where ends of branches meet in one point."""
    import shapely

    caps = [(i, end, branch.course.cap(end)) for i, branch in enumerate(branches) for end in (0, -1)]
    middles = np.array([cap.mean(axis=0) for _, _, cap in caps])
    ends, joints = [], []
    for k, (i, end, cap) in enumerate(caps):
        meeting = np.flatnonzero(np.hypot(*(middles - middles[k]).T) <= _SAME_PLACE)
        near = [int(m) for m in meeting if not (caps[m][1] == 0 and branches[caps[m][0]].side is not None)]
        joined = len(near) > 1 and k in near
        if joined and k == min(near):
            joints.append(shapely.MultiPoint(np.concatenate([caps[m][2] for m in near])).convex_hull)
        wanted = branches[i].ends_open[end]
        ends.append(_End(i, end, cap, bool(wanted) if wanted is not None else not joined, joined))
    return ends, joints


def _apart(branches: Sequence[Branch], areas: Sequence[shapely.Polygon]) -> list[Fault]:
    """Which branches do not touch what comes before them."""
    import shapely

    group, left = [0], set(range(1, len(branches)))
    while near := {i for i in left if areas[i].intersection(shapely.union_all([areas[j] for j in group])).area > 0}:
        group += sorted(near)
        left -= near
    united = shapely.union_all([areas[j] for j in group])
    first = min(left, key=lambda i: areas[i].distance(united))
    nearest = min(group, key=lambda j: areas[j].distance(areas[first]))
    gap = areas[first].distance(areas[nearest]) * 1e3
    text = f"there is a gap of {gap:.4g} mm between {branches[first].name!r} and {branches[nearest].name!r}"
    return [Fault(first, "points", f"{text}; every branch must overlap another, move its points")]


def _filleted(
    lumen: shapely.Polygon, branches: Sequence[Branch], areas: Sequence[shapely.Polygon], clean: float
) -> shapely.Polygon:
    """The lumen with its corners rounded: what a disc of the fillet's radius, rolled along the walls' outside, does not
    reach is added at each corner.
    """
    import shapely

    wanted: dict[float, list[Floats]] = {}
    for corner in _corners_into(lumen):
        owners = [i for i, area in enumerate(areas) if area.boundary.distance(shapely.Point(corner)) < clean]
        radius = branches[max(owners)].fillet if owners else 0.0
        if radius > 0:
            wanted.setdefault(radius, []).append(corner)
    webs = []
    width = min(2 * float(branch.course.radius.min()) for branch in branches)
    for radius, corners in wanted.items():
        facets = arc_facets(math.pi / 2, radius, width)
        wide = lumen.buffer(radius, join_style="mitre", mitre_limit=20)
        closed = wide.buffer(-radius, join_style="round", quad_segs=facets)
        spots = shapely.MultiPoint(corners)
        added = shapely.difference(closed, lumen, grid_size=GRID)
        webs += [web for web in shapely.get_parts(added) if web.area > clean**2 and web.distance(spots) < clean]
    return shapely.union_all([lumen, *webs], grid_size=GRID) if webs else lumen


def _corners_into(lumen: shapely.Polygon) -> list[Floats]:
    points = np.asarray(lumen.exterior.coords)[:-1]
    if not lumen.exterior.is_ccw:
        points = points[::-1]
    turns = _turns(points)
    return [point for point, turn in zip(points, turns, strict=True) if turn < -_CORNER]


def _turns(points: Floats) -> Floats:
    after = np.roll(points, -1, axis=0) - points
    before = np.roll(after, 1, axis=0)
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turns: Floats = np.arctan2(cross, (before * after).sum(axis=1))
    return turns


def _without_specks(lumen: shapely.Polygon, clean: float) -> tuple[shapely.Polygon, list[shapely.Polygon]]:
    """The lumen without its holes, and the holes that are more than specks."""
    import shapely

    holes = [shapely.Polygon(ring) for ring in lumen.interiors]
    return shapely.Polygon(lumen.exterior), [hole for hole in holes if not hole.buffer(-clean).is_empty]


def _loop_fault(branches: Sequence[Branch], areas: Sequence[shapely.Polygon], loop: shapely.Polygon) -> Fault:
    touching = [i for i, area in enumerate(areas) if area.distance(loop) < 1e-9]
    names = " and ".join(repr(branches[i].name) for i in touching)
    x, y = loop.representative_point().coords[0]
    text = f"{names or 'the branches'} make a loop round an island at ({x * 1e3:.6g}, {y * 1e3:.6g}) mm"
    return Fault(max(touching, default=None), "", f"{text}; loops are not supported, end a branch before it closes one")


def _end_faults(
    branches: Sequence[Branch],
    areas: Sequence[shapely.Polygon],
    lumen: shapely.Polygon,
    ends: Sequence[_End],
    clean: float,
) -> list[Fault]:
    """Ends that are neither free nor inside another branch."""
    import shapely

    rim, faults = lumen.exterior.buffer(clean), []
    for end in ends:
        line = shapely.LineString(end.cap)
        free = line.intersection(rim).length / line.length
        branch = branches[end.branch]
        if end.joined or (end.end == 0 and branch.side is not None):
            continue
        others = [branches[i].name for i, a in enumerate(areas) if i != end.branch and a.intersects(line)]
        inside = " and ".join(repr(name) for name in others) or "the rest of the vessel"
        if end.end == -1 and branch.side is not None and free < 0.01:
            text = f"the branch ends inside {inside}; make it longer"
            faults.append(Fault(end.branch, "length", text))
        elif end.is_open and 0.01 < free < 0.99:
            text = f"the {end.words} lies half inside {inside} and half outside"
            faults.append(Fault(end.branch, "", f"{text}; move it, so that it lies wholly inside or wholly outside"))
    # Two ends that cut into each other are one mistake: that of the later branch.
    return [fault for fault in faults if fault.branch == faults[-1].branch]


def _cleaned(lumen: shapely.Polygon, clean: float, caps: Sequence[Floats]) -> Floats:
    """Corners of the outline, counter-clockwise, without those that lie within `clean` of the line past them; where an
    open end begins or ends, a corner stays even if the wall goes straight on.
    """
    import shapely

    points = np.asarray(shapely.orient_polygons(lumen).exterior.coords)[:-1]
    kept = {int(np.argmax(np.abs(_turns(points))))}
    for corner in (corner for cap in caps for corner in cap):
        far = np.hypot(*(points - corner).T)
        if far.min() < clean:
            kept.add(int(np.argmin(far)))
    first, *others = sorted(kept)
    points = np.roll(points, -first, axis=0)
    stops = [0, *(i - first for i in others), len(points)]
    ring = np.concatenate([points, points[:1]])
    pieces = [
        np.asarray(shapely.LineString(ring[a : b + 1]).simplify(clean).coords)[:-1] if b - a > 1 else ring[a:b]
        for a, b in pairwise(stops)
    ]
    return np.concatenate(pieces)


def _without_steps(points: Floats, caps: Sequence[Floats], highest: float) -> Floats:
    """The outline without low steps, left where branches of all but fitting widths meet: the walls on both sides of a
    step are drawn on to where they cross, or to its middle.
    """
    ends = np.concatenate([*caps, np.full((1, 2), np.inf)])
    while len(points) > 4:
        turns, after = _turns(points), np.roll(points, -1, axis=0)
        step = (turns * np.roll(turns, -1) < 0) & (np.hypot(*(after - points).T) < highest)
        at_cap = np.hypot(*np.moveaxis(points[:, None] - ends[None], -1, 0)).min(axis=1) < highest
        found = np.flatnonzero(step & ~at_cap & ~np.roll(at_cap, -1))
        if not len(found):
            break
        points = np.roll(points, 1 - int(found[0]), axis=0)  # the step is now from point 1 to point 2
        a, b, c, d = points[:4]
        meeting, middle = _crossing(a, b, d, c), (b + c) / 2
        if meeting is None or np.hypot(*(meeting - middle)) > 2 * highest:
            meeting = middle
        points = np.concatenate([points[:1], meeting[None], points[3:]])
    return points


def _crossing(a: Floats, b: Floats, c: Floats, d: Floats) -> Floats | None:
    """Where the line through a and b crosses that through c and d; None where they run alike."""
    along, other = b - a, d - c
    across = along[0] * other[1] - along[1] * other[0]
    if abs(across) < 1e-6 * np.hypot(*along) * np.hypot(*other):
        return None
    part = ((c - a)[0] * other[1] - (c - a)[1] * other[0]) / across
    found: Floats = a + part * along
    return found


def _open_edges(points: Floats, caps: Sequence[Floats], near: float) -> tuple[int, ...]:
    import shapely

    lines = [shapely.LineString(cap).buffer(near) for cap in caps]
    edges = [shapely.LineString([a, b]) for a, b in zip(points, np.roll(points, -1, axis=0), strict=True)]
    return tuple(
        i for i, edge in enumerate(edges) if edge.length > 2 * near and any(line.contains(edge) for line in lines)
    )
