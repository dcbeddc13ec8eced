"""Running cases, one after the other or in processes of their own."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass

from gw_exudyn.verification.evidence import Case, Evidence, Finding
from gw_exudyn.verification.registry import case_named


@dataclass(frozen=True, eq=False)
class Outcome:
    """What came of a case. problem : why it could not be run to its end, empty where it could."""

    case: Case
    finding: Finding
    problem: str = ""

    @property
    def failing(self) -> tuple[Evidence, ...]:
        """The rows that do not hold."""
        return tuple(row for row in self.finding.rows if not row.holds)

    @property
    def holds(self) -> bool:
        """It ran, it has rows, and every row holds."""
        return not self.problem and bool(self.finding.rows) and not self.failing


def outcome_of(case: Case) -> Outcome:
    """Run a case. An error in it is part of the outcome: the other cases are worth running all the same."""
    try:
        return Outcome(case, case.find())
    except Exception as error:
        return Outcome(case, Finding(()), f"{type(error).__name__}: {error}")


def run_cases(cases: Sequence[Case], jobs: int) -> Iterator[Outcome]:
    """The outcomes as they come. jobs : number of processes; 1 runs them here."""
    if jobs <= 1:
        yield from map(outcome_of, cases)
        return
    # A fresh interpreter each, as Exudyn's threads and matplotlib would not survive a fork.
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, context, initializer=_prepare) as pool:
        try:
            waiting = {pool.submit(_find, case.group, case.name): case for case in cases}
            for done in as_completed(waiting):
                finding, problem = done.result()
                yield Outcome(waiting[done], finding, problem)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _prepare() -> None:
    """In a process of the pool: Ctrl-C is the parent's business, and linear algebra keeps to one thread."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(name, "1")


def _find(group: str, name: str) -> tuple[Finding, str]:
    outcome = outcome_of(case_named(group, name))
    return outcome.finding, outcome.problem
