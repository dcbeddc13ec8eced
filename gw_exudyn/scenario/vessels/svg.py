"""The outline in an SVG drawing: one closed path, scaled by the viewBox, its transforms applied, y turned upwards."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.errors import ScenarioError
from gw_exudyn.scenario.faults import wrong
from gw_exudyn.scenario.vessels.outline import LARGEST_FILE, Outline
from gw_exudyn.scenario.words import path_text, plural, shown
from gw_exudyn.scenario.yaml_source import read_text

Matrix = NDArray[np.float64]

CURVE_TOLERANCE = 1e-4
"""How far, over the width of the viewBox, a straight wall piece may lie from the curve that it stands for."""

_SIZES = {"mm": 1e-3, "cm": 1e-2, "in": 25.4e-3}
_DEEPEST_SPLIT = 12
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_NO_COMMAND = re.compile(r"[^MmZzLlHhVvCcSsQqTtAa0-9eE+.,\s-]+")
_STEP = re.compile(r"\s*,?\s*([A-Za-z]+)\s*\(([^)]*)\)")


@dataclass
class _Drawing:
    """What the XML holds. paths : (id, data, matrix, line)."""

    view_box: str | None = None
    width: str = ""
    paths: list[tuple[str | None, str, Matrix, int]] = field(default_factory=list)
    root: str | None = None
    root_line: int = 1


def read_svg(path: Path, length: float | None, path_id: str | None) -> Outline:
    """The outline of an SVG's path. length : m, of the viewBox's width; None takes the drawing's own, if it
    is in mm, cm or in. The origin is the viewBox's lower left corner.

    Edge i of the outline is the path's drawn command i, a curve counting as one edge.

    Raises PydanticCustomError with the file and the line.
    """
    try:
        text = read_text(path, LARGEST_FILE)
    except ScenarioError as error:
        raise wrong(f"{path_text([str(path)], longest=300)}: {error.problems[0].message}") from None
    file = str(path)
    drawing = _parsed(text, file)
    left, top, width, height = _view_box(drawing, file)
    _, data, matrix, line = _chosen(drawing, path_id, file)
    length = _own_width(drawing, file) if length is None else length
    scale = length / width
    to_metres = scale * np.array([[1.0, 0.0, -left], [0.0, -1.0, top + height]]) @ matrix
    points, commands = _flattened(data, to_metres, CURVE_TOLERANCE * length, file, line)
    return Outline(tuple(points), file=file, lines=(line,) * len(points), commands=tuple(commands))


def _parsed(text: str, file: str) -> _Drawing:
    drawing, stack = _Drawing(), [np.eye(3)]
    parser = expat.ParserCreate(namespace_separator=" ")

    def begin(tag: str, attributes: dict[str, str]) -> None:
        line, name = parser.CurrentLineNumber, tag.rpartition(" ")[2]
        if drawing.root is None:
            drawing.root, drawing.root_line, drawing.view_box = name, line, attributes.get("viewBox")
            drawing.width = attributes.get("width", "")
        stack.append(stack[-1] @ _transform(attributes.get("transform", ""), file, line))
        if name == "path":
            drawing.paths.append((attributes.get("id"), attributes.get("d", ""), stack[-1], line))

    def refuse_entity(*_: object) -> None:
        raise wrong("declares entities, which are not read; save it as plain SVG", file=file)

    parser.StartElementHandler = begin
    parser.EndElementHandler = lambda _: stack.pop()
    parser.EntityDeclHandler = refuse_entity
    try:
        parser.Parse(text.encode(), True)
    except expat.ExpatError as error:
        raise wrong(f"is no XML: {expat.ErrorString(error.code)}", file=file, line=error.lineno) from None
    if drawing.root != "svg":
        raise wrong(f"its root is <{drawing.root}>; an SVG drawing is needed", file=file, line=drawing.root_line)
    return drawing


def _view_box(drawing: _Drawing, file: str) -> tuple[float, float, float, float]:
    line, remedy = drawing.root_line, "write viewBox='0 0 120 80': left, top, width, height"
    if drawing.view_box is None:
        raise wrong(f"the svg element has no viewBox, so its scale is unknown; {remedy}", file=file, line=line)
    numbers = [float(n) for n in re.findall(_NUMBER, drawing.view_box)]
    if len(numbers) != 4 or not (numbers[2] > 0 and numbers[3] > 0):
        raise wrong(f"viewBox {shown(drawing.view_box)} is not understood; {remedy}", file=file, line=line)
    return numbers[0], numbers[1], numbers[2], numbers[3]


def _own_width(drawing: _Drawing, file: str) -> float:
    """The drawing's width, m, where it is in a unit that has a size: pixels have none."""
    match = re.fullmatch(rf"\s*({_NUMBER})\s*(mm|cm|in)\s*", drawing.width)
    if match is None or not float(match[1]) > 0:
        text = "the svg element has no width in mm, cm or in, so its scale is unknown"
        remedy = "give length beside file, the width of its viewBox: length: 120 mm"
        raise wrong(f"{text}; {remedy}", file=file, line=drawing.root_line)
    return float(match[1]) * _SIZES[match[2]]


