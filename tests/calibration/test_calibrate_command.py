"""`gw-exudyn calibrate` with real simulations: what it finds, writes and tells, and how it ends."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from calibration_cases import FILE, FRICTION, TIP, measure, run_of

from gw_exudyn.cli import main
from gw_exudyn.scenario import load_scenario

MORE = "push_force: 0.1 mN, wall_force_x: 0.1 mN, wall_force_y: 0.1 mN"
TRUTH = {FRICTION: 0.22, TIP: 1.2}


@pytest.fixture
def gw(capsys):
    def run(*arguments: str):
        capsys.readouterr()
        code = main(arguments)
        return code, *capsys.readouterr()

    return run


@pytest.fixture
def file() -> str:
    measure(run_of(contact__friction_coefficient=TRUTH[FRICTION], wire__stiffness_factor__tip=TRUTH[TIP]), seed=3)
    Path("fit.yaml").write_text(FILE.replace("push_force: 0.1 mN", MORE))
    return "fit.yaml"


def test_it_recovers_what_is_true_and_writes_a_folder(gw, file):
    code, out, err = gw("calibrate", file, "--jobs", "1", "--json")
    assert code == 0, err
    told = json.loads(out)
    folder = Path("results", "calibrations", "fit")
    kept = json.loads((folder / "fit.json").read_text())
    assert {name: told[name] for name in kept} == kept
    assert kept["converged"]
    assert kept["identified"], err
    for path, true in TRUTH.items():
        low, high = kept["parameters"][path]["interval"]
        assert low <= true <= high
    assert kept["reduced_chi_square"] == pytest.approx(1.0, abs=0.25)
    assert "1: chi square " in err
    assert f"at {FRICTION} 0.3, {TIP} 1 (1 simulations)" in err

    names = {str(path.relative_to(folder)) for path in folder.rglob("*") if "simulations" not in path.parts}
    drawn = {
        f"figures/{name}.{end}" for name in ("confidence", "residuals", "measured_and_fitted") for end in ("png", "pdf")
    }
    assert names == {"fit.json", "fitted.yaml", "residuals.csv", "figures"} | drawn
    assert {str(Path(path).relative_to(folder)) for path in told["written"]} == {
        "fit.json",
        "fitted.yaml",
        "residuals.csv",
    } | drawn

    # A scenario like any other, with the fitted values.
    scenario = load_scenario(folder / "fitted.yaml")
    assert scenario.contact.friction_coefficient == kept["parameters"][FRICTION]["value"]
    assert scenario.wire.stiffness_factor.tip == kept["parameters"][TIP]["value"]
    assert scenario.wire.segments == 20
    assert "values fitted by: gw-exudyn calibrate fit.yaml" in (folder / "fitted.yaml").read_text().splitlines()[0]

    with open(folder / "residuals.csv", newline="") as rows:
        residuals = [float(row["residual [1]"]) for row in csv.DictReader(rows)]
    assert sum(x * x for x in residuals) == pytest.approx(kept["chi_square"], rel=1e-9)
    assert len(residuals) == kept["degrees_of_freedom"] + 2

    # The same again without a simulation; another start shares what it can.
    code, out, err = gw("calibrate", file, "--jobs", "1", "--no-figures", "--quiet")
    assert (code, err) == (0, "")
    again = json.loads((folder / "fit.json").read_text())
    assert again["simulations"] == {**kept["simulations"], "run": 0}
    assert {k: v for k, v in again.items() if k != "simulations"} == {
        k: v for k, v in kept.items() if k != "simulations"
    }
    lines = out.splitlines()
    assert lines[0].split() == ["parameter", "value", "+-", "(95", "%)", "low", "high"]
    assert lines[1].split()[0] == FRICTION
    assert lines[1].endswith("identified")
    assert lines[-1] == str(folder)


def test_friction_without_contact_is_not_identified(gw):
    # Out of a catheter into the open: nothing is touched.
    changes = (
        "{wire.segments: 12, drive.distance: 8 mm, solver.step: 0.2 s, output.interval: 0.2 s, drive.start: 12 mm}"
    )
    Path("fit.yaml").write_text(
        f"""base: straight
set: {changes}
measured: [camera.csv]
noise: {{tip: 0.1 mm}}
fit:
  {FRICTION}: {{start: 0.3, low: 0.05, high: 0.6}}
  catheter.direction: {{start: 2 deg, low: -6 deg, high: 6 deg}}
"""
    )
    course = run_of(
        "straight", drive__distance=0.008, drive__start=0.012, catheter__direction=0.05, vessel__diameter=0.02
    )
    measure(course, seed=1)
    code, out, err = gw("calibrate", "fit.yaml", "--set", "vessel.diameter=20 mm", "--jobs", "1", "--no-figures")
    assert code == 0, err
    assert f"{FRICTION} is not identified: its interval is wider than half its range" in err
    assert "catheter.direction is not" not in err
    rows = {line.split()[0]: line for line in out.splitlines() if line}
    assert rows[FRICTION].endswith("NOT identified")
    assert rows["catheter.direction"].endswith(" identified")
    kept = json.loads(Path("results/calibrations/fit/fit.json").read_text())
    low, high = kept["parameters"]["catheter.direction"]["interval"]
    assert low < 0.05 < high
    assert "NOT identified" in Path("results/calibrations/fit/fitted.yaml").read_text()


def test_bad_files_and_folders_have_their_exit_codes(gw, file):
    Path("bad.yaml").write_text(FILE.replace("friction_coefficient", "friction_coeficient"))
    code, _, err = gw("calibrate", "bad.yaml")
    assert code == 3
    assert "bad.yaml:6: fit.contact.friction_coeficient: no scenario has this value; did you mean" in err
    assert gw("calibrate", "nothing.yaml")[0] == 3
    assert gw("calibrate", file, "--jobs", "0")[0] == 2
    assert gw("calibrate", file, "--set", "wire.segments")[0] == 2
    Path("taken").mkdir()
    Path("taken", "letter.txt").write_text("mine")
    code, _, err = gw("calibrate", file, "--out", "taken")
    assert code == 7
    assert "taken: the folder exists and is not a calibration of gw-exudyn" in err
    Path("file").write_text("")
    assert gw("calibrate", file, "--out", "file")[0] == 7


def test_a_start_that_fails_ends_with_4(gw, file):
    code, out, err = gw("calibrate", file, "--jobs", "1", "--set", "wire.segments=5", "--set", "drive.distance=60 mm")
    assert (code, out) == (4, "")
    assert "the simulation at the start values failed: The wire was pressed into a wall" in err
    assert not Path("results/calibrations/fit/fit.json").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="sends a signal")
def test_ctrl_c_keeps_what_is_done(file):
    command = [sys.executable, "-m", "gw_exudyn", "calibrate", file, "--jobs", "1", "--out", "out"]
    process = subprocess.Popen(command, text=True, stderr=subprocess.PIPE, start_new_session=True)
    end = time.monotonic() + 90
    while not list(Path("out").glob("simulations/points/*/run.json")) and process.poll() is None:
        assert time.monotonic() < end, "it did not come about"
        time.sleep(0.02)
    os.kill(process.pid, signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert "the simulations that are done are kept, and the same command goes on" in err
    assert "Traceback" not in err
    assert not Path("out/fit.json").exists()
    assert list(Path("out").glob("simulations/points/*/run.json"))
