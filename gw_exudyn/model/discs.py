"""Discs that press on the wire without friction: supports, and a nose that moves. Few of them, so plain numpy does.

A disc is met like a corner of a wall that points into the lumen, with a radius of its own: the gap is signed, and no
disc gets to the wire's other side. See corner_pair in contact.c, of which this is the part without friction.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.model.kernel import Motion
from gw_exudyn.model.wire import Wire

Floats = NDArray[np.float64]

_ONSET = 1e-5
"""Half width of the contact's quadratic onset over the wire's radius; a disc that just touches carries nothing yet."""

_BLEND = 0.1
"""Half width, in radii of the wire, over which neighbours at a joint share a disc."""


@dataclass(frozen=True)
class Disc:
    """A disc in the catheter's frame.

    at : (2,), m, centre at the start. radius : m. side : +1 where it lies on the wire's left, -1 on its right.
    stiffness : N/m. way : (2,), m, and time : s, of its motion: it gets to at + way at a steady speed, and stands; a
        support has neither.
    """

    at: Floats
    radius: float
    side: float
    stiffness: float
    way: Floats
    time: float = 0.0

    @property
    def moves(self) -> bool:
        """A nose rather than a support."""
        return self.time > 0

    def centre(self, time: float) -> Floats:
        """(2,), m."""
        share = min(time / self.time, 1.0) if self.moves else 0.0
        return self.at + share * self.way


@dataclass(frozen=True)
class DiscContact:
    """A contact that carries force. disc, body : indices. gap : m. normal : N. direction : (2,), from the wire's axis
    to the disc. foot : m, place on the body, from its centre towards the tip. point : (2,), m, on the wire's surface.
    """

    disc: int
    body: int
    gap: float
    normal: float
    direction: Floats
    foot: float
    point: Floats


class Discs:
    """The discs of a scenario. After `add`: contacts, energy (J, in their springs), depth (m, deepest penetration)."""

    def __init__(self, wire: Wire, discs: tuple[Disc, ...]) -> None:
        self.discs = discs
        self._wire, self._half = wire, wire.lengths / 2
        self._toe = _ONSET * wire.radius
        blend = np.minimum(_BLEND * wire.radius, self._half / 2)
        blend[:-1] = np.minimum(blend[:-1], blend[1:])
        self._blend = blend
        self.contacts: list[DiscContact] = []
        self.energy = self.depth = 0.0

    def add(self, motion: Motion, time: float, force: Floats, tangent: Floats) -> None:
        """Add the forces, (n, 3), and their derivatives by each body's own coordinates, (n, 3, 3)."""
        self.contacts, self.energy, self.depth = [], 0.0, 0.0
        for number, disc in enumerate(self.discs):
            centre = disc.centre(time)
            for body in self._near(motion, disc, centre):
                self._pair(motion, number, body, centre, force[body], tangent[body])

    def force_on(self, number: int) -> Floats:
        """(2,), N: of the wire on a disc."""
        total = np.zeros(2)
        for contact in self.contacts:
            if contact.disc == number:
                total += contact.normal * contact.direction
        return total

    def _near(self, motion: Motion, disc: Disc, centre: Floats) -> Iterator[int]:
        offset = centre - motion.q[:, :2]
        x = offset[:, 0] * motion.c + offset[:, 1] * motion.s
        y = -offset[:, 0] * motion.s + offset[:, 1] * motion.c
        reach = disc.radius + self._wire.radius
        over = np.maximum(np.abs(x) - self._half, 0.0)
        near = (over < reach) & (disc.side * y < reach) & (disc.side * y > -reach)
        return (int(body) for body in np.flatnonzero(near))

    def _pair(self, motion: Motion, number: int, body: int, centre: Floats, force: Floats, tangent: Floats) -> None:
        disc, half, last = self.discs[number], float(self._half[body]), len(self._half) - 1
        c, s = float(motion.c[body]), float(motion.s[body])
        dx, dy = centre - motion.q[body, :2]
        x, y = float(dx * c + dy * s), float(-dx * s + dy * c)
        foot = min(max(x, -half), half)
        over = x - foot
        at_end = (body == last and over > 0) or (body == 0 and over < 0)
        if over != 0 and (disc.side * y > 0 or at_end):
            distance = math.hypot(over, y)
            curvature, ux, uy = 1 / distance, over / distance, y / distance
        else:
            distance, curvature, ux, uy = disc.side * y, 0.0, 0.0, disc.side
        gap = distance - self._wire.radius - disc.radius
        if gap >= 0:
            return
        weight, slope = self._weight(motion, body, x, y)
        if weight <= 0:
            return
        normal, stiffness, energy = self._law(gap, disc.stiffness)
        # In the body's frame: gradients of the gap and of the place along the wire, by the body's coordinates.
        g = np.array([-ux, -uy, ux * y - uy * x])
        p = np.array([uy, -ux, -uy * y - ux * x])
        k = weight * (-stiffness * np.outer(g, g) + normal * curvature * np.outer(p, p)) + np.outer(normal * g, slope)
        turn = weight * normal * np.array([uy, -ux])
        k[:2, 2] += turn
        k[2, :2] += turn
        k[2, 2] += weight * normal * p[2]
        out = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        force += weight * normal * (out @ g)
        tangent += out @ k @ out.T
        self.energy += weight * energy
        self.depth = max(self.depth, -gap if weight > 0.5 else 0.0)
        direction = out[:2, :2] @ np.array([ux, uy])
        axis = motion.q[body, :2] + foot * np.array([c, s])
        self.contacts.append(
            DiscContact(number, body, gap, weight * normal, direction, foot, axis + self._wire.radius * direction)
        )

    def _law(self, gap: float, modulus: float) -> tuple[float, float, float]:
        """Force, its stiffness and energy: a spring with a quadratic onset."""
        toe = self._toe
        u, deep = min(-gap, 2 * toe), max(-gap - 2 * toe, 0.0)
        energy = u**3 / (12 * toe) + deep * (toe + deep / 2)
        return modulus * (u * u / (4 * toe) + deep), modulus * u / (2 * toe), modulus * energy

    def _weight(self, motion: Motion, body: int, x: float, y: float) -> tuple[float, Floats]:
        """Share of a body in a disc at its place (x, y), and the gradient by the body's coordinates, in its frame."""
        half, last = float(self._half[body]), len(self._half) - 1
        far, far_slope = 1.0, np.zeros(3)
        near, near_slope = 1.0, np.zeros(3)
        if body < last:
            far, far_slope = self._at_joint(motion, body, body + 1, half, float(self._blend[body]), x, y)
        if body > 0:
            near, near_slope = self._at_joint(motion, body, body - 1, -half, float(self._blend[body - 1]), x, y)
        return far * near, far_slope * near + near_slope * far

    @staticmethod
    def _at_joint(
        motion: Motion, body: int, other: int, end: float, blend: float, x: float, y: float
    ) -> tuple[float, Floats]:
        """The same at one joint, at `end` (m) of the body: neighbours hand over about the joint's bisector."""
        turn = float(motion.q[other, 2] - motion.q[body, 2]) / 2
        ca, sa = math.cos(turn), math.sin(turn)
        sign, rx = math.copysign(1.0, end), x - end
        argument = 0.5 - sign * (rx * ca + y * sa) / (2 * blend)
        part = min(max(argument, 0.0), 1.0)
        slope = -sign * 6 * part * (1 - part) / (2 * blend)
        gradient = slope * np.array([-ca, -sa, -end * sa + 0.5 * (-rx * sa + y * ca)])
        return part * part * (3 - 2 * part), gradient
