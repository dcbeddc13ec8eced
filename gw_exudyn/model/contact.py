"""Contact of the whole wire with all walls: forces, tangent, and the memory that friction and carinas need."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.model.kernel import Kernel, Motion, Pairs, Summary
from gw_exudyn.model.walls import Walls
from gw_exudyn.model.wire import Wire

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Ints32 = NDArray[np.int32]


@dataclass(frozen=True)
class ContactLaw:
    """Numbers of the contact law.

    stiffness, tangential_stiffness : N/m, of one contact. damping : N s/m per m of penetration. toe : m, half width of
    the quadratic onset: a contact begins to push at this gap and is fully stiff at this penetration.
    """

    stiffness: float
    tangential_stiffness: float
    damping: float
    toe: float


class Deepest(NamedTuple):
    """A penetration: depth, m; the body; the wall segment, or the corner, that it is in."""

    depth: float
    body: int
    target: int
    corner: bool


NOWHERE = Deepest(0.0, -1, -1, False)
"""Nothing is inside a wall."""


def _no_keys() -> Ints:
    return np.zeros(0, np.int64)


def _no_values() -> Floats:
    return np.zeros(0)


@dataclass(frozen=True)
class ContactMemory:
    """What contact keeps from one step to the next. Part of the saved state.

    node_keys : (a,), sorted; node pair (body * walls + wall) that carried a force. node_slip : (a,), m, its elastic
        slip; node_held : (a,), its share of the full stiffness.
    corner_keys : (b,), sorted; corner pair (body * corners + corner). corner_pair_slip, corner_held : (b,).
    side : (k,), for each corner +1 or -1, the side of the wire on which it lies, or 0 while it is ahead of the tip.
        Decided when the tip passes, undone when it comes back.
    corner_slip : (k,), m, elastic slip of the wire past the corner, for a segment that is new to it.
    """

    side: Floats
    corner_slip: Floats
    node_keys: Ints = field(default_factory=_no_keys)
    node_slip: Floats = field(default_factory=_no_values)
    node_held: Floats = field(default_factory=_no_values)
    corner_keys: Ints = field(default_factory=_no_keys)
    corner_pair_slip: Floats = field(default_factory=_no_values)
    corner_held: Floats = field(default_factory=_no_values)


class Contact:
    """Contact during a run. Body i carries node i, its distal end; arrays over bodies are (n,) or (n, 3).

    One step is: `start_step` at the accepted place (finds the pairs that can touch), any number of `evaluate` at trial
    places, `accept` at the converged one. `memory` is all that crosses steps.
    """

    def __init__(self, wire: Wire, walls: Walls, law: ContactLaw) -> None:
        self.wire, self.walls, self.law = wire, walls, law
        self.motion = Motion(wire.segments)
        self._kernel = Kernel(_arrays(wire, walls), _numbers(wire, law))
        self.nodes, self.corners = Pairs(_ROOM), Pairs(_ROOM)
        self.memory = ContactMemory(np.zeros(len(walls.corner)), np.zeros(len(walls.corner)))
        self.reach = 5 * wire.radius
        self._half_bore = float(np.abs(walls.start[walls.tube, 1]).max(initial=0.0)) or np.inf
        self.first = 0
        self._corners_at: tuple[Floats, tuple[int, Ints32, Ints32, Floats]] | None = None
        self._summary: Summary | None = None

    @property
    def force(self) -> Floats:
        """(n, 3): force (N) and moment (N m) about the centre on each body, of the last `evaluate`."""
        return self._kernel.force.reshape(-1, 3)

    @property
    def tangent(self) -> Floats:
        """(9 n,): 3 x 3 blocks by rows; d force/dq, weighted as the last `evaluate` was told."""
        return self._kernel.tangent

    def _about_corners(self) -> tuple[int, Ints32, Ints32, Floats]:
        """At the present place: the first body in the vessel; for each corner the nearest body, whether the corner is
        ahead of the tip, and its offset, m. The end of a step asks, and the start of the next."""
        if self._corners_at is None or not np.array_equal(self._corners_at[0], self.motion.q):
            first = first_in_vessel(self.motion, self.wire, self._half_bore)
            found = self._kernel.nearest(self.motion, first, len(self.walls.corner))
            self._corners_at = self.motion.q.copy(), (first, *found)
        return self._corners_at[1]

    def start_step(self) -> None:
        """Find the pairs for a step that starts at the present place, and recall what they carried."""
        self.motion.start_step()
        self.first, nearest, _, _ = self._about_corners()
        while not self._kernel.candidates(
            self.motion, self.memory.side, nearest, self.first, self.reach, self.nodes, self.corners
        ):
            self.nodes, self.corners = Pairs(4 * self.nodes.capacity), Pairs(4 * self.corners.capacity)
        memory, nodes, corners = self.memory, self.nodes, self.corners
        self._node_keys = nodes.body.astype(np.int64) * len(self.walls.length) + nodes.target
        self._corner_keys = corners.body.astype(np.int64) * len(self.walls.corner) + corners.target
        here, there = _known(self._node_keys, memory.node_keys)
        nodes.start[here], nodes.held[here] = memory.node_slip[there], memory.node_held[there]
        corners.start[:] = memory.corner_slip[corners.target]
        here, there = _known(self._corner_keys, memory.corner_keys)
        corners.start[here], corners.held[here] = memory.corner_pair_slip[there], memory.corner_held[there]

    def evaluate(
        self, position: float = 1.0, velocity: float = 0.0, *, predicted: bool = False, followed: bool = False
    ) -> None:
        """Forces and tangent at the present place; tangent = position * d/dq + velocity * d/dq_t.

        predicted : the place is the first guess of a step (see contact_law in contact.c). followed : Newton's step led
        here from where `step_on` was called (see taken_at there).
        """
        self._summary = None
        self.motion.struct.predicted, self.motion.struct.followed = int(predicted), int(followed)
        self._kernel.evaluate(self.motion, self.nodes, self.corners, position, velocity)

    def step_on(self) -> None:
        """Newton steps on from the place of the last `evaluate`: the next ones may look back on its forces."""
        self._kernel.step_on(self.nodes, self.corners)

    def add_turning(self, tangent: Floats, reaction: Floats, *, stiffening: bool) -> None:
        """Add to a tangent (9 n,) like `tangent`, contiguous, how the joints' forces turn each segment as it turns.

        reaction : (2 n,), N, minus the force on each segment's proximal end, contiguous. stiffening : leave out what
        makes a segment resist its turn less.
        """
        self._kernel.add_turning(self.motion, tangent, reaction, stiffening=stiffening)

    def share_to_touch(self, before: Motion) -> float:
        """Share of the way from the place `before` to the present one where the first contact closes.

        0 to 1; of the contacts that were open at `before`, 1 if none of them closes.
        """
        return self._kernel.share_to_touch(before, self.nodes, self.corners)

    def accept(self) -> None:
        """Take the present place, just evaluated, as the end of the step: keep slips, stiffness shares and sides."""
        nodes, corners, walls = self.nodes, self.corners, self.walls
        stiffness = self.law.stiffness
        touching = np.flatnonzero(nodes.normal * nodes.weight)
        meeting = np.flatnonzero(corners.normal * corners.weight)
        at, share, elastic = corners.target[meeting], corners.weight[meeting], corners.elastic[meeting]
        total = np.bincount(at, share, len(walls.corner))
        slip = np.bincount(at, share * elastic, len(walls.corner))
        side = self._passed()
        # Slip counts along the wire, whose sense about the corner is that of a corner on the left until it is passed.
        turned = np.where((side < 0) == (self.memory.side < 0), 1.0, -1.0)
        self.memory = ContactMemory(
            side=side,
            corner_slip=turned * np.where(total > 0, slip / np.where(total > 0, total, 1.0), 0.0),
            node_keys=self._node_keys[touching],
            node_slip=nodes.elastic[touching],
            node_held=nodes.normal_stiffness[touching] / nodes.weight[touching] / stiffness,
            corner_keys=self._corner_keys[meeting],
            corner_pair_slip=turned[at] * elastic,
            corner_held=corners.normal_stiffness[meeting] / share / stiffness,
        )

    def _passed(self) -> Floats:
        """(k,): the sides after the present place."""
        side = self.memory.side
        if not len(side):
            return side
        _, body, ahead, offset = self._about_corners()
        fresh = np.where(offset < 0, -1.0, 1.0)
        kept: Floats = np.where((ahead == 1) | (body < 0), 0.0, np.where(side == 0, fresh, side))
        return kept

    def summary(self) -> Summary:
        """All contacts together, at the last `evaluate`."""
        if self._summary is None:
            self._summary = self._kernel.summary(self.motion, self.nodes, self.corners)
        return self._summary

    def deepest(self) -> Deepest:
        """The deepest penetration of the last `evaluate`."""
        found = self.summary()
        return Deepest(found.deepest, found.body, found.target, bool(found.corner))

    def is_unstable(self, joint_stiffness: Floats) -> bool:
        """The last `evaluate` found a balance that is no minimum: a compressed wire that has yet to choose a side.

        joint_stiffness : (n,), N m/rad, of the joint proximal to each body, the damper's share of the step included.
        """
        return self._kernel.unstable(self.motion, self.nodes, self.corners, joint_stiffness) > 0

    def rubs(self) -> bool:
        """A contact with friction carries force at the last `evaluate`."""
        return any(bool(pairs.tangential.any()) for pairs in (self.nodes, self.corners))

    def crossing(self) -> tuple[int, int] | None:
        """(body, wall) where the wire's axis crosses a wall of the vessel or the catheter now, or None."""
        return self._kernel.crossing(self.motion, self._about_corners()[0])


