"""`Simulation`: results do not depend on how time is cut, restored runs go on bit for bit, instances do not mix."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from scenes import scenario

from gw_exudyn.errors import ScenarioError, UsageError
from gw_exudyn.quantities import CONTACT_FIELDS, JOINT_FIELDS, NODE_FIELDS, SCALARS
from gw_exudyn.result import Status
from gw_exudyn.scenario import load_scenario
from gw_exudyn.simulation import Simulation, output_times, simulate

IN_CONTACT = 11.0
"""Time, s, at which the wire of the scene has met the corner."""


@pytest.fixture(scope="module")
def cornered() -> Simulation:
    """A simulation that tests reset; building one costs more than a step."""
    return Simulation(scenario())


def same(a: Mapping[str, Any], b: Mapping[str, Any]) -> bool:
    """Equal to the last bit (solver counts apart, which tell of the work done)."""
    work = {"solver_steps", "newton_iterations", "smallest_step"}
    return all(np.array_equal(a[name], b[name]) for name in a if name not in work)


def test_outputs_hold_every_quantity_of_the_table(cornered: Simulation) -> None:
    cornered.reset()
    outputs = cornered.step(0.1)
    assert set(outputs) == {"time", *SCALARS, *NODE_FIELDS, *JOINT_FIELDS, *CONTACT_FIELDS}
    assert outputs["node_x"].shape == (41,)
    assert outputs["joint_torque"].shape == (40,)


def test_outputs_without_the_shape_are_the_others(cornered: Simulation) -> None:
    lean = Simulation(scenario(), shape=False)
    cornered.reset()
    for time in (0.0, IN_CONTACT):
        for simulation in (cornered, lean):
            simulation.advance(time)
        few, all_of_them = lean.outputs, cornered.outputs
        assert set(all_of_them) - set(few) == {*NODE_FIELDS, *JOINT_FIELDS}
        for name in few:
            assert few[name] == pytest.approx(all_of_them[name], rel=1e-14), name
        assert (all_of_them["node_x"][-1], all_of_them["node_y"][-1]) == (all_of_them["tip_x"], all_of_them["tip_y"])


def test_the_tip_starts_at_the_exit_and_follows_the_drive(cornered: Simulation) -> None:
    cornered.reset()
    assert cornered.time == 0.0
    assert cornered.outputs["tip_x"] == pytest.approx(0.0, abs=1e-15)
    outputs = cornered.step(2.0)
    # A straight channel so far: the tip is where the drive has moved it, less what the rest curvature shortens.
    assert outputs["tip_x"] == pytest.approx(4e-3, abs=2e-6)
    assert outputs["insertion_depth"] == pytest.approx(4e-3, abs=1e-15)


@pytest.mark.parametrize("cut", [0.1, 0.5, 0.25, 0.03, 0.0137])
def test_results_do_not_depend_on_how_time_is_cut(cornered: Simulation, cut: float) -> None:
    cornered.reset()
    cornered.advance(IN_CONTACT)
    whole = dict(cornered.outputs)
    assert whole["wall_force_normal"] > 0
    cornered.reset()
    while cornered.time < IN_CONTACT - 1e-9:
        cornered.step(min(cut, IN_CONTACT - cornered.time))
    assert same(whole, cornered.outputs)


def test_an_instant_between_steps_does_not_depend_on_the_calls_before_it(cornered: Simulation) -> None:
    cornered.reset()
    cornered.advance(IN_CONTACT + 0.07)
    once = dict(cornered.outputs)
    cornered.reset()
    cornered.advance(IN_CONTACT)
    for part in (0.01, 0.02, 0.04):
        cornered.step(part)
    assert same(once, cornered.outputs)


def test_a_step_that_was_cut_back_ends_at_the_next_nominal_step() -> None:
    """A coarse step round a corner has to be cut; the times of the outputs stay on the grid all the same."""
    simulation = Simulation(scenario(solver={"step": 1.0}))
    for i in range(1, 15):
        simulation.advance(float(i))
        assert simulation.time == pytest.approx(i, abs=1e-9)
    assert simulation.counters["solver_steps"] > 14


@pytest.mark.parametrize("when", [IN_CONTACT, IN_CONTACT + 0.03])
def test_a_restored_run_goes_on_bit_for_bit(cornered: Simulation, when: float) -> None:
    cornered.reset()
    cornered.advance(when)
    state = cornered.get_state()
    cornered.advance(13.0)
    direct = dict(cornered.outputs)
    other = Simulation(scenario())
    other.set_state(state)
    assert other.time == pytest.approx(when, abs=1e-9)
    other.advance(13.0)
    assert same(direct, other.outputs)
    cornered.set_state(state)
    cornered.advance(13.0)
    assert same(direct, cornered.outputs)


def test_a_state_taken_twice_is_the_same_bytes(cornered: Simulation) -> None:
    cornered.reset()
    cornered.advance(IN_CONTACT)
    state = cornered.get_state()
    cornered.set_state(state)
    assert cornered.get_state() == state


def test_a_state_keeps_an_outside_drive(cornered: Simulation) -> None:
    cornered.reset()
    cornered.step(1.0, speed=5e-3)
    state = cornered.get_state()
    expected = dict(cornered.step(0.5))
    cornered.reset()
    cornered.set_state(state)
    assert same(expected, cornered.step(0.5))


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (lambda data: b"", "no saved state"),
        (lambda data: b"PK" + data[2:], "no saved state"),
        (lambda data: data[:-1], "damaged or cut short"),
        (lambda data: data[:-8] + bytes([data[-8] ^ 1]) + data[-7:], "damaged or cut short"),
        (lambda data: data[:4] + b"\x63\x00" + data[6:], "version 99"),
    ],
)
def test_a_damaged_state_is_refused_and_changes_nothing(cornered: Simulation, spoil: Any, says: str) -> None:
    cornered.reset()
    cornered.advance(1.0)
    before = dict(cornered.outputs)
    with pytest.raises(UsageError, match=says):
        cornered.set_state(spoil(cornered.get_state()))
    assert same(before, cornered.outputs)


def test_the_state_of_another_scenario_is_refused(cornered: Simulation) -> None:
    with pytest.raises(UsageError, match="another scenario"):
        cornered.set_state(Simulation(scenario(contact={"friction_coefficient": 0.3})).get_state())


def test_reset_gives_the_run_of_a_fresh_simulation(cornered: Simulation) -> None:
    cornered.step(1.0, speed=-1e-3)
    cornered.reset()
    cornered.advance(IN_CONTACT)
    fresh = Simulation(scenario())
    fresh.advance(IN_CONTACT)
    assert same(fresh.outputs, cornered.outputs)
    assert fresh.counters == cornered.counters


def test_instances_in_one_process_do_not_know_of_each_other() -> None:
    first, second = Simulation(scenario()), Simulation(scenario(contact={"friction_coefficient": 0.1}))
    alone = Simulation(scenario())
    alone.advance(IN_CONTACT)
    while first.time < IN_CONTACT - 1e-9:
        first.step(0.5)
        second.step(0.7)
    assert same(alone.outputs, first.outputs)
    assert not same(first.outputs, second.outputs)


def test_a_speed_from_outside_takes_over_without_a_jump(cornered: Simulation) -> None:
    cornered.reset()
    cornered.advance(1.03)
    before = cornered.outputs["insertion_depth"]
    outputs = cornered.step(0.5, speed=-1e-3)
    assert outputs["insertion_depth"] == pytest.approx(before - 0.5e-3, abs=1e-12)
    assert outputs["drive_speed"] == -1e-3
    assert cornered.step(0.5)["insertion_depth"] == pytest.approx(before - 1e-3, abs=1e-12)


@pytest.mark.parametrize("dt", [0.0, -1.0, float("nan"), float("inf")])
def test_a_step_must_be_positive(cornered: Simulation, dt: float) -> None:
    with pytest.raises(UsageError, match="must be positive"):
        cornered.step(dt)


def test_a_speed_must_be_finite(cornered: Simulation) -> None:
    with pytest.raises(UsageError, match="finite number"):
        cornered.step(0.1, speed=float("nan"))


@pytest.mark.parametrize("speed", [0.1, -0.1])
def test_the_end_of_the_wire_stays_in_the_catheter(cornered: Simulation, speed: float) -> None:
    """60 mm of wire: a second at 100 mm/s either way would take its end out of where it is guided."""
    cornered.reset()
    with pytest.raises(UsageError, match="guided from"):
        cornered.step(1.0, speed=speed)
    assert cornered.time == 0.0
    assert cornered.step(1.0)["insertion_depth"] == pytest.approx(2e-3)


def test_what_cannot_start_is_a_bad_scenario() -> None:
    with pytest.raises(ScenarioError, match=r"catheter\.bore"):
        Simulation(scenario(catheter={"bore": 0.3e-3}))


def test_a_wire_pressed_too_deep_stops_with_the_reason() -> None:
    """A dead end: the wire is pushed on against a wall that is far too soft."""
    dead_end = {"kind": "straight", "length": 5e-3, "diameter": 0.5e-3, "end": "dead"}
    soft = {"wall_stiffness": 5.0, "friction_coefficient": 0.0}
    simulation = Simulation(scenario(vessel=dead_end, contact=soft, catheter={"bore": 0.4e-3}))
    assert simulation.advance(20.0) is False
    assert simulation.failed
    assert simulation.status.status is Status.TOO_DEEP
    assert simulation.time < 20.0
    with pytest.raises(UsageError, match="the run has ended"):
        simulation.step(0.1)
    simulation.reset()
    assert not simulation.failed
    assert simulation.advance(0.5)


def test_simulate_reports_progress_and_can_be_stopped() -> None:
    seen: list[float] = []
    result = simulate(
        scenario(), progress=lambda time, end, outputs: seen.append(time), should_stop=lambda: len(seen) == 3
    )
    assert seen == pytest.approx([0.1, 0.2, 0.3])
    assert result.status.status is Status.STOPPED
    assert result.time == pytest.approx([0.0, 0.1, 0.2, 0.3])


def test_ctrl_c_keeps_what_is_done() -> None:
    def interrupt(time: float, end: float, outputs: Mapping[str, Any]) -> None:
        if time > 0.25:
            raise KeyboardInterrupt

    result = simulate(scenario(), progress=interrupt)
    assert result.status.status is Status.STOPPED
    assert result.time[-1] == pytest.approx(0.3)


def test_output_times_end_at_the_end() -> None:
    odd = scenario(drive={"kind": "speed", "speed": 2e-3, "duration": 0.25}, output={"interval": 0.1})
    assert output_times(odd) == pytest.approx([0.1, 0.2, 0.25])
    even = scenario(drive={"kind": "speed", "speed": 2e-3, "duration": 0.3}, output={"interval": 0.1})
    assert output_times(even) == pytest.approx([0.1, 0.2, 0.3])


def test_a_step_that_fails_after_outputs_on_its_way_ends_the_run_as_not_converged() -> None:
    overrides = {
        "wire.model": "amplatz-super-stiff",
        "wire.segments": 60,
        "contact.friction_coefficient": 0.6,
        "drive.distance": 2e-3,
        "solver.step": 0.5,
        "solver.minimum_step": 0.5,
    }
    result = simulate(load_scenario("phantom-universal", overrides))
    assert result.status.status is Status.NOT_CONVERGED
    assert (np.diff(result.time) > 0).all()
    assert result.time[-1] == result.status.time
