"""A solver of its own for one question: an elastic rod pushed round a sharp corner, quasi-statically and with friction.

It shares no code and no method with the simulation. The rod is a smooth inextensible curve, its angle piecewise linear
in arc length (the simulation's is constant in each segment); there is no mass, no time and no damper; each place of the
drive is a minimum of the potential of bending, walls and friction, whose normal forces are taken from the pass before
(lagged friction, as in incremental potential contact [Li et al. 2020]).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Rod:
    """radius : m. lengths : (n,), m, of the elements from the proximal end. stiffness : (n,), N m^2."""

    radius: float
    lengths: Floats
    stiffness: Floats


@dataclass(frozen=True)
class Corner:
    """A channel along the x axis that turns left at the origin. angle : rad, under pi/2. width : m."""

    angle: float
    width: float

    @property
    def normals(self) -> Floats:
        """(2, 2): of the outer walls before and after the corner, into the lumen; the inner walls' point against
        them."""
        return np.array([[0.0, 1.0], [-math.sin(self.angle), math.cos(self.angle)]])

    @property
    def directions(self) -> Floats:
        """(2, 2): along the walls, into the vessel."""
        return np.column_stack([self.normals[:, 1], -self.normals[:, 0]])

    @property
    def inner(self) -> Floats:
        """(2,), m: the corner that points into the lumen."""
        total: Floats = self.normals.sum(axis=0)
        return total * (self.width / 2 / (1 + math.cos(self.angle)))


@dataclass(frozen=True)
class Law:
    """stiffness : N/m, of one contact; onset : m, over which it sets in. friction : Coulomb's. creep : m, the slip at
    which friction is nearly full."""

    stiffness: float
    friction: float
    onset: float = 2e-6
    creep: float = 1e-6


class Pushed(NamedTuple):
    """x, y : (n + 1,), m, of the nodes. push_force : N."""

    x: Floats
    y: Floats
    push_force: float


class _Point(NamedTuple):
    """A place on the rod: an element, and how far along it, 0 to 1."""

    element: int
    share: float


class _Touch(NamedTuple):
    """A point of the rod near a wall. normal : (2,), away from the wall. gap : m."""

    point: _Point
    normal: Floats
    gap: float


class _Drag(NamedTuple):
    """Friction at a point: at most limit, N, against the slip, m, along `direction` from the place before the step."""

    point: _Point
    direction: Floats
    before: Floats
    limit: float


def _along(angle: Floats | float) -> Floats:
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def _left(angle: Floats | float) -> Floats:
    return np.stack([-np.sin(angle), np.cos(angle)], axis=-1)


class _Curve:
    """The rod at given angles of its nodes; places by Simpson's rule in each element."""

    def __init__(self, lengths: Floats, angle: Floats, base: float) -> None:
        self.lengths, self.angle = lengths, angle
        self._middle = (angle[:-1] + angle[1:]) / 2
        ends, middle = _along(angle), _along(self._middle)
        pieces = lengths[:, None] * (ends[:-1] + 4 * middle + ends[1:]) / 6
        self.nodes = np.vstack([[base, 0.0], [base, 0.0] + np.cumsum(pieces, axis=0)])
        ends, middle = _left(angle), _left(self._middle)
        self._by_first = lengths[:, None] * (ends[:-1] + 2 * middle) / 6
        self._by_second = lengths[:, None] * (2 * middle + ends[1:]) / 6

    def _angles(self, point: _Point) -> tuple[float, float, float]:
        first, second = float(self.angle[point.element]), float(self.angle[point.element + 1])
        end = first + point.share * (second - first)
        return first, (first + end) / 2, end

    def place(self, point: _Point) -> Floats:
        """(2,), m."""
        first, middle, end = self._angles(point)
        reach = float(self.lengths[point.element]) * point.share
        place: Floats = self.nodes[point.element] + reach * (_along(first) + 4 * _along(middle) + _along(end)) / 6
        return place

    def angle_at(self, point: _Point) -> float:
        """Rad."""
        return self._angles(point)[2]

    def gradient(self, point: _Point, direction: Floats) -> Floats:
        """(n + 1,), m: of the point's place along a direction, by the angles."""
        e, share = point
        rows = np.zeros(len(self.angle))
        rows[:e] += self._by_first[:e] @ direction
        rows[1 : e + 1] += self._by_second[:e] @ direction
        first, middle, end = (_left(angle) @ direction for angle in self._angles(point))
        reach = float(self.lengths[e]) * share / 6
        rows[e] += reach * (first + 4 * middle * (1 - share / 2) + end * (1 - share))
        rows[e + 1] += reach * (2 * middle * share + end * share)
        return rows

    def stiffening(self, forces: list[tuple[_Point, Floats]]) -> tuple[Floats, Floats]:
        """Second derivative of the work of constant forces, counted negative: its diagonal (n + 1,) and the
        neighbours' (n,), N m."""
        tail = np.zeros((len(self.lengths), 2))
        for point, force in forces:
            tail[: point.element] += force
            tail[point.element] += point.share * force
        tail *= self.lengths[:, None] / 6
        ends, middle = _along(self.angle), _along(self._middle)
        diagonal = np.zeros(len(self.angle))
        diagonal[:-1] += (tail * (ends[:-1] + middle)).sum(axis=1)
        diagonal[1:] += (tail * (ends[1:] + middle)).sum(axis=1)
        return diagonal, (tail * middle).sum(axis=1)


