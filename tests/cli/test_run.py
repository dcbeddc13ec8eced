"""`gw-exudyn run`: folders, output and exit codes."""

from __future__ import annotations

import json
import os
import signal
from pathlib import Path

import pytest

from gw_exudyn.result import Status
from gw_exudyn.storage import read_run


def test_a_run_names_its_folder_on_stdout_and_says_the_rest_on_stderr(gw, solver):
    outcome = gw("run", "straight")
    assert outcome.code == 0
    assert outcome.out == f"{Path('results', 'runs', 'straight')}\n"
    assert "largest push force" in outcome.err
    folder = Path("results/runs/straight")
    assert {"run.nc", "series.csv", "run.json", "figures"} == {path.name for path in folder.iterdir()}
    assert read_run(folder).scenario.name == "straight"


def test_quiet_says_nothing_but_the_folder(gw, solver):
    assert gw("run", "straight", "--quiet", "--no-figures").err == ""


def test_no_figures_leaves_them_out(gw, solver):
    gw("run", "straight", "--no-figures")
    assert not Path("results/runs/straight/figures").exists()


def test_overrides_reach_the_simulation_and_the_command_is_kept(gw, solver):
    gw("run", "straight", "--set", "wire.segments=30", "--set", "drive.speed=1 mm/s", "--out", "here it is", "-q")
    assert solver.scenarios[0].wire.segments == 30
    command = json.loads(Path("here it is/run.json").read_text())["command"]
    assert command == "gw-exudyn run straight --set wire.segments=30 --set 'drive.speed=1 mm/s' --out 'here it is'"


def test_several_scenarios_share_the_folder_that_is_given(gw, solver):
    outcome = gw("run", "straight", "arc90", "--out", "both", "--no-figures")
    assert outcome.out.split() == [str(Path("both", "straight")), str(Path("both", "arc90"))]


def test_json_holds_status_and_metrics_with_units(gw, solver):
    outcome = gw("run", "straight", "--json")
    (run,) = json.loads(outcome.out)["runs"]
    assert run["folder"] == str(Path("results", "runs", "straight"))
    assert run["status"]["name"] == "completed"
    assert run["trusted"] is True
    assert run["metrics"]["push_force_max"]["unit"] == "N"
    assert isinstance(run["wall_time"], float)
    assert all(Path(file).is_file() for file in run["figures"])
    assert len(run["figures"]) > 1


@pytest.mark.parametrize("status", [status for status in Status if status.is_event])
def test_a_run_that_an_event_ended_is_an_outcome_and_is_told(gw, solver, status):
    solver.status = status
    outcome = gw("run", "straight", "--quiet", "--no-figures")
    assert outcome.code == 0
    assert status.problem in outcome.err
    assert status.remedy in outcome.err
    run = read_run("results/runs/straight")
    assert run.status.status is status


@pytest.mark.parametrize("status", [status for status in Status if not status.trusted])
def test_a_run_that_cannot_be_trusted_is_written_told_and_ends_with_4(gw, solver, status):
    solver.status = status
    outcome = gw("run", "straight", "--quiet", "--no-figures")
    assert outcome.code == 4
    assert status.problem in outcome.err
    assert status.remedy in outcome.err
    assert "t = 12.5 s" in outcome.err
    assert outcome.out.strip() == str(Path("results", "runs", "straight"))
    assert read_run("results/runs/straight").status.status is status


def test_one_bad_run_of_several_ends_with_4_and_the_others_are_run(gw, solver):
    solver.status = Status.TOO_DEEP
    outcome = gw("run", "straight", "arc90", "-q", "--no-figures")
    assert outcome.code == 4
    assert len(outcome.out.split()) == 2


def test_all_problems_of_all_scenarios_are_told_before_anything_is_run(gw, solver):
    Path("bad.yaml").write_text("wire: {model: universal-iii}\n")
    outcome = gw("run", "straight", "bad.yaml", "no-such-thing", "--set", "solver.step=3 m")
    assert outcome.code == 3
    assert outcome.out == ""
    assert solver.scenarios == []
    for part in ("universal-iii", "no-such-thing", "solver.step", "bad.yaml:1: wire.model"):
        assert part in outcome.err


def test_what_the_model_refuses_is_a_bad_scenario(gw, solver):
    outcome = gw("run", "straight", "arc90", "--set", "catheter.exit=[0 mm, 50 mm]")
    assert outcome.code == 3
    assert outcome.err.count("outside the lumen") == 2
    assert solver.scenarios == []


def test_a_warning_of_the_model_is_told(gw, solver):
    outcome = gw("run", "straight", "--set", "contact.wall_stiffness=10", "--no-figures")
    assert outcome.code == 0
    assert "warning: contact.wall_stiffness: 10 N/m lets the wire sink" in outcome.err


def test_two_scenarios_of_one_name_do_not_share_a_folder(gw, solver):
    outcome = gw("run", "straight", "arc90", "--set", "name=same")
    assert outcome.code == 2
    assert "'same'" in outcome.err
    assert solver.scenarios == []


def test_a_folder_that_is_not_ours_is_refused_before_the_run(gw, solver):
    Path("mine").mkdir()
    Path("mine/thesis.txt").write_text("precious")
    outcome = gw("run", "straight", "--out", "mine")
    assert outcome.code == 7
    assert solver.scenarios == []
    assert Path("mine/thesis.txt").read_text() == "precious"


def test_ctrl_c_keeps_what_is_done_and_ends_with_130(gw, solver):
    solver.during = lambda: os.kill(os.getpid(), signal.SIGINT)
    outcome = gw("run", "straight", "arc90", "--no-figures")
    assert outcome.code == 130
    assert outcome.out.split() == [str(Path("results", "runs", "straight"))]
    assert read_run("results/runs/straight").status.status is Status.STOPPED
    assert "not run: arc90" in outcome.err


def test_ctrl_c_twice_gives_up(gw, solver):
    def twice():
        os.kill(os.getpid(), signal.SIGINT)
        os.kill(os.getpid(), signal.SIGINT)

    solver.during = twice
    outcome = gw("run", "straight", "--no-figures")
    assert outcome.code == 130
    assert outcome.out == ""
    assert not Path("results/runs/straight").exists()


def test_an_error_of_any_type_after_ctrl_c_twice_is_an_interruption(gw, solver):
    def in_the_guise_of_the_solver():
        os.kill(os.getpid(), signal.SIGINT)
        try:
            os.kill(os.getpid(), signal.SIGINT)
        except KeyboardInterrupt:
            raise RuntimeError("the solver failed") from None

    solver.during = in_the_guise_of_the_solver
    outcome = gw("run", "straight", "--no-figures")
    assert outcome.code == 130
    assert outcome.err.endswith("interrupted\n")
    assert not Path("results/runs/straight").exists()


def test_the_signals_are_given_back(gw, solver):
    before = signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)
    gw("run", "straight", "-q", "--no-figures")
    assert (signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)) == before
