"""The outline of a lumen: a closed polygon from CSV or a list of points, checked and turned counter-clockwise."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

from gw_exudyn.errors import ScenarioError, UnitError
from gw_exudyn.scenario.csv_lines import csv_cells, data_lines
from gw_exudyn.scenario.faults import Faults, wrong
from gw_exudyn.scenario.units import Unit, describe, format_quantity, in_si, parse_number, parse_unit, units_that_fit
from gw_exudyn.scenario.words import path_text, shown
from gw_exudyn.scenario.yaml_source import read_text

Points = tuple[tuple[float, float], ...]

MOST_POINTS = 100_000
LARGEST_FILE = 20_000_000  # bytes
_SAME_POINT = 1e-9  # m
_SMALLEST_SPAN, _LARGEST_SPAN = 1e-4, 10.0  # m, of the outline's larger side
_SHOWN_FAULTS = 20
_HEADER = re.compile(r"\s*(x|y|open)\s*(?:\[\s*(.+?)\s*\])?\s*", re.IGNORECASE)
_FORM = "'x,y' for metres or 'x [mm],y [mm]', with a column 'open' if you like"


@dataclass(frozen=True)
class Outline:
    """Corners of a closed outline as given.

    points : ((x, y), ...), m; the first is not repeated at the end. open_edges : indices of the edges, point i to
        point i + 1, that are open ends. file, lines : the CSV file and the line of each point; empty if they were
        given in the scenario. commands : for each point the edge that begins there as a person counts it, where a
        curve is one edge but several points; empty if every edge is straight.
    """

    points: Points
    open_edges: tuple[int, ...] = ()
    file: str | None = None
    lines: tuple[int, ...] = field(default=(), compare=False)
    commands: tuple[int, ...] = ()

    @property
    def edges(self) -> int:
        """How many edges a person counts."""
        return self.commands[-1] + 1 if self.commands else len(self.points)

    def among_points(self, edges: Sequence[int]) -> tuple[int, ...]:
        """Edges as a person counts them, as edges between points."""
        if not self.commands:
            return tuple(edges)
        return tuple(i for i, command in enumerate(self.commands) if command in edges)


def read_outline(path: Path) -> Outline:
    """Read a CSV file of points.

    The header is `x,y` (metres) or names a length unit, `x [mm],y [mm]`; a column `open` with 1 marks the edge that
    starts at this row as an open end. Empty lines and lines that begin with # are left out.

    Raises
    ------
    PydanticCustomError, ValidationError
        with the file and the line of what is wrong.
    """
    try:
        text = read_text(path, LARGEST_FILE)
    except ScenarioError as error:
        problem = error.problems[0]
        raise wrong(f"{path_text([str(path)], longest=300)}: {problem.message}") from None
    rows = csv_rows(text, str(path))
    if not rows:
        raise wrong(f"is empty; a header is needed, {_FORM}, then one point a line", file=str(path), line=1)
    columns, units = _header(*rows[0], str(path))
    if len(rows) - 1 > MOST_POINTS + 1:
        raise wrong(f"has {len(rows) - 1} points; at most {MOST_POINTS} are allowed", file=str(path), line=rows[0][0])
    return _outline(rows[1:], columns, units, str(path))


def csv_rows(text: str, file: str) -> list[tuple[int, list[str]]]:
    """Line number and cells of every row that is not empty and no comment."""
    rows = []
    for number, line in data_lines(text):
        _check_separator(line, file, number)
        try:
            rows.append((number, csv_cells(line)))
        except ValueError as error:
            raise wrong(str(error), file=file, line=number) from None
    return rows


def _check_separator(row: str, file: str, line: int) -> None:
    for mark, words in ((";", "semicolons"), ("\t", "tabs")):
        if mark in row.strip():
            text = f"its columns are separated by {words}; separate them by commas, and write decimals with a point"
            raise wrong(text, file=file, line=line)


def _header(line: int, cells: list[str], file: str) -> tuple[list[str], dict[str, Unit]]:
    """Column names, and the unit of x and y."""
    columns, units = [], {}
    for cell in cells:
        match = _HEADER.fullmatch(cell)
        if match is None:
            raise wrong(f"header {shown(cell)} is not understood; write {_FORM}", file=file, line=line)
        columns.append(match.group(1).lower())
        units[columns[-1]] = header_unit(match.group(2) or "m", file, line)
    if sorted(columns) not in (["x", "y"], ["open", "x", "y"]):
        raise wrong(f"header has the columns {', '.join(columns)}; write {_FORM}", file=file, line=line)
    if units["x"] != units["y"]:
        raise wrong("header gives x and y different units; give both the same", file=file, line=line)
    return columns, units


def header_unit(text: str, file: str, line: int) -> Unit:
    """The unit of length that a column's head names."""
    try:
        unit = parse_unit(text)
    except UnitError as error:
        raise wrong(f"header: {error}", file=file, line=line) from None
    if unit.dimension != parse_unit("m").dimension:
        fit = ", ".join(units_that_fit("m"))
        raise wrong(
            f"header: {shown(text)} is {describe(unit.dimension)}, not a length; units that fit: {fit}",
            file=file,
            line=line,
        )
    return unit


