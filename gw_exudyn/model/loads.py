"""Loads on the wire besides contact with walls: at its tip, from discs, and the sleeve that may guide it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.model.discs import Disc, Discs
from gw_exudyn.model.frame import Frame
from gw_exudyn.model.kernel import Motion
from gw_exudyn.model.wire import Wire, compliance, rest_angles

if TYPE_CHECKING:
    from gw_exudyn.scenario import DiscSpec, Scenario

Floats = NDArray[np.float64]

_DISC_STIFFNESS = 2000.0
"""Stiffness of a disc's contact over that of the wire in three-point bending between the discs: together nose and
supports give way by some ten-thousandth of the deflection."""

_SLEEVE_STIFFNESS = 10.0
"""Stiffness of the sleeve over that of a joint, seen at a segment's length."""


@dataclass(frozen=True)
class LoadsInstant:
    """What the energy balance needs of the loads at an instant.

    force : (n, 3), N and N m about the centres; (1, 3) zeros where there are no loads. effort, place : (e,), loads that
        do work, and what they do it on (N and m, N m and rad). elastic : J, in the clamp at the tip. stored : J, in the
        springs of discs and sleeve. tip_reaction : (2,), N, of what holds the tip on the wire.
    """

    force: Floats = field(default_factory=lambda: np.zeros((1, 3)))
    effort: Floats = field(default_factory=lambda: np.zeros(0))
    place: Floats = field(default_factory=lambda: np.zeros(0))
    elastic: float = 0.0
    stored: float = 0.0
    tip_reaction: Floats = field(default_factory=lambda: np.zeros(2))


@dataclass(frozen=True)
class TipLoad:
    """Loads at the tip and what holds it, in the catheter's frame.

    dead : (2,), N, fixed in space. follower : (2,), N, along the wire and to its left. moment : N m. ramp : s.
    held : (along, across) the catheter's axis: the tip's place is fixed there. clamp : N m/rad, of the half segment
        between the last joint's stretch and a clamped tip; 0 where it may turn. rest : rad, its angle without load.
    """

    dead: Floats
    follower: Floats
    moment: float
    ramp: float
    held: tuple[bool, bool]
    clamp: float
    rest: float

    def share(self, time: float) -> float:
        """Of the loads at a time."""
        return min(time / self.ramp, 1.0) if self.ramp > 0 else 1.0


@dataclass(frozen=True)
class LoadSet:
    """What loads a wire. sleeve : the catheter is one, without clearance or friction."""

    tip: TipLoad
    discs: tuple[Disc, ...]
    sleeve: bool


