"""Measured courses: the path of a tip or the curve of a force from an experiment, read from CSV."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from gw_exudyn.comparison import COMPARED, PATH, Course, Floats, at, common_time
from gw_exudyn.errors import ComparisonError, Problem, ScenarioError, StorageError, UnitError
from gw_exudyn.quantities import QUANTITIES
from gw_exudyn.scenario.csv_lines import csv_cells, data_lines
from gw_exudyn.scenario.units import Unit, in_si, parse_number, parse_unit
from gw_exudyn.scenario.words import did_you_mean, shown
from gw_exudyn.scenario.yaml_source import read_text

KNOWN = ("time", *PATH, *COMPARED)
LARGEST_FILE = 100_000_000  # bytes
_HEADER = re.compile(r"\s*(\w+)\s*(?:\[\s*(.*?)\s*\])?\s*")
_GAPS = ("", "nan", "-")
_SHOWN_FAULTS = 20


def read_measured(path: str | Path) -> Course:
    """Read a CSV file of measured values.

    The header names quantities with their units, `time [s],tip_x [mm],tip_y [mm],push_force [mN]`; a name without a
    unit is in SI. Times rise at any rate. An empty cell is a gap, or another quantity's rate: `gw_exudyn.comparison`
    has the rule. Empty lines and lines that begin with # are left out.

    Raises ScenarioError with everything that is wrong, by file and line; StorageError where the file cannot be read.
    """
    file = Path(path)
    if not file.is_file():
        raise StorageError(f"{file}: there is no such file; give a CSV file of measured values")
    faults: list[Problem] = []
    rows = _rows(read_text(file, LARGEST_FILE), file, faults)
    if not rows:
        raise ScenarioError(Problem("", f"is empty; a header is needed, as {_EXAMPLE}", str(file), 1))
    columns = _columns(*rows[0], file, faults)
    _raise(faults)
    table = np.array([_numbers(line, cells, columns, file, faults) for line, cells in rows[1:]]).reshape(
        -1, len(columns)
    )
    _raise(faults)
    _check_times(table[:, [name for name, _ in columns].index("time")], rows[1:], file, faults)
    _raise(faults)
    values = {name: table[:, i] for i, (name, _) in enumerate(columns)}
    return Course(file.stem, values.pop("time"), values)


_EXAMPLE = "time [s],tip_x [mm],tip_y [mm],push_force [mN]"


def aligned(measured: Course, run: Course) -> Course:
    """The measured path turned and shifted, not stretched, so that it lies on the run's as well as it can.

    Least squares over pairs at equal times (Kabsch's method in the plane).

    Raises ComparisonError where there are fewer than two such pairs, or no path.
    """
    if not all(name in course.values for course in (measured, run) for name in PATH):
        raise ComparisonError(f"{measured.name} has no path (tip_x, tip_y) to align")
    time = common_time(measured, run)
    here = np.column_stack([measured.values[name] for name in PATH])[np.isin(measured.time, time)]
    there = np.column_stack([at(run, name, time) for name in PATH])
    known = np.isfinite(here).all(axis=1) & np.isfinite(there).all(axis=1)
    if known.sum() < 2:
        raise ComparisonError(f"{measured.name} and {run.name} have fewer than two places in common to align by")
    here_mean, there_mean = here[known].mean(axis=0), there[known].mean(axis=0)
    a, b = here[known] - here_mean, there[known] - there_mean
    angle = math.atan2(float(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])), float(np.sum(a * b)))
    c, s = math.cos(angle), math.sin(angle)
    x, y = (measured.values[name] - mean for name, mean in zip(PATH, here_mean, strict=True))
    turned = {"tip_x": c * x - s * y + there_mean[0], "tip_y": s * x + c * y + there_mean[1]}
    if "tip_angle" in measured.values:
        turned["tip_angle"] = measured.values["tip_angle"] + angle
    return replace(measured, values={**measured.values, **turned})


def _rows(text: str, file: Path, faults: list[Problem]) -> list[tuple[int, list[str]]]:
    rows = []
    for number, line in data_lines(text):
        try:
            rows.append((number, csv_cells(line)))
        except ValueError as error:
            faults.append(Problem("", str(error), str(file), number))
    return rows


def _columns(line: int, cells: list[str], file: Path, faults: list[Problem]) -> list[tuple[str, Unit]]:
    """Name and unit of each column."""
    columns: list[tuple[str, Unit]] = []
    if any(";" in cell for cell in cells):
        faults.append(Problem("", f"header has semicolons; separate with commas, as {_EXAMPLE}", str(file), line))
        return columns

    def wrong(message: str) -> None:
        faults.append(Problem("", message, str(file), line))

    for cell in cells:
        match = _HEADER.fullmatch(cell)
        name = match.group(1) if match else cell.strip()
        if match is None or name not in KNOWN:
            wrong(f"header {shown(cell)} is not known; {did_you_mean(name, KNOWN)}known: {', '.join(KNOWN)}")
            continue
        if name in dict(columns):
            wrong(f"header {shown(name)} stands there twice")
        try:
            columns.append((name, _unit(name, match.group(2))))
        except UnitError as error:
            wrong(f"header {shown(cell)}: {error}")
    names = [name for name, _ in columns]
    if "time" not in names:
        wrong(f"has no column time; write the header as {_EXAMPLE}")
    if len(set(PATH) & set(names)) == 1:
        wrong("has only one of tip_x and tip_y; give both")
    if not faults and len(names) < 2:
        wrong("has nothing but time; give at least one quantity more")
    return columns


def _unit(name: str, written: str | None) -> Unit:
    """The unit of a column. Raises UnitError for one that does not fit."""
    needed = parse_unit(QUANTITIES[name].unit)
    unit = parse_unit(written) if written else needed
    if unit.dimension != needed.dimension:
        raise UnitError(f"{written!r} is no unit of the {QUANTITIES[name].label}; write one as {QUANTITIES[name].unit}")
    return unit


def _numbers(
    line: int, cells: list[str], columns: list[tuple[str, Unit]], file: Path, faults: list[Problem]
) -> list[float]:
    """The values of a row in SI, gaps as NaN."""
    if len(cells) != len(columns):
        message = f"has {len(cells)} cells, the header {len(columns)}; an empty cell is a gap"
        faults.append(Problem("", message, str(file), line))
        return [math.nan] * len(columns)
    numbers = []
    for cell, (name, unit) in zip(cells, columns, strict=True):
        number = math.nan
        if cell.strip().lower() not in _GAPS:
            try:
                number = float(in_si(parse_number(cell.strip()), unit))
            except (UnitError, ValueError):
                faults.append(Problem(name, f"{shown(cell)} is no number; a gap is an empty cell", str(file), line))
        numbers.append(number)
    return numbers


def _check_times(time: Floats, rows: list[tuple[int, list[str]]], file: Path, faults: list[Problem]) -> None:
    if len(time) < 2:
        faults.append(Problem("", "has fewer than two rows of values", str(file), rows[0][0] if rows else 1))
        return
    for i in range(len(time)):
        if not np.isfinite(time[i]):
            faults.append(Problem("time", "is missing; every row needs its time", str(file), rows[i][0]))
        elif i and time[i] <= time[i - 1]:
            message = f"{time[i]:.6g} s does not come after {time[i - 1]:.6g} s; times rise"
            faults.append(Problem("time", message, str(file), rows[i][0]))


def _raise(faults: list[Problem]) -> None:
    if faults:
        raise ScenarioError(faults[:_SHOWN_FAULTS])
