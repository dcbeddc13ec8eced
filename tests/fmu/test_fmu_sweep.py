"""A sweep by the FMU gives the table of the sweep by the simulation."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
import xarray as xr

from gw_exudyn.cli.main import main
from gw_exudyn.errors import ScenarioError, UsageError
from gw_exudyn.fmi.export import export
from gw_exudyn.scenario import load_scenario, scenario_from_dict
from gw_exudyn.simulation import simulate
from gw_exudyn.sweep.fmu_runner import NOT_TOLD, FmuRunner
from gw_exudyn.sweep.runner import Task

SETTINGS = ("wire.segments=20", "drive.speed=20 mm/s", "drive.distance=40 mm", "output.interval=0.3 s")
STUDY = """base: BASE
SET
vary:
  contact.friction_coefficient: [0.1, 0.4]
  vessel.radius: [15 mm, 25 mm]
"""


@pytest.fixture(autouse=True)
def _own_world(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def table(folder: str) -> list[dict[str, str]]:
    with open(Path(folder, "sweep.csv"), newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def sweep(folder: str, *options: str) -> int:
    return main(["sweep", "study.yaml", "--out", folder, "--jobs", "1", "--quiet", "--no-figures", *options])


def write_study(base: str = "arc90") -> None:
    given = "{" + ", ".join(pair.replace("=", ": ") for pair in SETTINGS) + "}" if base == "arc90" else "{}"
    Path("study.yaml").write_text(STUDY.replace("BASE", base).replace("SET", f"set: {given}"))


def compare(ours: str, theirs: str) -> None:
    for mine, native in zip(table(ours), table(theirs), strict=True):
        for head, text in native.items():
            name = head.partition(" ")[0]
            if name in ("id", "wall_time"):
                continue
            if name in NOT_TOLD:
                assert mine[head] == ""
            elif name in ("status", "reason", "trusted", "wire.model", "wire.estimate") or not text:
                assert mine[head] == text, head
            else:
                assert float(mine[head]) == pytest.approx(float(text), rel=1e-9, abs=1e-18), head
    with xr.open_dataset(Path(ours, "sweep.nc")) as mine, xr.open_dataset(Path(theirs, "sweep.nc")) as native:
        xr.testing.assert_allclose(
            mine.drop_vars(["id", "wall_time", *(f"metric_{name}" for name in NOT_TOLD)]),
            native.drop_vars(["id", "wall_time", *(f"metric_{name}" for name in NOT_TOLD)]),
            rtol=1e-9,
            atol=1e-18,
        )


def test_a_sweep_by_the_fmu_gives_the_numbers_of_the_native_one(capsys):
    write_study()
    assert sweep("native") == 0
    assert sweep("fmu", "--engine", "fmu") == 0
    compare("fmu", "native")
    assert any(float(row["wall_force_max [N]"]) > 1e-4 for row in table("fmu"))
    run = json.loads(next(Path("fmu").glob("points/*/run.json")).read_text())
    assert run["provenance"]["engine"] == "fmu"
    assert run["command"].endswith("--engine fmu --out fmu")
    capsys.readouterr()
    assert sweep("fmu", "--engine", "fmu", "--json") == 0
    assert json.loads(capsys.readouterr().out)["run"] == 0


def test_the_base_may_be_an_fmu(capsys):
    export(load_scenario("arc90", SETTINGS), "base.fmu")
    write_study("base.fmu")
    assert sweep("fmu", "--engine", "fmu") == 0
    assert sweep("native") == 0
    compare("fmu", "native")
    Path("base.fmu").write_text("no")
    assert sweep("fmu") == 3
    assert "is no FMU of gw-exudyn" in capsys.readouterr().err


@pytest.mark.parametrize(
    "vary",
    [
        {"drive.speed": "[20 mm/s, 25 mm/s]"},
        {"drive.distance": "[30 mm]", "drive.speed": "[25 mm/s]"},
        {"wire.model": "[amplatz-super-stiff]"},
        {"wire.estimate": "[low]"},
    ],
    ids=lambda vary: " ".join(vary),
)
def test_a_study_of_an_fmu_may_vary_what_its_scenario_has_written_out(vary):
    export(load_scenario("arc90", SETTINGS), "base.fmu")
    axes = "".join(f"  {path}: {values}\n" for path, values in vary.items())
    Path("study.yaml").write_text(f"base: base.fmu\nvary:\n{axes}")
    assert sweep("fmu", "--engine", "fmu") == 0
    given = ", ".join(pair.replace("=", ": ") for pair in SETTINGS if pair.partition("=")[0] not in vary)
    Path("study.yaml").write_text(f"base: arc90\nset: {{{given}}}\nvary:\n{axes}")
    assert sweep("native") == 0
    compare("fmu", "native")


def test_a_study_of_an_fmu_with_several_speeds_is_told_why_it_has_none_to_vary(capsys):
    export(load_scenario("push-hold-pull", ["wire.segments=10"]), "base.fmu")
    Path("study.yaml").write_text("base: base.fmu\nvary:\n  drive.speed: [20 mm/s]\n")
    assert sweep("fmu", "--engine", "fmu") == ScenarioError.exit_code
    assert "the drive has no one speed, but a table of it in time; change drive.table" in capsys.readouterr().err


def test_what_an_fmu_cannot_do_is_refused(capsys):
    write_study()
    assert sweep("out", "--engine", "fmu", "--keep-runs") == UsageError.exit_code
    assert "leave it out" in capsys.readouterr().err
    assert sweep("out", "--engine", "fmu", "--scheduler", "tcp://127.0.0.1:1") == UsageError.exit_code
    assert not Path("out").exists()


def test_a_point_does_not_depend_on_those_before_it_and_an_early_end_is_told(fmus, scenario):
    runner = FmuRunner(str(fmus[2]))
    plain = scenario.to_dict()
    plain["stop"]["push_force"] = 1e-4  # the exported scenario has none, so neither has the FMU: a file is read
    stopped = scenario_from_dict(plain).to_dict()
    first = runner.run(Task("a", scenario.to_dict()))
    ended = runner.run(Task("b", stopped))
    again = runner.run(Task("c", scenario.to_dict()))
    runner._session.close()
    assert first.status == "completed"
    assert first.files["series.csv"] == again.files["series.csv"]
    native = simulate(scenario_from_dict(stopped))
    assert ended.status == native.status.status.name.lower() == "force_limit"
    assert ended.sentence == native.status.sentence()
    assert ended.trusted