class Loads:
    """All loads of a model in motion. Bodies carry (x, y, angle); force : (n, 3), tangent : (n, 3, 3), d force/dq of each body,
    both of the last `evaluate` at the time `time`, s.
    """

    def __init__(self, wire: Wire, loads: LoadSet) -> None:
        self.tip, self.sleeve = loads.tip, loads.sleeve
        self.discs = Discs(wire, loads.discs)
        self._wire, self._half = wire, wire.lengths / 2
        self.force, self.tangent = np.zeros((wire.segments, 3)), np.zeros((wire.segments, 3, 3))
        self.time = 0.0
        self.present = bool(loads.discs) or self.sleeve or self.tip.clamp > 0 or self.loads_tip
        self._sleeve_stiffness = _SLEEVE_STIFFNESS * float((wire.joint_stiffness / wire.lengths**2).max())
        self.sleeve_force, self.sleeve_normal, self._sleeve_energy = np.zeros(2), 0.0, 0.0

    @property
    def loads_tip(self) -> bool:
        """There are forces or a moment at the tip."""
        return bool(self.tip.dead.any() or self.tip.follower.any() or self.tip.moment)

    @property
    def follows(self) -> bool:
        """A load turns with the wire, so that there is no potential."""
        return bool(self.tip.follower.any())

    def evaluate(self, motion: Motion) -> None:
        """Forces and tangent at a place."""
        if not self.present:
            return
        self.force[:] = 0.0
        self.tangent[:] = 0.0
        self._add_tip(motion)
        self.discs.add(motion, self.time, self.force, self.tangent)
        if self.sleeve:
            self._add_sleeve(motion)

    def instant(self, motion: Motion, tip_reaction: Floats) -> LoadsInstant:
        """At the place and time of the last `evaluate`. tip_reaction : (2,), N, of what holds the tip on the wire."""
        if not self.present:
            return LoadsInstant(tip_reaction=tip_reaction)
        along, arm = self._along(motion), self._arm(motion)
        effort = [*self._tip_force(along), self.tip.moment * self.tip.share(self.time)]
        place = [*(motion.q[-1, :2] + arm), motion.q[-1, 2]]
        for number, disc in enumerate(self.discs.discs):
            if disc.moves:
                effort += list(-self.discs.force_on(number))
                place += list(disc.centre(self.time))
        bend = float(motion.q[-1, 2]) + self.tip.rest
        return LoadsInstant(
            force=self.force.copy(),
            effort=np.array(effort),
            place=np.array(place),
            elastic=0.5 * self.tip.clamp * bend**2,
            stored=self.discs.energy + self._sleeve_energy,
            tip_reaction=tip_reaction,
        )

    def _along(self, motion: Motion) -> Floats:
        return np.array([motion.c[-1], motion.s[-1]])

    def _arm(self, motion: Motion) -> Floats:
        return float(self._half[-1]) * self._along(motion)

    def _tip_force(self, along: Floats) -> Floats:
        """(2,), N, dead load and follower together."""
        axial, transverse = self.tip.follower
        c, s = along
        turned = np.array([axial * c - transverse * s, axial * s + transverse * c])
        total: Floats = (self.tip.dead + turned) * self.tip.share(self.time)
        return total

    def _add_tip(self, motion: Motion) -> None:
        tip, half, share = self.tip, float(self._half[-1]), self.tip.share(self.time)
        along = self._along(motion)
        c, s = along
        force = self._tip_force(along)
        axial, transverse = share * tip.follower
        bend = float(motion.q[-1, 2]) + tip.rest
        self.force[-1, :2] += force
        self.force[-1, 2] += share * tip.moment + half * (c * force[1] - s * force[0]) - tip.clamp * bend
        self.tangent[-1, 0, 2] += -axial * s - transverse * c
        self.tangent[-1, 1, 2] += axial * c - transverse * s
        # A follower's lever turns with it, so only the dead load turns the segment the more the further it has turned.
        self.tangent[-1, 2, 2] += half * (axial - along @ force) - tip.clamp

    def _add_sleeve(self, motion: Motion) -> None:
        """Two-sided springs on the nodes behind the exit, and at the exit on the segment that passes it."""
        stiffness, half = self._sleeve_stiffness, self._half
        before = self.force[:, :2].sum(axis=0)
        self._sleeve_energy = self.sleeve_normal = 0.0
        fade = half / 2
        x, y = motion.q[:, 0] + half * motion.c, motion.q[:, 1] + half * motion.s
        for body in np.flatnonzero(x < 0):
            part = min(-float(x[body]) / float(fade[body]), 1.0)
            share, slope = part * part * (3 - 2 * part), -6 * part * (1 - part) / float(fade[body])
            self._add_node_spring(motion, int(body), float(y[body]), stiffness * share, stiffness * slope)
        local = -(motion.q[:, 0] * motion.c + motion.q[:, 1] * motion.s)
        passing = np.flatnonzero(np.abs(local) <= half)
        if len(passing):
            self._add_exit_spring(motion, int(passing[-1]), stiffness)
        self.sleeve_force = self.force[:, :2].sum(axis=0) - before

    def _add_node_spring(self, motion: Motion, body: int, y: float, stiffness: float, slope: float) -> None:
        """On the distal node: energy stiffness y^2 / 2, where the stiffness falls off with x by `slope`, N/m^2."""
        c, s, half = float(motion.c[body]), float(motion.s[body]), float(self._half[body])
        along_x, along_y = np.array([1.0, 0.0, -half * s]), np.array([0.0, 1.0, half * c])
        fx, fy = -0.5 * slope * y * y, -stiffness * y
        self.force[body] += fx * along_x + fy * along_y
        block = self.tangent[body]
        block -= stiffness * np.outer(along_y, along_y)
        block -= slope * y * (np.outer(along_x, along_y) + np.outer(along_y, along_x))
        block[2, 2] -= half * (fx * c + fy * s)
        self._sleeve_energy += 0.5 * stiffness * y * y
        self.sleeve_normal += abs(fy)

    def _add_exit_spring(self, motion: Motion, body: int, stiffness: float) -> None:
        """Energy stiffness v^2 / 2, v the offset of the exit's middle from the segment's axis."""
        c, s = float(motion.c[body]), float(motion.s[body])
        qx, qy = float(motion.q[body, 0]), float(motion.q[body, 1])
        along, across = -qx * c - qy * s, qx * s - qy * c
        gradient = np.array([s, -c, -along])
        self.force[body] -= stiffness * across * gradient
        block = self.tangent[body]
        block -= stiffness * np.outer(gradient, gradient)
        turn = stiffness * across * np.array([c, s])
        block[:2, 2] -= turn
        block[2, :2] -= turn
        block[2, 2] += stiffness * across * across
        self._sleeve_energy += 0.5 * stiffness * across**2
        self.sleeve_normal += abs(stiffness * across)


