"""Simulations of a calibration's points: run in parallel by the study engine, kept by id, so that none runs twice."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from gw_exudyn.calibration.form import Calibration
from gw_exudyn.comparison import COMPARED, PATH, Course
from gw_exudyn.errors import Interrupted, ScenarioError
from gw_exudyn.result import Floats
from gw_exudyn.sweep.folder import SweepFolder, read_point
from gw_exudyn.sweep.identity import Maker, this_maker
from gw_exudyn.sweep.plan import Options, Plan, Progress, is_there
from gw_exudyn.sweep.pool import Pool, pool
from gw_exudyn.sweep.run import Running
from gw_exudyn.sweep.studies.study import Study
from gw_exudyn.sweep.table import read_series


@dataclass(frozen=True, eq=False)
class Simulated:
    """How a point went. course : None where nothing can be believed. completed : it reached its drive's end.
    reason : why there is no course, or why the run ended early.
    """

    course: Course | None
    completed: bool
    reason: str


class Simulations:
    """Runs points of calibrations on workers; points that the folder has are read. Made by `simulations`."""

    def __init__(
        self, place: SweepFolder, workers: Pool, maker: Maker, options: Options, should_stop: Callable[[], bool]
    ) -> None:
        self._place, self._workers, self._maker, self._options = place, workers, maker, options
        self._should_stop = should_stop
        self._asked: set[str] = set()
        self.asked = self.run = self.failed = 0
        """Different points so far; those of them that were run now; and that failed."""

    def __call__(self, calibration: Calibration, points: Sequence[Floats]) -> list[Simulated]:
        """The points' simulations, in order. points : each (parameters,), relative.

        Raises Interrupted where it was stopped, and what a pool raises.
        """
        study = calibration.study(points)
        refused: dict[int, str] = {}
        ids = [self._id(study, i, refused) for i in range(len(points))]
        first: dict[str, int] = {}
        for i, found in enumerate(ids):
            if i not in refused:
                first.setdefault(found, i)
        # What was asked for before has been run in this call, with failure or without.
        new = {found: i for found, i in first.items() if found not in self._asked}
        missing = [i for found, i in new.items() if not is_there(self._place.point(found), self._options)]
        plan = Plan(tuple(ids), first, tuple(missing), self._maker)
        progress = Progress(len(first), earlier=len(first) - len(missing))
        running = Running(study, plan, self._options, self._place, progress, lambda _: None, self._should_stop)
        if missing and not running.run_on(self._workers, missing):
            raise Interrupted("interrupted; the simulations that are done are kept, and the same command goes on")
        if self._should_stop():
            raise Interrupted("interrupted; the simulations that are done are kept, and the same command goes on")
        self._asked |= new.keys()
        self.asked, self.run = len(self._asked), self.run + len(missing)
        done = [
            Simulated(None, False, refused[i]) if i in refused else self._read(found) for i, found in enumerate(ids)
        ]
        self.failed += len(refused) + sum(done[i].course is None for i in new.values())
        return done

    def _id(self, study: Study, point: int, refused: dict[int, str]) -> str:
        try:
            return self._maker.point_id(study.scenario(point).to_dict())
        except ScenarioError as error:
            refused[point] = str(error.problems[0])
            return f"refused-{point}"

    def _read(self, found: str) -> Simulated:
        folder = self._place.point(found)
        content, series = read_point(folder), read_series(folder)
        if content is None:
            return Simulated(None, False, "the point's folder is damaged")
        status = content["status"]
        sentence = str(status.get("sentence", "")).partition(". ")[0].rstrip(".")
        if series is None or not content.get("trusted"):
            return Simulated(None, False, sentence)
        course = Course(found, series["time"], {name: series[name] for name in (*PATH, *COMPARED)})
        return Simulated(course, status.get("name") == "completed", sentence)


@contextmanager
def simulations(
    place: SweepFolder, options: Options, should_stop: Callable[[], bool] = lambda: False
) -> Iterator[Simulations]:
    """Workers and a folder for calibrations, for as long as the block lasts. place : in use. options : as a sweep's."""
    maker = this_maker(options.runner)
    with pool(options.jobs, options.scheduler, options.runner, options.timeout) as workers:
        yield Simulations(place, workers, maker, options, should_stop)
