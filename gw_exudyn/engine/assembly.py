"""The multibody system in Exudyn: a hub on the catheter's axis, rigid segments, revolute joints, torsional springs.

Coordinates in their global order: the hub's (x, y, angle), then those of segments 0 to n - 1. All in the catheter's
frame.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.engine.hub import Hub, PlacedHub, PushedHub
from gw_exudyn.engine.library import exudyn
from gw_exudyn.model import Model
from gw_exudyn.model.drive import Force
from gw_exudyn.model.wire import Wire

Floats = NDArray[np.float64]

HUB_COORDINATES = 3


@dataclass(frozen=True)
class System:
    """The assembled system and what the stepping needs to know of it.

    reference : (n, 3), place of the centres (m) and angles (rad) of the segments at the start; Exudyn's coordinates
        count from there.
    hub : what moves the proximal end. range : m, its travel stays between these. contact : the object that carries
        the forces of contact and loads. base_moves : the hub is free to move across the axis.
    """

    container: Any
    mbs: Any
    reference: Floats
    hub: Hub
    range: tuple[float, float]
    contact: int
    base_moves: bool


Jacobian = Callable[[Any, float, int, list[float], list[float], float, float], Any]


def assemble(model: Model, contact_jacobian: Jacobian) -> System:
    """Build the system in the catheter, the tip at its exit: at rest before a force, moving with the first speed of a
    drive that has one."""
    exu, wire = exudyn(), model.wire
    import exudyn.itemInterface as items  # noqa: N813

    container = exu.SystemContainer()
    mbs = container.AddSystem()
    reference = reference_places(wire)
    drive, inserted = model.drive, model.scenario.drive.start
    # Nothing moves at first where what holds the tip stops it.
    speed = 0.0 if isinstance(drive, Force) or model.loads.tip.held[0] > 0 else drive.speed_at(0.0)
    hub_mass = drive.hub_mass if isinstance(drive, Force) else float(wire.mass[0])
    hub_body, hub_node = _body(mbs, items, (-wire.length, 0.0, 0.0), hub_mass, float(wire.inertia[0]), inserted, speed)
    hub = _guide(mbs, items, hub_node, model)
    bodies, nodes = [], []
    for i in range(wire.segments):
        body, node = _body(mbs, items, reference[i], float(wire.mass[i]), float(wire.inertia[i]), inserted, speed)
        bodies.append(body)
        nodes.append(node)
    for i in range(wire.segments):
        before, before_node, reach = (
            (bodies[i - 1], nodes[i - 1], wire.lengths[i - 1] / 2) if i else (hub_body, hub_node, 0.0)
        )
        _joint(mbs, items, wire, i, (before, before_node, float(reach)), (bodies[i], nodes[i]))
    count = 3 * wire.segments
    empty = exu.MatrixContainer()
    empty.SetWithSparseMatrix(np.zeros((1, 3)), count, count)  # sparse, so that the contact's tangent is too
    contact = mbs.AddObject(
        items.ObjectGenericODE2(
            nodeNumbers=nodes,
            massMatrix=empty,
            stiffnessMatrix=empty,
            dampingMatrix=empty,
            forceVector=np.zeros(count),
            jacobianUserFunction=contact_jacobian,  # type: ignore[arg-type]
        )
    )
    mbs.Assemble()
    return System(container, mbs, reference, hub, model.travel_range, contact, model.scenario.drive.hold == "axial")


def reference_places(wire: Wire) -> Floats:
    """(n, 3): centre (m) and angle (rad) of each segment of the straight wire, its tip at the origin, from where
    Exudyn's coordinates count; the length inserted at the start is an initial coordinate."""
    places = np.zeros((wire.segments, 3))
    places[:, 0] = -(wire.node_arc_length[:-1] + wire.node_arc_length[1:]) / 2
    return places


def _body(mbs: Any, items: Any, place: Any, mass: float, inertia: float, start: float, speed: float) -> tuple[int, int]:
    node = mbs.AddNode(
        items.NodeRigidBody2D(
            referenceCoordinates=[float(x) for x in place],
            initialCoordinates=[start, 0.0, 0.0],
            initialVelocities=[speed, 0.0, 0.0],
        )
    )
    return mbs.AddObject(items.ObjectRigidBody2D(mass=mass, inertia=inertia, nodeNumber=node)), node


def _guide(mbs: Any, items: Any, hub_node: int, model: Model) -> Hub:
    """Hold the hub on the axis (where the drive does) without turning, and let the drive place or push it along the
    axis. What places it is the first constraint; one that holds nothing keeps its place among the constraint forces."""
    ground = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(items.NodePointGround()), coordinate=0))
    markers = [
        mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=hub_node, coordinate=coordinate))
        for coordinate in range(HUB_COORDINATES)
    ]
    hub: Hub
    if isinstance(model.drive, Force):
        hub = PushedHub(mbs, items, ground, markers[0], model.drive.hub_damping)
    else:
        hub = PlacedHub(mbs, items, ground, markers[0], float(model.wire.mass[0]))
    for marker, holds in zip(markers[1:], (model.scenario.drive.hold != "axial", True), strict=True):
        mbs.AddObject(items.CoordinateConstraint(markerNumbers=[ground, marker], offset=0.0, activeConnector=holds))
    return hub


def _joint(mbs: Any, items: Any, wire: Wire, i: int, before: tuple[int, int, float], after: tuple[int, int]) -> None:
    """Revolute joint and torsional spring-damper proximal to segment i.

    The spring-damper acts between the two rotation coordinates, which in the plane is the torsional spring-damper, and
    cheaper than its connector in space.
    """
    body, node, reach = before
    distal_end = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[reach, 0.0, 0.0]))
    proximal_end = mbs.AddMarker(
        items.MarkerBodyRigid(bodyNumber=after[0], localPosition=[-float(wire.lengths[i]) / 2, 0.0, 0.0])
    )
    mbs.AddObject(items.ObjectJointRevolute2D(markerNumbers=[distal_end, proximal_end]))
    turns = [mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=n, coordinate=2)) for n in (node, after[1])]
    mbs.AddObject(
        items.CoordinateSpringDamper(
            markerNumbers=turns,
            stiffness=float(wire.joint_stiffness[i]),
            damping=float(wire.joint_damping[i]),
            offset=float(wire.rest_angle[i]),
        )
    )
