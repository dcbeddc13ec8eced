"""One output instant: everything that a result keeps, in the scenario's plane and the table's units."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.engine.stepper import Stepper
from gw_exudyn.model.energy import joint_moments, relative_angles
from gw_exudyn.model.kernel import Pairs
from gw_exudyn.quantities import CONTACT_FIELDS, QUANTITIES

Floats = NDArray[np.float64]

_NO_CONTACTS: Mapping[str, Floats] = MappingProxyType(
    {name: np.zeros(0, int if QUANTITIES[name].integer else float) for name in CONTACT_FIELDS}
    | {"force": np.zeros((0, 2)), "at_tip": np.zeros(0, bool)}
)
"""As `contact_points` where nothing touches."""

NODE_ON_WALL, CORNER_ON_WIRE, TIP_ON_CORNER, DISC_ON_WIRE = 0, 1, 2, 3
VESSEL, CATHETER, SUPPORT, NOSE = 0, 1, 2, 3


def sample(stepper: Stepper, *, shape: bool = True) -> dict[str, Any]:
    """The quantities of the table at the time reached (see `quantities`): scalars, node, joint and contact arrays.

    shape : False leaves the arrays over nodes and joints out.
    """
    contacts = contact_points(stepper)
    arrays = _shape(stepper) if shape else {}
    # The tip is the last node, to the bit.
    tip = (arrays["node_x"][-1], arrays["node_y"][-1]) if shape else stepper.model.frame.points_out(stepper.tip())
    return {
        "time": stepper.time,
        "tip_x": tip[0],
        "tip_y": tip[1],
        **_place(stepper),
        **arrays,
        **_forces(stepper, contacts),
        **_loads(stepper),
        **_energies(stepper),
        **_solver(stepper),
        **{name: contacts[name] for name in contacts if name.startswith("contact_")},
    }


def _place(stepper: Stepper) -> dict[str, Any]:
    return {
        "insertion_depth": stepper.instant.travel,
        "tip_angle": stepper.contact.motion.q[-1, 2] + stepper.model.frame.angle,
        "drive_speed": stepper.hub.speed,
        "drive_position": stepper.instant.travel - stepper.model.wire.length,
    }


def _shape(stepper: Stepper) -> dict[str, Floats]:
    wire, motion = stepper.model.wire, stepper.contact.motion
    half, nodes = wire.lengths / 2, np.empty((wire.segments + 1, 2))
    for axis, direction in enumerate((motion.c, motion.s)):
        arm = half * direction
        nodes[0, axis] = motion.q[0, axis] - arm[0]
        nodes[1:, axis] = motion.q[:, axis] + arm
    nodes = stepper.model.frame.points_out(nodes)
    return {
        "node_x": nodes[:, 0],
        "node_y": nodes[:, 1],
        "joint_angle": relative_angles(motion.q[:, 2]),
        "joint_torque": -joint_moments(wire, motion),
    }


def contact_points(stepper: Stepper) -> Mapping[str, Floats]:
    """The contacts that carry a force, (c,) each: the table's contact fields, and `force` (c, 2), N, of the wire on
    the wall in the plane, and `at_tip` (c,) bool, on the tip's disc."""
    found = [part for part in (_node_contacts(stepper), _corner_contacts(stepper), _disc_contacts(stepper)) if part]
    if not found:
        return _NO_CONTACTS
    joined = {name: np.concatenate([part[name] for part in found]) for name in found[0]}
    points = stepper.model.frame.points_out(joined.pop("point"))
    return {**joined, "contact_x": points[:, 0], "contact_y": points[:, 1]}


