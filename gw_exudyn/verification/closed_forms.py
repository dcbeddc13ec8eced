"""What is known in closed form of elastic rods, chains and ropes. SI, angles in rad."""

from __future__ import annotations

import math
from typing import NamedTuple


class Bent(NamedTuple):
    """Tip of a bent cantilever: deflection across and shortening along its straight axis over the length, and slope,
    rad."""

    across: float
    shortening: float
    slope: float


def cantilever_under_dead_load(load: float) -> Bent:
    """A cantilever under a tip force square to its straight axis. load : P L^2 / EI [Bisshopp and Drucker 1945]."""
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

    root = math.sqrt(load)

    def parts(slope: float) -> tuple[float, float, float]:
        """m = k^2, and the amplitude at the clamp: sin^2 of it is 1 / (2 m)."""
        m = (1 + math.sin(slope)) / 2
        at_clamp = math.asin(min(1.0, 1 / math.sqrt(2 * m)))
        return m, at_clamp, float(ellipk(m) - ellipkinc(at_clamp, m))

    slope = float(brentq(lambda angle: parts(angle)[2] - root, 1e-9, math.pi / 2 - 1e-12, xtol=1e-15))
    m, at_clamp, _ = parts(slope)
    across = 1 - 2 / root * float(ellipe(m) - ellipeinc(at_clamp, m))
    return Bent(across, 1 - math.sqrt(2 * math.sin(slope)) / root, slope)


class Buckled(NamedTuple):
    """A column clamped at one end under an axial dead load: load over the buckling load; place of the tip along and
    across the straight axis over the length."""

    load: float
    along: float
    across: float


def buckled_column(tip_angle: float) -> Buckled:
    """The elastica beyond buckling, by the angle to which its tip has turned [Timoshenko and Gere 1961, 2.7]."""
    from scipy.special import ellipe, ellipk

    k = math.sin(tip_angle / 2)
    whole, second = float(ellipk(k * k)), float(ellipe(k * k))
    return Buckled((2 * whole / math.pi) ** 2, 2 * second / whole - 1, 2 * k / whole)


def buckling_load(stiffness: float, length: float) -> float:
    """N, of a column clamped at one end and free at the other [Euler]. stiffness : N m^2."""
    return math.pi**2 * stiffness / (4 * length**2)


def chain_buckling_load(stiffness: float, length: float, segments: int) -> float:
    """N, of the same column as a chain of equal segments, with half a segment's compliance in the clamp.

    Mirrored at the clamp it is Hencky's chain of twice as many segments between pins, whose joint in the middle has
    the compliance of a whole one: 4 k / l sin^2(pi / (4 n)), k = EI / l [Hencky 1920].
    """
    link = length / segments
    return 4 * stiffness / link**2 * math.sin(math.pi / (4 * segments)) ** 2


def chain_deflection(force: float, stiffness: float, length: float, segments: int) -> float:
    """m, of the tip of a cantilever as a chain, with half a segment's compliance in the clamp, under a small load.

    The sum over joints of F x^2 / k, which is exactly F L^3 / (3 EI) (1 + 1 / (2 n^2)).
    """
    return force * length**3 / (3 * stiffness) * (1 + 1 / (2 * segments**2))


def capstan(friction: float, angle: float) -> float:
    """Tension at the pulled end over that at the other, of a rope that slides round a post [Euler]."""
    return math.exp(friction * angle)


def push_into_circle(stiffness: float, radius: float) -> float:
    """N, to push a rod without friction into a circular channel that it fills: the bending energy of the length that
    enters, EI / (2 R^2)."""
    return stiffness / (2 * radius**2)


def three_point_stiffness(span: float, steps: list[tuple[float, float, float]]) -> float:
    """N m^2, that F l^3 / (48 d) gives on a beam whose stiffness is piecewise constant [paper, Eq. 1].

    steps : (from, to, EI), m from one support, over the whole span. The deflection under the load in the middle is the
    integral of M^2 / (F EI), with M = F x / 2 from the nearer support.
    """
    per_force = 0.0
    for start, end, stiffness in steps:
        for low, high in ((start, min(end, span / 2)), (span - end, min(span - start, span / 2))):
            if high > low:
                per_force += (high**3 - low**3) / 12 / stiffness
    return span**3 / 48 / per_force


def vibration_frequency(stiffness: float, length: float, mass: float) -> float:
    """Hz, lowest, of a cantilever. mass : kg, of the whole [Euler-Bernoulli: 1.8751^2]."""
    from scipy.optimize import brentq

    root = float(brentq(lambda x: math.cos(x) * math.cosh(x) + 1, 1.5, 2.5, xtol=1e-14))
    return root**2 / (2 * math.pi) * math.sqrt(stiffness / (mass * length**3))
