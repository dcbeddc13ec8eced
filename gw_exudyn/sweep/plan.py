"""What a sweep will do and what it came to: its options, the points that are missing, progress and summary."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from gw_exudyn.errors import ScenarioError
from gw_exudyn.storage.netcdf import DATA
from gw_exudyn.sweep.folder import POINTS, read_point
from gw_exudyn.sweep.identity import Maker, this_maker
from gw_exudyn.sweep.runner import SIMULATION
from gw_exudyn.sweep.studies.problems import ProblemList
from gw_exudyn.sweep.studies.study import Study

_FAILURES_TOLD = 1000
"""Failed points that a summary names; sweep.csv has them all."""


@dataclass(frozen=True)
class Options:
    """How a sweep is run. jobs, scheduler, timeout, runner : as `pool` takes them. keep_runs : whole run folders.
    retry_failed : run failed points again. fresh : run all points again. figures : draw. command : what a person types
    to repeat it.
    """

    jobs: int = 1
    scheduler: str | None = None
    timeout: float | None = None
    keep_runs: bool = False
    retry_failed: bool = False
    fresh: bool = False
    figures: bool = True
    command: str = ""
    runner: str = SIMULATION


@dataclass
class Progress:
    """How far a sweep is. points : different ones in all. earlier : done before this call. done : in this call, of
    which failed: gave nothing that can be trusted. threads : of all workers.
    """

    points: int
    earlier: int = 0
    done: int = 0
    failed: int = 0
    threads: int = 0


@dataclass(frozen=True)
class Failure:
    """A point that failed: id, number of its first row in the table, status and reason."""

    id: str
    point: int
    status: str
    reason: str


@dataclass
class Summary:
    """What a sweep came to. points : rows of the table. unique : different points. earlier : done before this call.
    run : run in this call. completed, failed : of all that are done. failures : the first thousand. interrupted : it
    was stopped before its end.
    """

    folder: Path
    points: int
    unique: int
    earlier: int
    run: int = 0
    completed: int = 0
    failed: int = 0
    failures: list[Failure] = field(default_factory=list)
    interrupted: bool = False
    files: list[Path] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Plan:
    """The points of a study by id, and which are there already.

    ids : of every point of the design, in order. first : number of the first point with an id. missing : numbers of the
    points to run.
    """

    ids: tuple[str, ...]
    first: Mapping[str, int]
    missing: tuple[int, ...]
    maker: Maker


def make_plan(study: Study, folder: Path, options: Options, look: Callable[[int], None] = lambda _: None) -> Plan:
    """Check all points of a study and find out which are to be run. Changes nothing.

    look : called with the number of points that were checked. Raises ScenarioError with everything that is wrong.
    """
    maker, problems = this_maker(options.runner), ProblemList()
    ids: list[str] = []
    first: dict[str, int] = {}
    missing: list[int] = []
    for point in range(len(study)):
        look(point)
        try:
            scenario = study.scenario(point)
            found = maker.point_id(scenario.to_dict())
            ids.append(found)
            if found in first:
                continue
            first[found] = point
            if not options.fresh and is_there(folder / POINTS / found, options):
                continue
            missing.append(point)
            _build(study, point, scenario)
        except ScenarioError as error:
            problems.add(error.problems)
            if problems.full:
                break
    problems.raise_if_any()
    return Plan(tuple(ids), first, tuple(missing), maker)


def _build(study: Study, point: int, scenario: Any) -> None:
    """Find out whether a scenario can start. Raises ScenarioError with places in the study file."""
    from gw_exudyn import model

    try:
        model.build(scenario)
    except ScenarioError as error:
        raise ScenarioError(study.placed(error.problems, point)) from None


def is_there(folder: Path, options: Options) -> bool:
    """Whether a point is done, as far as the options care."""
    content = read_point(folder)
    if content is None:
        return False
    good = content.get("trusted") is True
    if options.retry_failed and not good:
        return False
    return not (options.keep_runs and good and not (folder / DATA).is_file())


def note_failure(summary: Summary, failure: Failure) -> None:
    """Count a failed point, and name it if there is room."""
    summary.failed += 1
    if len(summary.failures) < _FAILURES_TOLD:
        summary.failures.append(failure)
