"""Patches of the vessel's walls whose friction differs. Catheter's frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Patch:
    """What lies within `within` (m) of the line from `start` to `end`, (2,), m, has this friction coefficient."""

    start: Floats
    end: Floats
    within: float
    friction: float

    def distance(self, points: Floats) -> Floats:
        """(p,), m, of points (p, 2) from the line."""
        along = self.end - self.start
        share = ((points - self.start) @ along) / max(float(along @ along), 1e-300)
        foot = self.start + np.clip(share, 0.0, 1.0)[:, None] * along
        found: Floats = np.hypot(*(points - foot).T)
        return found

    def borders(self, a: Floats, b: Floats) -> list[float]:
        """Shares, 0 to 1, of the way from a to b, (2,), m, where it enters or leaves the patch."""
        shares = [t for end in (self.start, self.end) for t in _circle(a, b, end, self.within)]
        axis = self.end - self.start
        across = np.array([-axis[1], axis[0]]) / max(float(np.hypot(*axis)), 1e-300)
        rise, height = float(across @ (b - a)), float(across @ (a - self.start))
        if rise != 0:
            shares += [(side * self.within - height) / rise for side in (1, -1)]
        at = np.array([t for t in shares if 0 < t < 1])
        if not len(at):
            return []
        off = self.distance(a + at[:, None] * (b - a)) - self.within
        return [float(t) for t in at[abs(off) < 1e-9 * max(self.within, 1e-3)]]


def _circle(a: Floats, b: Floats, centre: Floats, radius: float) -> list[float]:
    """Shares of the way from a to b at which the line through them crosses a circle."""
    d, r = b - a, a - centre
    square, half = float(d @ d), float(d @ r)
    root = half**2 - square * (float(r @ r) - radius**2)
    return [] if root <= 0 else [(-half + sign * math.sqrt(root)) / square for sign in (1, -1)]


def divided(points: Floats, patches: Sequence[Patch], shortest: float, *, closed: bool) -> Floats:
    """The polyline, (p, 2), m, with points where it enters or leaves a patch.

    A border nearer than `shortest` (m) to another point gets none of its own.
    """
    if not patches:
        return points
    found = []
    for i, a in enumerate(points):
        found.append(a)
        if i + 1 == len(points) and not closed:
            break
        b = points[(i + 1) % len(points)]
        length, last = float(np.hypot(*(b - a))), 0.0
        for t in sorted(t for patch in patches for t in patch.borders(a, b)):
            if (t - last) * length >= shortest and (1 - t) * length >= shortest:
                found.append(a + t * (b - a))
                last = t
    return np.array(found)


def friction_at(points: Floats, patches: Sequence[Patch], otherwise: float) -> Floats:
    """(p,): friction coefficient of walls at points (p, 2), m; the last patch that holds a point counts."""
    found = np.full(len(points), otherwise)
    for patch in patches:
        found[patch.distance(points) <= patch.within] = patch.friction
    return found
