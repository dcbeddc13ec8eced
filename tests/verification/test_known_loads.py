"""A wire under known loads against closed forms: cantilever, columns, three-point bending.

The chain is a discrete one: where its own closed form is known the tolerance is that of the solver; else it is the
chain's distance from the continuous beam, which goes with the square of the segment's length.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from gw_exudyn.result import Result, Status
from gw_exudyn.scenario import scenario_from_dict
from gw_exudyn.simulation import simulate

LENGTH, EI = 0.1, 1e-5
SHARP = {"tolerance": 1e-10, "absolute_tolerance": 1e-14}
EULER = math.pi**2 * EI / LENGTH**2


def beam(segments=40, duration=2.0, **changes):
    content = {
        "wire": {
            "diameter": 0.36e-3,
            "length": LENGTH,
            "bending_stiffness": EI,
            "density": 6000.0,
            "segments": segments,
            "imperfection": 0.0,
        },
        "vessel": {"kind": "none"},
        "catheter": {},
        "drive": {"kind": "speed", "speed": 0.0, "duration": duration},
    }
    for section, change in changes.items():
        content[section] = content[section] | change if section in content else change
    return content


def run(*args, **changes) -> Result:
    result = simulate(scenario_from_dict(beam(*args, **changes)))
    assert result.status.status is Status.COMPLETED, result.status.sentence()
    return result


def at_end(result, name):
    return float(result.values(name)[-1])


def books_close(result):
    largest = max(np.abs(result.values(name)).max() for name in ("load_work", "insertion_work"))
    return np.abs(result.values("energy_error")).max() < 1e-3 * largest


@pytest.mark.parametrize("segments", [10, 40])
def test_a_cantilever_under_a_small_tip_load(segments):
    """delta = F L^3 / (3 EI) (1 + 1/(2 n^2)): the chain's own, its clamp twice as stiff as its joints."""
    force = 1e-4 * 3 * EI / LENGTH**2
    result = run(segments, tip={"force": [0.0, force], "ramp": 0.5}, solver=SHARP)
    expected = force * LENGTH**3 / (3 * EI) * (1 + 1 / (2 * segments**2))
    # Large turns shorten the lever by (w/L)^2, 1e-8.
    assert at_end(result, "tip_y") == pytest.approx(expected, rel=1e-6, abs=0)
    assert at_end(result, "load_work") == pytest.approx(force * expected / 2, rel=0.1)
    assert at_end(result, "elastic_energy") == pytest.approx(force * expected / 2, rel=1e-6)


def test_the_cantilever_is_where_the_catheter_ends_and_turns_with_it():
    """Inserted to its whole length, the wire stands outside of a catheter that points up."""
    force = 1e-4 * 3 * EI / LENGTH**2
    outside = {"exit": [0.02, 0.01], "direction": math.pi / 2, "bore": 1e-3}
    result = run(tip={"force": [-force, 0.0], "ramp": 0.5}, catheter=outside, drive={"start": LENGTH}, solver=SHARP)
    assert at_end(result, "insertion_depth") == LENGTH
    assert at_end(result, "tip_x") == pytest.approx(0.02 - force * LENGTH**3 / (3 * EI) * (1 + 1 / 3200), abs=1e-10)
    assert at_end(result, "tip_y") == pytest.approx(0.01 + LENGTH, abs=1e-8)


def test_the_elastica_under_a_dead_tip_load():
    """P L^2 / EI = 1: w/L = 0.30172, u/L = 0.05643 [Bisshopp and Drucker 1945; Mattiasson 1981]."""
    result = run(100, tip={"force": [0.0, EI / LENGTH**2], "ramp": 1.0})
    assert at_end(result, "tip_y") / LENGTH == pytest.approx(0.30172, abs=0.0001)
    assert 1 + at_end(result, "tip_x") / LENGTH == pytest.approx(1 - 0.05643, abs=0.0001)
    assert books_close(result)
    assert result.counters["newton_iterations"] <= 2 * result.counters["solver_steps"]


def elastica_under_a_follower(load):
    """Tip (x, y)/L and angle of a clamped elastica, EI = L = 1, under a transverse follower.

    From the tip back, in the tip's frame, where the load is fixed: the moment at a place is the load times its
    distance along the tip's direction, and no shooting is needed.
    """
    from scipy.integrate import solve_ivp

    def rates(_, state):
        angle, x, _ = state
        return [load * x, -math.cos(angle), -math.sin(angle)]

    angle, x, y = solve_ivp(rates, (0, 1), [0.0, 0.0, 0.0], rtol=1e-10, atol=1e-12).y[:, -1]
    c, s = math.cos(angle), math.sin(angle)
    return -np.array([c * x + s * y, c * y - s * x]), -angle


def test_the_elastica_under_a_transverse_follower():
    load = 2.0
    tip, angle = elastica_under_a_follower(load)
    result = run(100, tip={"follower_force": [0.0, load * EI / LENGTH**2], "ramp": 1.0})
    measured = np.array([1 + at_end(result, "tip_x") / LENGTH, at_end(result, "tip_y") / LENGTH])
    # The moment is zero at the tip, so the distal half segment that has no joint bends by 1e-5 only.
    assert at_end(result, "tip_angle") == pytest.approx(angle, abs=1e-3)
    assert measured == pytest.approx(tip, abs=1e-3)
    assert books_close(result)