def _node_contacts(stepper: Stepper) -> dict[str, Floats]:
    """Of the nodes with walls; nothing at all where none touches, as of the other kinds."""
    pairs, wire, walls, motion = stepper.contact.nodes, stepper.model.wire, stepper.model.walls, stepper.contact.motion
    live = _carrying(pairs)
    if not live.any():
        return {}
    body, wall = pairs.body[live], pairs.target[live]
    along = np.column_stack([motion.c[body], motion.s[body]])
    node = motion.q[body, :2] + wire.lengths[body, None] / 2 * along
    tangent, normal = walls.tangent[wall], walls.normal[wall]
    pressed, dragged = _shares(pairs, live)
    on_wire = pressed[:, None] * normal + dragged[:, None] * tangent
    is_tip = body == wire.segments - 1
    return {
        "point": node - wire.radius * normal,
        "contact_arc_length": wire.node_arc_length[body + 1],
        "contact_normal_force": pressed,
        "contact_tangential_force": -dragged * np.where((tangent * along).sum(axis=1) < 0, -1.0, 1.0),
        "contact_gap": pairs.gap[live],
        "contact_kind": np.full(len(body), NODE_ON_WALL),
        "contact_owner": np.where(walls.tube[wall], CATHETER, VESSEL),
        "force": stepper.model.frame.vectors_out(-on_wire),
        "at_tip": is_tip,
    }


def _corner_contacts(stepper: Stepper) -> dict[str, Floats]:
    pairs, wire, walls, motion = (
        stepper.contact.corners,
        stepper.model.wire,
        stepper.model.walls,
        stepper.contact.motion,
    )
    live = _carrying(pairs)
    if not live.any():
        return {}
    body, corner = pairs.body[live], pairs.target[live]
    half = wire.lengths[body] / 2
    along = np.column_stack([motion.c[body], motion.s[body]])
    place = walls.corner[corner]
    offset = place - motion.q[body, :2]
    beside = np.clip((offset * along).sum(axis=1), -half, half)
    away = offset - beside[:, None] * along
    direction = away / np.maximum(np.hypot(*away.T), 1e-300)[:, None]
    past_tip = (body == wire.segments - 1) & ((offset * along).sum(axis=1) > half)
    pressed, dragged = _shares(pairs, live)
    # Slip counts across the direction to the corner, in the sense of contact.c (`turn`).
    across = np.where(pairs.side[live] < 0, -1.0, 1.0)[:, None] * np.column_stack([direction[:, 1], -direction[:, 0]])
    towards_tip = np.where((across * along).sum(axis=1) < 0, -1.0, 1.0)
    on_wire = -pressed[:, None] * direction + dragged[:, None] * across
    return {
        "point": place,
        "contact_arc_length": wire.node_arc_length[body + 1] + half - beside,
        "contact_normal_force": pressed,
        "contact_tangential_force": -dragged * towards_tip,
        "contact_gap": pairs.gap[live],
        "contact_kind": np.where(past_tip, TIP_ON_CORNER, CORNER_ON_WIRE),
        "contact_owner": np.where(walls.corner_tube[corner], CATHETER, VESSEL),
        "force": stepper.model.frame.vectors_out(-on_wire),
        "at_tip": past_tip,
    }


def _disc_contacts(stepper: Stepper) -> dict[str, Floats]:
    discs, wire, frame = stepper.loads.discs, stepper.model.wire, stepper.model.frame
    found = discs.contacts
    if not found:
        return {}
    body = np.array([contact.body for contact in found], dtype=int)
    foot = np.array([contact.foot for contact in found])
    normal = np.array([contact.normal for contact in found])
    direction = np.array([contact.direction for contact in found]).reshape(-1, 2)
    owner = [NOSE if discs.discs[contact.disc].moves else SUPPORT for contact in found]
    return {
        "point": np.array([contact.point for contact in found]).reshape(-1, 2),
        "contact_arc_length": wire.node_arc_length[body + 1] + wire.lengths[body] / 2 - foot,
        "contact_normal_force": normal,
        "contact_tangential_force": np.zeros(len(found)),
        "contact_gap": np.array([contact.gap for contact in found]),
        "contact_kind": np.full(len(found), DISC_ON_WIRE),
        "contact_owner": np.array(owner, dtype=int),
        "force": frame.vectors_out(normal[:, None] * direction),
        "at_tip": np.zeros(len(found), dtype=bool),
    }


def _carrying(pairs: Pairs) -> NDArray[np.bool_]:
    live: NDArray[np.bool_] = (pairs.normal > 0) & (pairs.weight > 0)
    return live


def _shares(pairs: Pairs, live: NDArray[np.bool_]) -> tuple[Floats, Floats]:
    """Normal and tangential force on the wire, N, weighted."""
    return pairs.weight[live] * pairs.normal[live], pairs.weight[live] * pairs.tangential[live]


