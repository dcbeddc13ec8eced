"""Contact forces as vectors in the plane."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.plots.scene import centreline

if TYPE_CHECKING:
    from gw_exudyn.result import Floats, Result


def contact_vectors(result: Result, instant: int) -> tuple[Floats, Floats, Floats]:
    """Contacts of an output instant (an index).

    points : (c, 2) float, m. On the wire's surface, at the wall. forces : (c, 2) float, N. Of the wire on the wall;
    the normal points from the wire's axis to the contact, the tangent towards the wire's tip. owners : (c,) float. 0
    vessel, 1 catheter.
    """
    contacts = result.contacts_at(instant)
    points = np.column_stack([contacts["contact_x"], contacts["contact_y"]])
    place = contacts["contact_arc_length"]
    axis, tangent = _on_wire(result, instant, place)
    normal = points - axis
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    # A contact right on the axis has no side of its own; any normal to the wire is as good.
    across = np.column_stack([-tangent[:, 1], tangent[:, 0]])
    normal = np.where(size > 1e-12, normal / np.maximum(size, 1e-12), across)
    along = np.column_stack([-normal[:, 1], normal[:, 0]])
    along = np.where((along * tangent).sum(axis=1, keepdims=True) < 0, -along, along)
    forces = contacts["contact_normal_force"][:, None] * normal + contacts["contact_tangential_force"][:, None] * along
    good = np.isfinite(points).all(axis=1) & np.isfinite(forces).all(axis=1)
    return points[good], forces[good], contacts["contact_owner"][good]


def vessel_contacts(result: Result, instant: int) -> tuple[Floats, Floats]:
    """Points and forces, both (c, 2), of the contacts with the vessel; those with the catheter load no vessel."""
    points, forces, owners = contact_vectors(result, instant)
    return points[owners == 0], forces[owners == 0]


def _on_wire(result: Result, instant: int, place: Floats) -> tuple[Floats, Floats]:
    """Points on the wire's axis at the arc lengths `place` (c,) from the tip, and unit tangents towards the tip, both
    (c, 2).
    """
    nodes = centreline(result, instant)
    from_tip = result.values("node_arc_length")
    # np.interp wants rising places; the nodes run towards the tip.
    axis = np.column_stack([np.interp(place, from_tip[::-1], nodes[::-1, i]) for i in range(2)])
    segment = np.clip(np.searchsorted(-from_tip, -place, side="right") - 1, 0, len(nodes) - 2)
    tangent = nodes[segment + 1] - nodes[segment]
    return axis, tangent / np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), 1e-300)
