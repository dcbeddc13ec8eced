"""`gw-exudyn compare`: norms, what differs, and the exit code of a tolerance."""

from __future__ import annotations

import json
from pathlib import Path

import pytest


@pytest.fixture
def runs(gw, solver) -> list[str]:
    return gw("run", "straight", "arc90", "-q", "--no-figures").out.split()


def test_a_run_is_no_way_from_itself(gw, runs):
    outcome = gw("compare", runs[0], runs[0], "--tolerance", "tip_max=0", "--no-figure")
    assert outcome.code == 0
    assert "the scenarios are the same" in outcome.out


def test_what_differs_and_the_figure(gw, runs):
    outcome = gw("compare", *runs, "--json")
    content = json.loads(outcome.out)
    assert outcome.code == 0
    assert content["scenarios"]["vessel.kind"] == ["straight", "arc"]
    assert content["norms"]["push_force_rms"]["unit"] == "N"
    files = [Path(file) for file in content["figures"]]
    assert files == [Path("results", "runs", f"compare-straight-arc90.{suffix}") for suffix in ("png", "pdf")]
    assert all(file.stat().st_size > 1000 for file in files)


def test_comparisons_of_one_scenario_have_figures_of_their_own(gw, solver):
    for folder in ("coarse", "fine", "finest"):
        gw("run", "straight", "-q", "--no-figures", "--out", folder)
    for other in ("fine", "finest"):
        outcome = gw("compare", "coarse", other)
        assert "the scenarios are the same" in outcome.out
    assert {path.name for path in Path().glob("*.png")} == {"compare-coarse-fine.png", "compare-coarse-finest.png"}


@pytest.fixture
def coarse(gw) -> list[str]:
    """Two runs of the true solver that differ in friction."""
    small = ("--set", "wire.segments=10", "--set", "drive.distance=40 mm", "-q", "--no-figures")
    return [
        gw(
            "run", "corner90-universal", *small, "--set", f"contact.friction_coefficient={friction}", "--out", friction
        ).out.strip()
        for friction in ("0.1", "0.5")
    ]


def test_beyond_a_tolerance_ends_with_6(gw, coarse):
    outcome = gw("compare", *coarse, "--tolerance", "push_force_max=1 uN", "--no-figure")
    assert outcome.code == 6
    assert "push_force_max" in outcome.err
    assert "is beyond 0.001 mN" in outcome.err
    assert gw("compare", *coarse, "--tolerance", "push_force_max=10 N", "--no-figure").code == 0


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ("tip_mx=0.1 mm", "did you mean 'tip_max'"),
        ("tip_max=0.1 N", "is a force, not a length"),
        ("tip_max=-1", "zero or more"),
        ("tip_max", "does not begin with a number"),
    ],
)
def test_a_tolerance_that_is_none_is_wrong_use(gw, runs, given, sentence):
    outcome = gw("compare", runs[0], runs[0], "--tolerance", given, "--no-figure")
    assert outcome.code == 2
    assert sentence in outcome.err


def test_a_measured_path_and_force(gw, coarse):
    rows = Path(coarse[0], "series.csv").read_text(encoding="utf-8").splitlines()
    head = rows[0].split(",")
    columns = [head.index(name) for name in ("time [s]", "tip_x [m]", "tip_y [m]", "push_force [N]")]
    lines = [",".join(row.split(",")[column] for column in columns) for row in rows[::3]]
    Path("camera.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    outcome = gw("compare", coarse[0], "camera.csv", "--tolerance", "tip_rms=0.2 mm", "--json")
    content = json.loads(outcome.out)
    assert outcome.code == 0
    assert content["aligned"] is False
    assert "common" not in outcome.err
    assert content["scenarios"] is None
    assert {name.rpartition("_")[0] for name in content["norms"]} == {"tip", "tip_nearest", "push_force"}
    assert Path(content["figures"][0]).name == "compare-corner90-universal-camera.png"
    assert "as they are in the file" in gw("compare", coarse[0], "camera.csv", "--no-figure").out
    outcome = gw("compare", coarse[0], "camera.csv", "--align", "--no-figure")
    assert outcome.code == 0
    assert "turned and shifted onto A's" in outcome.out
    assert "places are as" not in outcome.out
    assert json.loads(gw("compare", coarse[0], "camera.csv", "--align", "--no-figure", "--json").out)["aligned"] is True


def test_a_clock_of_its_own_is_told(gw, runs):
    """A camera that was switched on long before the push shares little of the run's time."""
    end = float(Path(runs[0], "series.csv").read_text(encoding="utf-8").splitlines()[-1].split(",")[0])
    for part, told in ((0.4, False), (0.9, True)):
        rows = (f"{end * (part + i / 10)},{i},0" for i in range(11))
        Path("late.csv").write_text("\n".join(("time [s],tip_x [mm],tip_y [mm]", *rows)) + "\n", encoding="utf-8")
        outcome = gw("compare", runs[0], "late.csv", "--no-figure")
        assert outcome.code == 0
        assert ("Time 0 is the start of the drive" in outcome.err) is told


def test_a_bad_measured_file_is_told_with_its_line(gw, runs):
    Path("bad.csv").write_text("time [s],push_force [N]\n0,1\n1,x\n", encoding="utf-8")
    outcome = gw("compare", runs[0], "bad.csv")
    assert outcome.code == 3
    assert "bad.csv:3: push_force: 'x' is no number" in outcome.err
    assert gw("compare", *runs, "--align").code == 2


def test_a_norm_without_pairs_is_told(gw, runs):
    """The camera has ended before the run's first output after the start, so that no instant is known of both."""
    header = "time [s],tip_x [mm],tip_y [mm],push_force [mN]"
    rows = ("1e-3,0,0,", "2e-3,0,0,", "9,,,1", "10,,,2")
    Path("short.csv").write_text("\n".join((header, *rows)) + "\n", encoding="utf-8")
    outcome = gw("compare", runs[0], "short.csv", "--tolerance", "tip_max=1 mm", "--no-figure")
    assert outcome.code == 6
    assert "no number for tip_rms, tip_max" in outcome.err
    assert "tip_max: at no time have both a value" in outcome.err
    assert "is beyond" not in outcome.err
