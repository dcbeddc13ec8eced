"""`gw-exudyn plot`: which files come of which runs."""

from __future__ import annotations

from pathlib import Path

import pytest
from matplotlib.figure import Figure

from gw_exudyn import plots
from gw_exudyn.cli import plot
from gw_exudyn.cli.apart import names_apart
from gw_exudyn.plots import FIGURES
from gw_exudyn.storage import read_run


@pytest.fixture
def runs(gw, solver) -> list[str]:
    return gw("run", "straight", "arc90", "-q", "--no-figures").out.split()


def test_the_names_are_those_of_the_figures():
    assert set(plot.FIGURES) == set(FIGURES)
    assert set(plot.TOGETHER) <= set(FIGURES)


def test_one_run_is_drawn_into_its_folder(gw, runs):
    outcome = gw("plot", runs[0], "--figure", "insertion", "--figure", "energy")
    assert outcome.code == 0
    folder = Path(runs[0], "figures")
    assert {Path(line) for line in outcome.out.splitlines()} == set(folder.iterdir())
    assert {path.name for path in folder.iterdir()} == {"insertion.png", "insertion.pdf", "energy.png", "energy.pdf"}


def test_several_runs_are_drawn_side_by_side_beside_the_first(gw, runs):
    outcome = gw("plot", *runs, "--figure", "insertion")
    files = [Path(line) for line in outcome.out.splitlines()]
    assert files == [Path("results", "runs", f"insertion-straight-arc90.{suffix}") for suffix in ("png", "pdf")]
    assert all(file.stat().st_size > 1000 for file in files)


@pytest.fixture
def alike(gw, solver) -> list[str]:
    """Three runs of one scenario, and one of another; two folders have the same name."""
    folders = ["coarse", "fine", "old/fine"]
    for folder in folders:
        gw("run", "straight", "-q", "--no-figures", "--out", folder)
    gw("run", "arc90", "-q", "--no-figures", "--out", "other")
    return [*folders, "other"]


def test_runs_of_one_scenario_are_told_apart_by_their_folders(gw, alike, monkeypatch):
    drawn = []
    monkeypatch.setattr(plots, "plot_forces", lambda results: drawn.extend(results) or Figure())
    outcome = gw("plot", "coarse", "fine", "other", "--figure", "forces")
    assert Path("forces-coarse-fine-arc90.png").is_file(), outcome.err
    assert [result.scenario.name for result in drawn] == ["coarse", "fine", "arc90"]


def test_folders_of_one_name_are_told_apart_by_those_above(alike):
    runs = [read_run(folder) for folder in alike]
    above = Path.cwd().name
    names = names_apart(runs, [Path(folder) for folder in alike])
    assert names == [f"{above}-coarse", f"{above}-fine", "old-fine", "arc90"]
    assert names_apart([runs[0], runs[0]], [Path("coarse")] * 2) == ["straight", "straight"]


def test_all_figures_that_show_several_runs(gw, runs):
    gw("plot", *runs, "--out", "drawn")
    names = {path.name.split("-")[0] for path in Path("drawn").iterdir()}
    assert names == set(plot.TOGETHER)


def test_a_figure_that_is_not_there_is_wrong_use(gw, runs):
    outcome = gw("plot", runs[0], "--figure", "inserton")
    assert outcome.code == 2
    assert "did you mean 'insertion'" in outcome.err
    outcome = gw("plot", *runs, "--figure", "energy")
    assert outcome.code == 2
    assert "shows one run" in outcome.err
