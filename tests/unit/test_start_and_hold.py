"""Every drive with a wire that is inserted and loaded at the start, and an end that may turn."""

from __future__ import annotations

from typing import Any

import pytest
from test_loads import beam

from gw_exudyn.scenario import scenario_from_dict
from gw_exudyn.simulation import Simulation

DRIVES: dict[str, dict[str, Any]] = {
    "speed": {"speed": 1e-3},
    "force": {"force": 2e-3, "hub_mass": 0.01, "hub_damping": 2.0},
    "tip_speed": {"speed": 1e-3, "max_speed": 0.01},
}


@pytest.fixture(params=DRIVES)
def loaded(request: pytest.FixtureRequest) -> dict[str, Any]:
    """A wire of which 30 mm are out, in a tube of some play, with a load at its tip."""
    drive = {"kind": request.param, "duration": 1.0, "start": 0.03, "hold": "pinned", **DRIVES[request.param]}
    content = beam(tip={"force": [0.0, 2e-3], "ramp": 0.5}, catheter={"bore": 0.5e-3})
    return content | {"drive": drive}


def test_it_starts_inserted_and_goes_on_from_there(loaded: dict[str, Any]) -> None:
    run = Simulation(scenario_from_dict(loaded))
    assert run.outputs["drive_position"] == pytest.approx(0.03 - 0.06, abs=1e-12)
    run.advance(1.0)
    assert 0.1e-3 < run.outputs["drive_position"] + 0.03 < 2e-3


def test_the_works_of_load_and_drive_are_in_one_balance(loaded: dict[str, Any]) -> None:
    run = Simulation(scenario_from_dict(loaded))
    run.advance(1.0)
    out = run.outputs
    assert abs(out["load_work"]) > 1e-6
    # What is left over is of the size of the Newton iteration's relative tolerance.
    assert abs(out["energy_error"]) < 1e-4 * (abs(out["load_work"]) + abs(out["drive_work"]))


def test_a_saved_state_goes_on_bit_for_bit(loaded: dict[str, Any]) -> None:
    scenario = scenario_from_dict(loaded)
    run, again = Simulation(scenario), Simulation(scenario)
    run.advance(0.403)
    state = run.get_state()
    run.advance(0.6)
    again.set_state(state)
    again.advance(0.6)
    assert again.get_state() == run.get_state()


def test_a_tip_that_starts_inserted_has_not_stalled() -> None:
    content = beam(stop={"tip_stall": "5 mm"}, catheter={"bore": 0.5e-3}) | {
        "drive": {"kind": "speed", "speed": 1e-3, "duration": 0.1, "start": 0.008}
    }
    run = Simulation(scenario_from_dict(content))
    assert run.advance(0.1), run.status.sentence()


def test_a_held_tip_does_not_stall_unless_the_scenario_says_so() -> None:
    drive = {"speed": 0.1, "duration": 0.06, "start": 0.0}
    run = Simulation(scenario_from_dict(beam(drive=drive, tip={"hold": "pinned"}, wire={"imperfection": 0.01})))
    assert run.advance(0.06), run.status.sentence()
