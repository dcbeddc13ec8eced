"""Statics of the wire without contact against closed forms: cantilever, column, elastica, three-point bending."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.result import Result
from gw_exudyn.simulation import simulate
from gw_exudyn.verification.closed_forms import (
    buckled_column,
    buckling_load,
    cantilever_under_dead_load,
    chain_buckling_load,
    chain_deflection,
    three_point_stiffness,
)
from gw_exudyn.verification.evidence import Case, Chart, Curve, Evidence, Finding
from gw_exudyn.verification.scenes import DIAMETER, alone, scene

Floats = NDArray[np.float64]

_GROUP = "statics"
_LENGTH, _STIFFNESS = 50e-3, 1e-6

_CANTILEVER = {
    0.25: (0.08275, 0.00412, 0.12429),
    0.5: (0.16214, 0.01592, 0.24453),
    1.0: (0.30172, 0.05643, 0.46135),
    2.0: (0.49346, 0.16064, 0.78175),
    3.0: (0.60325, 0.25442, 0.98602),
    5.0: (0.71379, 0.38763, 1.21537),
    10.0: (0.81061, 0.55500, 1.43029),
}
"""P L^2 / EI to w/L, u/L and tip slope, rad [Mattiasson 1981, Table 1]."""


def _settled(segments: int, tip: dict[str, Any], seconds: float = 3.0, **changes: Any) -> Result:
    """The cantilever at rest under loads at its tip, which rise over a second. Its damper ends what swings."""
    return simulate(alone(_LENGTH, _STIFFNESS, segments, seconds, tip={"ramp": 1.0, **tip}, **changes))


def _ends(result: Result) -> tuple[float, float, float]:
    """Tip of the cantilever: x and y over the length, slope, rad."""
    x, y, slope = (float(result.values(name)[-1]) for name in ("tip_x", "tip_y", "tip_angle"))
    return x / _LENGTH, y / _LENGTH, slope


def dead_tip_load() -> Finding:
    """Cantilever of 100 segments under a transverse dead load, up to slopes of 82 degrees."""
    rows: list[Evidence] = []
    found = []
    source = "elliptic integrals [Bisshopp and Drucker 1945]"
    for load, table in _CANTILEVER.items():
        exact = cantilever_under_dead_load(load)
        x, y, slope = _ends(_settled(100, {"force": [0.0, load * _STIFFNESS / _LENGTH**2]}))
        found.append((y, 1 - x, slope))
        for name, unit, measured, expected, tabled in zip(
            ("deflection w/L", "shortening u/L", "tip slope"), ("1", "1", "rad"), found[-1], exact, table, strict=True
        ):
            label = f"{name}, P L^2/EI = {load:g}"
            rows.append(
                Evidence(
                    f"{label}, closed form", "1" if unit == "1" else unit, expected, tabled, 6e-6, "table's last digit",
                    "Mattiasson 1981, Table 1",
                )
            )  # fmt: skip
            rows.append(Evidence(label, unit, measured, expected, 1e-3 * expected, _CHAIN_ERROR, source))
    loads = np.geomspace(0.2, 10.0, 60)
    theory = np.array([cantilever_under_dead_load(float(load)) for load in loads])
    points, at = np.array(found), np.array(list(_CANTILEVER))
    curves = []
    for column, name in enumerate(("w / L", "u / L", "slope / rad")):
        curves += [Curve(f"{name}, theory", loads, theory[:, column], "line"), Curve(name, at, points[:, column])]
    return Finding(
        tuple(rows),
        (Chart("cantilever", "Cantilever under a dead tip load, n = 100", "P L^2 / EI", "tip", tuple(curves)),),
    )


_CHAIN_ERROR = (
    "the chain's error is of order 1/(2 n^2), 0.005 % at n = 100; a tenth of a per cent leaves room for large bends"
)


def chain_formula() -> Finding:
    """Small deflections of chains of any number of segments, to the digits of the exact sum over their joints."""
    stiffness, rows = 1e-3, []
    force = 1e-3 * stiffness / _LENGTH**2  # w/L = 3e-4
    counts = (1, 2, 5, 10, 20, 50, 100)
    ratios = []
    for n in counts:
        result = simulate(
            alone(
                _LENGTH,
                stiffness,
                n,
                5.0,
                tip={"ramp": 1.0, "force": [0.0, force]},
                solver={"tolerance": 1e-10, "absolute_tolerance": 1e-13},
            )
        )
        measured, expected = float(result.values("tip_y")[-1]), chain_deflection(force, stiffness, _LENGTH, n)
        ratios.append(measured * 3 * stiffness / force / _LENGTH**3 - 1)
        rows.append(
            Evidence(
                f"tip deflection, n = {n}",
                "m",
                measured,
                expected,
                1e-6 * expected,
                "w/L = 3e-4: large deflection takes off (2/35) (P L^2/EI)^2 = 6e-8 of it",
                "F L^3/(3 EI) (1 + 1/(2 n^2))",
            )
        )
    curves = (
        Curve("1/(2 n^2)", np.array(counts, float), np.array([0.5 / n**2 for n in counts]), "line"),
        Curve("simulation", np.array(counts, float), np.array(ratios)),
    )
    chart = Chart("chain-formula", "Chain against beam", "segments", "deflection / F L^3/(3 EI) - 1", curves, "log")
    return Finding(tuple(rows), (chart,))


def buckling() -> Finding:
    """Critical load of the column clamped at one end: where the deflection of a nearly straight one has its pole.

    Of a wire with a small rest curvature c the deflection is c (sec kL - 1) / k^2, k^2 = P/EI: its inverse goes
    smoothly through zero at the critical load.
    """
    rows, curves = [], []
    source = "4 k/l sin^2(pi/4n), Hencky's chain; pi^2 EI/(4 L^2) for n to infinity"
    shares = np.array([0.92, 0.95, 0.98])
    for n in (5, 20, 100):
        exact = chain_buckling_load(_STIFFNESS, _LENGTH, n)
        deflections = np.array([_column(n, share * exact, imperfection=_SLIGHT)[1] for share in shares])
        inverse = 1 / deflections
        critical = exact * _root(shares, inverse)
        rows.append(
            Evidence(
                f"critical load, n = {n}",
                "N",
                critical,
                exact,
                1e-4 * exact,
                "parabola through three loads of an analytic function, and deflections under 1 % of the length",
                source,
            )
        )
        curves.append(Curve(f"n = {n}", shares * exact * 1e3, inverse * inverse[0] ** -1))
    euler = buckling_load(_STIFFNESS, _LENGTH)
    rows.append(
        Evidence(
            "critical load, n = 100, against Euler's column",
            "N",
            critical,
            euler,
            2e-4 * euler,
            "Hencky's chain of 100 segments is 0.002 % below, and the tolerance above",
            "pi^2 EI/(4 L^2)",
        )
    )
    line = np.array([0.9, 1.0]) * euler
    curves.append(Curve("1 - P/P_cr, Euler, scaled", line * 1e3, (1 - line / euler) / (1 - shares[0]), "line"))
    chart = Chart(
        "buckling", "Inverse deflection of a nearly straight column", "P / mN", "1/deflection, scaled", tuple(curves)
    )
    return Finding(tuple(rows), (chart,))


_SLIGHT = 2e-3
"""Rest curvature, 1/m, of a wire that needs a side to buckle to."""


def _column(n: int, load: float, imperfection: float) -> tuple[float, float, float]:
    # Near the critical load the wire creeps to its place with its damper's time over (1 - P/P_cr).
    wire = {"imperfection": imperfection, "damping_time": 2e-3}
    return _ends(_settled(n, {"force": [-load, 0.0]}, seconds=8.0, wire=wire))


def _root(x: Floats, y: Floats) -> float:
    """Where the parabola through three points is zero, just beyond the last."""
    roots = np.roots(np.polyfit(x, y, 2))
    real = roots[np.isreal(roots)].real
    return float(real[np.abs(real - 1).argmin()])


def post_buckling() -> Finding:
    """The column far beyond buckling: the load that belongs to the angle to which its tip has turned, and its place."""
    rows, found = [], []
    source = "elastica by elliptic integrals [Timoshenko and Gere 1961, Table 2-4]"
    for degrees, tabled in zip((20, 40, 60, 80, 100, 120, 140), _ELASTICA, strict=True):
        exact = buckled_column(math.radians(degrees))
        rows += [
            Evidence(f"{name} at {degrees} deg, closed form", "1", value, digits, 1.0e-3, "table's last digit", source)
            for name, value, digits in zip(("P/P_cr", "x/L", "y/L"), exact, tabled, strict=True)
        ]
        load = exact.load * buckling_load(_STIFFNESS, _LENGTH)
        x, y, angle = _column(100, load, imperfection=2e-4)
        there = buckled_column(angle)
        found.append((math.degrees(angle), exact.load, x, y))
        rows.append(
            Evidence(
                f"load that bends the tip to the angle measured, near {degrees} deg",
                "N",
                load,
                there.load * buckling_load(_STIFFNESS, _LENGTH),
                1e-3 * load,
                _CHAIN_ERROR,
                source,
            )
        )
        for name, measured, expected in (("x/L", x, there.along), ("y/L", y, there.across)):
            rows.append(Evidence(f"{name} near {degrees} deg", "1", measured, expected, 1e-3, _CHAIN_ERROR, source))
    angles = np.linspace(2.0, 145.0, 80)
    theory = np.array([buckled_column(math.radians(float(a))) for a in angles])
    points = np.array(found)
    curves = []
    for column, name in enumerate(("P/P_cr", "x/L", "y/L")):
        curves += [
            Curve(f"{name}, theory", angles, theory[:, column], "line"),
            Curve(name, points[:, 0], points[:, column + 1]),
        ]
    chart = Chart("post-buckling", "Column beyond buckling, n = 100", "tip angle / deg", "1", tuple(curves))
    return Finding(tuple(rows), (chart,))


_ELASTICA = (
    (1.015, 0.970, 0.219),
    (1.064, 0.881, 0.422),
    (1.152, 0.741, 0.593),
    (1.294, 0.559, 0.719),
    (1.518, 0.349, 0.792),
    (1.885, 0.123, 0.803),
    (2.542, -0.107, 0.750),
)
"""P/P_cr, x/L and y/L of the tip by its angle, 20 to 140 degrees [Timoshenko and Gere 1961, Table 2-4]."""


def three_point_bending() -> Finding:
    """The paper's test, F l^3/(48 d), along a wire of 400 segments whose stiffness has a step: 7 to 20 N mm2."""
    length, span, soft, hard, step = 150e-3, 30e-3, 7e-6, 20e-6, 75e-3
    rows, places, apparent = [], [], []
    pieces = [{"from": 0.0, "to": step, "value": soft}, {"from": step, "to": length, "value": hard}]
    for station in (30e-3, 50e-3, 65e-3, 72e-3, 75e-3, 80e-3, 90e-3, 110e-3):
        measured = _station(length, span, station, pieces)
        start = station - span / 2
        edge = min(max(step - start, 0.0), span)
        expected = three_point_stiffness(span, [(0.0, edge, soft), (edge, span, hard)])
        places.append(station)
        apparent.append(measured)
        rows.append(
            Evidence(
                f"F l^3/(48 d) {station * 1e3:g} mm from the tip, where EI is {7 if station < step else 20} N mm2",
                "N m^2",
                measured,
                expected,
                2e-3 * expected,
                "a nose between joints, segments of 1.25 % of the span, discs that roll by 0.002 mm",
                "beam theory: integral of M^2/EI",
            )
        )
    fine = np.linspace(25e-3, 115e-3, 181)
    theory = []
    for s in fine:
        edge = min(max(step - (float(s) - span / 2), 0.0), span)
        theory.append(three_point_stiffness(span, [(0.0, edge, soft), (edge, span, hard)]))
    curves = (
        Curve("beam theory of the test", fine * 1e3, np.array(theory) * 1e6, "line"),
        Curve("true EI", np.array([25.0, 75.0, 75.0, 115.0]), np.array([soft, soft, hard, hard]) * 1e6, "line"),
        Curve("simulated test", np.array(places) * 1e3, np.array(apparent) * 1e6),
    )
    chart = Chart(
        "three-point-bending", "Three-point bending over a step, span 30 mm", "station from the tip / mm",
        "F l^3/(48 d) / N mm2", curves,
    )  # fmt: skip
    return Finding(tuple(rows), (chart,))


