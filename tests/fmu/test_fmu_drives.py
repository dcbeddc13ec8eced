"""Drives by force and by tip speed from the host, and runs that end by an event of their own."""

from __future__ import annotations

import pytest
import yaml
from hosts import DISCARD, ERROR, OK, Host

from gw_exudyn.errors import ScenarioError
from gw_exudyn.fmi.export import export
from gw_exudyn.fmi.overriding import overridden
from gw_exudyn.scenario import scenario_from_dict
from gw_exudyn.simulation import Simulation

BASE = {
    "name": "driven",
    "wire": {"model": "universal-ii", "segments": 20},
    "vessel": {"kind": "arc", "diameter": 0.004, "radius": 0.015, "angle": 1.5, "lead_in": 0.02, "lead_out": 0.05},
    "catheter": {"bore": 0.0012},
}
FORCE = {"kind": "force", "force": 0.02, "hub_mass": 0.01, "hub_damping": 1.0, "duration": 5.0}
TIP_SPEED = {"kind": "tip_speed", "speed": 0.01, "max_speed": 0.05, "duration": 5.0}


@pytest.mark.parametrize(
    ("drive", "command", "value"), [(FORCE, "force", 0.01), (TIP_SPEED, "speed", 0.02)], ids=["force", "tip speed"]
)
def test_the_host_drives_by_what_the_drive_takes(tmp_path, drive, command, value):
    scenario = scenario_from_dict({**BASE, "drive": drive})
    simulation = Simulation(scenario)
    with Host(export(scenario, tmp_path / "driven.fmu")).start() as host:
        assert f"command.{'speed' if command == 'force' else 'force'}" not in host.variables
        assert host.step(0.5)["status"] == OK
        simulation.step(0.5)
        host.set(f"command.{command}", value)
        assert host.step(0.73)["status"] == OK
        simulation.step(0.73, **{command: value})
        for name in ("tip.x", "push.force", "insertion.depth"):
            quantity = name.replace(".", "_")
            assert host.get(name) == pytest.approx(simulation.outputs[quantity], rel=1e-9), name


def test_the_drives_own_numbers_are_parameters():
    scenario = scenario_from_dict({**BASE, "drive": FORCE})
    changed = overridden(scenario, {"drive.force": 0.03, "drive.hub_damping": 2.0})
    assert set(changed.drive.force) == {0.03}
    assert (changed.drive.hub_damping, changed.drive.hub_mass, changed.drive.duration) == (2.0, 0.01, 5.0)


TABLE = {"kind": "speed", "table": [[0.0, 0.01], [1.0, 0.01], [1.0, 0.02], [2.0, 0.02]]}


@pytest.mark.parametrize(
    ("drive", "name", "sentence"),
    [
        (TABLE, "drive.speed", "the drive has no one speed, but a table of it in time; leave it at its start"),
        (TABLE, "drive.distance", "the drive has no one speed, but a table of it in time; leave it at its start"),
        (FORCE, "drive.speed", "a drive of kind force has none; leave it at its start"),
        (FORCE, "drive.distance", "a drive of kind force has none; leave it at its start"),
        (TIP_SPEED, "drive.hub_mass", "a drive of kind tip_speed has none; leave it at its start"),
    ],
)
def test_a_parameter_that_another_scenarios_drive_lacks_is_told_beside_all_else(drive, name, sentence):
    scenario = scenario_from_dict({**BASE, "drive": drive})
    with pytest.raises(ScenarioError) as error:
        overridden(scenario, {name: 0.02, "contact.friction_coefficient": 9.0})
    first, second = sorted(str(error.value).splitlines())
    assert first.startswith("contact.friction_coefficient: 9.0 is out of range")
    assert second.startswith(f"{name}: {sentence}")


def test_a_command_that_another_scenarios_drive_does_not_take_is_an_error(tmp_path):
    other = tmp_path / "other.yaml"
    other.write_text(yaml.safe_dump(scenario_from_dict({**BASE, "drive": FORCE}).to_dict()))
    scenario = scenario_from_dict({**BASE, "drive": {"kind": "speed", "speed": 0.02, "distance": 0.07}})
    with Host(export(scenario, tmp_path / "driven.fmu")).start({"scenarioFile": str(other)}) as host:
        assert host.step(0.1)["status"] == OK  # by its own drive
        host.set("command.speed", 0.01)
        assert host.step(0.1)["status"] == ERROR
        assert "command.speed: a drive of kind force takes a force from outside" in host.messages[-1][2]
        assert "export the scenario that is to run as an FMU of its own" in host.messages[-1][2]


@pytest.mark.parametrize("fmi", [2, 3])
def test_an_event_ends_the_run_as_the_standard_has_it_and_may_be_trusted(tmp_path, fmi):
    scenario = scenario_from_dict(
        {
            **BASE,
            "drive": {"kind": "speed", "speed": 0.02, "distance": 0.07},
            "stop": {"push_force": 0.002},
        }
    )
    file = export(scenario, tmp_path / "event.fmu", fmi)
    simulation = Simulation(scenario)
    assert not simulation.advance(3.5)
    with Host(file).start() as host:
        end = host.step(3.5)
        assert end["terminate"]
        assert end["reached"] == pytest.approx(simulation.time)
        assert end["status"] == (DISCARD if fmi == 2 else OK)
        assert end["early"] == (fmi == 3)
        assert "exceeded its limit" in host.get("status.message")
        assert host.get("push.force") == pytest.approx(simulation.outputs["push_force"], rel=1e-9)
        assert host.step(0.1)["status"] == ERROR


def test_a_run_through_fmpy_stops_there_and_is_trusted(tmp_path):
    from gw_exudyn.fmi.session import FmuSession

    scenario = scenario_from_dict(
        {**BASE, "drive": {"kind": "speed", "speed": 0.02, "distance": 0.07}, "stop": {"push_force": 0.002}}
    )
    for fmi in (2, 3):
        with FmuSession(export(scenario, tmp_path / "event.fmu", fmi)) as session:
            run = session.run(step=0.5)
        assert run.trusted
        assert run.code
        assert run.final["time"] < 3.5
