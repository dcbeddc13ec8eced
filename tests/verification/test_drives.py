"""Drives by force and by the tip's speed against what is known of them, and the events that end a run.

Every drive: its results do not depend on how time is cut into calls, and a restored run goes on to the bit.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scenes import scenario

from gw_exudyn.errors import UsageError
from gw_exudyn.metrics import metrics
from gw_exudyn.result import Status
from gw_exudyn.scenario import load_scenario
from gw_exudyn.simulation import Simulation, simulate

FORCE = {"kind": "force", "force": 0.02, "hub_mass": 0.01, "hub_damping": 5.0, "duration": 40.0}
TIP = {"kind": "tip_speed", "speed": 2e-3, "max_speed": 10e-3, "force_limit": 1.0, "duration": 20.0}
ROUND_THE_CORNER = {**FORCE, "force": 0.3, "hub_damping": 50.0}
"""6 mm/s free; the wire snaps from the wall into the corner at about 3.7 s."""

WORK_DONE = {"solver_steps", "newton_iterations", "smallest_step"}


def same(a: Any, b: Any) -> bool:
    return all(np.array_equal(a[name], b[name]) for name in a if name not in WORK_DONE)


def test_a_free_wire_moves_with_force_over_damping() -> None:
    simulation = Simulation(scenario(drive=FORCE, contact={"friction_coefficient": 0.0}))
    simulation.advance(2.0)
    outputs = simulation.outputs
    assert outputs["drive_speed"] == pytest.approx(0.02 / 5.0, rel=1e-6)
    # The time constant mass / damping is 2 ms, which costs 8 um; the first steps' error is a part of the radius.
    assert outputs["insertion_depth"] == pytest.approx(8e-3, abs=0.2 * 0.36e-3)
    assert outputs["push_force"] == pytest.approx(0.0, abs=1e-6)


def test_at_rest_the_push_force_is_the_hubs_force() -> None:
    """The wall at the corner holds 20 mN: the wire stands, and all of the force goes through it."""
    simulation = Simulation(scenario(drive=FORCE))
    simulation.advance(10.0)
    outputs = simulation.outputs
    assert abs(outputs["drive_speed"]) < 1e-9
    assert outputs["push_force"] == pytest.approx(0.02, rel=1e-5)
    assert outputs["drive_force"] == 0.02
    # What the walls take along x, the vessel's and the catheter's, is what is pushed.
    assert outputs["wall_force_x"] + outputs["catheter_force_x"] == pytest.approx(0.02, rel=1e-4)


def test_a_force_that_suffices_takes_the_wire_round_the_corner_and_the_energy_closes() -> None:
    simulation = Simulation(scenario(drive=ROUND_THE_CORNER))
    assert simulation.advance(8.0), simulation.status.sentence()
    outputs = simulation.outputs
    assert outputs["tip_y"] > 20e-3
    assert abs(outputs["energy_error"]) < 1e-4 * outputs["insertion_work"]
    spent = outputs["insertion_work"] + outputs["hub_kinetic_energy"] + outputs["hub_damping_loss"]
    assert outputs["drive_work"] == pytest.approx(spent + outputs["hub_numerical_loss"], rel=1e-6)
    assert outputs["hub_kinetic_energy"] == pytest.approx(0.5 * 0.01 * outputs["drive_speed"] ** 2)
    # With the exact tangent a step takes 3.3 iterations on average, snap included.
    assert simulation.counters["newton_iterations"] < 5 * simulation.counters["solver_steps"]


def test_a_free_hub_never_outruns_the_reach_of_contact() -> None:
    """Steps of 1 s, in which the hub goes 6 mm and contact looks ahead 0.9 mm, are cut; the way is the same."""
    coarse = Simulation(scenario(drive=ROUND_THE_CORNER, solver={"step": 1.0}))
    travels = [0.0]
    noted = coarse._stepper._note_peaks
    coarse._stepper._note_peaks = lambda time: (travels.append(coarse._stepper.hub.travel), noted(time))
    assert coarse.advance(7.0), coarse.status.sentence()
    assert np.abs(np.diff(travels)).max() <= coarse._stepper.contact.reach / 3
    fine = Simulation(scenario(drive=ROUND_THE_CORNER))
    fine.advance(7.0)
    for name in ("insertion_depth", "tip_x", "tip_y"):
        assert coarse.outputs[name] == pytest.approx(fine.outputs[name], abs=0.2e-3), name


def test_the_hub_stops_at_the_end_of_its_travel() -> None:
    """The wire of 60 mm in a long channel."""
    channel = {"kind": "straight", "length": 100e-3, "diameter": 4e-3}
    simulation = Simulation(scenario(vessel=channel, drive={**FORCE, "force": 0.05}))
    assert simulation.advance(20.0) is False
    assert simulation.status.status is Status.END_OF_TRAVEL
    assert 58e-3 < simulation.outputs["insertion_depth"] < 60e-3
    assert simulation.ended
    assert not simulation.failed
    with pytest.raises(UsageError, match="the run has ended: The hub reached the end of its travel"):
        simulation.step(0.1)


@pytest.mark.parametrize("wire", ["universal", "amplatz"])
def test_the_tip_keeps_its_speed_round_the_corner(wire: str) -> None:
    """2 mm/s as the paper has it, within 15 % from 2 s after the tip has met the wall on; on the way there within
    1 %."""
    content = load_scenario(f"corner90-{wire}", {"wire.segments": 100}).to_dict()
    content["drive"] = {**TIP, "duration": 24.0}
    simulation = Simulation(scenario(**content))
    tips = [(0.0, 0.0)]
    while simulation.time < 24.0 - 1e-9:
        assert simulation.advance(simulation.time + 0.05), simulation.status.sentence()
        tips.append(simulation._stepper.tip())
    speed = np.hypot(*np.diff(tips, axis=0).T) / 0.05
    time = 0.05 * np.arange(1, len(tips))
    assert speed[(time > 2) & (time < 14.5)] == pytest.approx(2e-3, rel=0.01)
    assert speed[time > 18.5] == pytest.approx(2e-3, rel=0.15)
    # At a constant speed of the hub the tip is up to twice as fast there; on the whole it keeps to its pace.
    assert speed.sum() * 0.05 == pytest.approx(24.0 * 2e-3, rel=0.02)


@pytest.mark.parametrize("limit", [0.03, 0.06])
def test_the_hub_is_held_where_the_push_force_reaches_its_limit(limit: float) -> None:
    """The tip against the wall of the corner: a step that would pass the limit is taken again with a slower hub."""
    simulation = Simulation(scenario(drive={**TIP, "force_limit": limit}))
    push = []
    while simulation.time < 14.0 - 1e-9:
        assert simulation.advance(simulation.time + 0.1), simulation.status.sentence()
        push.append(simulation.outputs["push_force"])
    assert max(push) <= limit
    assert push[-1] > 0.5 * limit
    assert simulation.outputs["drive_speed"] < 1e-4


def test_a_tip_in_a_dead_end_ends_the_run() -> None:
    dead_end = {"kind": "straight", "length": 10e-3, "diameter": 4e-3, "end": "dead"}
    result = simulate(scenario(vessel=dead_end, stop={"tip_stall": "2 mm"}))
    assert result.status.status is Status.TIP_STALLED, result.status.sentence()
    # The tip meets the wall at 10 mm and slips a little before it stays.
    assert 12e-3 < result.values("insertion_depth")[-1] < 14e-3
    tip = np.column_stack([result.values("tip_x"), result.values("tip_y")])
    pushed = result.values("insertion_depth")
    meanwhile = pushed > pushed[-1] - 1.9e-3
    assert np.hypot(*(tip[meanwhile] - tip[-1]).T).max() < 2 * 0.1 * 2e-3
    assert "push force" in result.status.sentence()
    assert "buckles" in result.status.sentence()


def test_without_the_event_the_run_goes_on() -> None:
    dead_end = {"kind": "straight", "length": 10e-3, "diameter": 4e-3, "end": "dead"}
    drive = {"kind": "speed", "speed": 2e-3, "distance": 13e-3}
    result = simulate(scenario(vessel=dead_end, stop={"tip_stall": "off"}, drive=drive))
    assert result.status.status is Status.COMPLETED, result.status.sentence()


def test_the_push_force_may_end_the_run() -> None:
    result = simulate(scenario(stop={"push_force": 0.02}))
    assert result.status.status is Status.FORCE_LIMIT
    push = result.values("push_force")
    assert push[-1] > 0.02
    assert push[:-1].max() <= 0.02


def test_the_target_ends_the_run_only_if_it_is_to() -> None:
    target = {"at": [10e-3, 0.0], "within": 1e-3}
    drive = {"kind": "speed", "speed": 2e-3, "distance": 12e-3}
    ended = simulate(scenario(drive=drive, stop={"target": target, "at_target": True}))
    assert ended.status.status is Status.TARGET_REACHED
    assert np.hypot(ended.values("tip_x")[-1] - 10e-3, ended.values("tip_y")[-1]) <= 1e-3
    assert np.hypot(ended.values("tip_x")[-2] - 10e-3, ended.values("tip_y")[-2]) > 1e-3
    assert simulate(scenario(drive=drive, stop={"target": target})).status.status is Status.COMPLETED


def test_a_branch_as_the_target_ends_the_run_where_the_tip_enters_it() -> None:
    near = {"name": "near", "points": [[0.0, 0.0], [8e-3, 0.0]], "diameter": 4e-3}
    far = {"name": "far", "points": [[8e-3, 0.0], [20e-3, 0.0]], "diameter": 4e-3}
    drive = {"kind": "speed", "speed": 2e-3, "distance": 12e-3}
    stop = {"target": {"branch": "far"}, "at_target": True}
    ended = simulate(scenario(vessel={"kind": "branches", "branches": [near, far]}, drive=drive, stop=stop))
    assert ended.status.status is Status.TARGET_REACHED
    assert "branch far" in ended.status.sentence()
    # One step of 0.2 mm at most beyond the end of the first branch.
    assert 8e-3 < ended.values("tip_x")[-1] <= 8.21e-3
    assert metrics(ended)["target_insertion_depth"].value == ended.values("insertion_depth")[-1]


@pytest.fixture(scope="module", params=["force", "tip_speed"])
def driven(request: pytest.FixtureRequest) -> Simulation:
    """In contact in the corner: in the snap at 4 s (force), against the force limit at 12 s (tip speed)."""
    return Simulation(scenario(drive=ROUND_THE_CORNER if request.param == "force" else {**TIP, "force_limit": 0.04}))


def _end(simulation: Simulation) -> float:
    return 4.2 if simulation.scenario.drive.kind == "force" else 12.0


@pytest.mark.parametrize("cut", [0.1, 0.03, 0.37])
def test_results_do_not_depend_on_how_time_is_cut(driven: Simulation, cut: float) -> None:
    end = _end(driven)
    driven.reset()
    driven.advance(end)
    whole = dict(driven.outputs)
    assert whole["wall_force_normal"] > 0
    driven.reset()
    while driven.time < end - 1e-9:
        driven.step(min(cut, end - driven.time))
    assert same(whole, driven.outputs)


@pytest.mark.parametrize("back", [0.5, 0.27])
def test_a_restored_run_goes_on_bit_for_bit(driven: Simulation, back: float) -> None:
    """From a time on the grid, and from one between two of its steps."""
    end = _end(driven)
    driven.reset()
    driven.advance(end - back)
    state = driven.get_state()
    driven.advance(end)
    expected = dict(driven.outputs)
    other = Simulation(driven.scenario)
    other.set_state(state)
    other.advance(end)
    assert same(expected, other.outputs)


def test_an_event_comes_at_the_same_time_however_time_is_cut_and_survives_a_restore() -> None:
    dead_end = {"kind": "straight", "length": 10e-3, "diameter": 4e-3, "end": "dead"}
    simulation = Simulation(scenario(vessel=dead_end, stop={"tip_stall": "2 mm"}))
    simulation.advance(15.0)
    once = simulation.status
    simulation.reset()
    simulation.advance(5.77)
    state = simulation.get_state()
    simulation.reset()
    simulation.set_state(state)
    while not simulation.ended:
        simulation.step(0.03)
    assert simulation.status == once
    state = simulation.get_state()
    simulation.reset()
    assert not simulation.ended
    simulation.set_state(state)
    assert simulation.status == once


def test_a_force_from_outside_takes_over() -> None:
    simulation = Simulation(scenario(drive=FORCE))
    simulation.step(1.0)
    depth = simulation.outputs["insertion_depth"]
    outputs = simulation.step(1.03, force=-0.01)
    assert outputs["drive_force"] == -0.01
    assert outputs["drive_speed"] == pytest.approx(-0.01 / 5.0, rel=1e-4)
    assert outputs["insertion_depth"] < depth
    assert simulation.step(0.1)["drive_force"] == -0.01


def test_a_tip_speed_from_outside_takes_over() -> None:
    simulation = Simulation(scenario(drive=TIP))
    simulation.step(2.0)
    assert simulation.step(1.0, speed=5e-3)["drive_speed"] == pytest.approx(5e-3, rel=1e-3)


@pytest.mark.parametrize(
    ("drive", "given", "says"),
    [
        (FORCE, {"speed": 1e-3}, "a drive of kind force takes a force from outside, no speed; give force="),
        (TIP, {"force": 0.1}, "a drive of kind tip_speed takes a speed from outside, no force; give speed="),
        (FORCE, {"force": float("nan")}, "a force of nan N cannot be driven"),
        (TIP, {"speed": -1e-3}, "the hub never moves back"),
    ],
)
def test_what_a_drive_does_not_take_is_refused(drive: dict[str, Any], given: dict[str, float], says: str) -> None:
    simulation = Simulation(scenario(drive=drive))
    with pytest.raises(UsageError, match=says):
        simulation.step(0.1, **given)
    assert simulation.time == 0.0
