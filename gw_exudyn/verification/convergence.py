"""Orders of convergence: in segments without and with contact, and in time. The slopes are asserted, not only shown."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.simulation import Simulation, simulate
from gw_exudyn.verification.closed_forms import cantilever_under_dead_load, vibration_frequency
from gw_exudyn.verification.evidence import Case, Chart, Curve, Evidence, Finding
from gw_exudyn.verification.scenes import DIAMETER, SPEED, alone, corner_vessel, scene, soft_tip

Floats = NDArray[np.float64]

_GROUP = "convergence"


def order(sizes: Floats, errors: Floats) -> float:
    """Slope of a straight line through the logarithms, by least squares."""
    return float(np.polyfit(np.log(sizes), np.log(np.abs(errors)), 1)[0])


def _lines(label: str, sizes: Floats, errors: Floats, power: int) -> tuple[Curve, Curve]:
    """Errors, and a line of the order that they should have."""
    line = np.abs(errors[-1]) * (sizes / sizes[-1]) ** power
    return Curve(label, sizes, np.abs(errors)), Curve(f"order {power}", sizes, line, "line")


def segments_in_statics() -> Finding:
    """Tip of a strongly bent cantilever against elliptic integrals: second order, as the midpoint rule has."""
    length, stiffness, load = 50e-3, 1e-6, 3.0
    exact = cantilever_under_dead_load(load)
    counts = np.array([5, 10, 20, 40, 80])
    errors = []
    for n in counts:
        tip = {"ramp": 1.0, "force": [0.0, load * stiffness / length**2]}
        result = simulate(
            alone(length, stiffness, int(n), 4.0, tip=tip, solver={"tolerance": 1e-9, "absolute_tolerance": 1e-12})
        )
        x, y = float(result.values("tip_x")[-1]) / length, float(result.values("tip_y")[-1]) / length
        errors.append(math.hypot(x - (1 - exact.shortening), y - exact.across))
    sizes, found = 1.0 / counts, np.array(errors)
    row = Evidence(
        "order in segments, tip of a cantilever at P L^2/EI = 3",
        "1",
        order(sizes, found),
        2.0,
        0.05,
        "least squares over n = 5 to 80, of which the coarsest is not yet in the limit",
        "midpoint rule; the clamp has half a segment",
    )
    chart = Chart(
        "order-statics", "Cantilever, dead tip load", "segment / length", "error of the tip / length",
        _lines("simulation", sizes, found, 2), "log",
    )  # fmt: skip
    return Finding((row,), (chart,))


def steps_in_vibration() -> Finding:
    """Free vibration of a chain of four segments, against the exact motion of the linear chain.

    A tip load rises over 1.5 periods, which leaves the chain swinging about its bent place. Small bends, no dampers.
    The integrator is generalised alpha with a spectral radius of zero: second order, with damping of its own.
    """
    length, stiffness, segments, load = 50e-3, 1e-6, 4, 1e-3
    probe = Simulation(_swinging(length, stiffness, segments, load, 1.0, 1.0, 0.01))
    wire = probe.model.wire
    chain = _LinearChain(wire.lengths, wire.mass, wire.inertia, wire.joint_stiffness)
    period = 2 * math.pi / float(chain.frequencies[0])
    rise, end = 1.5 * period, 4.0 * period
    force = load * stiffness / length**2
    times = np.linspace(rise, end, 21)
    exact = chain.tip(times, force, rise)
    divisions, errors = np.array([40, 80, 160, 320]), []
    for count in divisions:
        simulation = Simulation(_swinging(length, stiffness, segments, load, rise, end, period / count))
        tip = []
        for time in times:
            simulation.advance(float(time))
            tip.append(float(simulation.outputs["tip_y"]))
        errors.append(float(np.sqrt(np.mean((np.array(tip) - exact) ** 2))))
    sizes, found = 1.0 / divisions, np.array(errors) / float(np.ptp(exact))
    row = Evidence(
        "order in steps, free vibration, the two finest pairs",
        "1",
        order(sizes[1:], found[1:]),
        2.0,
        0.15,
        "steps of a 40th of a period are not yet in the limit; higher modes swing faster",
        "generalised alpha [Chung and Hulbert 1993]",
    )
    shape = (
        Curve("exact motion of the linear chain", times / period, exact / length * 1e6, "line"),
        Curve("simulation, 320 steps a period", times / period, np.array(tip) / length * 1e6),
    )
    charts = (
        Chart(
            "order-time", "Free vibration of a chain", "step / period", "error / swing, root mean square",
            _lines("simulation", sizes, found, 2), "log",
        ),
        Chart("vibration", "Free vibration of a chain", "time / periods", "tip y / 1e-6 lengths", shape),
    )  # fmt: skip
    return Finding((row, _beam_frequency()), charts)


def _swinging(length: float, stiffness: float, segments: int, load: float, rise: float, end: float, step: float) -> Any:
    return alone(
        length,
        stiffness,
        segments,
        end,
        wire={"damping_time": 0.0},
        tip={"ramp": rise, "force": [0.0, load * stiffness / length**2]},
        solver={"step": step, "minimum_step": step / 1000, "tolerance": 1e-10, "absolute_tolerance": 1e-14},
    )


class _LinearChain:
    """Small motions of a clamped chain: masses and springs in the angles of its segments, solved by modes.

    lengths, mass, inertia : (n,). joint_stiffness : (n,), N m/rad.
    """

    def __init__(self, lengths: Floats, mass: Floats, inertia: Floats, joint_stiffness: Floats) -> None:
        from scipy.linalg import eigh

        count = len(lengths)
        centre = np.tril(np.tile(lengths, (count, 1)), -1) + np.diag(lengths / 2)
        difference = np.eye(count) - np.eye(count, k=-1)
        squares, self._modes = eigh(
            difference.T @ np.diag(joint_stiffness) @ difference, centre.T @ np.diag(mass) @ centre + np.diag(inertia)
        )
        self.frequencies: Floats = np.sqrt(squares)
        self._tip = lengths @ self._modes

    def tip(self, times: Floats, force: float, rise: float) -> Floats:
        """(k,), m, across, under a tip load that rises from rest over `rise` (s) and stays."""
        place = np.zeros_like(times)
        for frequency, lever in zip(self.frequencies, self._tip, strict=True):
            ramp = times - np.sin(frequency * times) / frequency
            since = np.maximum(times - rise, 0.0)
            ramp = ramp - (since - np.sin(frequency * since) / frequency)
            place = place + lever**2 * force / rise / frequency**2 * ramp
        return place


def _beam_frequency() -> Evidence:
    """Lowest frequency of a chain of 40 segments, from its swings past the middle."""
    length, stiffness, segments = 50e-3, 1e-6, 40
    mass = 6450.0 * math.pi * (DIAMETER / 2) ** 2 * length
    exact = vibration_frequency(stiffness, length, mass)
    period = 1 / exact
    rise, end, step = 1.5 * period, 6.5 * period, period / 200
    simulation = Simulation(_swinging(length, stiffness, segments, 1e-3, rise, end, step))
    times = np.arange(math.ceil(rise / step) + 1, math.floor(end / step)) * step
    tip = []
    for time in times:
        simulation.advance(float(time))
        tip.append(float(simulation.outputs["tip_y"]))
    swing = np.array(tip) - 1e-3 * length / 3
    rising = np.flatnonzero((swing[:-1] < 0) & (swing[1:] >= 0))
    crossings = times[rising] - swing[rising] / (swing[rising + 1] - swing[rising]) * step
    measured = (len(crossings) - 1) / float(crossings[-1] - crossings[0])
    return Evidence(
        "lowest frequency of a cantilever of 40 segments",
        "Hz",
        measured,
        exact,
        2e-3 * exact,
        "200 steps a period lengthen it by 0.05 %, 40 segments change it by 0.03 %",
        "Euler-Bernoulli beam, 1.8751^2 sqrt(EI/(m L^3))/(2 pi)",
    )


def segments_in_insertion() -> Finding:
    """Benchmark bend60, with friction: tip and push force at 20 mm by segments, against 800 of them."""
    counts = np.array([25, 50, 100, 200])
    reference = _bend60(800)
    ends = [_bend60(int(n)) for n in counts]
    sizes = 1.0 / counts
    tip = np.array([math.hypot(end[0] - reference[0], end[1] - reference[1]) for end in ends])
    rows = (
        Evidence(
            "order in segments, tip of an insertion with friction",
            "1",
            order(sizes, tip),
            1.0,
            0.0,
            "contact begins at nodes and passes corners between them: first order is what can be asked for",
            "self-convergence against n = 800",
            "at_least",
        ),
        Evidence(
            "distance of the tip at n = 100 from that at n = 800",
            "m",
            float(tip[2]),
            20e-6,
            0.0,
            "a tenth of the wire's radius",
            "self-convergence",
            "at_most",
        ),
    )
    chart = Chart(
        "order-insertion", "Sharp bend of 60 deg, friction 0.4", "1 / segments", "distance of the tip / m",
        _lines("simulation", sizes, tip, 1), "log",
    )  # fmt: skip
    return Finding(rows, (chart,))


def _bend60(segments: int) -> tuple[float, float, float]:
    """Tip, m, and push force, N, of the benchmark after 20 mm."""
    length, near, far, stretch, width = 0.150, 1e-6, 1e-4, 45e-3, 4e-3
    result = simulate(
        scene(
            {"length": length, "bending_stiffness": soft_tip(near, far, stretch, length), "segments": segments},
            {"kind": "speed", "speed": SPEED, "duration": 10.0},
            vessel=corner_vessel(width),
            catheter={"exit": [-5e-3, 0.0], "bore": width},
            contact={"friction_coefficient": 0.4, "wall_stiffness": 2000.0},
            solver={"step": 0.1},
            output={"interval": 10.0},
        )
    )
    x, y, force = (float(result.values(name)[-1]) for name in ("tip_x", "tip_y", "push_force"))
    return x, y, force


CASES = (
    Case(_GROUP, "segments, without contact", segments_in_statics),
    Case(_GROUP, "steps, free vibration", steps_in_vibration),
    Case(_GROUP, "segments, insertion with friction", segments_in_insertion),
)