def test_a_moment_rolls_a_wire_up():
    """M = 2 pi EI / L bends it to a full circle, but for the distal half segment that has no joint."""
    result = run(tip={"moment": 2 * math.pi * EI / LENGTH, "ramp": 1.0}, duration=3.0)
    assert at_end(result, "tip_angle") == pytest.approx(2 * math.pi * (1 - 1 / 80), rel=1e-4)
    assert abs(at_end(result, "tip_y")) < 1e-6
    assert books_close(result)


def test_a_perfect_column_under_a_dead_load_is_refused_from_its_buckling_load_on():
    """P_cr = pi^2 EI / (4 L^2): the straight balance is no minimum beyond it. Without dampers, whose share of a step
    would hold it up. The chain's own load is that of the beam to (pi/n)^2/48, 1e-4."""
    rises = beam(tip={"force": [-1.05 * EULER / 4, 0.0], "ramp": 1.0}, wire={"damping_time": 0.0})
    result = simulate(scenario_from_dict(rises))
    assert result.status.status is Status.NOT_CONVERGED
    assert result.status.time * 1.05 == pytest.approx(1.0, abs=5e-4)


@pytest.mark.parametrize(("load", "expected"), [(0.9, 0.0), (1.152, 0.593), (1.884, 0.803)])
def test_a_column_takes_the_bent_branch_beyond_its_buckling_load(load, expected):
    """Largest deflection over length of the post-buckled cantilever, at tip angles of 60 and 120 degrees [Timoshenko
    and Gere 1961, table 2-4]; the imperfection adds some thousandths."""
    result = run(tip={"force": [-load * EULER / 4, 0.0], "ramp": 2.0}, duration=5.0, wire={"imperfection": 1e-3})
    assert at_end(result, "tip_y") / LENGTH == pytest.approx(expected, abs=3e-3)
    assert books_close(result)


def test_a_compressive_follower_never_makes_a_cantilever_buckle_at_rest():
    """No other balance exists at any load [Beck 1952]; a dead load of twice the buckling load would not be carried."""
    result = run(tip={"follower_force": [-EULER / 2, 0.01 * EULER / 4], "ramp": 1.0})
    assert 0 < at_end(result, "tip_y") / LENGTH < 0.02


@pytest.mark.parametrize(("hold", "factor"), [("pinned", 2.0457), ("clamped", 4.0)])
def test_a_column_pushed_against_its_held_tip_buckles_at_eulers_load(hold, factor):
    """P_cr = factor pi^2 EI / L^2; the imperfection, and the rise at a shortening of 0.2 %, make up to 0.002."""
    content = beam(60, tip={"hold": hold}, wire={"imperfection": 0.01})
    phases = [{"speed": 0.2e-3, "duration": 1.0}, {"speed": 0.0, "duration": 1.0}]
    result = simulate(scenario_from_dict(content | {"drive": {"kind": "speed", "phases": phases}}))
    assert result.status.status is Status.COMPLETED
    assert at_end(result, "push_force") / (factor * EULER) == pytest.approx(1.0, abs=0.003)
    assert at_end(result, "tip_hold_force_x") == pytest.approx(at_end(result, "push_force"), rel=1e-4)
    assert books_close(result)


def test_a_pinned_tip_that_slides_carries_the_same_load():
    below = run(60, tip={"hold": "pinned", "slides": "along", "force": [-0.9 * 2.0457 * EULER, 0.0], "ramp": 1.0},
                wire={"imperfection": 0.04})  # fmt: skip
    beyond = run(60, tip={"hold": "pinned", "slides": "along", "force": [-1.1 * 2.0457 * EULER, 0.0], "ramp": 1.0},
                 wire={"imperfection": 0.04}, duration=3.0)  # fmt: skip
    assert np.abs(below.values("node_y")).max() < 0.003 * LENGTH
    assert np.abs(beyond.values("node_y")).max() > 0.2 * LENGTH


@pytest.mark.parametrize(("at", "radius"), [(0.075, 0.1e-3), (0.0752, 0.1e-3), (0.06, 1e-3)])
def test_three_point_bending_gives_back_the_bending_stiffness(at, radius):
    """EI = F L^3 / (48 d) [Sharei et al. 2019, Eq. 1], the wire lying freely on two supports wherever its joints are.

    0.2 %: segments of L/80 and, for large discs, a span that shortens as the wire turns on them.
    """
    stiffness, span, deflection = 7e-6, 0.03, 0.05e-3
    y = radius + 0.18e-3
    result = run(
        400,
        wire={"length": 0.15, "bending_stiffness": stiffness},
        drive={"start": 0.15, "hold": "axial"},
        supports=[{"at": [x, -y], "radius": radius} for x in (at - span / 2, at + span / 2)],
        nose={"at": [at, y], "radius": radius, "direction": -math.pi / 2, "speed": deflection, "travel": deflection},
    )
    force = at_end(result, "nose_force")
    assert force * span**3 / (48 * deflection) == pytest.approx(stiffness, rel=2e-3)
    assert at_end(result, "nose_travel") == pytest.approx(deflection)
    assert at_end(result, "support_force_y") == pytest.approx(-force, rel=1e-3)
    assert abs(at_end(result, "push_force")) < 0.01 * force
    work = force * deflection / 2
    assert at_end(result, "elastic_energy") == pytest.approx(work, rel=5e-3)
    assert books_close(result)
