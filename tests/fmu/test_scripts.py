"""The scripts of scenarios/ that use the FMU through fmpy alone do what they say."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

from gw_exudyn.fmi.export import export
from gw_exudyn.scenario import load_scenario

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"


def script(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, SCENARIOS / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_friction_study_needs_more_force_with_more_friction(fmus):
    rows = script("fmu_parameter_study").study(str(fmus[2]), (0.0, 0.2, 0.4), stop=2.5)
    push = [row[1] for row in rows]
    assert 0 < push[0] < push[1] < push[2]
    assert [row[3] for row in rows] == [0, 0, 0]


def test_the_controller_holds_the_tip_force(tmp_path):
    dead_end = load_scenario(
        "straight", ["vessel.end=dead", "vessel.length=3 mm", "solver.step=10 ms", "wire.segments=30"]
    )
    rows = script("fmu_tip_force_control").hold(str(export(dead_end, tmp_path / "dead.fmu")), duration=4.5)
    assert any(force == 0 for _, force, _ in rows)
    held = [force for time, force, _ in rows if time > 4.0]
    assert (min(held), max(held)) == pytest.approx((20e-3, 20e-3), rel=0.02)
