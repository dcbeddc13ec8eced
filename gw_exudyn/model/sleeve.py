"""A sleeve: a frictionless catheter without play. What is inside is straight, whatever bends it.

A joint stands for the bending of its stretch, from the middle of one segment to the middle of the next. Of a stretch
that crosses the exit only the share f outside can bend, so the joint has the stiffness k / f. All behind it is held
straight on the axis, so that what comes on top of the joint's own spring is a potential of the one segment in front,

    V = k/2 (1/f(x) - 1) angle^2,

x the place of its proximal end along the axis from the exit, angle its own to the axis. A rest angle does not show
here: the energy of the straightened share and the spring of the share outside add up to the joint's own spring and V.
With the moment M = k angle / f its force along the axis is M^2 / (2 EI), the change of the bending energy with the
length let out [Bigoni et al. 2015, "Eshelby-like forces acting on elastic structures"].
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.model.kernel import Motion
from gw_exudyn.model.wire import Wire

Floats = NDArray[np.float64]

LEAST = 1e-5
"""Share of its compliance that a joint inside keeps. A force Q across the wire and a moment M at the exit move it
there by LEAST Q L l^2 / EI, of a length L inside in segments of l, and turn it by LEAST M l / EI at most. Newton's
iteration converges alike from 1e-3 to 1e-6."""

_FLANK = 0.1
"""Half the way, in shortest segments, in which one joint's exit passes over into the next one's."""


class Sleeve:
    """The potential on a wire's segments. Of the last `add`: energy, J; push, N, out of the sleeve along its axis; and
    shares (n,), of each joint's compliance that is outside."""

    def __init__(self, wire: Wire) -> None:
        self._stiffness, self._half = wire.joint_stiffness, wire.lengths / 2
        self._begin = -self._half
        self._end = np.concatenate([[0.0], self._half[:-1]])
        self._flank = _FLANK * float(wire.lengths.min())
        self.energy = self.push = 0.0
        self.shares: Floats = np.ones(wire.segments)

    def add(self, motion: Motion, force: Floats, tangent: Floats) -> None:
        """Add to force (n, 3), N and N m about the centres, and to its derivative by each body's place, (n, 3, 3)."""
        lever, turn = self._half * motion.s, motion.q[:, 2]
        grown, slope, curvature = self._excess(motion.q[:, 0] - self._half * motion.c)
        v = self._stiffness / 2 * turn**2
        self.energy = float(v @ grown)
        push = -v * slope
        self.push = float(push.sum())
        bend = self._stiffness * turn
        force[:, 0] += push
        force[:, 2] += push * lever - bend * grown
        tangent[:, 0, 0] -= v * curvature
        mixed = v * curvature * lever + bend * slope
        tangent[:, 0, 2] -= mixed
        tangent[:, 2, 0] -= mixed
        tangent[:, 2, 2] -= (
            (v * curvature * lever + 2 * bend * slope) * lever
            + v * slope * self._half * motion.c
            + self._stiffness * grown
        )

    def _excess(self, x: Floats) -> tuple[Floats, Floats, Floats]:
        """1/f - 1 of each joint at its place x (n,), m, and the first two derivatives by it."""
        wide = self._end - self._begin
        near, near_slope, near_curvature = self._ramp(x - self._begin)
        far, far_slope, far_curvature = self._ramp(x - self._end)
        f = LEAST + (1 - LEAST) * (near - far) / wide
        slope = (1 - LEAST) * (near_slope - far_slope) / wide
        curvature = (1 - LEAST) * (near_curvature - far_curvature) / wide
        # The first joint that is out, and all beyond it, wherever they are: a wire may turn round in the vessel.
        out = np.maximum.accumulate(x >= self._end + self._flank)
        f[out], slope[out], curvature[out] = 1.0, 0.0, 0.0
        self.shares = f
        return 1 / f - 1, -slope / f**2, 2 * slope**2 / f**3 - curvature / f**2

    def _ramp(self, x: Floats) -> tuple[Floats, Floats, Floats]:
        """0 before 0, x after it, round in between, and its derivatives: joints that take turns share the exit there,
        so that the push force does not jump."""
        w = self._flank
        u = np.clip(x + w, 0.0, 2 * w)
        rise: Floats = u**2 / (4 * w) + np.maximum(x - w, 0.0)
        return rise, u / (2 * w), np.where((x > -w) & (x < w), 1 / (2 * w), 0.0)
