"""Two courses over time set against each other: how far apart, in numbers, and what their scenarios say otherwise.

Pairs are taken at equal time from the start, over the time that both have (our reading of Sharei et al. 2019, Eq. 14);
beside it stands the distance to the nearest point of the other path, which does not mind a delay.

Quantities that were taken at different rates may stand in one table, so that each has empty cells in the rows of the
others. Each is therefore interpolated over its own known values. A gap, over which nothing is interpolated, is where
cells are empty and the known values on both sides are further apart than `GAP` times the median spacing of that
quantity's known values, or where there is a known value on one side only.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.errors import ComparisonError
from gw_exudyn.quantities import QUANTITIES

if TYPE_CHECKING:
    from gw_exudyn.result import Result

Floats = NDArray[np.float64]

COMPARED = (
    "insertion_depth",
    "tip_angle",
    "push_force",
    "tip_force",
    "wall_force_x",
    "wall_force_y",
    "wall_force_normal",
)
"""Scalars that are compared, besides the path of the tip."""

PATH = ("tip_x", "tip_y")

_SAME_TIME = 1e-9
"""s; instants closer than this are one."""

GAP = 1.5
"""Times its median spacing by which known values of a quantity lie apart at a gap: at one rate, a single empty cell."""


@dataclass(frozen=True, eq=False)
class Course:
    """Quantities over time, in SI, empty cells as NaN.

    time : (k,), s, rising. values : by the name of the quantity, each (k,); any of `COMPARED`, and both of `PATH`.
    """

    name: str
    time: Floats
    values: Mapping[str, Floats]


@dataclass(frozen=True)
class Norm:
    """One number that says how far apart two courses are: value in SI, unit, meaning."""

    value: float
    unit: str
    meaning: str


@dataclass(frozen=True)
class Difference:
    """A value that two scenarios have otherwise; None where one has none."""

    path: str
    first: Any
    second: Any


def course_of(result: Result) -> Course:
    """The course of a run."""
    return Course(result.scenario.name, result.time, {name: result.values(name) for name in (*PATH, *COMPARED)})


def compare(first: Course, second: Course) -> dict[str, Norm]:
    """Norms of the difference, second less first, by name.

    Of the tip's path: `tip_rms`, `tip_max`, `tip_final` of the distance at equal times, `tip_nearest_rms` and
    `tip_nearest_max` of the distance of each of the first's points to the second's path, but for points whose time
    lies in a gap; the path breaks at gaps. Of every scalar that both have: its name with `_rms` and `_max`.

    A norm is NaN where no instant is known of both.

    Raises ComparisonError where the two have no time, or nothing at all, in common.
    """
    time = common_time(first, second)
    norms: dict[str, Norm] = {}
    if _both_have(first, second, *PATH):
        norms |= _path_norms(first, second, time)
    for name in COMPARED:
        if _both_have(first, second, name):
            apart = np.abs(at(second, name, time) - at(first, name, time))
            unit, words = QUANTITIES[name].unit, QUANTITIES[name].label
            norms[f"{name}_rms"] = Norm(_rms(apart), unit, f"root mean square difference of the {words}")
            norms[f"{name}_max"] = Norm(_largest(apart), unit, f"largest difference of the {words}")
    if not norms:
        raise ComparisonError(f"{first.name} and {second.name} have no quantity in common: nothing to compare")
    return norms


def common_time(first: Course, second: Course) -> Floats:
    """Instants, s, of the first that lie in the time of both. Raises ComparisonError where there is none."""
    begin, end = max(first.time[0], second.time[0]), min(first.time[-1], second.time[-1])
    within: Floats = first.time[(first.time >= begin - _SAME_TIME) & (first.time <= end + _SAME_TIME)]
    if not len(within):
        raise ComparisonError(
            f"{first.name} ({first.time[0]:g} to {first.time[-1]:g} s) and {second.name} "
            f"({second.time[0]:g} to {second.time[-1]:g} s) have no time in common"
        )
    return within


def shared_time(first: Course, second: Course) -> tuple[float, float]:
    """How long, s, the time of both is, and that of the shorter."""
    shared = min(first.time[-1], second.time[-1]) - max(first.time[0], second.time[0])
    return max(float(shared), 0.0), float(min(np.ptp(first.time), np.ptp(second.time)))


def at(course: Course, name: str, time: Floats) -> Floats:
    """A quantity at other instants, linear between its known values; NaN in its gaps."""
    values = course.values[name]
    known = np.isfinite(values)
    if not known.any():
        return np.full(len(time), np.nan)
    found: Floats = np.interp(time, course.time[known], values[known])
    for begin, end in _gaps(course.time, known):
        found[(time > begin + _SAME_TIME) & (time < end - _SAME_TIME)] = np.nan
    return found


def drawn_rows(time: Floats, values: Floats) -> NDArray[np.bool_]:
    """(k,) Rows of a line through values, (k,) or (k, 2): the known ones, and those of a gap, where it breaks."""
    rows = np.asarray(np.isfinite(values.reshape(len(time), -1)).all(axis=1))
    for begin, end in _gaps(time, rows.copy()):
        rows |= (time > begin) & (time < end)
    return rows


def _gaps(time: Floats, known: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """Begin and end, s, of the gaps: the last instant known before and the first known after, if any."""
    rows = np.flatnonzero(known)
    if not len(rows):
        return [(-np.inf, np.inf)]
    here = time[rows]
    far = np.diff(here) > GAP * np.median(np.diff(here)) if len(rows) > 1 else np.zeros(0, bool)
    between = np.flatnonzero((np.diff(rows) > 1) & far)
    gaps = [(float(here[i]), float(here[i + 1])) for i in between]
    if rows[0] > 0:
        gaps.insert(0, (-np.inf, float(here[0])))
    if rows[-1] < len(time) - 1:
        gaps.append((float(here[-1]), np.inf))
    return gaps


def distance(first: Course, second: Course, time: Floats) -> Floats:
    """Distance of the two tips at equal times, m."""
    along_x, along_y = (at(second, name, time) - at(first, name, time) for name in PATH)
    apart: Floats = np.hypot(along_x, along_y)
    return apart


def nearest_distance(points: Floats, path: Floats) -> Floats:
    """(k,) Distance, m, of each of the points (k, 2) to the polyline `path` (m, 2), which breaks where its rows
    are NaN; NaN for points that are.
    """
    from shapely import GeometryCollection, LineString, Point
    from shapely import distance as apart
    from shapely import points as as_points

    there = np.isfinite(points).all(axis=1)
    rows = np.flatnonzero(np.isfinite(path).all(axis=1))
    found = np.full(len(points), np.nan)
    if len(rows) and there.any():
        pieces = [path[piece] for piece in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1)]
        lines = GeometryCollection([LineString(piece) if len(piece) > 1 else Point(piece[0]) for piece in pieces])
        found[there] = apart(as_points(points[there]), lines)
    return found


def differences(first: Mapping[str, Any], second: Mapping[str, Any]) -> list[Difference]:
    """What two resolved scenarios (`Scenario.to_dict`) say otherwise, but for their names, by dotted path."""
    here, there = dict(_flat(first)), dict(_flat(second))
    paths = list(dict.fromkeys([*here, *there]))
    return [
        Difference(path, here.get(path), there.get(path))
        for path in paths
        if path != "name" and here.get(path) != there.get(path)
    ]


def _flat(content: Any, above: str = "") -> Iterator[tuple[str, Any]]:
    items = content.items() if isinstance(content, Mapping) else enumerate(content)
    for key, value in items:
        path = f"{above}.{key}" if above else str(key)
        if isinstance(value, Mapping | list | tuple) and len(value):
            yield from _flat(value, path)
        else:
            yield path, value


def _path_norms(first: Course, second: Course, time: Floats) -> dict[str, Norm]:
    apart = distance(first, second, time)
    path, other = (np.column_stack([course.values[name] for name in PATH]) for course in (first, second))
    common = np.isfinite(apart)  # a point has no nearest one on a path that is not known at its time
    near = nearest_distance(path[np.isin(first.time, time)][common], other[drawn_rows(second.time, other)])
    unit = QUANTITIES["tip_x"].unit
    known = apart[common]
    return {
        "tip_rms": Norm(_rms(apart), unit, "root mean square distance of the tips at equal times"),
        "tip_max": Norm(_largest(apart), unit, "largest distance of the tips at equal times"),
        "tip_final": Norm(
            float(known[-1]) if len(known) else float("nan"), unit, "distance of the tips at the last common time"
        ),
        "tip_nearest_rms": Norm(_rms(near), unit, "root mean square distance of the first's path from the second's"),
        "tip_nearest_max": Norm(_largest(near), unit, "largest distance of the first's path from the second's"),
    }


def _both_have(first: Course, second: Course, *names: str) -> bool:
    return all(name in course.values for course in (first, second) for name in names)


def _rms(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else float("nan")


def _largest(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(known.max()) if len(known) else float("nan")
