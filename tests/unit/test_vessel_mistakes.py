"""Mistakes in vessels: each ends in one sentence with its place and what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

from gw_exudyn.errors import ScenarioError
from gw_exudyn.model import build
from gw_exudyn.scenario import list_shipped, load_scenario

HEAD = """\
wire: {model: universal-ii}
catheter: {bore: 1.2 mm}
drive: {kind: speed, speed: 2 mm/s, distance: 40 mm}
"""
BRANCHES = """\
vessel:
  kind: branches
  branches:
    - {name: main, points: [[0 mm, 0 mm], [40 mm, 0 mm]], diameter: 4 mm}
"""


def branches(*rows: str) -> str:
    return BRANCHES + "".join(f"    - {{{row}}}\n" for row in rows)


def polygon(keys: str) -> str:
    return f"vessel: {{kind: polygon, file: {keys}}}\n"


def svg(body: str, view_box: str = "viewBox='0 0 120 80'") -> str:
    return f"<svg xmlns='http://www.w3.org/2000/svg' {view_box}>\n{body}\n</svg>"


MISTAKES = [
    pytest.param(
        polygon("a.wkt, unit: mm"),
        {"a.wkt": "POLYGON ((0 0, 40 4, 40 0, 0 4, 0 0))"},
        "a.wkt: vessel.file: the outline crosses itself at (20, 2) mm; give the corners in their order along the wall",
        id="crossing wkt",
    ),
    pytest.param(
        branches("name: far, points: [[50 mm, 0 mm], [90 mm, 0 mm]], diameter: 4 mm"),
        {},
        "s.yaml:8: vessel.branches.1.points: there is a gap of 10 mm between 'far' and 'main'; every "
        "branch must overlap another, move its points",
        id="gap",
    ),
    pytest.param(
        polygon("a.wkt, unit: m"),
        {"a.wkt": "POLYGON ((0 0, 40 0, 40 4, 0 4, 0 0))"},
        "a.wkt: vessel.file: the outline measures 40 m by 4 m, plausible is 0.1 mm to 10 m; look for "
        "a slip in unit or length beside file",
        id="units",
    ),
    pytest.param(
        polygon("a.wkt"),
        {"a.wkt": "POLYGON ((0 0, 40 0, 40 4, 0 4, 0 0))"},
        "s.yaml:4: vessel.file: a .wkt file does not say its unit of length; give unit beside file, as unit: mm",
        id="nounit",
    ),
    pytest.param(
        branches("name: side, parent: man, at: 20 mm, angle: 60 deg, length: 30 mm, diameter: 2 mm"),
        {},
        "s.yaml:8: vessel.branches.1.parent: there is no branch 'man'; did you mean 'main'? branches: main",
        id="no parent",
    ),
    pytest.param(
        branches(
            "name: a, parent: b, at: 20 mm, angle: 60 deg, length: 30 mm, diameter: 2 mm",
            "name: b, parent: a, at: 20 mm, angle: 60 deg, length: 30 mm, diameter: 2 mm",
        ),
        {},
        "s.yaml:8: vessel.branches.1.parent: the parents run in a circle, a -> b -> a; give one of "
        "these branches points instead",
        id="cyclic",
    ),
    pytest.param(
        branches("name: side, parent: main, at: 60 mm, angle: 60 deg, length: 30 mm, diameter: 2 mm"),
        {},
        "s.yaml:8: vessel.branches.1.at: 60 mm is beyond the end of 'main', which is 40 mm long; take 0 to 40 mm",
        id="at beyond",
    ),
    pytest.param(
        branches("name: side, parent: main, at: 20 mm, angle: 60 deg, length: 30 mm, diameter: -2 mm"),
        {},
        "s.yaml:8: vessel.branches.1.diameter: -2 mm is outside the plausible 0.1 mm to 100 mm",
        id="neg d",
    ),
    pytest.param(
        branches("name: side, parent: main, at: 20 mm, angle: 60 deg, length: 30 mm, diameter: [2 mm, -1 mm]"),
        {},
        "s.yaml:8: vessel.branches.1.diameter.1: -1 mm is outside the plausible 0.1 mm to 100 mm",
        id="neg d2",
    ),
    pytest.param(
        branches("name: side, parent: main, at: 20 mm, angle: 3 deg, length: 30 mm, diameter: 2 mm"),
        {},
        "s.yaml:8: vessel.branches.1.angle: 3 deg runs along the parent; take at least 10 deg, or "
        "put it at the parent's end",
        id="along",
    ),
    pytest.param(
        branches("name: side, parent: main, at: 20 mm, angle: 90 deg, length: 1.5 mm, diameter: 2 mm"),
        {},
        "s.yaml:8: vessel.branches.1.length: the branch ends inside 'main'; make it longer",
        id="short",
    ),
    pytest.param(
        branches("name: loop, points: [[10 mm, 0 mm], [10 mm, 20 mm], [30 mm, 20 mm], [30 mm, 0 mm]], diameter: 2 mm"),
        {},
        "s.yaml:8: vessel.branches.1: 'main' and 'loop' make a loop round an island at (20, 10.5) "
        "mm; loops are not supported, end a branch before it closes one",
        id="loop",
    ),
    pytest.param(
        branches("name: side, points: [[40 mm, 2 mm], [80 mm, 2 mm]], diameter: 2 mm"),
        {},
        "s.yaml:8: vessel.branches.1: the beginning lies half inside 'main' and half outside; move "
        "it, so that it lies wholly inside or wholly outside",
        id="half in",
    ),
    pytest.param(
        branches("name: side, diameter: 2 mm"),
        {},
        "s.yaml:8: vessel.branches.1.length: the branch has no course: give points, or parent, at, angle and length",
        id="missing course",
    ),
    pytest.param(
        branches("name: side, parent: main, angle: 60 deg, length: 30 mm, diameter: 2 mm"),
        {},
        "s.yaml:8: vessel.branches.1.length: the branch lacks at: give points, or parent, at, angle and length",
        id="missing at",
    ),
    pytest.param(
        branches(
            "name: side, points: [[0,0],[1,1]], parent: main, at: 1 mm, angle: 60 deg, length: 30 mm, diameter: 2 mm"
        ),
        {},
        "s.yaml:8: vessel.branches.1.length: parent, at, angle, length beside points: give points, "
        "or parent, at, angle and length",
        id="both",
    ),
    pytest.param(
        branches("name: main, parent: main, at: 20 mm, angle: 60 deg, length: 30 mm, diameter: 2 mm"),
        {},
        "s.yaml:8: vessel.branches.1.name: 'main' is the name of another branch too; rename one",
        id="twice",
    ),
    pytest.param(
        branches(
            "name: side, points: [[20 mm, 0 mm], [20 mm, 10 mm], [30 mm, 10 mm]], bend_radius: 12 mm, diameter: 2 mm"
        ),
        {},
        "s.yaml:8: vessel.branches.1.bend_radius: 12 mm needs 12 mm between the points 0 and 1, "
        "which are 10 mm apart; take a smaller one",
        id="bend",
    ),
    pytest.param(
        branches(
            "name: side, parent: main, at: 20 mm, angle: 60 deg, length: 30 mm, diameter: [[0 mm, 2 mm], [50 mm, 1 mm]]"
        ),
        {},
        "s.yaml:8: vessel.branches.1.diameter: has a row at 50 mm; the branch is 30 mm long",
        id="table",
    ),
    pytest.param(
        branches("name: side, parent: main, at: 20 mm, angel: 60 deg, length: 30 mm, diameter: 2 mm"),
        {},
        "s.yaml:8: vessel.branches.1.angel: unknown key; did you mean 'angle'? allowed: name, "
        "points, parent, at, angle, length, diameter, bend_radius, fillet, start, end",
        id="typo",
    ),
    pytest.param(
        "vessel: {kind: centreline, file: c.csv}\n",
        {"c.csv": "x [mm],y [mm],radius [mm]\n-20,0,3\n0,0,3\n1,0.3,3\n1.8,1,3\n2,2,3"},
        "c.csv:3: vessel: the lumen folds at (0.5, 0.15) mm: the centre line bends there more "
        "tightly than the lumen's radius, 3 mm; take a smaller diameter there or a gentler bend",
        id="folds",
    ),
    pytest.param(
        "vessel: {kind: centreline, file: c.csv}\n",
        {"c.csv": "x [mm],y [mm],diameter [mm]\n0,0,3\n"},
        "c.csv:1: vessel.file: header 'diameter [mm]' is not understood; write 'x,y,radius' in "
        "metres or 'x [mm],y [mm],radius [mm]', with columns z and branch if you like",
        id="cl header",
    ),
    pytest.param(
        "vessel: {kind: centreline, file: c.csv}\n",
        {"c.csv": "x,y,radius\n0,0,3\n40,0,3\n"},
        "c.csv:2: vessel.file: radius: 3000 mm is outside the plausible 0.05 mm to 50 mm; the header "
        "names the unit, as radius [mm], else it is metres",
        id="cl units",
    ),
    pytest.param(
        "vessel: {kind: centreline, file: c.csv}\n",
        {},
        "s.yaml:4: vessel.file: c.csv: there is no such file",
        id="cl missing",
    ),
    pytest.param(
        "vessel: {kind: centreline, file: c.csv}\n",
        {"c.csv": "x [mm],y [mm],radius [mm]\n0,0,3\n10,zero,3\n"},
        "c.csv:3: vessel.file: y: 'zero' is no number; write it as 2.5 or 1e-3",
        id="cl word",
    ),
    pytest.param(
        "vessel: {kind: centreline, file: c.csv}\n",
        {"c.csv": "x [mm],y [mm],radius [mm]\n0,0,3\n"},
        "c.csv:2: vessel.file: branch 'c' has one point; two at least are needed",
        id="cl one point",
    ),
    pytest.param(
        polygon("a.svg, length: 120 mm"),
        {"a.svg": '<svg xmlns="http://www.w3.org/2000/svg" >\n<path d="M 0 0 H 40 V 4 H 0 Z"/>\n</svg>'},
        "a.svg:1: vessel.file: the svg element has no viewBox, so its scale is unknown; write "
        "viewBox='0 0 120 80': left, top, width, height",
        id="svg no vb",
    ),
    pytest.param(
        polygon("a.svg, length: 120 mm"),
        {"a.svg": svg('<rect width="3"/>')},
        "a.svg:1: vessel.file: has no path element; turn the outline's shape into a path and save again",
        id="svg no path",
    ),
    pytest.param(
        polygon("a.svg, length: 120 mm"),
        {"a.svg": svg('<path d="M 0 0 H 40 V 4 H 0"/>')},
        "a.svg:2: vessel.file: the path is not closed; end its data with Z",
        id="svg open",
    ),
    pytest.param(
        polygon("a.svg, length: 120 mm"),
        {"a.svg": svg('<path d="M 0 0 H 40 V 4 X 0 Z"/>')},
        "a.svg:2: vessel.file: the path's data hold 'X', which is no command",
        id="svg data",
    ),
    pytest.param(
        polygon("a.svg, length: 120 mm"),
        {"a.svg": svg('<path d="M 0 0 H 40 V 4 H 0 Z"/>\n<path d="M 0 0 H 40 V 4 H 0 Z"/>')},
        "a.svg:3: vessel.file: has 2 paths; name the lumen's by id beside file; ids: none",
        id="svg two",
    ),
    pytest.param(
        polygon("a.svg, length: 120 mm"),
        {"a.svg": svg('<path d="M 0 0 H 40 V 4 H 0 Z M 10 1 h 2 v 1 z"/>')},
        "a.svg:2: vessel.file: the path has 2 parts; one closed outline is needed, islands are not supported",
        id="svg subpaths",
    ),
    pytest.param(
        polygon("a.svg"),
        {"a.svg": svg('<path d="M 0 0 H 40 V 4 H 0 Z"/>')},
        "a.svg:1: vessel.file: the svg element has no width in mm, cm or in, so its scale is unknown; "
        "give length beside file, the width of its viewBox: length: 120 mm",
        id="svg no length",
    ),
    pytest.param(
        polygon("a.svg, length: 120 mm"),
        {"a.svg": "<svg viewBox='0 0 1 1'><path></svg>"},
        "a.svg:1: vessel.file: is no XML: mismatched tag",
        id="svg xml",
    ),
    pytest.param(
        polygon("a.svg, length: 120 mm"),
        {"a.svg": svg('<path d="M 0 0 H 40 V 4 H 20 V -4 H 0 Z"/>')},
        "a.svg:2: vessel.file: the outline crosses itself at (20, 80) mm; give the corners in their "
        "order along the wall",
        id="svg cross",
    ),
    pytest.param(
        polygon("a.svg, length: 9 m"),
        {"a.svg": svg('<path d="M 0 0 H 4000 V 4 H 0 Z"/>')},
        "a.svg:1: vessel.file: the outline measures 300 m by 0.3 m, plausible is 0.1 mm to 10 m; "
        "look for a slip in unit or length beside file",
        id="svg units",
    ),
    pytest.param(
        polygon("a.geojson, unit: mm"),
        {"a.geojson": '{"type": "LineString", "coordinates": [[0, 0], [1, 1]]}'},
        "a.geojson: vessel.file: holds 'LineString'; a geometry of type Polygon is needed",
        id="geojson type",
    ),
    pytest.param(
        polygon("a.geojson, unit: mm"),
        {"a.geojson": '{"type": "Polygon", "coordinates": [[[0, 0], [1, 1], [1, 0]]]}'},
        "a.geojson: vessel.file: its Polygon is not closed; the last position must repeat the first, four at least",
        id="geojson open",
    ),
    pytest.param(
        polygon("a.geojson, unit: mm"),
        {"a.geojson": '{"type": "Polygon",\n'},
        "a.geojson:2: vessel.file: is no JSON: Expecting property name enclosed in double quotes",
        id="geojson json",
    ),
    pytest.param(
        polygon("a.wkt, unit: mm"),
        {"a.wkt": "POLYGON ((0 0, 40 0, 40 4, 0 4))"},
        "a.wkt:1: vessel.file: is no WKT: points of linearring do not form a closed linestring; "
        "write POLYGON ((x y, x y, ...))",
        id="wkt open",
    ),
    pytest.param(
        polygon("a.wkt, unit: mm"),
        {"a.wkt": "LINESTRING (0 0, 40 0)"},
        "a.wkt:1: vessel.file: holds a LINESTRING; one closed outline is needed, POLYGON ((x y, x y, ...))",
        id="wkt type",
    ),
    pytest.param(
        polygon("a.wkt, unit: mm"),
        {"a.wkt": "POLYGON ((0 0, 40 0, 40 4, 0 4, 0 0), (1 1, 2 1, 2 2, 1 1))"},
        "a.wkt:1: vessel.file: has 1 inner rings (islands), which are not supported; leave them out, or open the loop",
        id="wkt hole",
    ),
    pytest.param(
        polygon("a.wkt, unit: mm"),
        {"a.wkt": "x,y\n1,2"},
        "a.wkt:1: vessel.file: is no WKT: unknown type: 'x'; write POLYGON ((x y, x y, ...))",
        id="wkt text",
    ),
    pytest.param(polygon("no.csv"), {}, "s.yaml:4: vessel.file: no.csv: there is no such file", id="missing file"),
    pytest.param(
        polygon("a.dxf"),
        {"a.dxf": ""},
        "s.yaml:4: vessel.file: ends in .dxf; outlines are read from .csv, .wkt, .geojson, .json, .svg",
        id="ending",
    ),
    pytest.param(
        polygon("a.csv"),
        {"a.csv": "east,north\n0,0\n"},
        "a.csv:1: vessel.file: header 'east' is not understood; write 'x,y' for metres or 'x [mm],y "
        "[mm]', with a column 'open' if you like",
        id="csv header",
    ),
    pytest.param(
        polygon("a.csv"),
        {"a.csv": "x [mm],y [mm]\n0,0\n40,4\n40,0\n0,4\n"},
        "a.csv:2: vessel.file: the outline crosses itself at (20, 2) mm; give the corners in their "
        "order along the wall",
        id="csv cross",
    ),
    pytest.param(
        "vessel: {kind: file, file: no.yaml}\n",
        {},
        "s.yaml:4: vessel.file: no.yaml: there is no such file",
        id="shared missing",
    ),
    pytest.param(
        "vessel: {kind: file}\n",
        {},
        "s.yaml:4: vessel.file: is missing; write file: vessels/phantom.yaml, a file of a vessel's own keys",
        id="shared none",
    ),
    pytest.param(
        "vessel: {kind: file, file: v.yaml}\n",
        {
            "v.yaml": "kind: branches\nbranches:\n  - {name: main, points: [[0 mm, 0 mm], [40 mm, 0 mm]], "
            "diameter: 0 mm}\n"
        },
        "v.yaml:3: vessel.branches.0.diameter: 0 mm is outside the plausible 0.1 mm to 100 mm",
        id="shared wrong",
    ),
]


def told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str, files: dict[str, str]) -> str:
    monkeypatch.chdir(tmp_path)
    for name, content in files.items():
        Path(name).write_text(content)
    Path("s.yaml").write_text(text)
    with pytest.raises(ScenarioError) as error:
        build(load_scenario("s.yaml"))
    return str(error.value)


@pytest.mark.parametrize(("vessel", "files", "sentence"), MISTAKES)
def test_a_mistake_ends_in_one_sentence_with_place_and_remedy(tmp_path, monkeypatch, vessel, files, sentence):
    assert told(tmp_path, monkeypatch, HEAD + vessel, files) == sentence


def test_a_catheter_outside_of_the_branches(tmp_path, monkeypatch):
    text = HEAD.replace("bore", "exit: [0 mm, 9 mm], bore") + branches()
    assert told(tmp_path, monkeypatch, text, {}) == (
        "s.yaml:2: catheter.exit: (0 mm, 9 mm) is outside the lumen; "
        "move it inside, or turn catheter.direction so that it points into the vessel"
    )


def test_several_mistakes_are_told_at_once(tmp_path, monkeypatch):
    rows = branches(
        "name: a, parent: man, at: 1 mm, angle: 60 deg, length: 9 mm, diameter: 2 mm", "name: b, diameter: 0"
    )
    lines = told(tmp_path, monkeypatch, HEAD + rows, {}).splitlines()
    assert [line.split(": ")[:2] for line in lines] == [
        ["s.yaml:9", "vessel.branches.2.length"],
        ["s.yaml:9", "vessel.branches.2.diameter"],
    ]


SEMICOLONS = "its columns are separated by semicolons; separate them by commas, and write decimals with a point"


@pytest.mark.parametrize(
    ("kind", "text", "told"),
    [
        ("polygon", "x [mm];y [mm]\n0,5;-2,5\n", f":1: vessel.file: {SEMICOLONS}"),
        ("centreline", "x [mm];y [mm];radius [mm]\n0;0;3\n", f":1: vessel.file: {SEMICOLONS}"),
        ("polygon", "x [mm]\ty [mm]\n0\t-2\n", SEMICOLONS.replace("semicolons", "tabs")),
        ("polygon", "x [mm],y [mm]\n0,5,-2,5\n", "row has 4 cells, the header 2 (a decimal comma? write a point)"),
        ("polygon", b"\x89PNG\r\n\x1a\n\x00\x00", "a.csv: is a binary file, not text"),
        ("centreline", "x [mm],y [mm]\n".encode("utf-16"), "a.csv: is UTF-16 text; save it as UTF-8"),
        ("polygon", b"x,y\n" + b"1,2\n" * 6_000_000, "a.csv: is larger than 20 MB"),
        ("centreline", None, "a.csv: is a folder; a file is needed"),
    ],
    ids=["semicolons", "centreline semicolons", "tabs", "decimal commas", "binary", "utf-16", "huge", "folder"],
)
def test_files_that_other_programs_write(tmp_path, kind, text, told):
    vessel = tmp_path / "a.csv"
    if text is None:
        vessel.mkdir()
    else:
        vessel.write_bytes(text if isinstance(text, bytes) else text.encode())
    file = tmp_path / "s.yaml"
    file.write_text(HEAD + f"vessel: {{kind: {kind}, file: a.csv}}\n", encoding="utf-8")
    with pytest.raises(ScenarioError) as caught:
        load_scenario(file)
    assert told in str(caught.value)


CHANNEL = "[[0 mm, -2 mm], [60 mm, -2 mm], [60 mm, 2 mm], [0 mm, 2 mm]]"


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ("vessel.open_edges=[1, 3]", []),
        ("vessel.open_edges=[1]", ["through a wall of the vessel, at (0, 0) mm; if the vessel is open there, mark"]),
        ("catheter.direction=90 deg", ["through a wall of the vessel, at (20, -2) mm"]),
        ("catheter.exit=[30 mm, 0 mm]", []),
        (
            "vessel.points=[[0 mm, -20 mm], [60 mm, -20 mm], [60 mm, 20 mm], [0 mm, 20 mm]]",
            ["is 40 mm wide, 111 times as wide as the wire; see whether the vessel's unit"],
        ),
    ],
)
def test_what_may_be_meant_but_is_seldom_so_is_warned_of(tmp_path, changes, told):
    file = tmp_path / "s.yaml"
    exit_x = 20 if "direction" in changes else 0
    text = HEAD.replace("{bore", f"{{exit: [{exit_x} mm, 0 mm], bore") + (
        f"vessel: {{kind: polygon, points: {CHANNEL}, open_edges: [1, 3]}}\n"
    )
    file.write_text(text, encoding="utf-8")
    warnings = build(load_scenario(file, [changes])).warnings
    assert len(warnings) == len(told)
    assert all(part in warning for part, warning in zip(told, warnings, strict=True))


@pytest.mark.parametrize("name", list_shipped())
def test_the_shipped_scenarios_are_warned_of_nothing(name):
    assert build(load_scenario(name)).warnings == ()
