"""`gw-exudyn report`: one page, where it is asked for."""

from __future__ import annotations

from pathlib import Path


def test_a_page_of_two_runs(gw, solver):
    runs = gw("run", "straight", "arc90", "-q", "--no-figures").out.split()
    outcome = gw("report", *runs, "-o", "page.html", "--title", "Two & a half", "--no-figures")
    assert (outcome.code, outcome.out.strip()) == (0, "page.html")
    assert "<title>Two &amp; a half</title>" in Path("page.html").read_text(encoding="utf-8")


def test_a_page_with_figures_lies_in_the_run_folder_and_is_small(gw, solver):
    run = gw("run", "straight", "-q", "--no-figures").out.strip()
    assert gw("report", run).code == 0
    page = Path(run, "report.html")
    assert 1e5 < page.stat().st_size < 5e6


def test_a_page_that_cannot_be_written_ends_with_7(gw, solver):
    run = gw("run", "straight", "-q", "--no-figures").out.strip()
    Path("taken").touch()
    outcome = gw("report", run, "-o", "taken/page.html", "--no-figures")
    assert outcome.code == 7
    assert "name another place" in outcome.err


def test_two_runs_of_one_scenario_are_called_by_their_folders(gw, solver):
    for folder in ("coarse", "fine"):
        gw("run", "straight", "-q", "--no-figures", "--out", folder)
    gw("report", "coarse", "fine", "-o", "page.html", "--no-figures")
    page = Path("page.html").read_text(encoding="utf-8")
    assert "<title>coarse and fine</title>" in page
    assert "straight (1)" not in page
    assert "inputs of fine" in page


STUDY = """base: straight
set: {wire.segments: 5, solver.step: 0.5 s, output.interval: 0.5 s, drive.distance: 4 mm}
vary: {contact.friction_coefficient: [0.1, 0.2]}
"""


def test_a_page_of_a_sweep_lies_in_its_folder_and_stands_alone(gw, solver):
    Path("two.yaml").write_text(STUDY)
    folder = gw("sweep", "two.yaml", "-q", "--jobs", "1").out.strip()
    whole = Path(folder, "report.html")
    figures = whole.read_text(encoding="utf-8").count("data:image/png")
    assert figures == len(list(Path(folder, "figures").glob("*.png"))) > 0
    outcome = gw("report", folder, "--no-figures", "--title", "Two & a half", "-o", "page.html")
    assert (outcome.code, outcome.out.strip()) == (0, "page.html")
    page = Path("page.html").read_text(encoding="utf-8")
    assert "<title>Two &amp; a half</title>" in page
    assert "data:image/png" not in page
    outcome = gw("report", folder, folder)
    assert outcome.code == 2
    assert "alone" in outcome.err
