"""`gw-exudyn verify`: the evidence that the physics is right."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gw_exudyn.cli import options
from gw_exudyn.cli.console import put, put_json, put_table, stderr_console, tell
from gw_exudyn.errors import SolverError, StorageError

if TYPE_CHECKING:
    from collections.abc import Callable

    from gw_exudyn.verification.evidence import Case
    from gw_exudyn.verification.running import Outcome

FOLDER = Path("results", "verification")
"""Where the evidence goes under the current folder."""


@click.command(
    short_help="Show and write the evidence that the physics is right.",
    help="""Run every case of the evidence, print what was measured beside what it should be, and write the table (CSV
    and Markdown), figures and versions into a folder.

    The exit code is 4 if a row does not hold.""",
)
@click.option("--group", "groups", multiple=True, metavar="NAME", help="Only this group of cases. May be repeated.")
@click.option(
    "--out",
    metavar="DIR",
    help=f"The folder to write to. Without: {FOLDER.as_posix()}. Its older evidence is replaced.",
)
@click.option(
    "--jobs",
    type=click.IntRange(1, 256),
    metavar="N",
    help="Processes to run cases in. Without: as many as there are processors.",
)
@options.as_json
def command(groups: tuple[str, ...], out: str | None, jobs: int | None, as_json: bool) -> int:
    """Run, show, write; the exit code says whether every row holds."""
    from gw_exudyn.verification.folder import write
    from gw_exudyn.verification.registry import cases_of

    cases, folder = cases_of(groups), Path(out) if out else FOLDER
    _make(folder)
    outcomes = _run(cases, jobs or os.cpu_count() or 1)
    write(outcomes, folder, _command_line(groups, out))
    if as_json:
        put_json({"folder": str(folder), "holds": all(o.holds for o in outcomes), "cases": _entries(outcomes)})
    else:
        _show(outcomes)
        put(str(folder))
    failed = [outcome for outcome in outcomes if not outcome.holds]
    for outcome in failed:
        tell(f"{outcome.case.group}: {outcome.case.name}: {outcome.problem or _failing_words(outcome)}")
    return SolverError.exit_code if failed else 0


def _make(folder: Path) -> None:
    """Find out before the work whether there is a place for it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = error.strerror or error
        raise StorageError(f"{folder}: can't be made: {reason}; name another folder (--out)") from error


def _command_line(groups: tuple[str, ...], out: str | None) -> str:
    words = ["gw-exudyn", "verify", *(word for name in groups for word in ("--group", name))]
    return shlex.join([*words, "--out", out] if out else words)


def _run(cases: Sequence[Case], jobs: int) -> list[Outcome]:
    """The outcomes in the order of the cases."""
    from gw_exudyn.verification.running import run_cases

    order = {id(case): number for number, case in enumerate(cases)}
    outcomes: list[Outcome] = []
    with _progress(len(cases)) as report:
        for outcome in run_cases(cases, min(jobs, len(cases))):
            outcomes.append(outcome)
            report(outcome)
    return sorted(outcomes, key=lambda outcome: order[id(outcome.case)])


@contextmanager
def _progress(total: int) -> Iterator[Callable[[Outcome], None]]:
    """Give a function that counts cases: a bar on a terminal, elsewhere a line for each case."""
    console = stderr_console()
    if not console.is_terminal:
        done: list[Outcome] = []

        def tell_case(outcome: Outcome) -> None:
            done.append(outcome)
            verdict = "holds" if outcome.holds else "DOES NOT HOLD"
            tell(f"{len(done)} of {total}: {outcome.case.group}: {outcome.case.name}: {verdict}")

        yield tell_case
        return
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TextColumn("{task.description}", markup=False))
    with Progress(*columns, console=console, transient=True) as bars:
        task = bars.add_task("", total=total)

        def advance(outcome: Outcome) -> None:
            bars.update(task, advance=1, description=f"{outcome.case.group}: {outcome.case.name}")

        yield advance


def _show(outcomes: Sequence[Outcome]) -> None:
    from gw_exudyn.verification.table import rows_of

    head = ("", "group", "case", "quantity", "measured", "", "expected", "+-", "unit")
    rows = [head]
    for group, case, quantity, measured, rule, expected, tolerance, unit, holds, *_ in rows_of(outcomes):
        rows.append(
            ("ok" if holds == "yes" else "FAILS", group, case, quantity, measured, rule, expected, tolerance, unit)
        )
    put_table(rows, numbers=(4, 6, 7))


def _entries(outcomes: Sequence[Outcome]) -> list[dict[str, Any]]:
    from dataclasses import asdict

    return [
        {
            "group": outcome.case.group,
            "case": outcome.case.name,
            "holds": outcome.holds,
            "problem": outcome.problem,
            "rows": [{**asdict(row), "holds": row.holds} for row in outcome.finding.rows],
        }
        for outcome in outcomes
    ]


def _failing_words(outcome: Outcome) -> str:
    rows = [f"{row.quantity} ({row.measured:.4g} {row.unit})" for row in outcome.failing]
    return f"does not hold: {'; '.join(rows)}" if rows else "gave no row"
