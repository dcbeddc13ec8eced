"""The scenes of the cases: one wire, straight without load, and what is around it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from gw_exudyn.scenario import Scenario, scenario_from_dict

DIAMETER = 0.36e-3
SPEED = 2e-3
STILL = {"kind": "speed", "speed": 0.0}


def scene(wire: dict[str, Any], drive: dict[str, Any], **sections: Any) -> Scenario:
    """A scenario of a wire of 0.36 mm without imperfection, SI; `sections` as in a scenario file."""
    straight = {"diameter": DIAMETER, "density": 6450.0, "imperfection": 0.0}
    return scenario_from_dict({"wire": {**straight, **wire}, "drive": drive, **sections})


def alone(
    length: float, stiffness: float, segments: int, seconds: float, drive: dict[str, Any] | None = None, **sections: Any
) -> Scenario:
    """A wire of uniform stiffness without vessel or catheter, along +x with its proximal end, held, at the origin."""
    wire = {"length": length, "bending_stiffness": stiffness, "segments": segments, **sections.pop("wire", {})}
    still = {**STILL, "duration": seconds, "start": length, **(drive or {})}
    return scene(wire, still, vessel={"kind": "none"}, catheter={}, output={"interval": seconds}, **sections)


def soft_tip(near: float, far: float, stretch: float, length: float) -> dict[str, Any]:
    """Bending stiffness whose logarithm rises linearly from the tip over a stretch (m), then is uniform. N m^2."""
    places = np.linspace(0.0, stretch, 181)
    table = [[float(s), near * (far / near) ** (float(s) / stretch)] for s in places]
    return {"table": [*table, [length, far]]}


def corner_vessel(width: float) -> dict[str, Any]:
    """A channel along x that turns left by 60 degrees at the origin."""
    half, turn, before, after = width / 2, math.radians(60), -0.2, 0.06
    along, left = np.array([math.cos(turn), math.sin(turn)]), np.array([-math.sin(turn), math.cos(turn)])
    corner = half * np.array([-math.tan(turn / 2), 1.0])
    points = [
        (before, -half),
        tuple(-corner),
        tuple(after * along - half * left),
        tuple(after * along + half * left),
        tuple(corner),
        (before, half),
    ]
    return {"kind": "polygon", "points": [[float(x), float(y)] for x, y in points], "open_edges": [2, 5]}