def build_loads(scenario: Scenario, wire: Wire, frame: Frame) -> LoadSet:
    """The loads of a scenario, in the catheter's frame."""
    return LoadSet(_tip_load(scenario, wire, frame), _discs(scenario, frame), scenario.catheter.bore == 0.0)


def _tip_load(scenario: Scenario, wire: Wire, frame: Frame) -> TipLoad:
    tip, half = scenario.tip, float(wire.lengths[-1]) / 2
    near, far = np.zeros(1), np.array([half])
    held = tip.hold != "free"
    clamped = tip.hold == "clamped"
    return TipLoad(
        dead=frame.vectors_in(tip.force),
        follower=np.array(tip.follower_force),
        moment=tip.moment,
        ramp=tip.ramp,
        held=(held and tip.slides != "along", held and tip.slides != "across"),
        clamp=1 / float(compliance(scenario.wire.bending_stiffness, near, far)[0]) if clamped else 0.0,
        rest=float(rest_angles(scenario.wire, near, far)[0]) if clamped else 0.0,
    )


def _discs(scenario: Scenario, frame: Frame) -> tuple[Disc, ...]:
    """Supports, then the nose, in the catheter's frame."""
    stiffness = automatic_stiffness(scenario)
    discs = [_disc(spec, frame, stiffness, np.zeros(2), 0.0) for spec in scenario.supports]
    nose = scenario.nose
    if nose is not None:
        way = nose.travel * np.array([math.cos(nose.direction), math.sin(nose.direction)])
        discs.append(_disc(nose, frame, stiffness, frame.vectors_in(way), nose.travel / nose.speed))
    return tuple(discs)


def _disc(spec: DiscSpec, frame: Frame, stiffness: float, way: Floats, time: float) -> Disc:
    at = frame.points_in(spec.at)
    side = {"left": 1.0, "right": -1.0}.get(spec.side, -1.0 if at[1] < 0 else 1.0)
    return Disc(at, spec.radius, side, stiffness if spec.stiffness is None else spec.stiffness, way, time)


def automatic_stiffness(scenario: Scenario) -> float:
    """Of a disc's contact, N/m: far stiffer than the wire in three-point bending over the least distance of two."""
    discs = [*scenario.supports, *([] if scenario.nose is None else [scenario.nose])]
    centres = np.array([disc.at for disc in discs]).reshape(-1, 2)
    apart = [math.dist(a, b) for i, a in enumerate(centres) for b in centres[:i]]
    span = min([*apart, scenario.wire.length])
    largest = max(max(piece.value, piece.value_end) for piece in scenario.wire.bending_stiffness)
    return _DISC_STIFFNESS * 48 * largest / max(span, scenario.wire.diameter) ** 3
