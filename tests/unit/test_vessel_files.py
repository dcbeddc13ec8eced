"""Vessels from files: WKT, GeoJSON, SVG and centre lines give the same lumen as points written out."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import shapely
from model_cases import scenario

from gw_exudyn.errors import ScenarioError
from gw_exudyn.model.outline import build_outline
from gw_exudyn.scenario import scenario_from_dict
from gw_exudyn.scenario.vessels.centreline import MOST_OUT_OF_PLANE
from gw_exudyn.scenario.vessels.outline_files import read_any_outline
from gw_exudyn.scenario.vessels.svg import CURVE_TOLERANCE

MM = 1e-3
CORNER = [(0, 0), (32, 0), (32, 60), (28, 60), (28, 4), (0, 4)]
"""An L, mm; edges 2 and 5 are its open ends."""


@pytest.fixture
def vessel(tmp_path):
    """The vessel of a file's text and further keys."""

    def read(name: str, text: str, kind: str = "polygon", **keys):
        (tmp_path / name).write_text(text)
        base = scenario().to_dict()
        return scenario_from_dict(base | {"vessel": {"kind": kind, "file": name, **keys}}, folder=tmp_path).vessel

    return read


def svg(data: str, view_box: str = "0 0 120 80", around: str = "{}", attributes: str = "") -> str:
    path = f'<path id="lumen" d="{data}" {attributes}/>'
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{view_box}">\n{around.format(path)}\n</svg>'


def same_lumen(vessel, points_in_mm, exact: float = 1e-12) -> None:
    given, wanted = shapely.Polygon(vessel.points), shapely.Polygon(np.array(points_in_mm) * MM)
    assert given.symmetric_difference(wanted).area < exact
    assert given.exterior.is_ccw


def test_wkt(vessel):
    ring = ", ".join(f"{x} {y}" for x, y in [*CORNER, CORNER[0]])
    found = vessel("lumen.wkt", f"POLYGON (({ring}))\n", unit="mm", open_edges=[2, 5])
    same_lumen(found, CORNER)
    assert found.open_edges == (2, 5)


@pytest.mark.parametrize("wrapped", ["bare", "feature", "collection"])
def test_geojson(vessel, wrapped):
    shape = {"type": "Polygon", "coordinates": [[list(point) for point in [*CORNER, CORNER[0]]]]}
    feature = {"type": "Feature", "properties": {}, "geometry": shape}
    collection = {"type": "FeatureCollection", "features": [feature]}
    content = {"bare": shape, "feature": feature, "collection": collection}[wrapped]
    found = vessel("lumen.geojson", json.dumps(content), unit="mm", open_edges=[2, 5])
    same_lumen(found, CORNER)
    assert found.open_edges == (2, 5)


# In an SVG y points down: the L in a viewBox of 80 units' height.
DOWN = "M 0 80 L 32 80 V 20 h -4 v 56 H 0 Z"


def test_svg_is_scaled_by_its_view_box_and_turned_upwards(vessel):
    same_lumen(vessel("lumen.svg", svg(DOWN), length="120 mm"), CORNER)
    doubled = vessel("lumen.svg", svg(DOWN), length="240 mm")
    same_lumen(doubled, [(2 * x, 2 * y) for x, y in CORNER])


@pytest.mark.parametrize(
    ("around", "attributes"),
    [
        ('<g transform="translate(10, 0)"><g>{}</g></g>', 'transform="translate(-10)"'),
        ('<g transform="scale(2)">{}</g>', 'transform="matrix(0.5 0 0 0.5 0 0)"'),
        ('<g transform="rotate(90 60 40)">{}</g>', 'transform="rotate(-90, 60, 40)"'),
        ('<g transform="skewX(30) translate(1 2)">{}</g>', 'transform="translate(-1,-2) skewX(-30)"'),
    ],
)
def test_transforms_of_an_svg_are_applied_from_the_outside_in(vessel, around, attributes):
    same_lumen(vessel("lumen.svg", svg(DOWN, around=around, attributes=attributes), length="120 mm"), CORNER)


