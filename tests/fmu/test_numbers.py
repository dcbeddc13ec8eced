"""The FMU gives the numbers of the direct run."""

from __future__ import annotations

import numpy as np
import pytest
from hosts import OK, Host

from gw_exudyn.fmi.export import export
from gw_exudyn.fmi.overriding import overridden
from gw_exudyn.fmi.parameters import path_of
from gw_exudyn.fmi.variables import output_name
from gw_exudyn.quantities import SCALARS
from gw_exudyn.scenario import load_scenario
from gw_exudyn.simulation import Simulation

RAGGED = (0.013, 0.05, 0.0501, 0.2, 0.0003, 0.087, 0.2, 0.05, 0.1)
TOUCHES = 1.6
"""Time, s, at which the tip has met the outer wall."""


def compare(host, simulation):
    outputs = simulation.outputs
    for quantity in SCALARS:
        assert host.get(output_name(quantity)) == pytest.approx(outputs[quantity], rel=1e-9, abs=1e-18), quantity


@pytest.mark.parametrize("steps", [(0.05,) * 10, (0.01,) * 40, RAGGED], ids=["50ms", "10ms", "ragged"])
def test_every_output_is_that_of_the_direct_run(fmu, scenario, steps):
    simulation = Simulation(scenario)
    with Host(fmu).start() as host:
        compare(host, simulation)
        for dt in (TOUCHES, *steps):
            assert host.step(dt)["status"] == OK
            simulation.step(dt)
            compare(host, simulation)
        assert host.get("wall.contacts") > 0
        assert host.get("energy.friction_loss") > 0


def test_one_millisecond_at_a_time(fmus, scenario):
    simulation = Simulation(scenario)
    simulation.advance(TOUCHES)
    with Host(fmus[2]).start() as host:
        assert host.step(TOUCHES)["status"] == OK
        for _ in range(30):
            assert host.step(0.001)["status"] == OK
            simulation.step(0.001)
        compare(host, simulation)


def test_a_second_run_after_reset_is_the_first_to_the_bit(fmu):
    with Host(fmu).start() as host:
        runs = []
        for _ in range(2):
            rows = []
            for dt in (TOUCHES, *RAGGED):
                assert host.step(dt)["status"] == OK
                rows.append(host.outputs())
            runs.append(repr(rows))
            host.calls.terminate()
            host.calls.reset()
            host.start()
        assert runs[0] == runs[1]


def test_a_parameter_gives_the_run_of_the_scenario_with_it(fmu, scenario):
    values = {"contact.friction_coefficient": 0.1, "wire.segments": 12, "drive.speed": 0.025}
    simulation = Simulation(
        load_scenario(
            "arc90",
            {**values, "drive.distance": 0.07},
        )
    )
    with Host(fmu).start(values) as host:
        assert host.step(2.0)["status"] == OK
        simulation.step(2.0)
        compare(host, simulation)


LOADS = """wire: {model: universal-ii, segments: 20, length: 60 mm}
vessel: {kind: none}
catheter: {bore: 1 mm}
drive: {kind: speed, start: 25 mm, speed: 1 mm/s, distance: 5 mm}
supports: [{at: [10 mm, 1.3 mm], radius: 1 mm}]
nose: {at: [20 mm, -1.5 mm], radius: 1 mm, direction: 90 deg, speed: 0.5 mm/s, travel: 2 mm}
"""
LOADED = {
    "tip.dead_force[1]": 1e-5,
    "tip.follower_force[0]": 2e-6,
    "tip.moment": 1e-8,
    "tip.ramp": 0.5,
    "supports[0].at[0]": 0.011,
    "supports[0].radius": 0.0011,
    "nose.at[1]": -0.0014,
    "nose.speed": 0.001,
    "wire.stiffness_factor.tip": 1.2,
    "wire.estimate": "high",
    "catheter.exit[0]": 0.001,
}


def test_loads_supports_and_nose_are_parameters(tmp_path):
    (tmp_path / "loaded.yaml").write_text(LOADS)
    base = load_scenario(tmp_path / "loaded.yaml")
    simulation = Simulation(load_scenario(tmp_path / "loaded.yaml", {path_of(name): x for name, x in LOADED.items()}))
    free = Simulation(base)
    with Host(export(base, tmp_path / "loaded.fmu")).start(LOADED) as host:
        for _ in range(5):
            assert host.step(0.5)["status"] == OK
            simulation.step(0.5)
            free.step(0.5)
        compare(host, simulation)
        assert abs(host.get("tip.y") - free.outputs["tip_y"]) > 1e-4
        assert host.get("result.support_force_y") != 0


