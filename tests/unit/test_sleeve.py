"""The sleeve's potential: forces and tangent against differences, what is out of it, and what a scenario may say."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from model_cases import plain_wire
from numpy.typing import NDArray
from test_loads import beam
from test_start_and_hold import DRIVES

from gw_exudyn.cli.check import summary_rows
from gw_exudyn.cli.resolved import resolved_rows
from gw_exudyn.errors import ScenarioError
from gw_exudyn.model import build
from gw_exudyn.model.kernel import Motion
from gw_exudyn.model.sleeve import LEAST, Sleeve
from gw_exudyn.scenario import json_schema, scenario_from_dict
from gw_exudyn.simulation import Simulation

Floats = NDArray[np.float64]
WIRE = plain_wire([2e-3, 2e-3, 1.5e-3, 1e-3, 2e-3])
MIDDLE, FLANK = 0.3e-3, -0.45e-3


def placed(proximal: float, angle: float = 0.3) -> Floats:
    """(5, 3): all straight up to joint 3, which is at `proximal`, m; from there on bent."""
    q, x, y = np.zeros((5, 3)), proximal - float(WIRE.lengths[:3].sum()), 0.0
    for i, turn in enumerate((1e-4, -2e-4, 3e-4, angle, 2 * angle)):
        dx, dy = WIRE.lengths[i] * math.cos(turn), WIRE.lengths[i] * math.sin(turn)
        q[i] = x + dx / 2, y + dy / 2, turn
        x, y = x + dx, y + dy
    return q


def evaluated(q: Floats) -> tuple[Floats, Floats, Sleeve]:
    motion, sleeve = Motion(5), Sleeve(WIRE)
    motion.set(q, np.zeros((5, 3)))
    force, tangent = np.zeros((5, 3)), np.zeros((5, 3, 3))
    sleeve.add(motion, force, tangent)
    return force, tangent, sleeve


@pytest.mark.parametrize("proximal", [FLANK, -0.2e-3, MIDDLE, 0.69e-3])
def test_force_and_tangent_are_the_derivatives_of_the_energy(proximal: float) -> None:
    q = placed(proximal)
    force, tangent, _ = evaluated(q)
    assert force[3, 0] > 0
    for body in range(5):
        for coordinate, h in ((0, 1e-10), (1, 1e-10), (2, 1e-7)):
            ahead, behind = q.copy(), q.copy()
            ahead[body, coordinate] += h
            behind[body, coordinate] -= h
            (above, _, high), (below, _, low) = evaluated(ahead), evaluated(behind)
            scale = np.abs(force).max()
            assert -(high.energy - low.energy) / (2 * h) == pytest.approx(force[body, coordinate], abs=1e-4 * scale)
            column = (above - below) / (2 * h)
            assert np.delete(column, body, axis=0) == pytest.approx(0.0, abs=0.0)
            assert column[body] == pytest.approx(tangent[body, :, coordinate], abs=1e-5 * np.abs(tangent[body]).max())


def test_the_force_along_the_axis_is_the_bending_energy_per_length_at_the_exit() -> None:
    """M^2 / (2 EI), whatever share is outside: M of the joint, EI = k times its stretch."""
    force, _, sleeve = evaluated(placed(MIDDLE, angle=0.02))
    stretch = float(WIRE.lengths[2] + WIRE.lengths[3]) / 2
    moment = WIRE.joint_stiffness[3] * 0.02 / sleeve.shares[3]
    assert sleeve.shares[3] == pytest.approx((MIDDLE + 0.5e-3) / stretch, abs=2 * LEAST)
    assert force[3, 0] == pytest.approx(moment**2 / (2 * WIRE.joint_stiffness[3] * stretch), rel=3 * LEAST)


def test_joints_take_turns_at_the_exit_without_a_gap() -> None:
    """Over one segment's passage the shares outside grow by the length that goes out, at every place."""
    places = np.linspace(-0.5e-3, 1.5e-3, 401)
    stretches = np.convolve(np.concatenate([[0.0], WIRE.lengths]), [0.5, 0.5], mode="valid")
    out = np.array([float(evaluated(placed(x, angle=0.0))[2].shares @ stretches) for x in places])
    assert np.diff(out) == pytest.approx(np.diff(places), rel=2 * LEAST)


def test_what_has_come_out_is_free_even_where_it_turns_back_beside_the_sleeve() -> None:
    q = placed(2e-3)
    q[4] = -5e-3, 3e-3, math.pi
    force, tangent, sleeve = evaluated(q)
    assert sleeve.shares[3:] == pytest.approx(1.0, abs=0.0)
    assert not force[3:].any()
    assert not tangent[3:].any()


def in_sleeve(**changes: Any) -> dict[str, Any]:
    return beam(**({"catheter": {"bore": "sleeve"}} | changes))