def test_a_view_box_elsewhere_moves_the_origin(vessel):
    drawing = svg("M 10 100 h 32 v -60 h -4 v 56 h -28 z", view_box="10 20 120 80")
    moved = vessel("lumen.svg", drawing, length="120 mm")
    same_lumen(moved, CORNER)


@pytest.mark.parametrize(
    ("data", "area"),
    [
        ("M 20 40 A 20 20 0 0 1 60 40 A 20 20 0 0 1 20 40 Z", math.pi * 400),
        ("M 20 40 a 30 15 0 1 0 60 0 a 30 15 0 1 0 -60 0 z", math.pi * 450),
        # A parabola over a chord has two thirds of its rectangle.
        ("M 0 40 Q 30 -20 60 40 Z", 2 / 3 * 60 * 30),
        ("M 0 40 Q 15 10 30 40 T 60 40 V 70 H 0 Z", 60 * 30),
        # The integral of y dx with x = 60 (3 t^2 - 2 t^3), y = 120 t (1 - t), which is 43200 t^2 (1 - t)^2 dt.
        ("M 0 40 C 0 0 60 0 60 40 Z", 43200 / 30),
        ("M 0 40 C 0 20 30 20 30 40 S 60 60 60 40 V 75 H 0 Z", 60 * 35),
    ],
)
def test_curves_of_an_svg_keep_to_the_tolerance(vessel, data, area):
    found = vessel("lumen.svg", svg(data), length="120 mm")
    polygon = shapely.Polygon(found.points)
    # A chord that lies within the tolerance of its curve, all along the outline.
    assert polygon.area / MM**2 == pytest.approx(area, abs=polygon.length / MM * 120 * CURVE_TOLERANCE)
    assert len(found.points) < 200


def test_open_edges_of_an_svg_are_counted_in_commands(vessel):
    found = vessel("lumen.svg", svg("M 0 80 C 10 75 20 85 30 80 V 70 H 0 Z"), length="120 mm", open_edges=[1, 3])
    points = np.array(found.points) / MM
    for edge in found.open_edges:
        a, b = points[edge], points[(edge + 1) % len(points)]
        assert abs(a[0] - b[0]) < 1e-9
        assert {round(float(a[0])), round(float(b[0]))} <= {0, 30}
    assert len(found.open_edges) == 2


def test_the_path_of_an_svg_with_several_is_named(vessel):
    both = svg(DOWN, around='<path id="frame" d="M 0 0 H 5 V 5 Z"/>{}')
    same_lumen(vessel("lumen.svg", both, length="120 mm", id="lumen"), CORNER)


# --- centre lines


def centreline(rows, head: str = "x [mm],y [mm],radius [mm]") -> str:
    def cell(value) -> str:
        return value if isinstance(value, str) else f"{value:.9g}"

    return "\n".join([head, *(",".join(map(cell, row)) for row in rows)])


def test_a_straight_centre_line_is_a_channel(vessel):
    found = vessel("line.csv", centreline([(x, 0, 2) for x in range(0, 101, 5)]), kind="centreline")
    points = build_outline(found).points / MM
    assert sorted(map(tuple, np.round(points, 9))) == [(0, -2), (0, 2), (100, -2), (100, 2)]
    assert found.branch_names == ("line",)
    assert found.out_of_plane is None


def test_a_curved_centre_line_keeps_to_its_walls_with_few_facets(vessel):
    turn = np.linspace(0, math.pi / 2, 400)
    rows = [(20 * math.sin(t), 20 * (1 - math.cos(t)), 3) for t in turn]
    outline = build_outline(vessel("arc.csv", centreline(rows), kind="centreline"))
    far = np.hypot(*(outline.points / MM - [0, 20]).T)
    # Half a per cent of the diameter for the thinned line, and as much for the mitres at its corners.
    assert np.minimum(np.abs(far - 17), np.abs(far - 23)).max() < 0.06
    assert len(outline.points) < 50
    assert len(outline.open_edges) == 2


