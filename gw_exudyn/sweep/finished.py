"""A sweep's folder as it lies there: its points in arrays, from the table, or from the points where that is not written
yet.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator, Mapping, Sequence
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
        return _points(units, list(_so_far(folder, units)), whole=False)
    with open(folder / TABLE, newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    first = len(units) + 2
    if head[first : first + 3] != ["status", "trusted", "reason"] or any(len(row) != len(head) for row in rows):
        raise StorageError(f"{folder / TABLE}: is damaged; give the command of the sweep again: {about['command']}")
    names = [name.rpartition(" [") for name in head[first + 3 :]]
    found = [
        _Row(int(row[0]), row[1], dict(zip(units, row[2:first], strict=True)), row[first], row[first + 2],
             row[first + 1] == "true", {name: (cell, unit[:-1]) for (name, _, unit), cell in
                                        zip(names, row[first + 3 :], strict=True)})
        for row in rows
    ]  # fmt: skip
    return _points(units, found, whole=True)


@dataclass(frozen=True)
class _Row:
    number: int
    id: str
    labels: Mapping[str, Any]
    status: str
    reason: str
    trusted: bool
    metrics: Mapping[str, tuple[Any, str]]


def _so_far(folder: Path, units: Mapping[str, str | None]) -> Iterator[_Row]:
    """Rows of the points with these parameters that are done, by their parameters."""
    rows = []
    for place in sorted((folder / POINTS).iterdir() if (folder / POINTS).is_dir() else ()):
        content = read_point(place)
        point = (content or {}).get("provenance", {}).get("point", {})
        if content is None or set(point.get("parameters", {})) != set(units):
            continue
        status = str(content["status"].get("name"))
        metrics = {"wall_time": (content.get("wall_time"), "s")}
        metrics |= {name: (entry["value"], entry["unit"]) for name, entry in content.get("metrics", {}).items()}
        reason = "" if status == COMPLETED else str(content["status"].get("sentence"))
        good = content.get("trusted") is True
        rows.append(_Row(0, place.name, point["parameters"], status, reason, good, metrics))
    rows.sort(key=lambda row: [(str(type(row.labels[path])), row.labels[path]) for path in units])
    return (_Row(**{**row.__dict__, "number": i}) for i, row in enumerate(rows))


def _points(units: Mapping[str, str | None], rows: Sequence[_Row], whole: bool) -> Points:
    labels: dict[str, Floats | Sequence[str]] = {
        path: [str(row.labels[path]) for row in rows] if unit is None else _numbers(row.labels[path] for row in rows)
        for path, unit in units.items()
    }
    known = {name: unit for row in rows for name, (_, unit) in row.metrics.items()}
    return Points(
        numbers=[row.number for row in rows],
        ids=[row.id for row in rows],
        status=[row.status for row in rows],
        reason=[row.reason for row in rows],
        trusted=np.array([row.trusted for row in rows], dtype=bool),
        labels=labels,
        metrics={name: _numbers(row.metrics.get(name, (None,))[0] for row in rows) for name in known},
        units=known,
        whole=whole,
    )


def _numbers(cells: Any) -> Floats:
    return np.array([np.nan if cell in (None, "") else float(cell) for cell in cells], dtype=float)
