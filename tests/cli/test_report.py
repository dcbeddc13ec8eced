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
