"""`gw-exudyn verify`: what it shows and writes, and its exit code."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gw_exudyn.verification import registry
from gw_exudyn.verification.evidence import Case, Evidence, Finding

ROW = Evidence("deflection", "m", 1.0, 1.0, 1e-3, "digits of the reference", "a book")
WRONG = Evidence("force", "N", 2.0, 1.0, 1e-3, "digits of the reference", "a book")


@pytest.fixture
def cases(monkeypatch):
    """Two quick cases in place of all."""
    quick = (Case("beam", "good", lambda: Finding((ROW,))), Case("column", "wrong", lambda: Finding((WRONG,))))
    monkeypatch.setattr(registry, "all_cases", lambda: quick)
    return quick


def test_rows_that_hold_end_with_nought(gw, cases):
    done = gw("verify", "--group", "beam", "--jobs", "1")
    assert done.code == 0
    assert "deflection" in done.out
    assert done.out.splitlines()[-1] == "results/verification"
    assert "1 of 1: beam: good: holds" in done.err
    assert "gw-exudyn verify --group beam" in Path("results/verification/README.md").read_text()


def test_a_row_that_does_not_hold_is_told_and_ends_with_four(gw, cases):
    done = gw("verify", "--jobs", "1", "--out", "here")
    assert done.code == 4
    assert "column: wrong: does not hold: force (2 N)" in done.err
    assert "FAILS" in done.out
    assert Path("here/evidence.csv").read_text().count("\n") == 3


def test_json_is_for_programs(gw, cases):
    done = gw("verify", "--json", "--jobs", "1")
    content = json.loads(done.out)
    assert content["holds"] is False
    assert [case["holds"] for case in content["cases"]] == [True, False]
    assert content["cases"][0]["rows"][0]["measured"] == 1.0


def test_an_unknown_group_is_answered_with_those_there_are(gw, cases):
    done = gw("verify", "--group", "beams")
    assert done.code == 2
    assert "groups: beam, column" in done.err


def test_a_file_in_the_way_is_told_before_the_work(gw, cases):
    Path("taken").write_text("mine")
    done = gw("verify", "--out", "taken", "--jobs", "1")
    assert done.code == 7
    assert "taken: can't be made" in done.err
    assert "1 of" not in done.err