def _station(length: float, span: float, station: float, pieces: list[dict[str, float]]) -> float:
    """N m^2, that the test gives at a station, m from the tip. The wire lies along x with its tip at the origin."""
    radius, way = 0.2e-3, 0.05e-3
    off = radius + DIAMETER / 2
    result = simulate(
        scene(
            {"length": length, "bending_stiffness": pieces, "segments": 400},
            {"kind": "speed", "speed": 0.0, "duration": 1.0, "hold": "axial"},
            vessel={"kind": "none"},
            catheter={},
            supports=[
                {"at": [-station - span / 2, -off], "radius": radius},
                {"at": [-station + span / 2, -off], "radius": radius},
            ],
            nose={"at": [-station, off], "radius": radius, "direction": -math.pi / 2, "speed": 1e-4, "travel": way},
            output={"interval": 1.0},
        )
    )
    return float(result.values("nose_force")[-1]) * span**3 / (48 * float(result.values("nose_travel")[-1]))


CASES = (
    Case(_GROUP, "cantilever under a dead tip load", dead_tip_load),
    Case(_GROUP, "exact formula of the chain", chain_formula),
    Case(_GROUP, "buckling load of a column", buckling),
    Case(_GROUP, "column beyond buckling", post_buckling),
    Case(_GROUP, "three-point bending", three_point_bending),
)
