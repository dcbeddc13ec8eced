"""Files of a run of an FMU: the inputs that it is given, and what comes of it."""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.errors import StorageError
from gw_exudyn.fmi.session import FmuRun, FmuSession
from gw_exudyn.scenario.units import parse_unit


def read_inputs(file: str | os.PathLike[str]) -> NDArray[Any]:
    """Inputs against time from a CSV file: header `time,command.speed`, SI, or with a unit, `command.speed [mm/s]`.

    Raises StorageError with file and line for what is no number, times that fall, or a missing time.
    """
    path = Path(file)
    try:
        with path.open(newline="", encoding="utf-8-sig") as lines:
            rows = [row for row in csv.reader(lines) if row]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise StorageError(f"{path}: can't be read: {error}") from error
    if len(rows) < 2:
        raise StorageError(f"{path}: has no rows; write a header, time,command.speed, and a row for each time")
    heads = [_heading(path, cell) for cell in rows[0]]
    if heads[0][0] != "time":
        raise StorageError(f"{path}:1: the first column is {rows[0][0]!r}; it must be time")
    table = np.zeros(len(rows) - 1, [(name, float) for name, _ in heads])
    for i, row in enumerate(rows[1:]):
        try:
            table[i] = tuple(float(cell) * factor for cell, (_, factor) in zip(row, heads, strict=True))
        except ValueError as error:
            raise StorageError(f"{path}:{i + 2}: {error}; {len(heads)} numbers are needed") from error
    if not (np.diff(table["time"]) >= 0).all():
        raise StorageError(f"{path}: the times must not fall")
    return table


def _heading(path: Path, cell: str) -> tuple[str, float]:
    name, bracket, unit = cell.strip().partition("[")
    try:
        return name.strip(), float(parse_unit(unit.rstrip("] ")).factor) if bracket else 1.0
    except ValueError as error:
        raise StorageError(f"{path}:1: {cell}: {error}") from error


def write_run(run: FmuRun, session: FmuSession, values: Mapping[str, Any], folder: str | os.PathLike[str]) -> Path:
    """Write outputs.csv (scalars, header with SI units) and run.json into a folder. Raises StorageError."""
    target = Path(folder)
    names = [name for name in run.names if run.outputs[name].ndim == 1]
    units = {"time": "s", **{n: getattr(session.variables.get(n), "unit", None) or "1" for n in names if n != "time"}}
    try:
        target.mkdir(parents=True, exist_ok=True)
        with (target / "outputs.csv").open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow([f"{name} [{units[name]}]" for name in names])
            writer.writerows([[repr(row[name].item()) for name in names] for row in run.outputs])
        content = {"status": run.code, "message": run.message, "values": dict(values)}
        (target / "run.json").write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
    except OSError as error:
        raise StorageError(f"{target}: can't be written: {error.strerror or error}") from error
    return target