def test_another_wire_brings_its_own_values(fmus):
    simulation = Simulation(
        load_scenario(
            "arc90",
            {"wire.model": "amplatz-super-stiff", "wire.segments": 20, "drive.speed": 0.02, "drive.distance": 0.07},
        )
    )
    with Host(fmus[2]).start({"wire.model": "amplatz-super-stiff"}) as host:
        assert host.step(1.0)["status"] == OK
        simulation.step(1.0)
        compare(host, simulation)


def test_the_stiffness_factors_scale_the_pieces(scenario):
    changed = overridden(scenario, {"wire.bending_stiffness.factor": 2.0, "wire.bending_stiffness[1].factor": 3.0})
    before, after = scenario.wire.bending_stiffness, changed.wire.bending_stiffness
    assert after[0].value == pytest.approx(2 * before[0].value)
    assert after[1].value == pytest.approx(6 * before[1].value)


def test_another_scenario_file_runs_and_equal_parameters_leave_it_alone(fmus, tmp_path):
    file = tmp_path / "other.yaml"
    file.write_text(
        "wire: {model: amplatz-super-stiff, segments: 10}\nvessel: {kind: straight, length: 100 mm, diameter: 4 mm}\n"
        "catheter: {bore: 1.2 mm}\ndrive: {kind: speed, speed: 5 mm/s, distance: 20 mm}\n"
    )
    simulation = Simulation(load_scenario(file))
    with Host(fmus[2]).start({"scenarioFile": file, "contact.friction_coefficient": 0.4}) as host:
        assert host.step(0.5)["status"] == OK
        simulation.step(0.5)
        compare(host, simulation)


def test_the_speed_comes_from_the_host_once_it_differs(fmu, scenario):
    simulation = Simulation(scenario)
    with Host(fmu).start() as host:
        host.set("command.speed", float(host.variables["command.speed"].start))  # nothing is taken over
        assert host.step(0.5)["status"] == OK
        simulation.step(0.5)
        for speed in (0.01, -0.01, 0.02):
            host.set("command.speed", speed)
            assert host.step(0.13)["status"] == OK
            simulation.step(0.13, speed=speed)
            compare(host, simulation)


def test_the_speed_rules_from_the_beginning_if_the_host_says_so(fmus):
    with Host(fmus[2]).start({"command.active": True}) as host:
        assert host.step(0.5)["status"] == OK
        assert host.get("insertion.depth") == pytest.approx(0.01)


def test_a_start_time_only_shifts_the_clock(fmu, scenario):
    with Host(fmu).start(begin=100.0) as host, Host(fmu).start() as other:
        for dt in (0.5, 0.7):
            assert host.step(dt)["status"] == OK
            assert other.step(dt)["status"] == OK
        assert host.time == pytest.approx(101.2)
        assert host.get("tip.x") == pytest.approx(other.get("tip.x"), rel=1e-9)


def test_the_stations_show_the_wire(fmus):
    with Host(fmus[3]).start() as host:
        assert host.step(1.8)["status"] == OK
        arc, x, y = (np.array(host.get(f"wire.station.{name}")) for name in ("arc_length", "x", "y"))
        assert len(arc) == 7
        assert (x[0], y[0]) == pytest.approx((host.get("tip.x"), host.get("tip.y")))
        # The wire cannot be stretched: a chord is no longer than the arc, and hardly shorter where it is straight.
        chords = np.hypot(np.diff(x), np.diff(y))
        assert (chords <= np.diff(arc) * (1 + 1e-9)).all()
        assert chords[-1] == pytest.approx(arc[-1] - arc[-2], rel=1e-3)
        forces = sum(host.get("wire.station.normal_force"))
        assert forces == pytest.approx(host.get("wall.force.normal") + host.get("catheter.force.normal"))
        assert forces > 0


def test_time_can_be_read_in_fmi3(fmus):
    with Host(fmus[3]).start() as host:
        assert host.step(0.25)["status"] == OK
        assert host.get("time") == 0.25
