"""The cases that the benchmarks run, as scenarios. Lengths in metres, all SI."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from gw_exudyn.verification.insertions import channel

Point = tuple[float, float]

WIRES: dict[str, dict[str, Any]] = {"universal": {"model": "universal-ii"}, "amplatz": {"model": "amplatz-super-stiff"}}


def bend60(segments: int, grading: float = 1.0, step: float = 0.1, **wire: Any) -> dict[str, Any]:
    """A 150 mm wire of 0.36 mm in a channel 4 mm wide with one sharp corner of 60 degrees; 20 mm at 2 mm/s.

    EI rises from 1e-6 to 1e-4 N m^2 over the distal 45 mm, its logarithm linearly. The wall stiffness is given, so that
    solvers of other kinds can be compared.
    """
    places = np.linspace(0.0, 0.045, 181)
    table = [[float(s), float(1e-6 * 100 ** (s / 0.045))] for s in places] + [[0.150, 1e-4]]
    path = [(-0.2, 0.0), (0.0, 0.0), turned(0.06, 60)]
    return {
        "name": f"bend60-{segments}",
        "wire": {
            "diameter": 0.36e-3,
            "length": 0.150,
            "density": 6450.0,
            "bending_stiffness": {"table": table},
            "segments": segments,
            "grading": grading,
            **wire,
        },
        "vessel": channel(path, 4e-3),
        "catheter": {"exit": [-5e-3, 0.0], "bore": 4e-3},
        "contact": {"friction_coefficient": 0.4, "wall_stiffness": 2000.0},
        "drive": {"kind": "speed", "speed": 2e-3, "duration": 10.0},
        "solver": {"step": step},
        "output": {"interval": 10.0},
    }


def insertion(vessel: dict[str, Any], wire: str, segments: int, friction: float, **changes: Any) -> dict[str, Any]:
    """One of the paper's wires pushed 50 mm into a vessel that begins at the origin, from a catheter of 1.2 mm.

    Steps and wall stiffness are the program's defaults, as a user would run it.
    """
    return {
        "name": "hard-scene",
        "wire": {**WIRES[wire], "segments": segments, **changes.pop("wire_changes", {})},
        "vessel": vessel,
        "catheter": {"exit": [0.0, 0.0], "bore": 1.2e-3},
        "contact": {"friction_coefficient": friction},
        "drive": {"kind": "speed", "speed": 2e-3, "duration": 25.0},
        "output": {"interval": 1.0},
        **changes,
    }


PUSH_HOLD_PULL = {
    "kind": "speed",
    "phases": [
        {"speed": 2e-3, "distance": 0.030},
        {"speed": 0.0, "duration": 2.0},
        {"speed": -2e-3, "distance": 0.028},
    ],
}


def vessels() -> dict[str, dict[str, Any]]:
    """The hard scenes by name."""
    long = 0.08
    return {
        "corner 90": channel(path_of((20e-3, 90), (long, 0)), 4e-3),
        "corner 120": channel(path_of((20e-3, 120), (long, 0)), 4e-3),
        "U-turn": channel(path_of((20e-3, 90), (6e-3, 90), (long, 0)), 4e-3),
        "three bends": channel(path_of((15e-3, 60), (12e-3, -60), (12e-3, 60), (long, 0)), 4e-3),
        "carina": carina(),
        "T": tee(),
        "arc, 8 facets": arc(8),
        "arc, 96 facets": arc(96),
    }


def arc(facets: int) -> dict[str, Any]:
    """A quarter circle of 15 mm in a 4 mm lumen."""
    return {
        "kind": "arc",
        "radius": 15e-3,
        "angle": math.pi / 2,
        "diameter": 4e-3,
        "facets": facets,
        "lead_in": 10e-3,
        "lead_out": 60e-3,
    }


def carina() -> dict[str, Any]:
    """A trunk of 6 mm that splits into two branches at 35 degrees either way; the wedge's apex is on the axis."""
    wide, run, half = 3e-3, 15e-3, math.radians(35)
    d = np.array([math.cos(half), math.sin(half)]) * 0.06
    mirrored = d * [1, -1]
    start, apex = np.array([run, wide]), np.array([21e-3, 0.0])
    points = [
        (0.0, -wide),
        (run, -wide),
        tuple(start * [1, -1] + mirrored),
        tuple(apex + mirrored),
        tuple(apex),
        tuple(apex + d),
        tuple(start + d),
        (run, wide),
        (0.0, wide),
    ]
    return polygon(points, open_edges=(2, 5, 8))


def tee() -> dict[str, Any]:
    """A channel of 4 mm that ends square on the middle of another."""
    w, x, y = 2e-3, 15e-3, 0.06
    points = [(0.0, -w), (x, -w), (x, -y), (x + 2 * w, -y), (x + 2 * w, y), (x, y), (x, w), (0.0, w)]
    return polygon(points, open_edges=(2, 4, 7))


def path_of(*stretches: tuple[float, float]) -> list[Point]:
    """Corners of a path from the origin along +x: (length, turn in degrees after it)."""
    points, x, y, heading = [(0.0, 0.0)], 0.0, 0.0, 0.0
    for length, turn in stretches:
        x, y = x + length * math.cos(heading), y + length * math.sin(heading)
        points.append((x, y))
        heading += math.radians(turn)
    return points


def turned(length: float, degrees: float) -> Point:
    """A point at a distance and a direction from the origin."""
    return length * math.cos(math.radians(degrees)), length * math.sin(math.radians(degrees))


def polygon(points: Sequence[Any], open_edges: Sequence[int]) -> dict[str, Any]:
    """A polygon vessel in a scenario's form."""
    return {"kind": "polygon", "points": [[float(x), float(y)] for x, y in points], "open_edges": list(open_edges)}