def _forces(stepper: Stepper, contacts: Mapping[str, Floats]) -> dict[str, Any]:
    force, normal = contacts["force"], contacts["contact_normal_force"]
    vessel, inside = contacts["contact_owner"] == VESSEL, contacts["contact_owner"] == CATHETER
    wall, catheter = force[vessel].sum(axis=0), force[inside].sum(axis=0)
    catheter = catheter + _on_sleeve(stepper, wall)
    tip = force[contacts["at_tip"].astype(bool)].sum(axis=0)
    return {
        "push_force": stepper.instant.push,
        "drive_force": stepper.hub.force,
        "tip_force": float(np.hypot(*tip)),
        "wall_force_x": wall[0],
        "wall_force_y": wall[1],
        "wall_force_normal": normal[vessel].sum(),
        "wall_force_tangential": contacts["contact_tangential_force"][vessel].sum(),
        "wall_force_max": np.hypot(*force[vessel].T).max(initial=0.0),
        "catheter_force_x": catheter[0],
        "catheter_force_y": catheter[1],
        "catheter_force_normal": normal[inside].sum(),
        "contacts": np.count_nonzero(vessel),
        "penetration_max": max(stepper.contact.deepest().depth, stepper.loads.discs.depth),
    }


def _on_sleeve(stepper: Stepper, wall: Floats) -> Floats:
    """(2,), N, of the wire on a sleeve; zeros for other catheters. wall : (2,), N, of the wire on the vessel.

    Along the axis from the sleeve's potential. The hub runs in the sleeve, so whatever vessel and loads do to the wire
    across the axis is the sleeve's to take.
    """
    sleeve, frame = stepper.loads.sleeve, stepper.model.frame
    if sleeve is None:
        return np.zeros(2)
    across = float(stepper.instant.loads.force[:, 1].sum()) - float(frame.vectors_in(wall)[1])
    return frame.vectors_out(np.array([-sleeve.push, across]))


def _loads(stepper: Stepper) -> dict[str, float]:
    discs, frame = stepper.loads.discs, stepper.model.frame
    support, nose, travel = np.zeros(2), 0.0, 0.0
    for number, disc in enumerate(discs.discs):
        force = discs.force_on(number)
        if disc.moves:
            nose = -float(force @ disc.way) / float(np.hypot(*disc.way))
            travel = float(np.hypot(*(disc.centre(stepper.time) - disc.at)))
        else:
            support += force
    support, held = frame.vectors_out(support), frame.vectors_out(-stepper.loads.hold_force(stepper.contact.motion))
    return {
        "load_work": stepper.energies.load_work,
        "support_force_x": support[0],
        "support_force_y": support[1],
        "nose_force": nose,
        "nose_travel": travel,
        "tip_hold_force_x": held[0],
        "tip_hold_force_y": held[1],
    }


def _energies(stepper: Stepper) -> dict[str, float]:
    energies = stepper.energies
    return {
        "insertion_work": energies.insertion_work,
        "elastic_energy": energies.elastic,
        "wall_energy": energies.wall,
        "kinetic_energy": energies.kinetic,
        "friction_loss": energies.friction_loss,
        "damping_loss": energies.damping_loss,
        "numerical_loss": energies.numerical_loss,
        **_hub_energies(stepper),
        "energy_error": stepper.energy_error,
    }


def _hub_energies(stepper: Stepper) -> dict[str, float]:
    """Where the hub is placed, the drive works on the wire alone."""
    hub = stepper.hub_energies
    free = stepper.system.hub.moves_freely
    return {
        "drive_work": hub.work if free else stepper.energies.insertion_work,
        "hub_kinetic_energy": hub.kinetic,
        "hub_damping_loss": hub.damping_loss,
        "hub_numerical_loss": hub.numerical_loss,
    }


def _solver(stepper: Stepper) -> dict[str, Any]:
    counts = stepper.counts()
    return {
        "solver_steps": counts["solver_steps"],
        "newton_iterations": counts["newton_iterations"],
        "smallest_step": stepper.smallest_step if counts["solver_steps"] else stepper.model.scenario.solver.step,
    }
