"""Energies of a run, each from its own forces; what is left over is the error, and nothing is made to fit.

At the end of a step the forces on every segment balance. Their work over the step, taken with the forces at its end,
therefore balances too; the terms below are that balance, written with the energies that a person asks for. The
integrator's own loss (forces at the end instead of along the step, finite turns of rigid segments) is worked out term
by term as `numerical_loss`; in a snap-through that is skipped in one step it is the energy set free.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.model.contact import Contact
from gw_exudyn.model.kernel import Motion
from gw_exudyn.model.loads import LoadsInstant
from gw_exudyn.model.wire import Wire

Floats = NDArray[np.float64]


NO_LOADS = LoadsInstant()
"""Nothing but contact and drive acts on the wire."""


@dataclass(frozen=True)
class Energies:
    """All in J.

    elastic (joints), wall (normal and tangential springs), kinetic : now. insertion_work (by the drive), friction_loss,
        damping_loss (joints and walls), numerical_loss : sums since the start.
    load_work (by loads at the tip and the nose) : since the start.
    start : stored at the start. largest_work : the largest of the works and of the stored energy so far.
    """

    elastic: float = 0.0
    wall: float = 0.0
    kinetic: float = 0.0
    insertion_work: float = 0.0
    friction_loss: float = 0.0
    damping_loss: float = 0.0
    numerical_loss: float = 0.0
    start: float = 0.0
    largest_work: float = 0.0
    load_work: float = 0.0

    @property
    def error(self) -> float:
        """What does not add up, J."""
        stored = self.elastic + self.wall + self.kinetic - self.start
        return (
            self.insertion_work + self.load_work - stored - self.friction_loss - self.damping_loss - self.numerical_loss
        )


@dataclass(frozen=True)
class Snapshot:
    """What the balance of the next step needs of this instant.

    q, v : (n, 3), place and rate of the segments. push : N. travel : m. elastic, kinetic : J.
    """

    q: Floats
    v: Floats
    push: float
    travel: float
    elastic: float
    kinetic: float
    loads: LoadsInstant = NO_LOADS


def snapshot(wire: Wire, motion: Motion, push: float, travel: float, loads: LoadsInstant = NO_LOADS) -> Snapshot:
    """This instant."""
    q, v = motion.q.copy(), motion.v.copy()
    bend = relative_angles(q[:, 2]) - wire.rest_angle
    elastic = 0.5 * float(wire.joint_stiffness @ bend**2) + loads.elastic
    kinetic = 0.5 * float(wire.mass @ (v[:, 0] ** 2 + v[:, 1] ** 2) + wire.inertia @ v[:, 2] ** 2)
    return Snapshot(q, v, push, travel, elastic, kinetic, loads)


def relative_angles(angle: Floats) -> Floats:
    """(n,), rad: of each segment against the one before; the first against the catheter."""
    relative = angle.copy()
    relative[1:] -= angle[:-1]
    return relative


def joint_moments(wire: Wire, motion: Motion) -> Floats:
    """(n,), N m: spring and damper of each joint, on its distal segment counted negative (they resist the bend)."""
    bend = relative_angles(motion.q[:, 2]) - wire.rest_angle
    moments: Floats = wire.joint_stiffness * bend + wire.joint_damping * relative_angles(motion.v[:, 2])
    return moments


def advanced(
    before: Energies,
    contact: Contact,
    wall_before: float,
    old: Snapshot,
    new: Snapshot,
    acceleration: Floats,
    step: float,
) -> Energies:
    """The energies after a step. `contact` is evaluated at its end; acceleration : (n, 3) at its end; step : s.

    wall_before : J, in the springs of the walls at its start.
    """
    wire = contact.wire
    moved, travelled = new.q - old.q, new.travel - old.travel
    turned = relative_angles(moved[:, 2])
    bend = relative_angles(new.q[:, 2]) - wire.rest_angle
    walls = contact.summary()
    friction, wall_damping = walls.friction, walls.damping
    wall, wall_before = walls.energy + new.loads.stored, wall_before + old.loads.stored
    inertia = np.column_stack([wire.mass, wire.mass, wire.inertia]) * acceleration
    resisted = wire.joint_damping * relative_angles(new.v[:, 2])
    damping = float(wire.joint_damping @ turned**2) / step
    work = 0.5 * (old.push + new.push) * travelled
    load_work = 0.5 * float((old.loads.effort + new.loads.effort) @ (new.loads.place - old.loads.place))
    applied = contact.force + new.loads.force
    in_tip = new.loads.elastic - old.loads.elastic
    # Work with the forces at the step's end, less what each force really stored or took.
    numerical = (
        0.5 * (old.push - new.push) * travelled
        + float((wire.joint_stiffness * bend) @ turned) - (new.elastic - old.elastic - in_tip)
        + float(resisted @ turned) - damping
        + float((inertia * moved).sum()) - (new.kinetic - old.kinetic)
        - float((applied * moved).sum()) + load_work - in_tip - (wall - wall_before) - friction - wall_damping
        - _finite_turns(wire, old, new, inertia - applied)
    )  # fmt: skip
    stored = new.elastic + wall + new.kinetic
    return Energies(
        elastic=new.elastic,
        wall=wall,
        kinetic=new.kinetic,
        insertion_work=before.insertion_work + work,
        friction_loss=before.friction_loss + friction,
        damping_loss=before.damping_loss + damping + wall_damping,
        numerical_loss=before.numerical_loss + numerical,
        start=before.start,
        largest_work=max(
            before.largest_work, abs(before.insertion_work + work), abs(before.load_work + load_work), stored
        ),
        load_work=before.load_work + load_work,
    )


def _finite_turns(wire: Wire, old: Snapshot, new: Snapshot, needed: Floats) -> float:
    """J: work of the joints' forces because a rigid segment's end moves on an arc, not along the tangent at its place.

    needed : (n, 3), inertia less the forces on each segment. The force in joint i is what the distal part needs.
    """
    joint = np.cumsum(needed[::-1, :2], axis=0)[::-1]
    half = (wire.lengths / 2)[:, None]
    angle0, angle1 = old.q[:, 2], new.q[:, 2]
    direction0 = np.column_stack([np.cos(angle0), np.sin(angle0)])
    direction1 = np.column_stack([np.cos(angle1), np.sin(angle1)])
    tangent = np.column_stack([-direction1[:, 1], direction1[:, 0]]) * (angle1 - angle0)[:, None]
    arc = half * (direction1 - direction0 - tangent)
    gap = arc.copy()
    gap[1:] += arc[:-1]
    return float((joint * gap).sum())