class Elastica:
    """The rod in the corner, straight at first with its tip at x = `tip`, m. Its proximal end keeps to the axis, does
    not turn, and is driven along it."""

    def __init__(self, rod: Rod, corner: Corner, law: Law, tip: float) -> None:
        self.rod, self.corner, self.law = rod, corner, law
        bending = rod.stiffness / rod.lengths
        self._bending = np.diag(np.append(bending, 0.0) + np.append(0.0, bending))
        self._bending -= np.diag(bending, 1) + np.diag(bending, -1)
        self._base = tip - float(rod.lengths.sum())
        self._now = _Curve(rod.lengths, np.zeros(len(rod.lengths) + 1), self._base)

    def push(self, travel: float, step: float) -> list[Pushed]:
        """Push by `travel` in equal steps of about `step`, m; what each led to."""
        count = math.ceil(travel / step)
        start = self._base
        return [self._to(start + travel * (i + 1) / count) for i in range(count)]

    def _to(self, base: float) -> Pushed:
        """The next place of the drive: passes with normal forces held in the friction until they no longer change."""
        before, force = self._now, math.inf
        self._base = base
        self._now = _Curve(self.rod.lengths, before.angle, base)
        drags = self._drags(before, before)
        for _ in range(_MOST_PASSES):
            self._settle(drags)
            drags = self._drags(self._now, before)
            last, force = force, self._push_force(drags)
            if abs(force - last) <= _SAME * abs(force) + _LEAST:
                break
        return Pushed(self._now.nodes[:, 0], self._now.nodes[:, 1], force)

    def _settle(self, drags: list[_Drag]) -> None:
        """Newton's method with a line search, down the potential."""
        for _ in range(_MOST_ITERATIONS):
            value, gradient, hessian = self._slopes(self._now, drags)
            if np.abs(gradient[1:]).max() < _BALANCE:
                return
            way = np.zeros_like(gradient)
            way[1:] = -_solve_downhill(hessian[1:, 1:], gradient[1:])
            way *= min(1.0, _LARGEST_TURN / np.abs(way).max())
            for _ in range(30):
                trial = _Curve(self.rod.lengths, self._now.angle + way, self._base)
                if self._value(trial, drags) <= value + 1e-4 * float(gradient @ way) + 1e-16:
                    break
                way /= 2
            self._now = trial

    def _touches(self, curve: _Curve) -> Iterator[_Touch]:
        radius, half = self.rod.radius, self.corner.width / 2
        height = curve.nodes[1:] @ self.corner.normals.T
        near = half - radius - _FAR * self.law.onset
        for wall, normal in enumerate(self.corner.normals):
            for i in np.flatnonzero(height[:, wall] < -near):
                yield _Touch(_Point(int(i), 1.0), normal, float(half + height[i, wall]) - radius)
        # An inner wall holds the nodes whose foot is on it, not on what would be its way on past the corner.
        past = (curve.nodes[1:] - self.corner.inner) @ self.corner.directions.T
        beside = (height > near) & np.column_stack([past[:, 0] < 0, past[:, 1] > 0])
        for i, wall in zip(*np.nonzero(beside), strict=True):
            yield _Touch(_Point(int(i), 1.0), -self.corner.normals[wall], float(half - height[i, wall]) - radius)
        corner = self._at_corner(curve)
        if corner is not None:
            yield corner

    def _at_corner(self, curve: _Curve) -> _Touch | None:
        """The point of the rod whose normal goes through the inner corner, which stays on the rod's left."""
        corner = self.corner.inner
        ahead = ((corner - curve.nodes) * _along(curve.angle)).sum(axis=1)
        crossed = np.flatnonzero((ahead[:-1] > 0) & (ahead[1:] <= 0))
        if not len(crossed):
            return None
        e = int(crossed[-1])
        low, high, low_value, high_value = 0.0, 1.0, float(ahead[e]), float(ahead[e + 1])
        for _ in range(4):  # the rule of false position: the function is all but straight within an element
            share = low + (high - low) * low_value / (low_value - high_value)
            point = _Point(e, share)
            value = float((corner - curve.place(point)) @ _along(curve.angle_at(point)))
            if value > 0:
                low, low_value = share, value
            else:
                high, high_value = share, value
        left = _left(curve.angle_at(point))
        return _Touch(point, -left, float((corner - curve.place(point)) @ left) - self.rod.radius)

    def _normal(self, gap: float) -> tuple[float, float, float]:
        """Energy (J), force (N) and stiffness (N/m) of a contact: ln(1 + exp(x)) goes over from nothing to x."""
        k, onset = self.law.stiffness, self.law.onset
        x = -gap / onset
        if x > 30:
            return k * onset**2 * (x * x / 2 + math.pi**2 / 6), k * onset * x, k
        from scipy.special import spence

        growth = math.exp(x)
        return -k * onset**2 * float(spence(1 + growth)), k * onset * math.log1p(growth), k * growth / (1 + growth)

    def _value(self, curve: _Curve, drags: list[_Drag]) -> float:
        """The potential, J."""
        total = 0.5 * float(curve.angle @ self._bending @ curve.angle)
        total += sum(self._normal(touch.gap)[0] for touch in self._touches(curve))
        for drag in drags:
            slip = float((curve.place(drag.point) - drag.before) @ drag.direction)
            total += drag.limit * (math.hypot(slip, self.law.creep) - self.law.creep)
        return total

    def _slopes(self, curve: _Curve, drags: list[_Drag]) -> tuple[float, Floats, Floats]:
        """The potential, J, its gradient (n + 1,) and its second derivative (n + 1, n + 1) by the angles."""
        gradient, hessian = self._bending @ curve.angle, self._bending.copy()
        total = 0.5 * float(curve.angle @ gradient)
        forces = []
        for touch in self._touches(curve):
            energy, force, stiffness = self._normal(touch.gap)
            rows = curve.gradient(touch.point, touch.normal)
            total += energy
            gradient -= force * rows
            hessian += stiffness * np.outer(rows, rows)
            forces.append((touch.point, force * touch.normal))
        for drag in drags:
            slip = float((curve.place(drag.point) - drag.before) @ drag.direction)
            far = math.hypot(slip, self.law.creep)
            rows = curve.gradient(drag.point, drag.direction)
            total += drag.limit * (far - self.law.creep)
            gradient += drag.limit * slip / far * rows
            hessian += drag.limit * self.law.creep**2 / far**3 * np.outer(rows, rows)
            forces.append((drag.point, -drag.limit * slip / far * drag.direction))
        diagonal, beside = curve.stiffening(forces)
        hessian += np.diag(diagonal) + np.diag(beside, 1) + np.diag(beside, -1)
        return total, gradient, hessian

    def _drags(self, curve: _Curve, before: _Curve) -> list[_Drag]:
        """Friction with the normal forces of a curve."""
        found = []
        for touch in self._touches(curve):
            limit = self.law.friction * self._normal(touch.gap)[1]
            direction = np.array([touch.normal[1], -touch.normal[0]])
            found.append(_Drag(touch.point, direction, before.place(touch.point), limit))
        return found

    def _push_force(self, drags: list[_Drag]) -> float:
        """N: what the walls hold back along the axis."""
        total = 0.0
        for touch, drag in zip(self._touches(self._now), drags, strict=True):
            slip = float((self._now.place(drag.point) - drag.before) @ drag.direction)
            held = drag.limit * slip / math.hypot(slip, self.law.creep) * drag.direction
            total += float(held[0]) - self._normal(touch.gap)[1] * float(touch.normal[0])
        return total


_MOST_PASSES, _MOST_ITERATIONS = 15, 60
_SAME, _LEAST = 1e-3, 1e-7
"""Passes end where the push force changes by less than this share and this much, N."""

_BALANCE = 1e-9
"""N m, of a node's angle, that counts as none."""

_LARGEST_TURN = 0.1
"""Rad, of a node in one iteration."""

_FAR = 15.0
"""Gap over the onset beyond which a contact is nothing."""


def _solve_downhill(hessian: Floats, gradient: Floats) -> Floats:
    """Newton's step, the second derivative stiffened until it is one of a minimum."""
    shift, size = 0.0, float(np.abs(np.diag(hessian)).max())
    while True:
        try:
            lower = np.linalg.cholesky(hessian + shift * np.eye(len(hessian)))
        except np.linalg.LinAlgError:
            shift = max(10 * shift, 1e-6 * size)
            continue
        step: Floats = np.linalg.solve(lower.T, np.linalg.solve(lower, gradient))
        return step
