"""The motion of a run, packed small: what the player of the page reads.

Positions are 16-bit integers over the box that holds them, which is a thousandth of a millimetre in a vessel of 60 mm;
everything else is 32-bit.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gw_exudyn.plots.contact_vectors import contact_vectors
from gw_exudyn.plots.scene import centreline
from gw_exudyn.quantities import QUANTITIES, display_unit, plain
from gw_exudyn.report.packing import base64_text, floats, spread

if TYPE_CHECKING:
    from gw_exudyn.result import Floats, Result

CURVES = ("push_force", "wall_force_x", "wall_force_y", "wall_force_normal", "wall_force_max", "tip_force")
READINGS = ("insertion_depth", "tip_x", "tip_y", "tip_angle", "contacts", *CURVES)
"""Scalars that the player shows as numbers."""

MOST_FRAMES = 600
MOST_NODES = 201
LEVELS = 65534
NO_NUMBER = 65535
"""Stands for a coordinate that is not finite."""


def packed_run(result: Result, most_frames: int = MOST_FRAMES, most_nodes: int = MOST_NODES) -> dict[str, Any]:
    """One run for the player. Lengths are in millimetres, forces in newtons, time in seconds."""
    frames = spread(len(result.time), most_frames)
    nodes = spread(result.values("node_x").shape[1], most_nodes)
    course = np.stack([centreline(result, int(i))[nodes] for i in frames]) * 1e3
    low, high = _box(course)
    return {
        "name": result.scenario.name,
        "diameter": result.scenario.wire.diameter * 1e3,
        "status": result.status.sentence(),
        "trusted": result.status.status.trusted,
        "time": floats(result.time[frames]),
        "nodes": len(nodes),
        "box": [*low, *high],
        "course": base64_text(_quantised(course, low, high), "<u2"),
        "walls": [(line * 1e3).round(5).tolist() for line in result.vessel_outline],
        "catheter": [(line * 1e3).round(5).tolist() for line in result.catheter_outline],
        "scalars": {name: floats(result.values(name)[frames]) for name in READINGS},
        **_contacts(result, frames),
    }


def scalars_table() -> dict[str, dict[str, Any]]:
    """Label, unit and factor from SI of each scalar that the player shows."""
    table = {}
    for name in ("time", *READINGS):
        unit, factor = display_unit(name)
        table[name] = {
            "label": QUANTITIES[name].label,
            "unit": "" if unit == "1" else plain(unit),
            "factor": factor,
            "meaning": QUANTITIES[name].long_name,
        }
    return table


def _contacts(result: Result, frames: Floats) -> dict[str, Any]:
    """Contacts of all frames behind each other: `starts` says where those of a frame begin."""
    starts, rows = [0], []
    for frame in frames:
        points, forces, owners = contact_vectors(result, int(frame))
        rows.append(np.column_stack([points * 1e3, forces, owners]))
        starts.append(starts[-1] + len(points))
    return {"starts": starts, "contacts": floats(np.concatenate(rows).ravel())}


def _box(course: Floats) -> tuple[Floats, Floats]:
    points = course.reshape(-1, 2)
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        return np.zeros(2), np.ones(2)
    return points.min(axis=0), points.max(axis=0)


def _quantised(course: Floats, low: Floats, high: Floats) -> Floats:
    share = (course - low) / np.maximum(high - low, 1e-9)
    known = np.isfinite(share).all(axis=-1, keepdims=True)
    return np.where(known, np.nan_to_num(share) * LEVELS, NO_NUMBER).round()