def test_a_tree_comes_from_a_column_or_from_files(vessel, tmp_path):
    rows = [(0, 0, 3, "main"), (40, 0, 3, "main"), (20, 0, 2, "side"), (30, 20, 1.5, "side")]
    tree = vessel("tree.csv", centreline(rows, "x [mm],y [mm],radius [mm],branch"), kind="centreline", fillet="1 mm")
    assert tree.branch_names == ("main", "side")
    assert len(build_outline(tree).open_edges) == 3
    for name in ("main", "side"):
        own = [row[:3] for row in rows if row[3] == name]
        (tmp_path / f"{name}.csv").write_text(centreline(own))
    keys = {"kind": "centreline", "files": ["main.csv", "side.csv"], "fillet": "1 mm"}
    assert scenario_from_dict(scenario().to_dict() | {"vessel": keys}, folder=tmp_path).vessel == tree


def test_a_line_in_space_is_laid_into_its_plane(vessel):
    flat = np.array([(0, 0), (20, 0), (40, 10), (60, 30)], float)
    tilt = math.radians(30)  # about x
    rows = [(x, y * math.cos(tilt), y * math.sin(tilt), 3) for x, y in flat]
    found = vessel("space.csv", centreline(rows, "x [mm],y [mm],z [mm],radius [mm]"), kind="centreline")
    assert found.out_of_plane == pytest.approx(0, abs=1e-9)
    place = np.array(found.branches[0].points) / MM
    # Lengths and angles are those of the line in its plane, and x still points along x.
    assert place == pytest.approx(flat, abs=1e-6)


@pytest.mark.parametrize("bump", [0.3, 0.6])
def test_what_is_out_of_the_plane_is_told_and_refused_beyond_a_part_of_the_radius(vessel, bump):
    # A zigzag across the plane, symmetric, so that the best plane is z = 0 but for a hair.
    rows = [(x, (x / 40) ** 2 * 20, 2 * bump * (1 if i % 2 else -1), 2) for i, x in enumerate(range(0, 81, 2))]
    text = centreline(rows, "x [mm],y [mm],z [mm],radius [mm]")
    if bump < MOST_OUT_OF_PLANE:
        assert vessel("space.csv", text, kind="centreline").out_of_plane == pytest.approx(bump, rel=0.15)
    else:
        told = r"space\.csv:\d+: .*of its radius out of the best plane, at most 0\.5 are allowed"
        with pytest.raises(ScenarioError, match=told):
            vessel("space.csv", text, kind="centreline")


def test_a_vessels_own_file_may_lie_elsewhere_and_name_files_beside_it(tmp_path):
    (tmp_path / "vessels").mkdir()
    Path(tmp_path / "vessels" / "line.csv").write_text(centreline([(0, 0, 2), (50, 0, 2)]))
    Path(tmp_path / "vessels" / "own.yaml").write_text("kind: centreline\nfile: line.csv\n")
    keys = {"vessel": {"kind": "file", "file": "vessels/own.yaml"}}
    found = scenario_from_dict(scenario().to_dict() | keys, folder=tmp_path).vessel
    assert found.branch_names == ("line",)


@pytest.mark.parametrize(("width", "scale"), [("120mm", 1.0), ("12cm", 1.0), (" 4.7244094488in ", 1.0), ("60mm", 0.5)])
def test_a_drawing_with_a_width_in_a_real_unit_needs_no_length(tmp_path, width, scale):
    """As an editor saves it: a group that is moved, relative commands."""
    (tmp_path / "a.svg").write_text(
        f"<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='80mm' viewBox='0 0 120 80'>"
        "<g transform='translate(5,10)'><path d='m 0,30 h 40 v 4 H 0 Z'/></g></svg>"
    )
    outline = read_any_outline(tmp_path / "a.svg", None, None, None)
    wanted = np.array([(5, 40), (45, 40), (45, 36), (5, 36)]) * 1e-3 * scale
    assert np.array(outline.points) == pytest.approx(wanted)
