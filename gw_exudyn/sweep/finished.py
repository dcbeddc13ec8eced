"""A sweep's folder as it lies there: its points in arrays, from the table, or from the points where that is not written
yet.
"""

from __future__ import annotations

import csv
import json
import math
import sys
from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.errors import StorageError
from gw_exudyn.result import Floats
from gw_exudyn.sweep.folder import POINTS, SWEEP, is_sweep, read_point
from gw_exudyn.sweep.table import COMPLETED, TABLE


@dataclass(frozen=True)
class Points:
    """The points of a sweep.

    numbers : in the study. ids, status, reason : of each. trusted : (points,). labels : coordinates by path, in SI or
    words. metrics : (points,) in SI by name; NaN where there is none. units : of metrics. whole : the table was there;
    else these are the points that were done so far.
    """

    numbers: Sequence[int]
    ids: Sequence[str]
    status: Sequence[str]
    reason: Sequence[str]
    trusted: NDArray[np.bool_]
    labels: Mapping[str, Floats | Sequence[str]]
    metrics: Mapping[str, Floats]
    units: Mapping[str, str]
    whole: bool


def read_about(folder: Path) -> dict[str, Any]:
    """sweep.json. Raises StorageError for a folder that is no sweep of ours."""
    if not is_sweep(folder):
        raise StorageError(f"{folder}: is no folder of a sweep, as `gw-exudyn sweep` names it")
    content: dict[str, Any] = json.loads((folder / SWEEP).read_text(encoding="utf-8"))
    return content


def read_points(folder: Path, about: Mapping[str, Any]) -> Points:
    """The points of a finished sweep, or those that an interrupted one got to.

    Raises StorageError for a table that is damaged.
    """
    units: Mapping[str, str | None] = about["parameters"]
    # A sweep that goes on writes its summary last: without it the table is missing, or that of an earlier study.
    if "summary" not in about or not (folder / TABLE).is_file():
        return _so_far(folder, units)
    gathered = _Gathered(units)
    first = len(units) + 2
    with open(folder / TABLE, newline="", encoding="utf-8") as file:
        rows = csv.reader(file)
        head = next(rows, [])
        names = [name.rpartition(" [") for name in head[first + 3 :]]
        known = head[first : first + 3] == ["status", "trusted", "reason"]
        for row in rows if known else ([],):
            if not known or len(row) != len(head):
                again = f"give the command of the sweep again: {about['command']}"
                raise StorageError(f"{folder / TABLE}: is damaged; {again}")
            status, trusted, reason, *numbers = row[first:]
            metrics = {name: (cell, unit[:-1]) for (name, _, unit), cell in zip(names, numbers, strict=True)}
            gathered.add(
                int(row[0]),
                row[1],
                dict(zip(units, row[2:first], strict=True)),
                status,
                trusted == "true",
                reason,
                metrics,
            )
    return gathered.points(whole=True)


def _so_far(folder: Path, units: Mapping[str, str | None]) -> Points:
    """The points with these parameters that are done, by their parameters."""
    found = []
    for place in sorted((folder / POINTS).iterdir() if (folder / POINTS).is_dir() else ()):
        content = read_point(place)
        point = (content or {}).get("provenance", {}).get("point", {})
        if content is not None and set(point.get("parameters", {})) == set(units):
            found.append((place.name, point["parameters"], content))
    found.sort(key=lambda one: [(str(type(one[1][path])), one[1][path]) for path in units])
    gathered = _Gathered(units)
    for number, (name, labels, content) in enumerate(found):
        status = str(content["status"].get("name"))
        metrics = {"wall_time": (content.get("wall_time"), "s")}
        metrics |= {name: (entry["value"], entry["unit"]) for name, entry in content.get("metrics", {}).items()}
        reason = "" if status == COMPLETED else str(content["status"].get("sentence"))
        gathered.add(number, name, labels, status, content.get("trusted") is True, reason, metrics)
    return gathered.points(whole=False)


class _Gathered:
    """Points as they come in, column by column: a hundred thousand of them do not fill the memory."""

    def __init__(self, units: Mapping[str, str | None]) -> None:
        self._units = units
        self._numbers: list[int] = []
        self._ids: list[str] = []
        self._status: list[str] = []
        self._reason: list[str] = []
        self._trusted: list[bool] = []
        self._labels: dict[str, Any] = {path: [] if unit is None else array("d") for path, unit in units.items()}
        self._metrics: dict[str, array[float]] = {}
        self._metric_units: dict[str, str] = {}

    def add(
        self,
        number: int,
        point: str,
        labels: Mapping[str, Any],
        status: str,
        trusted: bool,
        reason: str,
        metrics: Mapping[str, tuple[Any, str]],
    ) -> None:
        """Note a point. metrics : values, None or empty where there is none, with their units."""
        self._numbers.append(number)
        self._ids.append(point)
        self._status.append(sys.intern(status))
        self._trusted.append(trusted)
        self._reason.append(sys.intern(reason))
        for path, unit in self._units.items():
            self._labels[path].append(sys.intern(str(labels[path])) if unit is None else float(labels[path]))
        for name, (cell, unit) in metrics.items():
            if name not in self._metrics:
                self._metrics[name] = array("d", [math.nan] * (len(self._ids) - 1))
                self._metric_units[name] = unit
            self._metrics[name].append(math.nan if cell in (None, "") else float(cell))
        for column in self._metrics.values():
            if len(column) < len(self._ids):
                column.append(math.nan)

    def points(self, whole: bool) -> Points:
        """All of them."""
        return Points(
            numbers=self._numbers,
            ids=self._ids,
            status=self._status,
            reason=self._reason,
            trusted=np.array(self._trusted, dtype=bool),
            labels={path: np.array(x) if isinstance(x, array) else x for path, x in self._labels.items()},
            metrics={name: np.array(column) for name, column in self._metrics.items()},
            units=self._metric_units,
            whole=whole,
        )