def _outline(rows: list[tuple[int, list[str]]], columns: list[str], units: dict[str, Unit], file: str) -> Outline:
    faults, bad = Faults(), 0
    points: list[tuple[float, float]] = []
    open_edges: list[int] = []
    lines: list[int] = []
    for line, cells in rows:
        try:
            point, is_open = _point(cells, columns, units)
        except UnitError as error:
            bad += 1
            if bad <= _SHOWN_FAULTS:
                faults.add((), wrong(str(error), file=file, line=line))
            continue
        if is_open:
            open_edges.append(len(points))
        points.append(point)
        lines.append(line)
    if bad > _SHOWN_FAULTS:
        faults.add((), wrong(f"and {bad - _SHOWN_FAULTS} more rows that are wrong", file=file, line=rows[-1][0]))
    faults.raise_if_any()
    return closed(Outline(tuple(points), tuple(open_edges), file, tuple(lines)))


def _point(cells: list[str], columns: list[str], units: dict[str, Unit]) -> tuple[tuple[float, float], bool]:
    if len(cells) != len(columns):
        hint = " (a decimal comma? write a point)" if len(cells) == 2 * len(columns) else ""
        raise UnitError(f"row has {len(cells)} cells, the header {len(columns)}{hint}; write {','.join(columns)}")
    values: dict[str, Fraction] = {}
    for name, cell in zip(columns, cells, strict=True):
        try:
            values[name] = parse_number(cell)
        except UnitError as error:
            raise UnitError(f"{name}: {error}") from None
    if values.get("open", Fraction(0)) not in (0, 1):
        raise UnitError(f"open: {shown(cells[columns.index('open')])} is neither 0 (wall) nor 1 (open end)")
    return (in_si(values["x"], units["x"]), in_si(values["y"], units["y"])), values.get("open") == 1


def closed(outline: Outline) -> Outline:
    """The outline without a last point that only repeats the first, as many programs write it."""
    points = outline.points
    if len(points) < 2 or math.dist(points[0], points[-1]) > _SAME_POINT:
        return outline
    last = len(points) - 1
    return Outline(
        points[:-1],
        tuple(edge for edge in outline.open_edges if edge < last),
        outline.file,
        outline.lines[:-1],
        outline.commands[:-1],
    )


