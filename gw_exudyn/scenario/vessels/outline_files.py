"""Outlines from files: CSV, WKT, GeoJSON and SVG, told apart by the end of the file's name."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from gw_exudyn.errors import ScenarioError, UnitError
from gw_exudyn.scenario.faults import wrong
from gw_exudyn.scenario.fields import is_number
from gw_exudyn.scenario.units import Unit, parse_unit
from gw_exudyn.scenario.vessels.outline import LARGEST_FILE, Outline, closed, read_outline
from gw_exudyn.scenario.vessels.svg import read_svg
from gw_exudyn.scenario.words import path_text, shown
from gw_exudyn.scenario.yaml_source import read_text

UNIT_NEEDED = (".wkt", ".geojson", ".json")
ENDINGS = (".csv", *UNIT_NEEDED, ".svg")


def read_any_outline(path: Path, unit: str | None, length: float | None, path_id: str | None) -> Outline:
    """The outline in a file.

    unit : of the coordinates in WKT and GeoJSON. length : m, width of the viewBox of an SVG; None takes the
        drawing's. path_id : id of the path in an SVG, where there are several.

    Raises PydanticCustomError or ValidationError with the file, and the line where there is one.
    """
    ending = path.suffix.lower()
    _check_scale(ending, unit, length, path_id)
    if ending == ".svg":
        return closed(read_svg(path, length, path_id))
    if ending not in UNIT_NEEDED:
        return read_outline(path)
    text = text_of(path, LARGEST_FILE)
    factor = float(_length_unit(unit or "m").factor)
    ring = _wkt_ring(text, str(path)) if ending == ".wkt" else _geojson_ring(text, str(path))
    return closed(Outline(tuple((x * factor, y * factor) for x, y in ring), file=str(path)))


def text_of(path: Path, largest: int) -> str:
    """The text of a file named in a scenario. Raises PydanticCustomError."""
    try:
        return read_text(path, largest)
    except ScenarioError as error:
        raise wrong(f"{path_text([str(path)], longest=300)}: {error.problems[0].message}") from None


def _check_scale(ending: str, unit: str | None, length: float | None, path_id: str | None) -> None:
    """What says how large things are stands there, and nothing that this format does not read."""
    if ending not in ENDINGS:
        raise wrong(f"ends in {ending or 'nothing'}; outlines are read from {', '.join(ENDINGS)}")
    if ending in UNIT_NEEDED and unit is None:
        raise wrong(f"a {ending} file does not say its unit of length; give unit beside file, as unit: mm")
    if unit is not None and ending not in UNIT_NEEDED:
        where = "its header names the unit" if ending == ".csv" else "give length instead"
        raise wrong(f"unit is not for a {ending} file: {where}")
    if length is not None and ending != ".svg":
        raise wrong(f"length is not for a {ending} file, whose coordinates have a unit; remove it")
    if path_id is not None and ending != ".svg":
        raise wrong(f"id is not for a {ending} file; remove it")


def _length_unit(text: str) -> Unit:
    try:
        unit = parse_unit(text)
    except UnitError as error:
        raise wrong(f"unit: {error}") from None
    if unit.dimension != parse_unit("m").dimension:
        raise wrong(f"unit: {shown(text)} is no unit of length; write m, mm or um")
    return unit


def _wkt_ring(text: str, file: str) -> list[tuple[float, float]]:
    import shapely

    try:
        shape = shapely.from_wkt(text.strip())
    except shapely.errors.ShapelyError as error:
        reason = str(error).partition(":")[2].strip().lower() or str(error)
        raise wrong(f"is no WKT: {reason}; write POLYGON ((x y, x y, ...))", file=file, line=1) from None
    if shape.geom_type != "Polygon":
        text = f"holds a {shape.geom_type.upper()}; one closed outline is needed, POLYGON ((x y, x y, ...))"
        raise wrong(text, file=file, line=1)
    if len(shape.interiors):
        raise wrong(_ISLANDS.format(count=len(shape.interiors)), file=file, line=1)
    return [(float(x), float(y)) for x, y, *_ in shape.exterior.coords]


_ISLANDS = "has {count} inner rings (islands), which are not supported; leave them out, or open the loop"


def _geojson_ring(text: str, file: str) -> list[tuple[float, float]]:
    try:
        found = json.loads(text)
    except (ValueError, RecursionError) as error:
        line = getattr(error, "lineno", None)
        raise wrong(f"is no JSON: {getattr(error, 'msg', error)}", file=file, line=line) from None
    shape = _geometry(found, file)
    kind = shape.get("type") if isinstance(shape, dict) else None
    if kind != "Polygon":
        raise wrong(f"holds {shown(kind)}; a geometry of type Polygon is needed", file=file)
    rings = shape.get("coordinates")
    if not isinstance(rings, list) or not rings or not all(isinstance(ring, list) for ring in rings):
        raise wrong("its Polygon has no coordinates; write [[[x, y], [x, y], ...]]", file=file)
    if len(rings) > 1:
        raise wrong(_ISLANDS.format(count=len(rings) - 1), file=file)
    ring = [_position(position, i, file) for i, position in enumerate(rings[0])]
    if len(ring) < 4 or ring[0] != ring[-1]:
        raise wrong("its Polygon is not closed; the last position must repeat the first, four at least", file=file)
    return ring


def _geometry(found: Any, file: str) -> Any:
    """The one geometry in a GeoJSON object."""
    if isinstance(found, dict) and found.get("type") == "FeatureCollection":
        features = found.get("features")
        count = len(features) if isinstance(features, list) else 0
        if not isinstance(features, list) or count != 1:
            raise wrong(f"its FeatureCollection has {count} features; one is needed, the lumen", file=file)
        found = features[0]
    if isinstance(found, dict) and found.get("type") == "Feature":
        return found.get("geometry")
    return found


def _position(position: Any, i: int, file: str) -> tuple[float, float]:
    if not isinstance(position, list) or len(position) < 2 or not all(is_number(value) for value in position[:2]):
        raise wrong(f"position {i} is {shown(position)}; [x, y] is needed", file=file)
    return float(position[0]), float(position[1])
