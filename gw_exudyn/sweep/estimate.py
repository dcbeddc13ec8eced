"""What a sweep will cost, before it is run."""

from __future__ import annotations

import shutil
import statistics
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from gw_exudyn.storage.manifest import MANIFEST
from gw_exudyn.sweep.folder import POINTS, read_point
from gw_exudyn.sweep.plan import Options, Plan
from gw_exudyn.sweep.studies.study import Study

_TRIAL = 3.0
"""Seconds for which a point is run to measure its speed."""

_LOOKED_AT = 50
"""Finished points whose times are taken, at most."""


@dataclass(frozen=True)
class Estimate:
    """points : to run. seconds : for one point on one core; all : for all on the workers there are, None for those of
    a cluster. disk : bytes for all. free : bytes free there. source : where the time comes from.
    """

    points: int
    seconds: float
    all: float | None
    disk: float
    free: float
    source: str

    def to_dict(self) -> dict[str, Any]:
        """As plain data."""
        return asdict(self)

    def sentences(self) -> Iterator[str]:
        """The same in words."""
        yield f"{self.points} points to run, about {self.seconds:.2g} s each ({self.source})"
        if self.all is not None:
            yield f"about {self.all:.3g} s in all; the start of the workers, some seconds, comes to it"
        yield f"about {self.disk / 1e6:.3g} MB of disk, {self.free / 1e6:.3g} MB are free"


def estimate(study: Study, plan: Plan, folder: Path, options: Options) -> Estimate:
    """Time and disk for the missing points: by those that are done, else by running one of them for a moment."""
    done = _by_finished(plan, folder)
    if done is not None:
        seconds, size, source = done
    elif plan.missing:
        seconds, size, source = _by_trial(study, plan.missing[len(plan.missing) // 2], options)
    else:
        seconds, size, source = 0.0, 0.0, "nothing is left to run"
    count = len(plan.missing)
    workers = None if options.scheduler is not None else min(options.jobs, max(count, 1))
    in_all = None if workers is None else seconds * count / workers
    # sweep.nc holds the time series once more, and better packed.
    return Estimate(count, seconds, in_all, 1.5 * size * count, _free(folder), source)


def _free(folder: Path) -> float:
    there = folder.absolute()
    while not there.exists():
        there = there.parent
    return float(shutil.disk_usage(there).free)


def _by_finished(plan: Plan, folder: Path) -> tuple[float, float, str] | None:
    """Mean time and size of points that came out well."""
    missing = {plan.ids[point] for point in plan.missing}
    times: list[float] = []
    sizes: list[int] = []
    for found in plan.first:
        if found in missing or len(times) == _LOOKED_AT:
            continue
        content = read_point(folder / POINTS / found)
        if content is not None and content.get("wall_time") is not None:
            times.append(float(content["wall_time"]))
            sizes.append(sum(file.stat().st_size for file in (folder / POINTS / found).iterdir()))
    if not times:
        return None
    count = f"the mean of {len(times)} finished" if len(times) > 1 else "as the one finished"
    return statistics.fmean(times), statistics.fmean(sizes), count


def _by_trial(study: Study, point: int, options: Options) -> tuple[float, float, str]:
    """Speed of a point in its first seconds, carried on to its end; and the size of its files likewise."""
    from gw_exudyn.simulation import output_times, simulate
    from gw_exudyn.sweep.encoding import encoded

    scenario = study.scenario(point)
    began = time.perf_counter()
    result = simulate(scenario, should_stop=lambda: time.perf_counter() - began > _TRIAL)
    spent = time.perf_counter() - began
    outputs = len(output_times(scenario)) + 1
    share = len(result.time) / outputs
    files = encoded(result, "", options.keep_runs)
    size = sum(len(content) * (1.0 if name == MANIFEST else 1 / share) for name, content in files.items())
    part = scenario.drive.duration
    reached = float(result.time[-1])
    if share >= 1 or not result.status.status.trusted:
        return spent, size, f"point {point} was run to see"
    return (
        spent * part / reached,
        size,
        (f"by the first {reached:.3g} s of the {part:.3g} s of point {point}; with more contact later it takes longer"),
    )
