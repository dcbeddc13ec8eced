"""The drives by force and by the tip's speed, and `stop`, as a file gives them: forms, sentences, and round trips."""

from __future__ import annotations

import math
from typing import Any

import pytest
from scenes import scenario

from gw_exudyn.cli.resolved import resolved_rows
from gw_exudyn.errors import ScenarioError
from gw_exudyn.model import build
from gw_exudyn.scenario import json_schema, scenario_from_dict

FORCE: dict[str, Any] = {
    "kind": "force",
    "force": "20 mN",
    "hub_mass": "10 g",
    "hub_damping": "5 N*s/m",
    "duration": "40 s",
}
TIP: dict[str, Any] = {"kind": "tip_speed", "speed": "2 mm/s", "max_speed": "10 mm/s", "duration": "20 s"}


def without(drive: dict[str, Any], *keys: str, **changes: Any) -> dict[str, Any]:
    return {key: value for key, value in drive.items() if key not in keys} | changes


def test_a_force_is_a_table_in_si() -> None:
    drive = scenario(drive=FORCE).drive
    assert (drive.time, drive.force) == ((0.0, 40.0), (0.02, 0.02))
    assert (drive.hub_mass, drive.hub_damping, drive.duration) == (0.01, 5.0, 40.0)


def test_a_ramp_rises_from_nothing() -> None:
    drive = scenario(drive={**FORCE, "ramp": "10 s"}).drive
    assert (drive.time, drive.force) == ((0.0, 10.0, 40.0), (0.0, 0.02, 0.02))
    drive = scenario(drive={**TIP, "ramp": "20 s"}).drive
    assert (drive.time, drive.speed) == ((0.0, 20.0), (0.0, 0.002))


@pytest.mark.parametrize(
    "changes",
    [
        {"drive": FORCE},
        {"drive": without(FORCE, "force", "duration", table=[[0, 0], [5, "30 mN"], [5, "-10 mN"], [9, 0]])},
        {"drive": TIP},
        {"drive": {**TIP, "force_limit": "1 N", "ramp": "2 s"}},
        {"stop": {"tip_stall": "off", "push_force": "5 N"}},
        {"stop": {"tip_stall": "12 mm", "target": {"at": ["20 mm", "30 mm"]}, "at_target": True}},
    ],
)
def test_the_resolved_scenario_is_a_scenario_again_and_can_be_shown(changes: dict[str, Any]) -> None:
    made = scenario(**changes)
    assert scenario_from_dict(made.to_dict()) == made
    assert any(path.startswith("drive.table") for path, _ in resolved_rows(made))


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"drive": without(FORCE, "hub_mass")},
         "drive.hub_mass: is missing: mass of the hub; for example hub_mass: 10 g"),
        ({"drive": without(FORCE, "duration")},
         "drive.duration: is missing: how long the drive lasts; give duration: 40 s"),
        ({"drive": without(FORCE, "force")}, "drive: says no force; give force with duration, or table"),
        ({"drive": {**FORCE, "table": [[0, 0], [1, 0]]}},
         "drive.force: stands beside table; the table says it all, remove it\n"
         "drive.duration: stands beside table; the table says it all, remove it"),
        ({"drive": {**FORCE, "ramp": "50 s"}}, "drive.ramp: 50 s is longer than the drive lasts; shorten it"),
        ({"drive": {**FORCE, "speed": 1}}, "drive.speed: unknown key; allowed: kind, force, duration, ramp, table, "
                                           "hub_mass, hub_damping, start, hold"),
        ({"drive": {**FORCE, "hold": "axial"}},
         "drive.hold: a hub that a force pushes moves along the axis alone; take hold: clamped or pinned"),
        ({"drive": TIP, "tip": {"hold": "pinned"}},
         "tip.hold: a tip that is pinned here cannot have the speed that a drive of kind tip_speed wants; let it be "
         "free or slide along, or take a drive of kind speed or force"),
        ({"drive": {**FORCE, "hub_damping": 0}}, "drive.hub_damping: 0 N*s/m is outside the plausible 0.001 N*s/m to "
                                                 "1e+06 N*s/m"),
        ({"drive": {**TIP, "speed": "-1 mm/s"}}, "drive.speed: -1 mm/s is outside the plausible 0 mm/s to 1000 mm/s"),
        ({"drive": {**TIP, "max_speed": "1 mm/s"}},
         "drive.max_speed: 1 mm/s is below the wanted speed of the tip, 2 mm/s; allow the hub that at least"),
        ({"drive": without(FORCE, "force", "duration", table=[[1, 0], [2, 1]])},
         "drive.table.0: begins at 1 s; the first time is 0"),
        ({"stop": {"tip_stall": "on"}},
         "stop.tip_stall: 'on' does not begin with a number; write it as '2.5 m'; or write auto or off"),
        ({"stop": {"at_target": True}},
         "stop: at_target needs a target; give target: {at: [20 mm, 40 mm], within: 2 mm}"),
        ({"stop": {"at_target": "yes"}}, "stop.at_target: 'yes' is neither true nor false"),
    ],
)  # fmt: skip
def test_what_is_wrong_has_its_sentence(changes: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        scenario(**changes)
    assert str(caught.value) == sentence


def test_a_tip_that_is_to_go_further_than_the_wire_is_long_cannot_start() -> None:
    with pytest.raises(ScenarioError, match="of a wire of 60 mm"):
        build(scenario(drive={**TIP, "duration": "40 s"}))


def test_the_stall_travel_is_chosen_by_the_lumen() -> None:
    """1.25 lumens, 5 mm at least; and whatever the user says."""
    wide = {"kind": "straight", "length": 50e-3, "diameter": 20e-3}
    assert build(scenario()).stall_travel == pytest.approx(5e-3)
    assert build(scenario(vessel=wide)).stall_travel == pytest.approx(25e-3)
    assert build(scenario(stop={"tip_stall": "7 mm"})).stall_travel == 7e-3
    assert math.isinf(build(scenario(stop={"tip_stall": "off"})).stall_travel)


def test_the_schema_knows_the_forms() -> None:
    schema = json_schema()
    assert {"DriveForm", "ForceForm", "TipSpeedForm", "StopSpec", "TargetSpec"} <= set(schema["$defs"])
    assert {"const": "off"} in schema["$defs"]["StopSpec"]["properties"]["tip_stall"]["anyOf"]
