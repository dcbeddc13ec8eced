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
from gw_exudyn.scenario.fields import Faults
from gw_exudyn.scenario.units import parse_number, parse_unit
from gw_exudyn.scenario.words import shown
from gw_exudyn.scenario.yaml_source import Place, parse_value, read_text
from gw_exudyn.sweep.axes import Axis, read_axis

LARGEST = 100_000_000
"""Bytes of a CSV file of points."""

_HEAD = re.compile(r"\s*([^\[\]\s]+)\s*(?:\[([^\[\]]*)\])?\s*")


def read_points(path: Path) -> tuple[list[Axis], dict[str, Place]]:
    """Axes of equal length, and the place of every value by `vary.PATH.ROW`.

    Raises ScenarioError with all that is wrong, by line.
    """
    name = str(path)
    rows = [(line, row) for line, row in _rows(read_text(path, LARGEST)) if any(cell.strip() for cell in row)]
    if len(rows) < 2:
        raise ScenarioError(Problem("", "holds no points; a line of dotted paths and a line for each is needed", name))
    (head_line, head), body = rows[0], rows[1:]
    columns, problems = _columns(head, name, head_line)
    values: list[list[Any]] = [[] for _ in columns]
    for line, row in body:
        if len(row) != len(head):
            problems.append(Problem("", f"has {len(row)} values, the first line {len(head)}", name, line))
            continue
        for column, cell, (dotted, unit) in zip(values, row, columns, strict=False):
            try:
                column.append(_value(cell.strip(), unit))
            except (UnitError, ScenarioError) as error:
                text = error.problems[0].message if isinstance(error, ScenarioError) else str(error)
                problems.append(Problem(dotted, text, name, line))
                column.append(None)
    if problems:
        raise ScenarioError(problems)
    axes = _axes([dotted for dotted, _ in columns], values, name, head_line)
    return axes, {f"vary.{axis.path}.{row}": (name, line) for axis in axes for row, (line, _) in enumerate(body)}


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
