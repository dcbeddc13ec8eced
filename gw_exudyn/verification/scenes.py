"""The scenes of the cases: one wire, straight without load, and what is around it."""

from __future__ import annotations

from typing import Any

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
