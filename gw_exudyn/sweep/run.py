"""A sweep from its study to its folder: which points are missing, running them, and what comes out."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

from gw_exudyn.storage.manifest import MANIFEST, MARKER, to_text
from gw_exudyn.sweep.folder import SweepFolder
from gw_exudyn.sweep.identity import Maker, decisive
from gw_exudyn.sweep.plan import Options, Plan, Progress, Summary, is_there, make_plan
from gw_exudyn.sweep.pool import Pool, pool
from gw_exudyn.sweep.rerun import rerun
from gw_exudyn.sweep.runner import Outcome, Task
from gw_exudyn.sweep.studies.study import Study


def run_sweep(
    study: Study,
    folder: Path,
    options: Options | None = None,
    *,
    plan: Plan | None = None,
    report: Callable[[Progress], None] = lambda _: None,
    should_stop: Callable[[], bool] = lambda: False,
) -> Summary:
    """Run what is missing of a study, and write its table, data set and figures.

    plan : of `make_plan`, made here if not given. report : called a few times a second. should_stop : asked as often;
    True ends the sweep, what is done is kept.

    Raises ScenarioError for points that cannot start, StorageError for the folder or the disk, UsageError for a
    scheduler that does not answer, SolverError where the workers cannot run anything.
    """
    options = options or Options(command=f"gw-exudyn sweep {study.file}")
    plan = plan or make_plan(study, folder, options)
    with SweepFolder(folder) as place:
        # Again under the lock: another sweep may have gone on in between, or a point may have vanished.
        missing = [
            point for point in plan.missing if options.fresh or not is_there(place.point(plan.ids[point]), options)
        ]
        place.write_about(_about(study, plan, options))
        if options.fresh:
            place.clear()
        progress = Progress(len(plan.first), earlier=len(plan.first) - len(missing))
        summary = Summary(folder, len(plan.ids), len(plan.first), progress.earlier)
        sweep = Running(study, plan, options, place, progress, report, should_stop)
        summary.interrupted = not sweep.run(missing)
        summary.run = progress.done
        from gw_exudyn.sweep.outputs import write_outputs, write_page

        write_outputs(study, plan, options, place, summary, sweep.run_whole if not summary.interrupted else None)
        files = [file.relative_to(folder).as_posix() for file in summary.files]
        place.write_about({**_about(study, plan, options), "summary": _counts(summary), "files": files})
        write_page(folder, summary)
    return summary


class Running:
    """The running part of a sweep."""

    def __init__(
        self,
        study: Study,
        plan: Plan,
        options: Options,
        place: SweepFolder,
        progress: Progress,
        report: Callable[[Progress], None],
        should_stop: Callable[[], bool],
    ) -> None:
        self._study, self._plan, self._options, self._place = study, plan, options, place
        self._progress, self._report, self._should_stop = progress, report, should_stop

    def run(self, points: list[int]) -> bool:
        """Run points; False if stopped on the way."""
        self._report(self._progress)
        if not points:
            return True
        with self._pool() as workers:
            return self.run_on(workers, points)

    def run_on(self, workers: Pool, points: list[int]) -> bool:
        """Run points on workers that somebody else has; False if stopped on the way."""
        return workers.run(self._tasks(points), self._keep, self._should_stop, lambda: self._look(workers))

    def run_whole(self, point: int) -> Mapping[str, bytes]:
        """The files of the whole run folder of a point, run for them alone; none where that did not work out."""
        from gw_exudyn.sweep.point_process import PointProcess

        process = PointProcess(self._options.runner, self._options.timeout)
        try:
            return process.run(next(self._tasks([point], whole=True))).files
        finally:
            process.close()

    def _pool(self) -> AbstractContextManager[Pool]:
        options = self._options
        return pool(options.jobs, options.scheduler, options.runner, options.timeout)

    def _look(self, workers: Pool) -> None:
        self._progress.threads = workers.threads
        self._report(self._progress)

    def _tasks(self, points: list[int], whole: bool | None = None) -> Iterator[Task]:
        for point in points:
            found = self._plan.ids[point]
            note = {
                "point": {"id": found, "parameters": self._study.design.labels(point), "code": self._plan.maker.code}
            }
            scenario = self._study.scenario(point).to_dict()
            keep = self._options.keep_runs if whole is None else whole
            yield Task(found, scenario, note, self._options.command, keep)

    def _keep(self, task: Task, outcome: Outcome) -> None:
        outcome = self._checked(outcome)
        files = outcome.files if MANIFEST in outcome.files else {MANIFEST: _failure(task, outcome, self._plan.maker)}
        self._place.add(task.id, files)
        self._progress.done += 1
        self._progress.failed += not outcome.trusted

    def _checked(self, outcome: Outcome) -> Outcome:
        """The outcome, unless it was made by other software than the point's id says."""
        if not outcome.versions:
            return outcome
        theirs = decisive(outcome.versions)
        differ = [
            f"{name} {theirs[name]} there, {version} here"
            for name, version in self._plan.maker.versions.items()
            if theirs[name] != version
        ]
        if not differ:
            return outcome
        return Outcome("error", f"The worker has other software: {'; '.join(differ)}. Install the same on both.")


def _failure(task: Task, outcome: Outcome, maker: Maker) -> bytes:
    """run.json of a point that gave no result."""
    content = {
        "format": MARKER,
        "format_version": 1,
        "name": task.scenario.get("name", ""),
        "status": {"name": outcome.status, "sentence": outcome.sentence, "time": None, "place": "", "detail": ""},
        "trusted": False,
        "wall_time": None,
        "metrics": {},
        "snaps": [],
        "counters": {},
        "peaks": {},
        "command": task.command,
        "versions": dict(maker.versions),
        "provenance": dict(task.note),
        "files": {},
        "scenario": task.scenario,
    }
    return to_text(content).encode()


def _about(study: Study, plan: Plan, options: Options) -> dict[str, Any]:
    return {
        "name": study.name,
        "base": study.base,
        "mode": study.mode,
        "method": study.method if study.mode == "sample" else None,
        "samples": study.samples or None,
        "seed": study.seed if study.mode == "sample" else None,
        "set": dict(study.fixed),
        "parameters": {axis.path: axis.unit for axis in study.design.axes},
        "metrics": list(study.metrics),
        "points": len(plan.ids),
        "unique_points": len(plan.first),
        "command": options.command,
        "versions": dict(plan.maker.versions),
        "code": plan.maker.code,
        "run": rerun(study),
    }


def _counts(summary: Summary) -> dict[str, Any]:
    return {name: getattr(summary, name) for name in ("completed", "failed", "interrupted")}
