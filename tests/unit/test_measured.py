"""Measured courses: what a CSV file may hold, what is wrong with one, and the alignment of paths."""

from __future__ import annotations

import numpy as np
import pytest

from gw_exudyn.comparison import Course, compare
from gw_exudyn.errors import ComparisonError, ScenarioError, StorageError
from gw_exudyn.measured import aligned, read_measured


@pytest.fixture
def written(tmp_path):
    def write(text):
        path = tmp_path / "camera.csv"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def told(path):
    with pytest.raises(ScenarioError) as caught:
        read_measured(path)
    return [(problem.line, problem.message) for problem in caught.value.problems]


def test_units_gaps_and_comments(written):
    course = read_measured(written("# camera\ntime [ms],tip_x [mm],tip_y [mm],push_force\n0,1,2,0.1\n66.7,,2.5,nan\n"))
    assert course.name == "camera"
    assert course.time == pytest.approx([0, 0.0667])
    assert course.values["tip_x"] == pytest.approx([1e-3, np.nan], nan_ok=True)
    assert course.values["tip_y"] == pytest.approx([2e-3, 2.5e-3])
    assert course.values["push_force"] == pytest.approx([0.1, np.nan], nan_ok=True)


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("", 1, "is empty"),
        ("time [s],tipx [mm]\n0,1\n1,2\n", 1, "did you mean 'tip_x'"),
        ("time [s];push_force [N]\n0;1\n", 1, "separate with commas"),
        ("tip_x [mm],tip_y [mm]\n0,1\n1,2\n", 1, "no column time"),
        ("time [s],tip_x [mm]\n0,1\n1,2\n", 1, "only one of tip_x and tip_y"),
        ("time [s]\n0\n1\n", 1, "nothing but time"),
        ("time [s],push_force [mm]\n0,1\n1,2\n", 1, "is no unit of the push force"),
        ("time [s],push_force [furlong]\n0,1\n1,2\n", 1, "furlong"),
        ("time [s],push_force [N],push_force [N]\n0,1,1\n1,2,2\n", 1, "twice"),
        ("time [s],push_force [N]\n0,1\n1,two\n", 3, "'two' is no number"),
        ("time [s],push_force [N]\n0,1\n1\n", 3, "has 1 cells, the header 2"),
        ("time [s],push_force [N]\n0,1\n0,2\n", 3, "times rise"),
        ("time [s],push_force [N]\n0,1\n,2\n", 3, "every row needs its time"),
        ("time [s],push_force [N]\n0,1\n", 2, "fewer than two rows"),
    ],
)
def test_what_is_wrong_has_its_line(written, text, line, message):
    found = told(written(text))
    assert any(at == line and message in words for at, words in found), found


def test_all_that_is_wrong_at_once(written):
    assert len(told(written("time [s],push_force [N]\n0,a\n1,b\n2,3,4\n"))) == 3


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(StorageError, match="no such file"):
        read_measured(tmp_path / "none.csv")


def path_of(x, y, name="run"):
    return Course(name, np.linspace(0, 1, len(x)), {"tip_x": np.array(x), "tip_y": np.array(y)})


def test_a_turned_and_shifted_path_lies_on_the_run_again():
    run = path_of([0.0, 0.01, 0.02, 0.025, 0.027, 0.03], [0.0, 0.0, 0.005, 0.02, 0.03, 0.04])
    c, s = np.cos(0.7), np.sin(0.7)
    x, y = run.values["tip_x"], run.values["tip_y"]
    measured = path_of(c * x - s * y + 0.3, s * x + c * y - 0.1, "camera")
    measured.values["tip_x"][1] = np.nan
    assert compare(run, measured)["tip_rms"].value > 0.1
    assert compare(run, aligned(measured, run))["tip_max"].value < 1e-12


def test_alignment_does_not_stretch():
    run = path_of([0.0, 0.01, 0.02], [0.0, 0.0, 0.0])
    twice = path_of([0.0, 0.02, 0.04], [0.0, 0.0, 0.0], "camera")
    assert compare(run, aligned(twice, run))["tip_max"].value == pytest.approx(0.01)


def test_nothing_to_align_by():
    run = path_of([0.0, 0.01], [0.0, 0.0])
    force = Course("cell", run.time, {"push_force": np.zeros(2)})
    with pytest.raises(ComparisonError, match="no path"):
        aligned(force, run)
