"""Small scenarios for tests that run the engine. Lengths in m, all SI."""

from __future__ import annotations

import copy
import math
from typing import Any

from gw_exudyn.scenario import Scenario, scenario_from_dict

SOFT: dict[str, Any] = {
    "diameter": 0.36e-3,
    "length": 0.060,
    "density": 6450.0,
    "bending_stiffness": 1e-6,
    "segments": 40,
}

CORNER = [(0.0, -2e-3), (22e-3, -2e-3), (22e-3, 40e-3), (18e-3, 40e-3), (18e-3, 2e-3), (0.0, 2e-3)]
"""A channel of 4 mm with one corner of 90 degrees; the inner corner is at (18, 2) mm."""


def scenario(**changes: Any) -> Scenario:
    """A soft wire in the cornered channel, pushed 30 mm at 2 mm/s; `changes` merge into its sections."""
    data: dict[str, Any] = {
        "name": "test",
        "wire": dict(SOFT),
        "vessel": polygon(CORNER, open_edges=(2, 5)),
        "catheter": {"exit": [0.0, 0.0], "bore": 1.2e-3},
        "contact": {"friction_coefficient": 0.2},
        "drive": {"kind": "speed", "speed": 2e-3, "distance": 0.030},
        "solver": {"step": 0.1},
        "output": {"interval": 0.1},
    }
    for section, values in copy.deepcopy(changes).items():
        keeps = isinstance(values, dict) and section in data and section not in ("vessel", "drive")
        data[section] = {**data[section], **values} if keeps else values
    return scenario_from_dict(data)


def polygon(points: list[tuple[float, float]], open_edges: tuple[int, ...] = ()) -> dict[str, Any]:
    """A polygon vessel."""
    return {"kind": "polygon", "points": [list(point) for point in points], "open_edges": list(open_edges)}


def bend(degrees: float, run_in: float = 10e-3, run_out: float = 40e-3, half: float = 2e-3) -> dict[str, Any]:
    """A channel with one sharp corner; the path turns left by `degrees` at (run_in, 0)."""
    a = math.radians(degrees)
    corner, d, n = half * math.tan(a / 2), (math.cos(a), math.sin(a)), (-math.sin(a), math.cos(a))
    out = (run_in + run_out * d[0], run_out * d[1])
    points = [
        (0.0, -half),
        (run_in + corner, -half),
        (out[0] - half * n[0], out[1] - half * n[1]),
        (out[0] + half * n[0], out[1] + half * n[1]),
        (run_in - corner, half),
        (0.0, half),
    ]
    return polygon(points, open_edges=(2, 5))
