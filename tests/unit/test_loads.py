"""Loads on the wire: forces against their potential, tangents against differences, stability, what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from model_cases import chain, plain_wire

from gw_exudyn.errors import ScenarioError
from gw_exudyn.model import build
from gw_exudyn.model.discs import Disc
from gw_exudyn.model.kernel import Motion
from gw_exudyn.model.loads import Loads, LoadSet, TipLoad
from gw_exudyn.model.stability import negative_pivots
from gw_exudyn.scenario import json_schema, scenario_from_dict
from gw_exudyn.simulation import Simulation

FREE = TipLoad(np.zeros(2), np.zeros(2), 0.0, 0.0, np.zeros(2), np.zeros(2), 0.0, 0.0)
WIRE = plain_wire(np.full(5, 2e-3))


def beam(**changes):
    """A wire without a vessel that the drive holds."""
    content = {
        "wire": {
            "diameter": 0.36e-3,
            "length": 0.06,
            "bending_stiffness": 7e-6,
            "density": 6000.0,
            "segments": 20,
            "imperfection": 0.0,
        },
        "vessel": {"kind": "none"},
        "catheter": {},
        "drive": {"kind": "speed", "speed": 0.0, "duration": 1.0, "start": 0.06},
    }
    for section, change in changes.items():
        keeps = isinstance(change, dict) and section in content
        content[section] = content[section] | change if keeps else change
    return content


BENDING = {
    "drive": {"hold": "axial"},
    "supports": [{"at": [x, -1.18e-3], "radius": 1e-3} for x in (0.015, 0.045)],
    "nose": {"at": [0.03, 1.18e-3], "radius": 1e-3, "direction": -np.pi / 2, "speed": 1e-4, "travel": 5e-5},
}


def loads_with(tip=FREE, discs=()):
    return Loads(WIRE, LoadSet(tip, tuple(discs)))


def placed(q):
    motion = Motion(len(q))
    motion.set(q, np.zeros_like(q))
    return motion


def disc(x, y, side, radius=1e-3):
    return Disc(np.array([x, y]), radius, side, 5e3, np.zeros(2))


CASES = {
    "dead": (replace(FREE, dead=np.array([0.3, -0.2])), ()),
    "follower": (replace(FREE, follower=np.array([-0.3, 0.2]), moment=1e-3), ()),
    "held": (replace(FREE, held=np.array([4e3, 5e3]), at=np.array([9.9e-3, 1e-5]), clamp=2e-3, rest=0.01), ()),
    "disc beside a segment": (FREE, [disc(3.2e-3, -1.17e-3, -1.0)]),
    "disc over a joint": (FREE, [disc(4.005e-3, -1.15e-3, -1.0), disc(5.99e-3, 1.15e-3, 1.0)]),
    "disc before the tip": (FREE, [disc(11.1e-3, 0.2e-3, 1.0)]),
}


@pytest.mark.parametrize("name", CASES)
def test_the_tangent_is_the_derivative_of_the_force(name):
    """Central differences over 1e-9 m and 1e-7 rad; the kinks of the contact's onset are further away."""
    tip, discs = CASES[name]
    loads = loads_with(tip, discs)
    q = chain(WIRE, (0, 0), [0.01, -0.01, 0.02, 0.0, 0.03])
    loads.evaluate(placed(q))
    tangent = loads.tangent.copy()
    assert np.abs(tangent).max() > 0
    for coordinate, size in enumerate((1e-9, 1e-9, 1e-7)):
        for body in range(5):
            either = []
            for sign in (1, -1):
                moved = q.copy()
                moved[body, coordinate] += sign * size
                loads.evaluate(placed(moved))
                either.append(loads.force[body].copy())
            numeric = (either[0] - either[1]) / (2 * size)
            # The hand-over at a joint turns with the neighbour too, and its own part is all that a block holds.
            assert numeric == pytest.approx(tangent[body, :, coordinate], rel=2e-4, abs=2e-4 * np.abs(tangent).max())


def test_a_disc_that_just_touches_carries_nothing_and_one_pressed_in_its_spring():
    loads = loads_with(discs=[disc(3e-3, -(1e-3 + WIRE.radius), -1.0)])
    loads.evaluate(placed(chain(WIRE, (0, 0), 0.0)))
    assert not loads.force.any()
    loads.evaluate(placed(chain(WIRE, (0, -1e-6), 0.0)))
    assert loads.force[1] == pytest.approx([0, 5e3 * (1e-6 - WIRE.radius * 1e-5), 0])
    assert loads.discs.force_on(0) == pytest.approx([0, -loads.force[1, 1]])
    # Pressed through to beyond the wire's axis it still pushes back to its own side.
    loads.evaluate(placed(chain(WIRE, (0, -1.1e-3), 0.0)))
    assert loads.force[1, 1] > 0


def test_a_disc_is_shared_by_neighbours_without_a_jump():
    forces = []
    for x in np.linspace(3.9e-3, 4.1e-3, 41):
        loads = loads_with(discs=[disc(x, -1.17e-3, -1.0)])
        loads.evaluate(placed(chain(WIRE, (0, 0), 0.0)))
        forces.append(loads.force[:, 1].sum())
    # In the hand-over, 18 um to each side, one of the two sees its round end, further off by up to 0.14 um of 10.
    assert forces == pytest.approx(np.full(41, forces[0]), rel=5e-3)


