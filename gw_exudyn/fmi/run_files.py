"""Files of a run of an FMU: the inputs that it is given, and what comes of it."""

from __future__ import annotations

import csv
import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.errors import StorageError
from gw_exudyn.fmi.session import FmuRun, FmuSession
from gw_exudyn.scenario.units import describe, parse_unit, units_that_fit


def read_inputs(file: str | os.PathLike[str], units: Mapping[str, str]) -> NDArray[Any]:
    """Inputs against time from a CSV file: header `time,command.speed`, or with a unit, `command.speed [mm/s]`.

    units : unit, as FMI names it, of each variable of the FMU; a column without a unit is in its variable's.
    Returns a structured array, `time` (s) first, every column in its variable's unit.

    Raises StorageError with file and line for what is no number, times that fall, a missing time, columns of one name,
    and a unit that is none or does not fit.
    """
    path = Path(file)
    try:
        with path.open(newline="", encoding="utf-8-sig") as lines:
            rows = [row for row in csv.reader(lines) if row]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise StorageError(f"{path}: can't be read: {error}") from error
    if len(rows) < 2:
        raise StorageError(f"{path}: has no rows; write a header, time,command.speed, and a row for each time")
    heads = _headings(path, rows[0], {**units, "time": "s"})
    table = np.zeros(len(rows) - 1, [(name, float) for name, _ in heads])
    for i, row in enumerate(rows[1:]):
        try:
            table[i] = tuple(float(cell) * factor for cell, (_, factor) in zip(row, heads, strict=True))
        except ValueError as error:
            raise StorageError(f"{path}:{i + 2}: {error}; {len(heads)} numbers are needed") from error
    if not (np.diff(table["time"]) >= 0).all():
        raise StorageError(f"{path}: the times must not fall")
    return table


_HEADING = re.compile(r"([^\[\]]+?)\s*(?:\[([^\[\]]*)\])?")


def _headings(path: Path, cells: Sequence[str], units: Mapping[str, str]) -> list[tuple[str, float]]:
    """Name of every column, and its factor to the variable's unit. Raises StorageError with all that is wrong."""
    found: list[tuple[str, float]] = []
    wrong: list[str] = []
    for cell in cells:
        try:
            name, factor = _heading(cell, units)
        except ValueError as error:
            wrong.append(f"{cell}: {error}")
            continue
        if any(name == known for known, _ in found):
            wrong.append(f"{name}: there are two columns of this name; take one out")
        found.append((name, factor))
    if not wrong and found[0][0] != "time":
        wrong.append(f"the first column is {cells[0]!r}; it must be time")
    if wrong:
        raise StorageError("\n".join(f"{path}:1: {text}" for text in wrong))
    return found


def _heading(cell: str, units: Mapping[str, str]) -> tuple[str, float]:
    """Raises ValueError for what is no heading, UnitError, which is one, for a unit that does not fit."""
    match = _HEADING.fullmatch(cell.strip())
    if match is None:
        raise ValueError("is no heading; write a name, and behind it the unit in brackets: command.speed [mm/s]")
    name, written = match.groups()
    unit = units.get(name, "")
    # A name that the FMU does not have is told with the nearest one when the run begins.
    if written is None or (name in units and written == unit):
        return name, 1.0
    if name in units and not unit:
        raise ValueError("has no unit in the FMU; leave the brackets out")
    given = parse_unit(written)
    if name not in units:
        return name, 1.0
    wanted = parse_unit(_spelled(unit))
    if given.dimension != wanted.dimension:
        fit = ", ".join(units_that_fit(wanted.text))
        raise ValueError(f"is {describe(given.dimension)}, not {describe(wanted.dimension)}; units that fit: {fit}")
    return name, float(given.factor / wanted.factor)


def _spelled(unit: str) -> str:
    """FMI's `N.mm2` as the scenario's `N*mm^2`."""
    return re.sub(r"(?<=[A-Za-z])(-?\d)", r"^\1", unit).replace(".", "*")


STATIONS = "stations.csv"


def write_run(run: FmuRun, session: FmuSession, values: Mapping[str, Any], folder: str | os.PathLike[str]) -> Path:
    """Write outputs.csv (scalars, header with SI units), stations.csv where there are arrays, and run.json into a
    folder. Raises StorageError.

    A row of stations.csv is a station at an instant: its time, its number, 0 at the tip, and the values there.
    """
    target = Path(folder)
    names = [name for name in run.names if run.outputs[name].ndim == 1]
    arrays = [name for name in run.names if run.outputs[name].ndim == 2]
    heads = {name: f"{name} [{'s' if name == 'time' else session.units.get(name) or '1'}]" for name in run.names}
    try:
        target.mkdir(parents=True, exist_ok=True)
        with (target / "outputs.csv").open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow([heads[name] for name in names])
            writer.writerows([[repr(row[name].item()) for name in names] for row in run.outputs])
        if arrays:
            with (target / STATIONS).open("w", newline="", encoding="utf-8") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow([heads["time"], "station", *(heads[name] for name in arrays)])
                writer.writerows(_station_rows(run.outputs, arrays))
        content = {"status": run.code, "message": run.message, "values": dict(values)}
        (target / "run.json").write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
    except OSError as error:
        raise StorageError(f"{target}: can't be written: {error.strerror or error}") from error
    return target


def _station_rows(outputs: NDArray[Any], arrays: Sequence[str]) -> Iterator[list[str | int]]:
    for row in outputs:
        time = repr(row["time"].item())
        # Of an FMU of others, arrays may differ in length: what is not there stays empty.
        columns = (map(repr, row[name].tolist()) for name in arrays)
        for station, values in enumerate(zip_longest(*columns, fillvalue="")):
            yield [time, station, *values]
