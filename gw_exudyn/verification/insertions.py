"""The insertions that several groups of evidence run, and how two results are compared. SI."""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from gw_exudyn.result import Result
from gw_exudyn.scenario import load_scenario, scenario_from_dict
from gw_exudyn.simulation import simulate
from gw_exudyn.verification.evidence import Curve, Floats

WIRES = ("universal-ii", "amplatz-super-stiff")
SEGMENTS = 80
LUMEN = 4e-3
SPEED = 2e-3


def bend60(wire: str) -> dict[str, Any]:
    """A wire of the catalogue pushed 20 mm through a channel with one sharp corner of 60 degrees, 5 mm ahead."""
    away = (0.06 * math.cos(math.radians(60)), 0.06 * math.sin(math.radians(60)))
    return {
        "name": f"bend60-{wire}",
        "wire": {"model": wire, "segments": SEGMENTS, "imperfection": 0.04},
        "vessel": channel([(-0.02, 0.0), (0.0, 0.0), away], LUMEN),
        "catheter": {"exit": [-5e-3, 0.0], "bore": 1.2e-3},
        "contact": {"friction_coefficient": 0.4},
        "drive": {"kind": "speed", "speed": SPEED, "distance": 0.020},
        "output": {"interval": 0.25},
    }


def corner90(wire: str) -> dict[str, Any]:
    """The shipped insertion of that wire round a corner of 90 degrees, with fewer segments."""
    shipped = {"universal-ii": "corner90-universal", "amplatz-super-stiff": "corner90-amplatz"}[wire]
    return load_scenario(shipped, {"wire.segments": SEGMENTS, "output.interval": 0.5}).to_dict()


def channel(path: Sequence[tuple[float, float]], width: float) -> dict[str, Any]:
    """A channel with sharp, mitred corners along a path, both ends open."""
    p = np.array(path)
    d = np.diff(p, axis=0)
    d /= np.hypot(*d.T)[:, None]
    normal = np.column_stack([-d[:, 1], d[:, 0]])
    mitre = normal[:-1] + normal[1:]
    mitre /= (mitre * normal[1:]).sum(axis=1)[:, None]
    across = width / 2 * np.vstack([normal[:1], mitre, normal[-1:]])
    outline = np.vstack([p - across, (p + across)[::-1]])
    return {"kind": "polygon", "points": outline.tolist(), "open_edges": [len(p) - 1, 2 * len(p) - 1]}


def changed(scene: Mapping[str, Any], **sections: Mapping[str, Any]) -> dict[str, Any]:
    """A copy of a scene with some values of its sections changed."""
    new = copy.deepcopy(dict(scene))
    for name, values in sections.items():
        new[name] = {**new.get(name, {}), **values}
    return new


def run(scene: Mapping[str, Any]) -> Result:
    """Simulate a scene to its end."""
    return simulate(scenario_from_dict(dict(scene)))


def tip(result: Result) -> Floats:
    """(t, 2), m: the path of the tip."""
    return np.column_stack([result.values("tip_x"), result.values("tip_y")])


def push_curve(label: str, result: Result, *, line: bool = False) -> Curve:
    """Push force, mN, over insertion depth, mm."""
    depth, push = result.values("insertion_depth") * 1e3, result.values("push_force") * 1e3
    return Curve(label, depth, push, "line" if line else "points")
