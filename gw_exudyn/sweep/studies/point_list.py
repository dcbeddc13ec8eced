"""A CSV file of points: a dotted path, with its unit if it has one, heads each column; each row is a point."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from gw_exudyn.errors import Problem, ScenarioError, UnitError
from gw_exudyn.scenario.faults import Faults
from gw_exudyn.scenario.units import parse_number, parse_unit
from gw_exudyn.scenario.words import shown
from gw_exudyn.scenario.yaml_source import Place, parse_value, read_text
from gw_exudyn.sweep.studies.axes import Axis, read_axis

LARGEST = 100_000_000
"""Bytes of a CSV file of points."""

_HEAD = re.compile(r"\s*([^\[\]\s]+)\s*(?:\[([^\[\]]*)\])?\s*")


def read_points(path: Path) -> tuple[list[Axis], dict[str, Place], list[Problem]]:
    """Axes of equal length, the place of every value by `vary.PATH.ROW`, and what is wrong; rows with something wrong
    are left out of the axes.

    Raises ScenarioError where there is nothing to go on with.
    """
    name = str(path)
    rows = [(line, row) for line, row in _rows(read_text(path, LARGEST)) if any(cell.strip() for cell in row)]
    if len(rows) < 2:
        raise ScenarioError(Problem("", "holds no points; a line of dotted paths and a line for each is needed", name))
    (head_line, head), body = rows[0], rows[1:]
    columns, problems = _columns(head, name, head_line)
    if problems:
        raise ScenarioError(problems)
    read: list[tuple[int, list[Any]]] = []
    for line, row in body:
        values, faults = _row(row, columns, name, line)
        problems += faults
        if not faults:
            read.append((line, values))
    if not read:
        raise ScenarioError(problems)
    paths = [dotted for dotted, _ in columns]
    axes = _axes(paths, [[values[i] for _, values in read] for i in range(len(paths))], name, head_line)
    places: dict[str, Place] = {
        f"vary.{dotted}.{row}": (name, line) for dotted in paths for row, (line, _) in enumerate(read)
    }
    return axes, places, problems


def _row(
    row: Sequence[str], columns: Sequence[tuple[str, str | None]], name: str, line: int
) -> tuple[list[Any], list[Problem]]:
    """The values of a row, and what is wrong with it."""
    if len(row) != len(columns):
        return [], [Problem("", f"has {len(row)} values, the first line {len(columns)}", name, line)]
    values: list[Any] = []
    problems: list[Problem] = []
    for cell, (dotted, unit) in zip(row, columns, strict=True):
        try:
            values.append(_value(cell.strip(), unit))
        except ScenarioError as error:
            problems.append(Problem(dotted, error.problems[0].message, name, line))
        except UnitError as error:
            problems.append(Problem(dotted, str(error), name, line))
    return values, problems


def _rows(text: str) -> list[tuple[int, list[str]]]:
    reader = csv.reader(text.splitlines())
    return [(reader.line_num, row) for row in reader]


def _columns(head: Sequence[str], name: str, line: int) -> tuple[list[tuple[str, str | None]], list[Problem]]:
    columns: list[tuple[str, str | None]] = []
    problems: list[Problem] = []
    for cell in head:
        match = _HEAD.fullmatch(cell)
        if match is None:
            problems.append(Problem("", f"{shown(cell)} heads no column; write PATH or PATH [unit]", name, line))
            continue
        dotted, unit = match.groups()
        try:
            if unit is not None and unit.strip() != "1":
                parse_unit(unit)
        except UnitError as error:
            problems.append(Problem(dotted, str(error), name, line))
        if any(dotted == other for other, _ in columns):
            problems.append(Problem(dotted, "heads two columns; remove one", name, line))
        columns.append((dotted, None if unit is None or unit.strip() == "1" else unit.strip()))
    return columns, problems


def _value(cell: str, unit: str | None) -> Any:
    if unit is None:
        return parse_value(cell, "")
    parse_number(cell)
    return f"{cell} {unit}"


def _axes(paths: Sequence[str], values: Sequence[list[Any]], name: str, line: int) -> list[Axis]:
    faults, axes = Faults(), []
    for path, column in zip(paths, values, strict=True):
        axis = faults.read((path,), partial(read_axis, path), column)
        if axis is not None:
            axes.append(axis)
    try:
        faults.raise_if_any()
    except ValidationError as error:
        problems = [
            Problem(str(d["loc"][0]), str(d.get("ctx", {}).get("text", d["msg"])), name, line)
            for d in error.errors(include_url=False)
        ]
        raise ScenarioError(problems) from None
    return axes
