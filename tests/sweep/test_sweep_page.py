"""The page of a sweep, from its folder: what it tells is what the folder holds, finished or not."""

from __future__ import annotations

import dataclasses
import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from gw_exudyn.errors import StorageError
from gw_exudyn.metrics import metrics
from gw_exudyn.report.curves import chosen
from gw_exudyn.report.study_page import Kept, Outcome, study_page
from gw_exudyn.scenario import load_scenario
from gw_exudyn.simulation import simulate
from gw_exudyn.sweep import load_study
from gw_exudyn.sweep.page import page_of, save_study_page
from gw_exudyn.sweep.plan import Options
from gw_exudyn.sweep.run import run_sweep

OUT = Path("out")
TRIVIAL = "{wire.segments: 5, solver.step: 0.5 s, output.interval: 0.5 s, drive.distance: 4 mm}"
GRID = f"""base: straight
set: {TRIVIAL}
vary:
  wire.diameter: [0.3 mm, 0.36 mm]
  contact.friction_coefficient: [0.4, 0.1]
"""
PLAIN = Options(jobs=1, figures=False, command="gw-exudyn sweep study.yaml")


def column(page, label):
    return next(column for column in page.columns if column.label == label)


def again(page, row):
    """The scenario of a point, from the words of the page's command."""
    words = [*page.command[3:]]
    for one in page.columns:
        if one.role == "parameter":
            value = one.values[row]
            text = page.values[one.label][value] if isinstance(value, str) else repr(float(value))
            words += ["--set", f"{one.label}={text}"]
    assert words[::2] == ["--set"] * (len(words) // 2)
    return load_scenario(page.command[2], words[1::2])


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A sweep that is done: its study, its folder, and the files that it named."""
    home = tmp_path_factory.mktemp("finished")
    (home / "grid.yaml").write_text(GRID)
    study = load_study(home / "grid.yaml")
    return study, home / "out", run_sweep(study, home / "out", PLAIN).files


@pytest.fixture
def folder(finished):
    """A copy of its folder, to change."""
    return Path(shutil.copytree(finished[1], OUT))


def test_it_tells_what_the_points_came_to(finished):
    study, folder, files = finished
    assert files[-1] == folder / "report.html"
    page = page_of(folder)
    assert page.outcome.tolist() == [Outcome.GOOD] * 4
    assert page.kept.tolist() == [Kept.SERIES] * 4
    assert column(page, "point").values.tolist() == [0, 1, 2, 3]
    assert column(page, "wire.diameter").values.tolist() == [0.3e-3, 0.3e-3, 0.36e-3, 0.36e-3]
    assert (column(page, "wire.diameter").unit, column(page, "push force max").unit) == ("mm", "mN")
    result = simulate(study.scenario(2))
    assert column(page, "push force max").values[2] == metrics(result)["push_force_max"].value
    assert column(page, "push force max").meaning == metrics(result)["push_force_max"].meaning
    assert np.array_equal(page.curves.series["push_force"][2], result.values("push_force"))
    assert np.array_equal(page.curves.time, result.time)
    assert page.first == np.argmin(column(page, "push force max").values)


def test_the_page_of_the_sweep_and_that_of_its_folder_are_the_same(finished, tmp_path):
    again = save_study_page(finished[1], tmp_path / "again.html")
    assert again.read_bytes() == (finished[1] / "report.html").read_bytes()


def test_a_point_runs_again_by_itself_as_it_was(study):
    named = "{values: [straight, {kind: arc, length: 5 mm, angle: 20 deg}], labels: [none, some]}"
    shapes = named.replace("straight", "{kind: straight}")
    found = study(
        f"wire.tip_shape: {shapes}\ncontact.friction_coefficient: {{uniform: [0.1, 0.3]}}", mode="sample", samples=4
    )
    run_sweep(found, OUT, PLAIN)
    page = page_of(OUT)
    assert set(column(page, "wire.tip_shape").values) == {"none", "some"}
    for row in range(4):
        assert again(page, row).to_dict() == found.scenario(row).to_dict()


def test_a_stopped_sweep_tells_what_was_not_run_and_finds_a_base_beside_the_study(study, tmp_path):
    shutil.copy(Path(__file__).parents[2] / "scenarios" / "straight.yaml", tmp_path / "mine.yaml")
    found = study("contact.friction_coefficient: {linspace: [0.1, 0.4, 8]}", base="mine.yaml")
    done = []
    run_sweep(found, OUT, PLAIN, report=lambda progress: done.append(progress.done), should_stop=lambda: bool(done[-1]))
    page = page_of(OUT)
    assert set(page.outcome) == {Outcome.GOOD, Outcome.NOT_RUN}
    assert again(page, 7).to_dict() == found.scenario(7).to_dict()


def test_failed_points_and_whole_runs_are_told_apart(study):
    settings = "{wire.segments: 6, solver.step: 0.1 s, output.interval: 0.5 s}"
    found = study("drive.distance: [4 mm, 36 mm]", base="corner90-universal", set=settings)
    run_sweep(found, OUT, dataclasses.replace(PLAIN, keep_runs=True))
    page = page_of(OUT)
    assert page.outcome.tolist() == [Outcome.GOOD, Outcome.FAILED]
    assert page.kept.tolist() == [Kept.WHOLE, Kept.WHOLE]
    assert column(page, "reason").values[0] == ""
    assert (
        "can't be trusted" in column(page, "reason").values[1] or "can be trusted" in column(page, "reason").values[1]
    )
    assert sorted(page.runs) == [0, 1]
    assert [page.runs[row]["trusted"] for row in (0, 1)] == [True, False]
    # The failed one has no say in what the study found.
    good = column(page, "push force max").values[0]
    assert column(page, "push force max").values[1] > good
    assert page.measured[1][0][1] == page.measured[1][0][3]


def test_a_sweep_that_was_killed_tells_what_it_got_to(folder):
    whole = page_of(folder)
    about = json.loads((folder / "sweep.json").read_text())
    del about["summary"], about["files"]  # as a sweep leaves it that has not come to its end
    (folder / "sweep.json").write_text(json.dumps(about))
    shutil.rmtree(folder / "points" / whole.columns[1].values[0])
    page = page_of(folder)
    assert "did not come to its end" in page.notes[0]
    assert '<p class="status waiting">3 of 4 points: 3 came out well</p>' in study_page(page)
    # By their parameters: the first friction of the first diameter is gone, and 0.1 stands before 0.4.
    assert column(page, "contact.friction_coefficient").values.tolist() == [0.1, 0.1, 0.4]
    forces, rows = column(whole, "push force max").values, [1, 3, 2]
    assert column(page, "push force max").values.tolist() == forces[rows].tolist()
    assert np.allclose(page.curves.series["push_force"], whole.curves.series["push_force"][rows])


def test_a_sweep_without_a_point_has_a_page(folder):
    about = json.loads((folder / "sweep.json").read_text())
    del about["summary"]
    (folder / "sweep.json").write_text(json.dumps(about))
    shutil.rmtree(folder / "points")
    assert '<p class="status waiting">0 of 4 points: 0 came out well</p>' in study_page(page_of(folder))


def test_a_folder_of_something_else_and_a_damaged_table_are_refused(folder, tmp_path):
    with pytest.raises(StorageError, match="is no folder of a sweep"):
        page_of(tmp_path)
    whole = (folder / "sweep.csv").read_text()
    for damaged in ("", "point,id\n", "point,id\n1,2\n", whole[: len(whole) // 2]):
        (folder / "sweep.csv").write_text(damaged)
        with pytest.raises(StorageError, match="is damaged; give the command of the sweep again: gw-exudyn sweep"):
            page_of(folder)


def test_many_points_take_fewer_and_coarser_curves():
    names = ["push_force", "insertion_depth", "tip_x", "tip_y"]
    assert [len(part) for part in chosen(names, 10, 80, 2)] == [4, 80]
    some, instants = chosen(names, 10_000, 80, 2)
    assert some == names[:2]
    assert 30 <= len(instants) < 80
    assert (instants[0], instants[-1]) == (0, 79)
    assert chosen(names, 100_000, 80, 2)[0] == []
