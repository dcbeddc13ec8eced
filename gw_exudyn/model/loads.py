"""Loads on the wire besides contact with walls: at its tip, and from discs."""

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

_ROUND = 16.0
"""Axial over bending stiffness of a solid round wire, times its diameter squared: what holds a tip yields as the wire,
whose segments are rigid, would along its axis. Without any give a straight wire could not be pushed at all."""

_DISC_STIFFNESS = 2000.0
"""Stiffness of a disc's contact over that of the wire in three-point bending between the discs: together nose and
supports give way by some ten-thousandth of the deflection."""


@dataclass(frozen=True)
class LoadsInstant:
    """What the energy balance needs of the loads at an instant.

    force : (n, 3), N and N m about the centres; (1, 3) zeros where there are no loads. effort, place : (e,), loads that
        do work, and what they do it on (N and m, N m and rad). elastic : J, in what holds the tip. stored : J, in the
        springs of the discs.
    """

    force: Floats = field(default_factory=lambda: np.zeros((1, 3)))
    effort: Floats = field(default_factory=lambda: np.zeros(0))
    place: Floats = field(default_factory=lambda: np.zeros(0))
    elastic: float = 0.0
    stored: float = 0.0


@dataclass(frozen=True)
class TipLoad:
    """Loads at the tip and what holds it, in the catheter's frame.

    dead : (2,), N, fixed in space. follower : (2,), N, along the wire and to its left. moment : N m. ramp : s.
    held : (2,), N/m, along and across the catheter's axis, of what holds the tip's place; 0 where it is free.
    at : (2,), m, the place that is held. clamp : N m/rad, of the half segment between the last joint's stretch and a
        clamped tip; 0 where it may turn. rest : rad, its angle without load.
    """

    dead: Floats
    follower: Floats
    moment: float
    ramp: float
    held: Floats
    at: Floats
    clamp: float
    rest: float

    def share(self, time: float) -> float:
        """Of the loads at a time."""
        return min(time / self.ramp, 1.0) if self.ramp > 0 else 1.0


@dataclass(frozen=True)
class LoadSet:
    """What loads a wire."""

    tip: TipLoad
    discs: tuple[Disc, ...]


class Loads:
    """All loads of a model in motion.

    force : (n, 3), N and N m about the centres. tangent : (n, 3, 3), d force/dq of each body. Both of the last
    `evaluate`, at the time `time`, s.
    """

    def __init__(self, wire: Wire, loads: LoadSet) -> None:
        self.tip = loads.tip
        self.discs = Discs(wire, loads.discs)
        self._wire, self._half = wire, wire.lengths / 2
        self.force, self.tangent = np.zeros((wire.segments, 3)), np.zeros((wire.segments, 3, 3))
        self.time = 0.0
        self.present = bool(loads.discs) or bool(self.tip.held.any()) or self.loads_tip

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

    def instant(self, motion: Motion) -> LoadsInstant:
        """At the place and time of the last `evaluate`."""
        if not self.present:
            return LoadsInstant()
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
            elastic=0.5 * self.tip.clamp * bend**2 + 0.5 * float(self.tip.held @ self._astray(motion) ** 2),
            stored=self.discs.energy,
        )

    def hold_force(self, motion: Motion) -> Floats:
        """(2,), N: of what holds the tip on the wire."""
        force: Floats = -self.tip.held * self._astray(motion)
        return force

    def _astray(self, motion: Motion) -> Floats:
        """(2,), m: how far the tip is from the place where it is held."""
        away: Floats = motion.q[-1, :2] + self._arm(motion) - self.tip.at
        return away

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
        force = self._tip_force(along) + self.hold_force(motion)
        axial, transverse = share * tip.follower
        bend = float(motion.q[-1, 2]) + tip.rest
        self.force[-1, :2] += force
        self.force[-1, 2] += share * tip.moment + half * (c * force[1] - s * force[0]) - tip.clamp * bend
        self.tangent[-1, 0, 2] += -axial * s - transverse * c
        self.tangent[-1, 1, 2] += axial * c - transverse * s
        # A follower's lever turns with it, so only the other loads turn the segment the more the further it has turned.
        self.tangent[-1, 2, 2] += half * (axial - along @ force) - tip.clamp
        x, y = np.array([1.0, 0.0, -half * s]), np.array([0.0, 1.0, half * c])
        self.tangent[-1] -= tip.held[0] * np.outer(x, x) + tip.held[1] * np.outer(y, y)


def build_loads(scenario: Scenario, wire: Wire, frame: Frame) -> LoadSet:
    """The loads of a scenario, in the catheter's frame."""
    return LoadSet(_tip_load(scenario, wire, frame), _discs(scenario, frame))


def _tip_load(scenario: Scenario, wire: Wire, frame: Frame) -> TipLoad:
    tip, half = scenario.tip, float(wire.lengths[-1]) / 2
    near, far = np.zeros(1), np.array([half])
    held = tip.hold != "free"
    clamped = tip.hold == "clamped"
    piece = scenario.wire.bending_stiffness[0]
    stiffness = _ROUND * piece.value / scenario.wire.diameter**2 / wire.length
    return TipLoad(
        dead=frame.vectors_in(tip.force),
        follower=np.array(tip.follower_force),
        moment=tip.moment,
        ramp=tip.ramp,
        held=stiffness * np.array([held and tip.slides != "along", held and tip.slides != "across"]),
        at=np.array([scenario.drive.start, 0.0]),
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