def _chosen(drawing: _Drawing, path_id: str | None, file: str) -> tuple[str | None, str, Matrix, int]:
    if not drawing.paths:
        text = "has no path element; turn the outline's shape into a path and save again"
        raise wrong(text, file=file, line=drawing.root_line)
    names = ", ".join(name for name, *_ in drawing.paths if name) or "none"
    if path_id is None:
        if len(drawing.paths) > 1:
            text = f"has {len(drawing.paths)} paths; name the lumen's by id beside file; ids: {names}"
            raise wrong(text, file=file, line=drawing.paths[1][3])
        return drawing.paths[0]
    found = [path for path in drawing.paths if path[0] == path_id]
    if not found:
        raise wrong(f"has no path with the id {shown(path_id)}; ids: {names}", file=file, line=drawing.root_line)
    return found[0]


def _transform(text: str, file: str, line: int) -> Matrix:
    """The matrix of a transform attribute: its steps from left to right."""
    matrix, at = np.eye(3), 0
    while text[at:].strip():
        match = _STEP.match(text, at)
        step = _one_transform(match[1], [float(n) for n in re.findall(_NUMBER, match[2])]) if match else None
        if match is None or step is None:
            raise wrong(f"transform {shown(text)} is not understood", file=file, line=line)
        matrix, at = matrix @ step, match.end()
    return matrix


def _one_transform(name: str, n: list[float]) -> Matrix | None:
    count = len(n)
    if name == "matrix" and count == 6:
        return np.array([[n[0], n[2], n[4]], [n[1], n[3], n[5]], [0, 0, 1]])
    if name == "translate" and count in (1, 2):
        return np.array([[1, 0, n[0]], [0, 1, n[1] if count == 2 else 0], [0, 0, 1]])
    if name == "scale" and count in (1, 2):
        return np.diag([n[0], n[-1], 1.0])
    if name in ("skewX", "skewY") and count == 1:
        slope = math.tan(math.radians(n[0]))
        return np.array(
            [[1, slope, 0], [0, 1, 0], [0, 0, 1]] if name == "skewX" else [[1, 0, 0], [slope, 1, 0], [0, 0, 1]]
        )
    if name == "rotate" and count in (1, 3):
        c, s = math.cos(math.radians(n[0])), math.sin(math.radians(n[0]))
        x, y = n[1:] if count == 3 else (0.0, 0.0)
        return np.array([[c, -s, x - c * x + s * y], [s, c, y - s * x - c * y], [0, 0, 1]])
    return None


def _flattened(
    data: str, matrix: Matrix, tolerance: float, file: str, line: int
) -> tuple[list[tuple[float, float]], list[int]]:
    """Corners, m, and for each the drawn command that begins there."""
    from svg.path import Arc, Close, Line, Move, parse_path

    strange = _NO_COMMAND.search(data)
    if strange is not None:
        raise wrong(f"the path's data hold {shown(strange[0])}, which is no command", file=file, line=line)
    try:
        drawn = list(parse_path(data))
    except Exception as error:  # the parser raises whatever the text leads to
        raise wrong(f"the path's data are not understood: {error}", file=file, line=line) from None
    parts = sum(isinstance(piece, Move) for piece in drawn)
    if parts > 1:
        text = f"the path has {plural(parts, 'part')}; one closed outline is needed, islands are not supported"
        raise wrong(text, file=file, line=line)
    points: list[tuple[float, float]] = []
    commands: list[int] = []
    number = 0

    def place(z: complex) -> tuple[float, float]:
        x, y = matrix @ [z.real, z.imag, 1.0]
        return float(x), float(y)

    pieces = [piece for piece in drawn if not isinstance(piece, Move)]
    if not pieces or math.dist(place(pieces[-1].end), place(pieces[0].start)) > tolerance / 100:
        raise wrong("the path is not closed; end its data with Z", file=file, line=line)
    for piece in pieces:
        if isinstance(piece, Close) and abs(piece.end - piece.start) == 0:
            continue
        straight = isinstance(piece, Line | Close) or (isinstance(piece, Arc) and not piece.radius)
        corners = [place(piece.start)] if straight else _curve(piece, place, tolerance)
        points += corners
        commands += [number] * len(corners)
        number += 1
    return points, commands


def _curve(
    piece: Any, to_plane: Callable[[complex], tuple[float, float]], tolerance: float
) -> list[tuple[float, float]]:
    """Points along a curve but its last, so close that chords keep within the tolerance."""

    def place(t: float) -> tuple[float, float]:
        return to_plane(piece.point(t))

    def split(t0: float, t1: float, depth: int) -> list[float]:
        a, b = np.array(place(t0)), np.array(place(t1))
        chord = b - a
        far = 0.0
        for part in (0.25, 0.5, 0.75):
            offset = np.array(place(t0 + part * (t1 - t0))) - a
            size = float(np.hypot(*chord))
            across = abs(chord[0] * offset[1] - chord[1] * offset[0]) / size if size > tolerance else np.hypot(*offset)
            far = max(far, float(across))
        if depth >= _DEEPEST_SPLIT or (far <= tolerance and depth > 0):
            return [t0]
        middle = (t0 + t1) / 2
        return split(t0, middle, depth + 1) + split(middle, t1, depth + 1)

    return [place(t) for t in split(0.0, 1.0, 0)]
