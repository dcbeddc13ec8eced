"""`gw-exudyn sweep` in this process."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

STUDY = """base: straight
set: {wire.segments: 5, solver.step: 0.5 s, output.interval: 0.5 s, drive.distance: 4 mm}
vary:
  contact.friction_coefficient: [0.1, 0.2]
  wire.diameter: [0.36 mm, 0.00036]
"""


@pytest.fixture
def study() -> str:
    Path("two.yaml").write_text(STUDY)
    return "two.yaml"


def test_a_dry_run_shows_points_time_and_disk_and_writes_nothing(gw, study):
    done = gw("sweep", study, "--dry-run", "--jobs", "2")
    assert done.code == 0
    lines = done.out.splitlines()
    assert lines[0].split() == ["point", "id", "contact.friction_coefficient", "wire.diameter", "[m]"]
    assert [line.split(maxsplit=4)[-1] for line in lines[1:]] == ["to run", "as 0", "to run", "as 2"]
    assert "2 points to run, about" in done.err
    assert "was run to see" in done.err
    assert "MB of disk" in done.err
    assert not Path("results").exists()
    told = json.loads(gw("sweep", study, "--dry-run", "--json").out)
    assert (told["points"], told["unique"], told["missing"]) == (4, 2, 2)
    assert told["estimate"]["all"] > 0
    assert told["list"][2]["contact.friction_coefficient"] == 0.2


def test_a_sweep_tells_its_folder_and_its_summary(gw, study):
    done = gw("sweep", study, "--jobs", "1", "--no-figures", "--json")
    assert done.code == 0, done.err
    told = json.loads(done.out)
    assert (told["points"], told["unique"], told["run"], told["completed"], told["failed"]) == (4, 2, 2, 2, 0)
    assert [Path(file).name for file in told["files"]] == ["sweep.csv", "sweep.nc", "report.html"]
    assert all(Path(file).is_file() for file in told["files"])
    assert "2 of 2 done, 0 failed" in done.err
    about = json.loads(Path(told["folder"], "sweep.json").read_text())
    assert about["command"] == "gw-exudyn sweep two.yaml"
    # A point is a run like others, though not all of it is kept.
    point = next(Path(told["folder"], "points").iterdir())
    assert "every check" in gw("info", str(point)).out
    # By the times of finished points, once there are any.
    assert "the mean of 2 finished" in gw("sweep", study, "--dry-run").err


def test_a_sweep_with_failed_points_ends_with_5_and_says_why(gw, study):
    # Six long segments do not go round the corner.
    Path("bad.yaml").write_text(
        "base: corner90-universal\nset: {wire.segments: 6, solver.step: 0.1 s}\nvary: {drive.distance: [36 mm]}\n"
    )
    done = gw("sweep", "bad.yaml", "--jobs", "1", "--out", "out")
    assert (done.code, done.out) == (5, "out\n")
    assert "too_deep: The wire was pressed into a wall" in done.err
    assert "no point came out well, so there is nothing to draw" in done.err
    assert "0 points completed, 1 failed: out" in done.err


def test_bad_studies_and_options_are_refused(gw, study):
    done = gw("sweep", "no-such-study")
    assert (done.code, done.err) == (3, "no-such-study: there is no such file, and no shipped study of that name\n")
    Path("bad.yaml").write_text("base: straight\nvary:\n  wire.diametr: [1]\n")
    done = gw("sweep", "bad.yaml")
    assert done.code == 3
    assert "bad.yaml:3: vary.wire.diametr: no scenario has this value; did you mean 'diameter'?" in done.err
    assert gw("sweep", study, "--jobs", "0").code == 2
    assert gw("sweep", study, "--timeout", "0").code == 2
    Path("taken").write_text("")
    assert gw("sweep", study, "--out", "taken", "--jobs", "1").code == 7