_ROOM = 256


def first_in_vessel(motion: Motion, wire: Wire, half_bore: float) -> int:
    """The first body whose distal end is past the catheter's exit, or beside the catheter; all from there on are in the
    vessel. half_bore : m."""
    half = wire.lengths / 2
    out = (motion.q[:, 0] + half * motion.c >= -1e-12) | (np.abs(motion.q[:, 1] + half * motion.s) > half_bore)
    return int(out.argmax()) if out.any() else len(out)


def _known(keys: Ints, remembered: Ints) -> tuple[Ints, Ints]:
    """Places in `keys` that are remembered, and their places in `remembered` (both sorted)."""
    if not len(keys):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    place = np.minimum(np.searchsorted(keys, remembered), len(keys) - 1)
    there = np.flatnonzero(keys[place] == remembered)
    return place[there], there


def _numbers(wire: Wire, law: ContactLaw) -> dict[str, float]:
    return {
        "radius": wire.radius,
        "stiffness": law.stiffness,
        "damping": law.damping,
        "toe": law.toe,
        "tangential_stiffness": law.tangential_stiffness,
    }


def _arrays(wire: Wire, walls: Walls) -> dict[str, NDArray[np.generic]]:
    half = wire.lengths / 2
    blend = np.minimum(wire.radius / 10, half / 2)
    blend[:-1] = np.minimum(blend[:-1], blend[1:])
    return {
        "half_length": half,
        "joint_blend": blend,
        "wall_x": walls.start[:, 0],
        "wall_y": walls.start[:, 1],
        "wall_tx": walls.tangent[:, 0],
        "wall_ty": walls.tangent[:, 1],
        "wall_length": walls.length,
        "wall_lo": walls.lo,
        "wall_hi": walls.hi,
        "wall_fade_lo": walls.fade_lo,
        "wall_fade_hi": walls.fade_hi,
        "wall_friction": walls.friction,
        "wire_friction": wire.friction_factor,
        "wall_sharp": walls.sharp,
        "wall_tube": walls.tube,
        "corner_x": walls.corner[:, 0],
        "corner_y": walls.corner[:, 1],
        "corner_friction": walls.corner_friction,
        "corner_tube": walls.corner_tube,
    }
