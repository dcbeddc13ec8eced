"""Insertions once more by models that share no code with the simulation: a cable of ANCF elements, and an elastica.

Both are idealised in their own way (a smooth arc for facets, statics for steps in time, a smooth curve for a chain), so
the tolerances are what those differences make, which refining either side shows.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.engine.cable import Cable, Inserted, SmoothBend, insert
from gw_exudyn.result import Result
from gw_exudyn.simulation import simulate
from gw_exudyn.verification.elastica import Corner, Elastica, Law, Pushed, Rod
from gw_exudyn.verification.evidence import Case, Chart, Curve, Evidence, Finding
from gw_exudyn.verification.scenes import DIAMETER, SPEED, corner_vessel, scene, soft_tip

Floats = NDArray[np.float64]

_GROUP = "second-opinion"
_RADIUS, _WALL_STIFFNESS = DIAMETER / 2, 2000.0


def smooth_bend(distal: float, proximal: float) -> Finding:
    """A wire of 100 segments pushed without friction round an arc, against a cable of 100 ANCF elements.

    distal, proximal : N m^2; the bending stiffness rises linearly between them over the distal 45 mm.
    """
    length, tip_stretch = 60e-3, 45e-3
    travels: Floats = np.linspace(0.0, 36e-3, 145)[1:]
    bend = SmoothBend(lead_in=10e-3, radius=15e-3, angle=math.pi / 2, width=4e-3)
    from_tip = length * (1 - (np.arange(100) + 0.5) / 100)
    stiffness = np.interp(from_tip, [0.0, tip_stretch], [distal, proximal])
    cable = insert(Cable(length, _RADIUS, stiffness), bend, travels, _WALL_STIFFNESS, start=0.0)
    vessel = {"kind": "arc", "radius": bend.radius, "angle": bend.angle, "diameter": bend.width, "facets": 180}
    result = _simulated(
        wire={
            "length": length,
            "bending_stiffness": {"table": [[0.0, distal], [tip_stretch, proximal], [length, proximal]]},
        },
        vessel={**vessel, "lead_in": bend.lead_in, "lead_out": 30e-3},
        catheter={"exit": [0.0, 0.0], "bore": bend.width},
        friction=0.0,
        travels=travels,
    )
    label = f"{distal * 1e6:g} to {proximal * 1e6:g} N mm2"
    rows = _compared(result, cable, 20e-6, 0.005, "ANCF cable elements, static, smooth arc", _ANCF_TOLERANCE)
    return Finding(rows, _drawn(result, cable, f"ancf-{proximal * 1e6:g}", f"Smooth bend, {label}", "ANCF cable"))


_ANCF_TOLERANCE = (
    "facets of 0.5 deg against a true arc, and contact at nodes 0.6 mm apart, whose sagitta is 3 um; along the path "
    "the two are up to 8 um and 0.9 % apart"
)


def sharp_bend() -> Finding:
    """Benchmark bend60, 60 degrees with friction 0.4, against an elastica that minimises a potential.

    The wire's dampers are off: the elastica has none.
    """
    length, near, far, stretch, width = 0.150, 1e-6, 1e-4, 45e-3, 4e-3
    travels: Floats = np.linspace(0.0, 20e-3, 101)[1:]
    lengths = np.geomspace(4.0, 1.0, 60)
    lengths *= length / lengths.sum()
    nodes = length - np.append(0.0, np.cumsum(lengths))
    flexibility = _exponential_flexibility(nodes, near, far, stretch)
    rod = Rod(_RADIUS, lengths, lengths / -np.diff(flexibility))
    elastica = Elastica(rod, Corner(math.radians(60), width), Law(_WALL_STIFFNESS, friction=0.4), tip=-5e-3)
    pushed = elastica.push(float(travels[-1]), step=float(travels[0]))
    result = _simulated(
        wire={"length": length, "bending_stiffness": soft_tip(near, far, stretch, length), "grading": 4.0},
        vessel=corner_vessel(width),
        catheter={"exit": [-5e-3, 0.0], "bore": width},
        friction=0.4,
        travels=travels,
    )
    rows = _compared(result, pushed, 10e-6, 0.015, "elastica by lagged-friction energy minimisation", _BEND_TOLERANCE)
    return Finding(rows, _drawn(result, pushed, "elastica-bend60", "Sharp bend of 60 deg, friction 0.4", "elastica"))


_BEND_TOLERANCE = (
    "refining the elastica (60 to 120 elements, steps of 0.2 to 0.1 mm) and the wire (100 to 400 segments) moves each "
    "by 4 um and 1 %"
)


def _exponential_flexibility(s: Floats, near: float, far: float, stretch: float) -> Floats:
    """(n,), rad/(N m): integral of ds/EI from the tip to s where ln EI rises linearly over a stretch."""
    rate = math.log(far / near) / stretch
    inside = (1 - np.exp(-rate * np.minimum(s, stretch))) / (near * rate)
    total: Floats = inside + np.maximum(s - stretch, 0.0) / far
    return total


def _simulated(
    wire: dict[str, Any], vessel: dict[str, Any], catheter: dict[str, Any], friction: float, travels: Floats
) -> Result:
    """The insertion by the simulation, with an output at each of the travels (equally spaced, m)."""
    return simulate(
        scene(
            {"segments": 100, "damping_time": 0.0, **wire},
            {"kind": "speed", "speed": SPEED, "distance": float(travels[-1])},
            vessel=vessel,
            catheter=catheter,
            contact={"friction_coefficient": friction, "wall_stiffness": _WALL_STIFFNESS},
            output={"interval": float(travels[0]) / SPEED},
        )
    )


def _compared(
    result: Result,
    other: list[Inserted] | list[Pushed],
    distance: float,
    share: float,
    source: str,
    tolerance_source: str,
) -> tuple[Evidence, ...]:
    tip = np.array([(at.x[-1], at.y[-1]) for at in other])
    apart = np.hypot(result.values("tip_x")[1:] - tip[:, 0], result.values("tip_y")[1:] - tip[:, 1])
    ours, theirs = result.values("push_force")[1:], np.array([at.push_force for at in other])
    end, mean = float(theirs[-1]), float(theirs.mean())
    return (
        Evidence("distance of the two tips at the end", "m", float(apart[-1]), 0.0, distance, tolerance_source, source),
        Evidence(
            "distance of the two tips, root mean square over the path",
            "m",
            math.sqrt(float((apart**2).mean())),
            0.0,
            distance,
            tolerance_source,
            source,
        ),
        Evidence("push force at the end", "N", float(ours[-1]), end, share * abs(end), tolerance_source, source),
        Evidence(
            "push force, mean over the path",
            "N",
            float(ours.mean()),
            mean,
            0.005 * abs(mean),
            tolerance_source,
            source,
        ),
    )


def _drawn(
    result: Result, other: list[Inserted] | list[Pushed], name: str, title: str, label: str
) -> tuple[Chart, ...]:
    travel = result.values("insertion_depth") * 1e3
    shape = (
        Curve(label, other[-1].x * 1e3, other[-1].y * 1e3, "line"),
        Curve("simulation", result.values("node_x")[-1] * 1e3, result.values("node_y")[-1] * 1e3),
    )
    force = (
        Curve(label, travel[1:], np.array([at.push_force for at in other]) * 1e3, "line"),
        Curve("simulation", travel, result.values("push_force") * 1e3),
    )
    return (
        Chart(f"{name}-shape", f"{title}: the wire at the end", "x / mm", "y / mm", shape),
        Chart(f"{name}-force", f"{title}: push force", "travel of the drive / mm", "push force / mN", force),
    )


CASES = (
    Case(_GROUP, "smooth bend, uniform wire, ANCF cable", partial(smooth_bend, 1e-6, 1e-6)),
    Case(_GROUP, "smooth bend, wire with a soft tip, ANCF cable", partial(smooth_bend, 1e-6, 5e-6)),
    Case(_GROUP, "sharp bend with friction, elastica", sharp_bend),
)
