"""The course of a branch: its centre line with rounded bends, and the radius of the lumen along it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

FACET_TOLERANCE = 0.005
"""How far, over the local diameter, a straight wall piece may lie from the curve that it stands for."""

STEEPEST_FACET = math.radians(22.5)
"""Largest turn between two wall pieces of one curve, rad."""

SHARPEST_BEND = math.radians(150)
"""Largest turn, rad, of a centre line at one point; beyond, the outer corner would run far away."""

_SAME = 1e-9  # m


class CourseError(ValueError):
    """A centre line that makes no lumen. key : the key of the branch to look at. where : (x, y), m, or None."""

    def __init__(self, key: str, message: str, where: tuple[float, float] | None = None) -> None:
        super().__init__(message)
        self.key, self.where = key, where


@dataclass(frozen=True)
class Course:
    """A centre line and the lumen's radius on it.

    points : (k, 2), m. radius : (k,), m. A station may be there twice where the radius steps.
    """

    points: Floats
    radius: Floats

    @property
    def length(self) -> float:
        """Length of the centre line, m."""
        return float(np.hypot(*np.diff(self.points, axis=0).T).sum())

    def at(self, place: float) -> tuple[Floats, float, float]:
        """Point (2,), m, heading, rad, and radius, m, at a length (m) along the centre line."""
        steps = np.diff(self.points, axis=0)
        lengths = np.hypot(*steps.T)
        ends = np.cumsum(lengths)
        i = min(int(np.searchsorted(ends, place - _SAME)), len(steps) - 1)
        while lengths[i] <= _SAME and i + 1 < len(steps):
            i += 1
        part = min(1.0, max(0.0, (place - (ends[i] - lengths[i])) / lengths[i]))
        radius = self.radius[i] + part * (self.radius[i + 1] - self.radius[i])
        return self.points[i] + part * steps[i], math.atan2(steps[i, 1], steps[i, 0]), float(radius)

    def cap(self, end: int) -> Floats:
        """(2, 2), m: the cross-section at the beginning (0) or the end (-1), from its right to its left."""
        stations = self.points if end == 0 else self.points[::-1]
        step = next(p - stations[0] for p in stations[1:] if np.hypot(*(p - stations[0])) > _SAME)
        along = step / np.hypot(*step) * (1.0 if end == 0 else -1.0)
        across = self.radius[end] * np.array([-along[1], along[0]])
        return np.array([self.points[end] - across, self.points[end] + across])

    def quads(self) -> list[Floats]:
        """The lumen as (4, 2) pieces, m, one for each step of the centre line; they share their corners. Raises
        CourseError where the lumen folds.
        """
        steps = np.diff(self.points, axis=0)
        lengths = np.hypot(*steps.T)
        kept = np.flatnonzero(lengths > _SAME)
        unit = steps[kept] / lengths[kept, None]
        normal = np.column_stack([-unit[:, 1], unit[:, 0]])
        cosine = (normal[1:] * normal[:-1]).sum(axis=1)
        middle = (normal[1:] + normal[:-1]) / (1 + cosine)[:, None]
        first, last = np.vstack([normal[:1], middle]), np.vstack([middle, normal[-1:]])
        found = []
        for k, i in enumerate(kept):
            r0, r1 = self.radius[i], self.radius[i + 1]
            a, b = self.points[i], self.points[i + 1]
            quad = np.array([a - r0 * first[k], b - r1 * last[k], b + r1 * last[k], a + r0 * first[k]])
            if min((quad[1] - quad[0]) @ unit[k], (quad[2] - quad[3]) @ unit[k]) <= 0:
                x, y = (a + b) / 2
                raise CourseError("diameter", _folds(x, y, max(r0, r1)), (float(x), float(y)))
            found.append(quad)
        return found


def _folds(x: float, y: float, radius: float) -> str:
    return (
        f"the lumen folds at ({x * 1e3:.6g}, {y * 1e3:.6g}) mm: the centre line bends there more tightly "
        f"than the lumen's radius, {radius * 1e3:.6g} mm; take a smaller diameter there or a gentler bend"
    )


def make_course(points: Sequence[Sequence[float]], diameters: DiameterTable, bend_radius: float) -> Course:
    """The course of a branch.

    points : corners of the centre line, m. diameters : see DiameterTable. bend_radius : m, of the centre line at its
        inner points; 0 leaves them sharp.

    Raises CourseError.
    """
    corners = np.array(points, dtype=float)
    if (np.hypot(*np.diff(corners, axis=0).T) <= _SAME).any():
        raise CourseError("points", "two points in a row are the same; remove one")
    line = _rounded(corners, bend_radius, diameters.smallest)
    places = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    return _with_radius(line, places, diameters)


@dataclass(frozen=True)
class DiameterTable:
    """Diameters along a branch. rows : ((place, diameter), ...), m; with `relative` the places are parts of the whole
    length. A place may come twice, for a step; the last diameter holds to the end.
    """

    rows: tuple[tuple[float, float], ...]
    relative: bool

    @property
    def smallest(self) -> float:
        """Smallest diameter, m."""
        return min(diameter for _, diameter in self.rows)


def _with_radius(line: Floats, places: Floats, diameters: DiameterTable) -> Course:
    """The line with a station at every row of the diameters."""
    scale = places[-1] if diameters.relative else 1.0
    rows = np.array(diameters.rows) * [scale, 0.5]
    if rows[-1, 0] > places[-1] * (1 + 1e-6) + 1e-6:
        raise CourseError(
            "diameter",
            f"has a row at {rows[-1, 0] * 1e3:.6g} mm; the branch is {places[-1] * 1e3:.6g} mm long",
        )
    inside = rows[(rows[:, 0] > _SAME) & (rows[:, 0] < places[-1] - _SAME)]
    far = np.array([np.abs(inside[:, 0] - p).min() > _SAME if len(inside) else True for p in places])
    stations = [(float(p), float(np.interp(p, rows[:, 0], rows[:, 1]))) for p in places[far]]
    stations += [(float(p), float(r)) for p, r in inside]
    stations.sort(key=lambda row: row[0])  # stable: the two rows of a step keep their order
    at, radius = np.array(stations).T
    return Course(np.column_stack([np.interp(at, places, line[:, k]) for k in range(2)]), radius)


def _rounded(corners: Floats, radius: float, diameter: float) -> Floats:
    steps = np.diff(corners, axis=0)
    lengths, headings = np.hypot(*steps.T), np.arctan2(steps[:, 1], steps[:, 0])
    turns = (np.diff(headings) + math.pi) % (2 * math.pi) - math.pi
    for i in np.flatnonzero(np.abs(turns) > SHARPEST_BEND):
        text = f"the centre line turns by {math.degrees(abs(turns[i])):.4g} deg at point {i + 1}, at most 150"
        raise CourseError("points", f"{text}; put a point between")
    if radius == 0:
        return corners
    reach = radius * np.tan(np.abs(turns) / 2)
    need = np.concatenate([[0.0], reach]) + np.concatenate([reach, [0.0]])
    for i in np.flatnonzero(need > lengths * (1 + 1e-9)):
        text = f"{radius * 1e3:.6g} mm needs {need[i] * 1e3:.6g} mm between the points {i} and {i + 1}"
        raise CourseError("bend_radius", f"{text}, which are {lengths[i] * 1e3:.6g} mm apart; take a smaller one")
    line = [corners[0]]
    for corner, turn in enumerate(turns):
        facets = arc_facets(abs(turn), radius + diameter / 2, diameter)
        begin = corners[corner + 1] - reach[corner] * steps[corner] / lengths[corner]
        for angle in np.linspace(0.0, turn, facets + 1):
            chord, course = 2 * radius * math.sin(abs(angle) / 2), headings[corner] + angle / 2
            line.append(begin + chord * np.array([math.cos(course), math.sin(course)]))
    line.append(corners[-1])
    apart = [True] + [bool(np.hypot(*(b - a)) > _SAME) for a, b in pairwise(line)]
    return np.array([point for point, kept in zip(line, apart, strict=True) if kept])


def arc_facets(turn: float, radius: float, diameter: float) -> int:
    """How many straight pieces an arc (turn, rad; radius, m) needs in a lumen of that diameter, m."""
    sagitta = min(FACET_TOLERANCE * diameter / radius, 1.0)
    return max(1, math.ceil(turn / min(2 * math.acos(1 - sagitta), STEEPEST_FACET) - 1e-9))
