"""Every row of evidence that `gw-exudyn verify` shows, held; and what makes a row one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gw_exudyn.errors import UsageError
from gw_exudyn.verification.evidence import Case, Chart, Curve, Evidence, Finding
from gw_exudyn.verification.folder import write
from gw_exudyn.verification.registry import all_cases, case_named, cases_of, groups
from gw_exudyn.verification.running import outcome_of, run_cases
from gw_exudyn.verification.table import as_csv, as_markdown, rounded

ROW = Evidence("deflection", "m", 1.00049, 1.0, 1e-3, "digits of the reference", "a book")


@pytest.mark.parametrize("case", all_cases(), ids=lambda case: f"{case.group}: {case.name}")
def test_the_evidence_holds(case: Case) -> None:
    finding = case.find()
    assert finding.rows, "a case without a row shows nothing"
    for row in finding.rows:
        assert row.tolerance_source, row.quantity
        assert row.source, row.quantity
        assert row.unit, row.quantity
        assert np.isfinite([row.measured, row.expected, row.tolerance]).all(), row.quantity
        assert row.tolerance >= 0, row.quantity
    quantities = [row.quantity for row in finding.rows]
    assert len(set(quantities)) == len(quantities), "two rows of one name"
    failing = [f"{row.quantity}: {row.measured:.6g} {row.rule} {row.expected:.6g}, tolerance {row.tolerance:.3g}"
               for row in finding.rows if not row.holds]  # fmt: skip
    assert not failing, "\n".join(failing)


def test_cases_have_names_of_their_own() -> None:
    names = [(case.group, case.name) for case in all_cases()]
    assert len(set(names)) == len(names)
    assert set(groups()) >= {"independence", "energy", "invariance", "traps"}
    assert case_named(*names[3]) is all_cases()[3]
    assert {case.group for case in cases_of(("traps",))} == {"traps"}
    with pytest.raises(UsageError, match="groups: "):
        cases_of(("trap",))


def test_a_row_holds_within_its_tolerance_only() -> None:
    assert ROW.holds
    assert not replace(ROW, measured=1.0011).holds
    assert not replace(ROW, measured=float("nan")).holds
    assert replace(ROW, rule="at_least").holds
    assert not replace(ROW, rule="at_most").holds
    assert not replace(ROW, rule="at_most", measured=-float("inf")).holds


@pytest.mark.parametrize(
    ("measured", "tolerance", "text"),
    [(1.00049, 1e-3, "1.00049"), (3.1e-13, 1e-5, "0"), (-0.00734, 0.02, "-0.00734"), (2.1234567e-3, 1e-4, "0.0021235")],
)
def test_numbers_are_rounded_to_a_thousandth_of_what_they_are_judged_by(measured, tolerance, text) -> None:
    row = replace(ROW, measured=measured, tolerance=tolerance)
    assert rounded(row.measured, row) == text
    assert abs(float(text) - measured) <= 1e-3 * tolerance


def finding() -> Finding:
    x = np.linspace(0.0, 1.0, 200)
    curves = (Curve("theory", x, x**2, "line"), Curve("measured", x, x**2))
    return Finding((ROW, replace(ROW, quantity="a | b")), (Chart("deflection", "Deflection", "x / mm", "y", curves),))


def failing() -> Finding:
    return Finding((replace(ROW, measured=2.0),))


def broken() -> Finding:
    raise ValueError("no such wire")


CASES = (Case("beam", "good", finding), Case("beam", "wrong", failing), Case("beam", "broken", broken))


def test_an_outcome_holds_where_every_row_does_and_nothing_went_wrong() -> None:
    good, wrong, hurt = run_cases(CASES, jobs=1)
    assert good.holds
    assert not wrong.holds
    assert wrong.failing[0].measured == 2.0
    assert not hurt.holds
    assert hurt.problem == "ValueError: no such wire"
    assert not outcome_of(Case("beam", "empty", lambda: Finding(()))).holds


def test_the_same_evidence_is_written_as_the_same_bytes(tmp_path) -> None:
    outcomes = list(run_cases(CASES, jobs=1))
    first, second = tmp_path / "a", tmp_path / "b"
    files = write(outcomes, first, "gw-exudyn verify")
    write(list(run_cases(CASES, jobs=1)), second, "gw-exudyn verify")
    names = {file.relative_to(first).as_posix() for file in files}
    assert names == {"evidence.csv", "README.md", "versions.json", "figures/deflection.png"}
    for name in names:
        assert (first / name).read_bytes() == (second / name).read_bytes(), name
    text = (first / "README.md").read_text()
    assert "2 of 4 rows hold" in text
    assert "figures/deflection.png" in text
    assert "a \\| b" in text


def test_figures_of_before_go_and_files_of_others_stay(tmp_path) -> None:
    write(list(run_cases(CASES, jobs=1)), tmp_path, "gw-exudyn verify")
    (tmp_path / "figures" / "mine.png").write_bytes(b"mine")
    write(list(run_cases(CASES[1:], jobs=1)), tmp_path, "gw-exudyn verify")
    assert [path.name for path in (tmp_path / "figures").iterdir()] == ["mine.png"]


def test_the_tables_name_what_does_not_hold() -> None:
    outcomes = list(run_cases(CASES, jobs=1))
    lines = as_csv(outcomes).splitlines()
    assert len(lines) == 5
    assert lines[3].startswith("beam,wrong,deflection,2,=,1,0.001,m,no,digits of the reference")
    assert "ValueError: no such wire" in lines[4]
    assert as_markdown(outcomes, "gw-exudyn verify").count("| no |") == 2


def test_processes_give_what_one_gives() -> None:
    cases = [case for case in all_cases() if case.name == "signs of normal force and friction"]
    here, there = list(run_cases(cases, jobs=1)), list(run_cases([*cases, *cases], jobs=2))
    assert as_csv(here * 2) == as_csv(there)
