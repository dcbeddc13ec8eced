"""The rows of all cases as a table: rounded to stated digits, so that the same results give the same bytes.

A measured number is rounded to a thousandth of its tolerance, or of its bound; where there is neither, to four digits.
What lies below is rounding of the processor's, and no evidence.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Sequence

from gw_exudyn.verification.evidence import Evidence
from gw_exudyn.verification.running import Outcome

HEADER = (
    "group",
    "case",
    "quantity",
    "measured",
    "rule",
    "expected",
    "tolerance",
    "unit",
    "holds",
    "tolerance from",
    "expected from",
)
DIGITS = 4
_SIGNS = {"within": "=", "at_most": "<=", "at_least": ">="}


def rows_of(outcomes: Sequence[Outcome]) -> Iterator[tuple[str, ...]]:
    """A row of text for each row of evidence, as HEADER says; one for a case that could not be run."""
    for outcome in outcomes:
        names = outcome.case.group, outcome.case.name
        if outcome.problem:
            yield (*names, outcome.problem, "nan", "", "", "", "", "no", "", "")
        for row in outcome.finding.rows:
            yield (*names, *_row(row))


def _row(row: Evidence) -> tuple[str, ...]:
    tolerance = digits(row.tolerance) if row.rule == "within" else ""
    expected = rounded(row.expected, row) if row.rule == "within" else digits(row.expected)
    holds = "yes" if row.holds else "no"
    numbers = rounded(row.measured, row), _SIGNS[row.rule], expected, tolerance
    return (row.quantity, *numbers, row.unit, holds, row.tolerance_source, row.source)


def rounded(value: float, row: Evidence) -> str:
    """A number of a row, to a thousandth of what it is judged by; at most fifteen digits, as a float has."""
    scale = abs(row.tolerance if row.rule == "within" else row.expected)
    if not math.isfinite(value) or not math.isfinite(scale) or scale == 0:
        return digits(value)
    place = math.floor(math.log10(scale)) - (DIGITS - 1)
    units = round(value / 10.0**place)
    # Digits of the number itself, as many as reach down to the place.
    return f"{units * 10.0**place + 0.0:.{max(1, min(15, len(str(abs(units)))))}g}"


def digits(value: float) -> str:
    """A number to four digits."""
    return f"{value + 0.0:.{DIGITS}g}"


def as_csv(outcomes: Sequence[Outcome]) -> str:
    """The table as CSV; lines end in a line feed on every system."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEADER)
    writer.writerows(rows_of(outcomes))
    return text.getvalue()


def as_markdown(outcomes: Sequence[Outcome], command: str) -> str:
    """The table as Markdown, a section a group, each with its figures."""
    lines = ["# Evidence", "", "```", command, "```", ""]
    held = sum(row.holds for outcome in outcomes for row in outcome.finding.rows)
    total = sum(max(1, len(outcome.finding.rows)) for outcome in outcomes)
    lines += [
        f"{held} of {total} rows hold. Units are SI. A number is rounded to a thousandth of its tolerance or its bound."
    ]
    for group in dict.fromkeys(outcome.case.group for outcome in outcomes):
        members = [outcome for outcome in outcomes if outcome.case.group == group]
        head = ("case", "quantity", "measured", "", "expected", "tolerance", "unit", "holds", *HEADER[-2:])
        lines += ["", f"## {group}", "", _line(head), _line(["---"] * len(head))]
        lines += [_line(row[1:]) for row in rows_of(members)]
        charts = [chart for outcome in members for chart in outcome.finding.charts]
        if charts:
            lines += ["", *(f"![{chart.title}](figures/{chart.name}.png)" for chart in charts)]
    return "\n".join(lines) + "\n"


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|").replace("\n", " ") for cell in cells) + " |"
