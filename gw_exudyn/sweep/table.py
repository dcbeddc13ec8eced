"""`sweep.csv`, a row a point, and the same in arrays for what is made of it."""

from __future__ import annotations

import csv
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.result import Floats
from gw_exudyn.storage.series import SERIES
from gw_exudyn.sweep.folder import SweepFolder, as_storage_error, read_point
from gw_exudyn.sweep.plan import Failure, Plan, Summary, note_failure
from gw_exudyn.sweep.studies.study import Study

TABLE = "sweep.csv"
NOT_RUN = "not_run"
COMPLETED = "completed"

_DECIMALS = 9
"""Of output times in seconds. A time is the sum of the solver's steps: where some were cut, 25 s may come out as
24.999999999999996 s, and is the same output."""


@dataclass(frozen=True)
class Table:
    """What all points came to.

    status : of each. good : (points,) it came out well, so that its numbers can be trusted. wall_time : (points,) s.
    metrics : name to (points,) in SI; NaN where there is none.
    times : the different series of output times (s), longest first; not those that begin another. At least one.
    """

    status: tuple[str, ...]
    good: NDArray[np.bool_]
    wall_time: Floats
    metrics: Mapping[str, Floats]
    times: tuple[Floats, ...]


def write_table(study: Study, plan: Plan, place: SweepFolder, summary: Summary) -> Table:
    """Read all points, write sweep.csv, and count in `summary` what came out."""
    count = len(plan.ids)
    status, wall_time, good = [], np.full(count, np.nan), np.zeros(count, dtype=bool)
    metrics = {name: np.full(count, np.nan) for name in study.metric_table}
    times = _Times()
    part = place.path / f".{TABLE}.part"
    with as_storage_error(place.path):
        with open(part, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(_heads(study))
            for point, found in enumerate(plan.ids):
                content = read_point(place.point(found))
                status.append(NOT_RUN if content is None else str(content["status"].get("name")))
                if content is not None:
                    wall_time[point] = _number(content.get("wall_time"))
                    for name, entry in content.get("metrics", {}).items():
                        if name in metrics:
                            metrics[name][point] = _number(entry["value"])
                    good[point] = content.get("trusted") is True
                    if plan.first[found] == point:
                        failure = Failure(found, point, status[-1], str(content["status"].get("sentence")))
                        _count(summary, good[point], failure)
                    times.note(place.point(found), whole=status[-1] == COMPLETED)
                numbers = [_text(values[point]) for values in (wall_time, *metrics.values())]
                reason = "" if content is None or status[-1] == COMPLETED else str(content["status"].get("sentence"))
                labels = [_text(label) for label in study.design.labels(point).values()]
                writer.writerow([point, found, *labels, status[-1], str(good[point]).lower(), reason, *numbers])
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, place.path / TABLE)
    return Table(tuple(status), good, wall_time, metrics, times.longest_first())


def _heads(study: Study) -> list[str]:
    axes = [axis.path if axis.unit is None else f"{axis.path} [{axis.unit}]" for axis in study.design.axes]
    metrics = [f"{name} [{metric.unit}]" for name, metric in study.metric_table.items()]
    return ["point", "id", *axes, "status", "trusted", "reason", "wall_time [s]", *metrics]


def _number(value: Any) -> float:
    return float("nan") if value is None else float(value)


def _text(value: float | str) -> str:
    """Full digits; empty where there is no number."""
    if isinstance(value, str):
        return value
    return "" if np.isnan(value) else repr(float(value))


def _count(summary: Summary, good: np.bool_, point: Failure) -> None:
    if good:
        summary.completed += 1
    else:
        note_failure(summary, point)


class _Times:
    """The different series of output times."""

    def __init__(self) -> None:
        self._texts: list[str] = []

    def note(self, folder: Path, whole: bool) -> None:
        """Note those of a point. A run that ended on its way has its last sample at a time of its own, which is left
        out.
        """
        try:
            lines = (folder / SERIES).read_text(encoding="utf-8").splitlines()[1:]
        except FileNotFoundError:
            return
        column = [float(line.partition(",")[0]) for line in (lines if whole else lines[:-1])]
        text = "".join(f"{round(time, _DECIMALS)}," for time in column)
        if not any(known.startswith(text) for known in self._texts):
            self._texts = [known for known in self._texts if not text.startswith(known)] + [text]

    def longest_first(self) -> tuple[Floats, ...]:
        """As arrays, s; the start alone where no point gave any."""
        found = [np.array(text.rstrip(",").split(","), dtype=float) for text in self._texts if text]
        return tuple(sorted(found, key=len, reverse=True)) or (np.zeros(1),)


def read_series(folder: Path) -> dict[str, Floats] | None:
    """The columns of a point's series.csv by name, in SI, times to the nanosecond; None where there is none."""
    try:
        head, *lines = (folder / SERIES).read_text(encoding="utf-8").splitlines()
    except FileNotFoundError:
        return None
    names = [name.partition(" ")[0] for name in head.split(",")]
    rows = np.array([line.split(",") for line in lines], dtype=float).reshape(len(lines), len(names))
    columns = {name: rows[:, i] for i, name in enumerate(names)}
    return {**columns, "time": np.round(columns["time"], _DECIMALS)}
