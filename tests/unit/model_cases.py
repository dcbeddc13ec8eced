"""Wires, walls and contacts for tests of the model: small, explicit, and placed by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gw_exudyn.model.contact import Contact, ContactLaw
from gw_exudyn.model.walls import Walls
from gw_exudyn.model.wire import Floats, Wire
from gw_exudyn.scenario import Scenario, scenario_from_dict

RADIUS = 0.18e-3
LAW = ContactLaw(stiffness=1000.0, tangential_stiffness=700.0, damping=1.5e4, toe=0.04 * RADIUS)


def scenario(**changes: Any) -> Scenario:
    """A soft wire in a straight channel; sections are updated, and a vessel of another kind takes its place."""
    content: dict[str, Any] = {
        "wire": {
            "diameter": 2 * RADIUS,
            "length": 0.1,
            "bending_stiffness": 2e-6,
            "density": 6000.0,
            "segments": 10,
            "imperfection": 0.0,
        },
        "vessel": {"kind": "straight", "length": 0.1, "diameter": 4e-3},
        "catheter": {"bore": 1.2e-3},
        "drive": {"kind": "speed", "speed": 2e-3, "distance": 0.06},
    }
    for section, change in changes.items():
        replaced = section == "drive" or "kind" in change
        content[section] = change if replaced else content.get(section, {}) | change
    return scenario_from_dict(content)


def plain_wire(lengths: ArrayLike, stiffness: float = 1e-3) -> Wire:
    """A straight wire of segments with these lengths (m), with one stiffness (N m/rad) in all joints."""
    length = np.array(lengths, dtype=float)
    nodes = np.concatenate([np.cumsum(length[::-1])[::-1], [0.0]])
    joints = np.full(len(length), stiffness)
    mass = 0.6e-3 * length
    return Wire(
        RADIUS,
        length,
        mass,
        mass * length**2 / 12,
        joints,
        0.02 * joints,
        np.zeros(len(length)),
        nodes,
        np.ones(len(nodes)),
    )


def bare_walls(
    *segments: tuple[tuple[float, float], tuple[float, float]],
    corners: ArrayLike = (),
    friction: float = 0.0,
    sharp: int = 0,
    tube: bool = False,
) -> Walls:
    """Walls (start, end), the lumen on their left, that fade out within half a radius at their ends; and corners."""
    ends = np.array(segments, dtype=float).reshape(-1, 2, 2)
    edge = ends[:, 1] - ends[:, 0]
    length = np.hypot(*edge.T)
    count, corner = len(length), np.array(corners, dtype=float).reshape(-1, 2)
    fade = np.full(count, RADIUS / 2)
    return Walls(
        start=ends[:, 0],
        tangent=edge / length[:, None],
        length=length,
        lo=np.zeros(count),
        hi=length,
        fade_lo=fade,
        fade_hi=fade,
        sharp=np.full(count, sharp, np.int32),
        friction=np.full(count, friction),
        tube=np.full(count, tube),
        corner=corner,
        corner_friction=np.full(len(corner), friction),
        corner_tube=np.full(len(corner), tube),
    )


def chain(wire: Wire, base: ArrayLike, angles: ArrayLike) -> Floats:
    """(n, 3): places of the segments of a chain whose proximal end is at `base` (m), with these angles (rad)."""
    angle = np.broadcast_to(np.array(angles, dtype=float), wire.lengths.shape)
    step = wire.lengths[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    centre = np.array(base, dtype=float) + np.cumsum(step, axis=0) - step / 2
    return np.column_stack([centre, angle])


def at_rest(wire: Wire, walls: Walls, q: Floats, law: ContactLaw = LAW) -> Contact:
    """A contact whose step begins at the place q, (n, 3), with the sides of its corners decided there."""
    contact = Contact(wire, walls, law)
    contact.motion.set(q, np.zeros_like(q))
    contact.start_step()
    settle(contact)
    return contact


def settle(contact: Contact) -> None:
    """Accept the present place as the end of the step, and begin the next one there."""
    contact.evaluate()
    contact.accept()
    contact.start_step()


def force_at(contact: Contact, q: Floats, v: Floats | None = None) -> Floats:
    """(n, 3): the contact force at a trial place of the present step."""
    contact.motion.set(q, np.zeros_like(q) if v is None else v)
    contact.evaluate()
    return contact.force.copy()
