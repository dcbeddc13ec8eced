"""States go on exactly, within an instance and in another process; what is no state is refused."""

from __future__ import annotations

import pytest
from fmpy.fmi1 import FMICallException
from hosts import OK, Host

from gw_exudyn.scenario import Scenario, scenario_from_dict
from gw_exudyn.simulation import Simulation


def run_on(host):
    rows = []
    for dt in (0.05, 0.03, 0.2):
        assert host.step(dt)["status"] == OK
        rows.append(host.outputs())
    return repr(rows)


@pytest.mark.parametrize("at", [1.8, 2.013], ids=["between steps", "within a step"])
def test_a_state_goes_on_exactly_here_and_in_another_process(fmu, at):
    values = {"contact.friction_coefficient": 0.3}
    with Host(fmu).start(values) as host:
        assert host.step(at)["status"] == OK
        assert host.get("wall.contacts") > 0
        state = host.state()
        straight_on = run_on(host)
        host.restore(state, at)
        assert run_on(host) == straight_on
        with Host(fmu).start() as other:  # of another friction, until the state brings its own
            assert other.step(0.5)["status"] == OK
            other.restore(state, at)
            assert run_on(other) == straight_on
            assert other.get("contact.friction_coefficient") == 0.3


CARINA = [(0, -3), (30, -3), (30, -0.05), (10, -0.05), (10, 0.05), (30, 0.05), (30, 3), (0, 3)]
"""Corners of a lumen that a thin septum parts at x = 10 mm, mm."""


@pytest.fixture(scope="module")
def forked() -> Scenario:
    return scenario_from_dict(
        {
            "name": "forked",
            "wire": {"model": "universal-ii", "segments": 20, "length": 0.05},
            "vessel": {
                "kind": "polygon",
                "points": [[x / 1e3, y / 1e3] for x, y in CARINA],
                "open_edges": [1, 5, 7],
            },
            "catheter": {"exit": [0, 0.00015], "bore": 0.0012},
            "drive": {"kind": "speed", "speed": 0.02, "distance": 0.02},
        }
    )


def test_a_state_keeps_on_which_side_of_a_carina_the_wire_lies(forked, tmp_path):
    from gw_exudyn.fmi.export import export

    beside = 0.7
    simulation = Simulation(forked)
    simulation.step(beside)
    state = simulation.get_state()
    assert simulation._stepper.contact.memory.side.any()
    after = simulation.step(0.2)["friction_loss"]
    simulation.set_state(state)
    simulation._stepper.contact.memory.side[:] = 0
    assert simulation.step(0.2)["friction_loss"] != after  # so a state without the sides would be found below

    for fmi in (2, 3):
        file = export(forked, tmp_path / f"forked{fmi}.fmu", fmi, stations=7)
        with Host(file).start() as host:
            assert host.step(beside)["status"] == OK
            assert host.get("tip.x") > 0.0135
            assert host.get("wall.contacts") > 0
            saved = host.state()
            straight_on = run_on(host)
            with Host(file).start() as other:
                other.restore(saved, beside)
                assert run_on(other) == straight_on


def test_a_state_keeps_who_drives(fmu):
    with Host(fmu).start() as host:
        host.set("command.speed", 0.01)
        assert host.step(0.5)["status"] == OK
        state = host.state()
        with Host(fmu).start() as other:
            other.restore(state, 0.5)
            assert host.step(0.5)["status"] == OK
            assert other.step(0.5)["status"] == OK
            assert other.get("insertion.depth") == host.get("insertion.depth") == pytest.approx(0.01)


def test_a_state_before_the_start_brings_its_values(fmu):
    with Host(fmu).instantiate() as host:
        host.set("contact.friction_coefficient", 0.15)
        state = host.state()
        host.set("contact.friction_coefficient", 0.25)
        host.restore(state, 0.0)
        assert host.get("contact.friction_coefficient") == 0.15


def test_bytes_that_are_no_state_are_refused(fmu):
    with Host(fmu).start() as host:
        assert host.step(0.1)["status"] == OK
        state = host.state()
        for spoiled in (b"", state[:-3], b"x" + state[1:], state + b"more"):
            with pytest.raises(FMICallException):
                host.restore(spoiled, 0.1)
            assert "no state of this FMU" in host.messages.pop()[2]
        assert host.step(0.1)["status"] == OK  # nothing has happened to the run


def test_a_damaged_worker_state_is_refused(fmu):
    with Host(fmu).start() as host:
        assert host.step(0.1)["status"] == OK
        state = bytearray(host.state())
        state[-20] ^= 255
        with pytest.raises(FMICallException):
            host.restore(bytes(state), 0.1)
        assert "damaged" in host.messages[-1][2]


def test_a_state_of_another_fmu_is_refused(fmus, scenario, tmp_path):
    from gw_exudyn.fmi.export import export
    from gw_exudyn.scenario import scenario_from_dict

    other = export(scenario_from_dict(scenario.to_dict(), {"wire.segments": 10}), tmp_path / "other.fmu")
    with Host(fmus[2]).start() as host, Host(other).start() as stranger, pytest.raises(FMICallException):
        host.restore(stranger.state(), 0.0)


def test_a_handle_that_is_none_is_told_and_not_followed(fmu):
    import ctypes

    with Host(fmu).start() as host, Host(fmu).start() as other:
        calls = host.calls
        handle = calls.getFMUstate() if host.fmi2 else calls.getFMUState()
        free = other.calls.freeFMUstate if host.fmi2 else other.calls.freeFMUState
        for wrong in (handle, ctypes.c_void_p(0x1234)):
            with pytest.raises(FMICallException):
                free(wrong)
        assert "no state of this instance" in other.messages[-1][2]