def test_it_is_a_word_beside_a_length() -> None:
    made = scenario_from_dict(in_sleeve())
    assert made.catheter.is_sleeve
    assert made.to_dict()["catheter"]["bore"] == "sleeve"
    assert scenario_from_dict(made.to_dict()) == made
    assert ("catheter.bore", "sleeve") in resolved_rows(made)
    model = build(made)
    assert not len(model.walls.length)
    assert dict(summary_rows(made, model.describe()))["catheter"].endswith("a sleeve without play or friction")
    options = json_schema()["$defs"]["CatheterSpec"]["properties"]["bore"]
    assert {"const": "sleeve"} in options["anyOf"]
    assert "sleeve" in options["description"]


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"catheter": {"bore": "sleve"}},
         "catheter.bore: 'sleve' does not begin with a number; write it as '2.5 m'; or write sleeve"),
        ({"catheter": {"bore": 0}}, "catheter.bore: 0 m is outside the plausible 0.05 mm to 50 mm"),
        ({"catheter": {"bore": "sleeve", "friction_coefficient": 0.1}},
         "catheter.friction_coefficient: a sleeve has no friction; leave it out, or give a bore in which the wire has "
         "some play"),
        ({"drive": {"kind": "speed", "speed": 0.0, "duration": 1.0, "hold": "pinned"}},
         "drive.hold: an end that is pinned cannot be in a sleeve, which holds its direction; leave it out, or give "
         "catheter.bore as a length"),
    ],
)  # fmt: skip
def test_what_is_wrong_has_its_sentence(changes: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        scenario_from_dict(in_sleeve(**changes))
    assert str(caught.value) == sentence


@pytest.mark.parametrize("kind", DRIVES)
def test_every_drive_pushes_through_it_and_goes_on_from_a_saved_state(kind: str) -> None:
    """A load bends what is outside while the drive lets it out; the books close, and a restored run is the same."""
    drive = {"kind": kind, "duration": 1.0, "start": 0.0295, **DRIVES[kind]}
    content = in_sleeve(tip={"force": [0.0, 5e-3], "ramp": 0.2}) | {"drive": drive}
    scenario = scenario_from_dict(content)
    run, again = Simulation(scenario), Simulation(scenario)
    run.advance(0.403)
    again.set_state(run.get_state())
    out = run.outputs
    assert abs(out["energy_error"]) < 1e-4 * (abs(out["load_work"]) + abs(out["drive_work"]))
    for one in (run, again):
        one.advance(0.7)
    assert again.get_state() == run.get_state()
    assert np.abs(run.outputs["node_y"][:10]).max() < 5e-6


def test_it_takes_the_wire_back() -> None:
    """Let out by four segments and more under a load and pulled back, the wire has the bend and push force it had."""
    steps = [[0.0, 0.0], [1.0, 0.0], [1.0, 8e-3], [2.6, 8e-3], [2.6, -8e-3], [4.2, -8e-3], [4.2, 0.0], [5.0, 0.0]]
    drive = {"kind": "speed", "start": 0.0313, "hold": "clamped", "table": steps}
    run = Simulation(scenario_from_dict(in_sleeve(tip={"force": [0.0, 2e-3], "ramp": 0.3}) | {"drive": drive}))
    run.advance(1.0)
    before = run.outputs
    run.advance(2.6)
    assert run.outputs["elastic_energy"] > 2 * before["elastic_energy"]
    run.advance(5.0)
    for name in ("elastic_energy", "push_force", "tip_y"):
        assert run.outputs[name] == pytest.approx(before[name], rel=1e-3)


def test_hub_tip_and_sleeve_are_in_balance_in_any_direction_of_the_catheter() -> None:
    """What is put on the tip and by the hub, the sleeve takes; along its axis that is -M^2 / (2 EI)."""
    direction, load = 0.5, np.array([1e-3, 2e-3])
    scenario = {
        "wire": {"diameter": 0.36e-3, "density": 6450.0, "length": 0.08, "segments": 80, "bending_stiffness": 1e-6},
        "drive": {"kind": "speed", "speed": 0.0, "duration": 2.0, "start": 0.0305},
        "vessel": {"kind": "none"},
        "catheter": {"exit": [0, 0], "direction": direction, "bore": "sleeve"},
        "tip": {"force": load.tolist(), "ramp": 1.0},
    }
    simulation = Simulation(scenario_from_dict(scenario))
    simulation.advance(2.0)
    outputs = simulation.outputs
    axis = np.array([math.cos(direction), math.sin(direction)])
    taken = np.array([outputs["catheter_force_x"], outputs["catheter_force_y"]])
    assert taken == pytest.approx(load + outputs["push_force"] * axis, abs=1e-6 * np.hypot(*load))
    tip = np.array([outputs["tip_x"], outputs["tip_y"]])
    moment = tip[0] * load[1] - tip[1] * load[0]
    assert taken @ axis == pytest.approx(-(moment**2) / 2e-6, rel=0.02)