def test_loads_rise_over_their_ramp_and_a_nose_stops():
    loads = loads_with(replace(FREE, dead=np.array([0.0, 2.0]), ramp=4.0))
    loads.time = 1.0
    loads.evaluate(placed(chain(WIRE, (0, 0), 0.0)))
    assert loads.force[-1] == pytest.approx([0, 0.5, 0.5 * 1e-3])
    nose = replace(disc(0, 5e-3, 1.0), way=np.array([0.0, -2e-3]), time=2.0)
    assert nose.centre(1.0) == pytest.approx([0, 4e-3])
    assert nose.centre(9.0) == pytest.approx([0, 3e-3])


def dense_stiffness(wire, q, blocks, springs):
    """Of the chain in its angles, by the chain rule with full matrices."""
    count = wire.segments
    normal = np.column_stack([-np.sin(q[:, 2]), np.cos(q[:, 2])])
    moves = np.zeros((count, 3, count))
    moves[:, :2] = (np.tril(np.ones((count, count)), -1) + 0.5 * np.eye(count))[:, None] * (
        wire.lengths[:, None] * normal
    ).T
    moves[:, 2] = np.eye(count)
    bend = np.eye(count) - np.eye(count, k=-1)
    return np.einsum("bim,bij,bjn->mn", moves, blocks, moves) + bend.T @ np.diag(springs) @ bend


@pytest.mark.parametrize("seed", range(20))
def test_pivots_tell_inertia_and_the_sign_of_the_determinant(seed):
    rng = np.random.default_rng(seed)
    q = chain(WIRE, (0, 0), rng.normal(0, 0.5, 5))
    springs = rng.uniform(0.5, 2.0, 5)
    blocks = rng.normal(0, 1.0, (5, 3, 3)) * np.array([[1e6, 1e6, 1e3], [1e6, 1e6, 1e3], [1e3, 1e3, 1.0]])
    unsymmetric = negative_pivots(WIRE, placed(q), blocks, springs, base_moves=False)
    assert (-1) ** unsymmetric == np.sign(np.linalg.det(dense_stiffness(WIRE, q, blocks, springs)))
    even = (blocks + blocks.transpose(0, 2, 1)) / 2
    values = np.linalg.eigvalsh(dense_stiffness(WIRE, q, even, springs))
    assert negative_pivots(WIRE, placed(q), even, springs, base_moves=False) == np.count_nonzero(values < 0)


def test_a_state_with_loads_goes_on_bit_for_bit():
    scenario = scenario_from_dict(beam(**BENDING, tip={"force": [0, 1e-4], "ramp": 0.5}))
    first, second = Simulation(scenario), Simulation(scenario)
    first.step(0.33)
    second.set_state(first.get_state())
    assert dict(first.step(0.4))["nose_force"] > 0
    second.step(0.4)
    for name, value in first.outputs.items():
        assert np.array_equal(value, second.outputs[name], equal_nan=True), name


def problems(**changes):
    with pytest.raises(ScenarioError) as caught:
        build(scenario_from_dict(beam(**changes)))
    return [(problem.path, problem.message) for problem in caught.value.problems]


def channel(**changes):
    return {"vessel": {"kind": "straight", "length": 0.1, "diameter": 4e-3}, "catheter": {"bore": 1e-3}} | changes


CORNER = [(0.0, -2e-3), (22e-3, -2e-3), (22e-3, 40e-3), (18e-3, 40e-3), (18e-3, 2e-3), (0.0, 2e-3)]


@pytest.mark.parametrize(
    ("changes", "path", "words"),
    [
        ({"vessel": {"kind": "straight", "length": 0.1, "diameter": 4e-3}}, "catheter.bore", "is missing"),
        ({"tip": {"hold": "glued"}}, "tip.hold", "allowed: free, pinned, clamped"),
        ({"tip": {"slides": "along"}}, "tip.slides", "take hold: pinned or clamped"),
        ({"tip": {"force": [1]}}, "tip.force", "[x, y] is needed"),
        ({"tip": {"forse": [1, 0]}}, "tip.forse", "did you mean 'force'"),
        ({"supports": [{"at": [0.01, 1e-3]}]}, "supports.0.radius", "is missing"),
        ({"supports": [{"at": [0.01, 1e-3], "radius": 1e-3}]}, "supports.0.at", "stands in the wire"),
        ({"supports": [{"at": [0.01, 2e-3], "radius": 1e-3, "side": "right"}]}, "supports.0.at", "other side"),
        ({"nose": {"at": [0, 1], "radius": 1e-3, "direction": 0.0, "speed": 1e-3}}, "nose.travel", "is missing"),
        ({"drive": {"hold": "loose"}}, "drive.hold", "allowed: clamped, pinned, axial"),
        (channel(drive={"start": 0.07}), "drive.start", "70 mm of a wire of 60 mm"),
        (
            channel(vessel={"kind": "polygon", "points": CORNER, "open_edges": [2, 5]}, drive={"start": 0.03}),
            "drive.start",
            "22 mm from the catheter's exit",
        ),
    ],
)
def test_what_cannot_start_is_refused(changes, path, words):
    found = dict(problems(**changes))
    assert words in found[path]


def test_a_wire_may_stand_out_to_its_end_in_a_vessel_and_without_a_tube():
    build(scenario_from_dict(beam(**channel())))
    build(scenario_from_dict(beam(drive={"start": 0.5})))


def test_the_scenario_keeps_its_loads_and_the_schema_knows_them():
    scenario = scenario_from_dict(beam(**BENDING, tip={"hold": "pinned", "slides": "across", "moment": 1e-6}))
    assert scenario_from_dict(scenario.to_dict()) == scenario
    assert {"tip", "supports", "nose"} <= set(json_schema()["properties"])