def check_outline(outline: Outline) -> None:
    """Check that the outline is a simple polygon of plausible size. Raises ValidationError with all that is wrong."""
    faults, points = Faults(), outline.points
    note = _noter(faults, outline)
    if len(points) < 3:
        note(None, f"has {len(points)} different points; an outline needs at least 3")
        faults.raise_if_any()
    repeated = [i for i in range(len(points)) if math.dist(points[i], points[i - 1]) <= _SAME_POINT]
    for i in repeated[:_SHOWN_FAULTS]:
        note(i, f"repeats the point before it, {_xy(points[i])}; remove one")
    _check_span(outline, note)
    if not repeated:
        _check_simple(points, note)
    faults.raise_if_any()


def _noter(faults: Faults, outline: Outline) -> Callable[[int | None, str], None]:
    """How to note a fault at point i: at its line in the CSV file, or at its place in the scenario's list."""

    def note(i: int | None, message: str) -> None:
        if outline.file is not None:
            line = (outline.lines[i] if i is not None else 1) if outline.lines else None
            faults.add((), wrong(message, file=outline.file, line=line))
        else:
            faults.add(() if i is None else (i,), message)

    return note


def _check_span(outline: Outline, note: Callable[[int | None, str], None]) -> None:
    spans = [max(column) - min(column) for column in zip(*outline.points, strict=True)]
    if not _SMALLEST_SPAN <= max(spans) <= _LARGEST_SPAN:
        size = " by ".join(format_quantity(span, "m") for span in spans)
        limits = f"{format_quantity(_SMALLEST_SPAN, 'mm')} to {format_quantity(_LARGEST_SPAN, 'm')}"
        remedy = "bare numbers are metres: write the unit, 'x [mm],y [mm]' in a CSV file, '1 mm' in a list"
        if outline.file is not None and not outline.file.lower().endswith(".csv"):
            remedy = "look for a slip in unit or length beside file"
        note(None, f"the outline measures {size}, plausible is {limits}; {remedy}")


def _check_simple(points: Points, note: Callable[[int | None, str], None]) -> None:
    import shapely

    reason = str(shapely.is_valid_reason(shapely.Polygon(points)))
    if reason == "Valid Geometry":
        if shapely.Polygon(points).area <= _SAME_POINT**2:
            note(None, "the outline encloses no area")
        return
    match = re.fullmatch(r"(.*?)\[(\S+) (\S+)\]", reason)
    if match is None:
        note(None, f"the outline is no simple polygon: {reason.lower()}")
        return
    where = (float(match.group(2)), float(match.group(3)))
    near = min(range(len(points)), key=lambda i: _distance(where, points[i], points[(i + 1) % len(points)]))
    what = "touches itself" if "ring" in match.group(1).lower() else "crosses itself"
    note(near, f"the outline {what} at {_xy(where)}; give the corners in their order along the wall")


def _distance(p: tuple[float, float], a: tuple[float, float], b: tuple[float, float]) -> float:
    """Distance of a point from the segment a to b."""
    ax, ay, bx, by = p[0] - a[0], p[1] - a[1], b[0] - a[0], b[1] - a[1]
    along = min(1.0, max(0.0, (ax * bx + ay * by) / ((bx * bx + by * by) or 1.0)))
    return math.hypot(ax - along * bx, ay - along * by)


def _xy(point: tuple[float, float]) -> str:
    return f"({point[0] * 1e3:.6g}, {point[1] * 1e3:.6g}) mm"


def counter_clockwise(points: Points, open_edges: Sequence[int]) -> tuple[Points, tuple[int, ...]]:
    """The same outline with the lumen on the left of every edge; open edges are renumbered with the points."""
    x0, y0 = points[0]
    shifted = [(x - x0, y - y0) for x, y in points]
    doubled_area = sum(
        x * y_next - x_next * y for (x, y), (x_next, y_next) in zip(shifted, [*shifted[1:], shifted[0]], strict=True)
    )
    if doubled_area > 0:
        return points, tuple(sorted(open_edges))
    count = len(points)
    # Reversed, point i becomes point count-1-i, so the edge from i to i+1 begins at what was point i+1.
    return points[::-1], tuple(sorted((count - 2 - edge) % count for edge in open_edges))
