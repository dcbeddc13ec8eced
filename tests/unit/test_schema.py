"""What a scenario may say, how it is resolved, and the sentence for everything else."""

from __future__ import annotations

import copy
import json
import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from gw_exudyn.errors import ScenarioError
from gw_exudyn.scenario.loading import scenario_from_dict
from gw_exudyn.scenario.schema import Scenario, json_schema

GOOD: dict[str, Any] = {
    "wire": {
        "diameter": "0.36 mm",
        "length": "150 mm",
        "bending_stiffness": [
            {"from": "0 mm", "to": "45 mm", "value": "1.0 N*mm^2"},
            {"from": "45 mm", "to": "150 mm", "value": ["7.0 N*mm^2", "8.0 N*mm^2"]},
        ],
        "density": "6450 kg/m^3",
    },
    "vessel": {"kind": "straight", "length": "100 mm", "diameter": "4 mm"},
    "catheter": {"exit": ["0 mm", "1 mm"], "direction": "45 deg", "bore": "1.2 mm"},
    "drive": {"kind": "speed", "speed": "2 mm/s", "distance": "60 mm"},
}
SQUARE = [["0 mm", "0 mm"], ["10 mm", "0 mm"], ["10 mm", "10 mm"], ["0 mm", "10 mm"]]
REMOVE = object()


def changed(changes: dict[str, Any]) -> dict[str, Any]:
    """The good scenario with values set, or removed, by dotted path."""
    data = copy.deepcopy(GOOD)
    for path, value in changes.items():
        *parents, last = path.split(".")
        node: Any = data
        for part in parents:
            node = node[int(part)] if isinstance(node, list) else node.setdefault(part, {})
        if value is REMOVE:
            del node[last]
        else:
            node[int(last) if isinstance(node, list) else last] = value
    return data


def made(changes: dict[str, Any]) -> Scenario:
    """The good scenario with some changes."""
    return scenario_from_dict(changed(changes))


def told(changes: dict[str, Any], folder: Path | str = ".") -> list[str]:
    """What is wrong with it."""
    with pytest.raises(ScenarioError) as caught:
        scenario_from_dict(changed(changes), folder=folder)
    return str(caught.value).split("\n")


def test_values_are_in_si() -> None:
    scenario = made({})
    wire = scenario.wire
    assert (wire.diameter, wire.length, wire.density) == (0.00036, 0.15, 6450.0)
    pieces = [(piece.start, piece.end, piece.value, piece.value_end) for piece in wire.bending_stiffness]
    assert pieces == [(0.0, 0.045, 1e-6, 1e-6), (0.045, 0.15, 7e-6, 8e-6)]
    assert scenario.catheter.exit == (0.0, 0.001)
    assert scenario.catheter.direction == math.pi / 4
    assert (scenario.drive.time, scenario.drive.speed) == ((0.0, 30.0), (0.002, 0.002))


def test_defaults() -> None:
    scenario = made({})
    wire, contact, solver = scenario.wire, scenario.contact, scenario.solver
    assert (wire.model, wire.damping_time, wire.segments, wire.grading, wire.imperfection) == (
        None,
        0.02,
        200,
        1.0,
        None,
    )
    assert wire.tip_shape.kind == "straight"
    assert (contact.friction_coefficient, contact.wall_stiffness, contact.wall_damping) == (0.4, None, None)
    assert contact.tangential_stiffness is None
    assert (solver.step, solver.tolerance, solver.minimum_step) == (0.05, 1e-6, 1e-6)
    assert scenario.output.interval == 0.1
    assert scenario.catheter.friction_coefficient is None
    assert scenario.name == "scenario"


def test_an_empty_section_is_its_default() -> None:
    """As when all its lines are commented out."""
    assert made({"contact": None, "stop": None, "solver": None, "output": None}) == made({})


def test_a_scenario_is_frozen_hashable_and_survives_pickling() -> None:
    scenario = made({})
    with pytest.raises(ValidationError, match="frozen"):
        scenario.wire.segments = 3
    assert pickle.loads(pickle.dumps(scenario)) == scenario
    assert hash(scenario) == hash(made({}))
    assert scenario != made({"wire.segments": 100})


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"wire.model": "universal-ii", "wire.imperfection": "0.01 1/m", "contact.wall_stiffness": "2 N/mm"},
        {
            "wire.tip_shape": {"kind": "bend", "length": "5 mm", "angle": "-30 deg"},
            "catheter.friction_coefficient": 0.1,
        },
        {"vessel": {"kind": "arc", "radius": "15 mm", "angle": "90 deg", "diameter": "4 mm", "end": "dead"}},
        {"vessel": {"kind": "polygon", "points": SQUARE[::-1], "open_edges": [1]}},
        {
            "drive": {
                "kind": "speed",
                "phases": [{"speed": 0.002, "distance": 0.05, "ramp": 0.3}, {"speed": 0, "duration": 7}],
            }
        },
        {"drive": {"kind": "speed", "table": [[0, 0], [1, 0.002], [1, 0.001], [3, -0.001]]}},
    ],
)
def test_the_resolved_scenario_is_a_scenario_again(changes: dict[str, Any]) -> None:
    scenario = made(changes)
    data = scenario.to_dict()
    assert scenario_from_dict(json.loads(json.dumps(data, allow_nan=False))) == scenario


def test_numpy_numbers_are_numbers() -> None:
    scenario = made({"wire.segments": np.int64(50), "wire.diameter": np.float64(0.0004), "wire.grading": np.float32(2)})
    assert (scenario.wire.segments, scenario.wire.diameter, scenario.wire.grading) == (50, 0.0004, 2.0)


@pytest.mark.parametrize(
    ("changes", "sentences"),
    [
        ({"wire.diameter": 0.36}, ["wire.diameter: 0.36 m is outside the plausible 0.05 mm to 5 mm; a bare number is "
                                   "in SI (m): write '0.36 mm'"]),
        ({"wire.diameter": "36 mm"}, ["wire.diameter: 36 mm is outside the plausible 0.05 mm to 5 mm"]),
        ({"wire.diameter": "0.36 N"}, ["wire.diameter: '0.36 N' is a force, not a length; units that fit: m, cm, mm, "
                                       "um, in, Fr"]),
        ({"wire.diameter": True}, ["wire.diameter: true is no quantity; write a number in SI (m) or text such as "
                                   "'2.5 mm'"]),
        ({"wire.diameter": [1]}, ["wire.diameter: a list of 1 item is no quantity; write a number in SI (m) or text "
                                  "such as '2.5 mm'"]),
        ({"wire.diameter": math.nan}, ["wire.diameter: nan is no finite number"]),
        ({"wire.length": 10**400}, ["wire.length: a whole number of more than 60 digits is too large a number"]),
        ({"wire.segments": 3.7}, ["wire.segments: 3.7 is no whole number; a whole number from 1 to 5000 is needed"]),
        ({"wire.segments": "3"}, ["wire.segments: '3' is text; a whole number from 1 to 5000 is needed, without "
                                  "quotes"]),
        ({"wire.segments": 5001}, ["wire.segments: 5001 is out of range; a whole number from 1 to 5000 is needed"]),
        ({"wire.segments": 0}, ["wire.segments: 0 is out of range; a whole number from 1 to 5000 is needed"]),
        ({"wire.segments": True}, ["wire.segments: true is no whole number; a whole number from 1 to 5000 is needed"]),
        ({"wire.grading": 0}, ["wire.grading: 0 is out of range; allowed: 0.05 to 50"]),
        ({"wire.density": REMOVE}, ["wire.density: is missing: mean density; write density: 6450 kg/m^3, or name a "
                                    "wire of the catalogue by model; all of them: gw-exudyn list wires"]),
        ({"wire.imperfection": "1 deg"}, ["wire.imperfection: '1 deg' is an angle, not a curvature; units that fit: "
                                          "1/m, 1/mm, 1/cm; or write auto"]),
        ({"wire.tip_shape": {"kind": "arc", "length": "10 mm"}}, [
         "wire.tip_shape.angle: is missing: the kind arc needs it; for example angle: 45 deg"]),
        ({"wire.tip_shape": {"kind": "straight", "angle": 1}}, [
         "wire.tip_shape.angle: a straight tip has none; remove it, or take kind: arc or bend"]),
        ({"wire.tip_shape": {"kind": "arc", "length": "200 mm", "angle": 1}}, [
         "wire.tip_shape: is 200 mm long, the wire only 150 mm"]),
        ({"contact.friction_coefficient": "0.4"}, ["contact.friction_coefficient: '0.4' is text; a plain number from "
                                                   "0 to 2 is needed"]),
        ({"contact.friction_coefficient": -0.1}, ["contact.friction_coefficient: -0.1 is out of range; allowed: 0 to "
                                                  "2"]),
        ({"contact.regularisation_speed": 1}, ["contact.regularisation_speed: unknown key; allowed: "
                                               "friction_coefficient, wall_stiffness, "
                                               "wall_damping, tangential_stiffness, patches"]),
        ({"vessel": {"kind": "branches"}}, ["vessel.branches: is missing: the branches; for example branches: [{name: "
                                            "main, points: [[0 mm, 0 mm], [40 mm, 0 mm]], diameter: 4 mm}]"]),
        ({"vessel.kind": "strait"}, ["vessel.kind: 'strait' is not known here; did you mean 'straight'? allowed: "
                                     "straight, arc, branches, centreline, polygon, file, none"]),
        ({"vessel.kind": REMOVE}, ["vessel.kind: is missing: what the vessel is; allowed: straight, arc, "
                                   "branches, centreline, polygon, file, none"]),
        ({"vessel": 3}, ["vessel: 3 stands where a vessel is needed: lines of 'key: value', the first kind: straight "
                         "| arc | branches | centreline | polygon | file | none"]),
        ({"vessel.end": "closed"}, ["vessel.end: 'closed' is not known here; allowed: open, dead"]),
        ({"vessel.length": REMOVE}, ["vessel.length: is missing: length along x; for example length: 100 mm"]),
        ({"vessel": {"kind": "arc", "radius": "2 mm", "angle": "90 deg", "diameter": "4 mm"}},
         ["vessel.radius: 2 mm is not beyond half the diameter, 2 mm: the inner wall would vanish"]),
        ({"vessel": {"kind": "arc", "radius": "20 mm", "angle": "90 deg", "diameter": "4 mm", "facets": 1}},
         ["vessel.facets: 1 facets turn 90 deg each, at most 45; take 2 or more"]),
        ({"vessel": {"kind": "arc", "radius": "10 mm", "angle": "300 deg", "diameter": "4 mm", "lead_in": "30 mm",
                     "lead_out": "40 mm"}},
         ["vessel.angle: the arc's end runs across its beginning; take a smaller angle, a shorter lead_out, or a "
          "larger radius"]),
        ({"catheter": None}, ["catheter: is empty; the catheter is needed: lines of 'key: value' with exit, "
                              "direction, bore, friction_coefficient"]),
        ({"catheter.exit": [0, 0, 0]}, ["catheter.exit: has 3 items; [x, y] is needed"]),
        ({"catheter.exit": [0, "1 s"]}, ["catheter.exit.1: '1 s' is a time, not a length; units that fit: m, cm, mm, "
                                         "um, in, Fr"]),
        ({"catheter.bore": REMOVE, "catheter.boar": "1 mm"}, [
         "catheter.boar: unknown key; did you mean 'bore'? allowed: exit, direction, bore, friction_coefficient"]),
        ({"drive.kind": "forze"}, ["drive.kind: 'forze' is not known here; did you mean 'force'? allowed: speed, "
                                   "force, tip_speed"]),
        ({"drive.kind": REMOVE}, ["drive.kind: is missing: what the drive is; allowed: speed, force, tip_speed"]),
        ({"drive.duration": 3}, ["drive.distance: distance and duration are both given; give one of the two"]),
        ({"drive.distance": REMOVE}, ["drive.distance: is missing: how far or how long; give distance: 60 mm, or "
                                      "duration: 30 s"]),
        ({"drive.speed": 0}, ["drive.distance: a speed of 0 covers no distance; give a duration to hold"]),
        ({"drive.distance": "-1 mm"}, ["drive.distance: -1 mm is outside the plausible 0.001 mm to 5000 mm"]),
        ({"drive.ramp": "70 s"}, ["drive.ramp: 70 s is longer than the phase lasts; shorten it"]),
        ({"drive.table": [[0, 0], [1, 0]]}, ["drive.table: stands beside speed; give one of speed, phases, table"]),
        ({"drive": {"kind": "speed", "phases": []}}, ["drive.phases: has 0 phases; 1 to 10000 are needed"]),
        ({"drive": {"kind": "speed", "phases": [{"speed": 0, "duration": 1}], "ramp": 1}}, [
         "drive.ramp: stands beside phases; put it into a phase"]),
        ({"drive": {"kind": "speed", "table": [[0.1, 0], [1, 0], [1, 1], [1, 0], [0.5, 0]]}},
         ["drive.table.0: begins at 0.1 s; the first time is 0", "drive.table.3: a third row at 1 s; two make a step",
          "drive.table.4: 0.5 s comes after 1 s; times never fall"]),
        ({"drive": {"kind": "speed"}}, ["drive: says no speed; give speed with distance or duration, or phases, or "
                                        "table"]),
        ({"drive.speed": "1 um/s", "drive.distance": "1 m"}, [
         "drive.speed: the drive lasts 1e+06 s, at most 100000 s are allowed; a faster speed or a shorter way"]),
        ({"solver.minimum_step": 0.5}, ["solver.minimum_step: 0.5 s is larger than the step, 0.05 s"]),
        ({"drive": {"kind": "speed", "speed": 0, "duration": "1e5 s"}, "output.interval": "1 ms"},
         ["output: makes 1e+08 outputs, at most 1000000 are kept; take an interval of 0.1 s or more"]),
        ({"name": "../x"}, ["name: '../x' cannot name a folder; letters, digits and _ . + - are allowed, a letter or "
                            "digit first, 100 in all"]),
        ({"wire": REMOVE}, ["wire: is missing: the wire; for example wire: {model: universal-ii}"]),
        ({"wire.model": "universal"}, ["wire.model: 'universal' is not in the catalogue; did you mean "
                                       "'universal-ii'? all of them: gw-exudyn list wires"]),
    ],
)  # fmt: skip
def test_everything_wrong_has_its_sentence(changes: dict[str, Any], sentences: list[str]) -> None:
    assert told(changes) == sentences


def test_one_slip_is_one_problem() -> None:
    """That the right name is missing, or what it would have given, is no second mistake."""
    wire = {"modle": "universal-ii"}
    assert [line.split(":")[0] for line in told({"wire": wire})] == ["wire.modle"]
    phase = {"speed": 0.001, "distanze": 0.05}
    assert [line.split(":")[0] for line in told({"drive": {"kind": "speed", "phases": [phase]}})] == [
        "drive.phases.0.distanze"
    ]


class TestBendingStiffness:
    """Forms in which it may be given, and how they must fit the wire."""

    def test_one_value_is_for_the_whole_wire(self) -> None:
        (piece,) = made({"wire.bending_stiffness": "7 N*mm^2"}).wire.bending_stiffness
        assert (piece.start, piece.end, piece.value, piece.value_end) == (0.0, 0.15, 7e-6, 7e-6)

    def test_a_table_is_linear_in_between_and_may_step(self) -> None:
        table = [[0, "1 N*mm^2"], ["50 mm", "2 N*mm^2"], ["50 mm", "5 N*mm^2"], ["150 mm", "7 N*mm^2"]]
        pieces = made({"wire.bending_stiffness": {"table": table}}).wire.bending_stiffness
        assert [(p.start, p.end, p.value, p.value_end) for p in pieces] == [
            (0.0, 0.05, 1e-6, 2e-6),
            (0.05, 0.15, 5e-6, 7e-6),
        ]

    def test_pieces_in_any_order(self) -> None:
        reverse = GOOD["wire"]["bending_stiffness"][::-1]
        assert made({"wire.bending_stiffness": reverse}) == made({})

    @pytest.mark.parametrize(
        ("pieces", "sentences"),
        [
            ([(0, 45), (50, 150)], ["1: a gap: nothing from 45 mm to 50 mm; pieces must meet"]),
            ([(0, 45), (40, 150)], ["1: an overlap: 40 mm to 45 mm is given twice; pieces must meet"]),
            ([(5, 150)], ["0: a gap: nothing from 0 mm to 5 mm; pieces must meet"]),
            ([(0, 140)], ["0: ends at 140 mm, the wire at 150 mm: the rest of the wire has no stiffness; the last "
                          "end is the wire's length"]),
            ([(0, 160)], ["0: ends at 160 mm, the wire at 150 mm: it goes beyond the wire; the last end is the "
                          "wire's length"]),
            ([(0, 150), (20, 10)], ["1: goes from 20 mm to 10 mm; 'to' must lie beyond 'from'"]),
        ],
    )  # fmt: skip
    def test_pieces_must_cover_the_wire(self, pieces: list[tuple[int, int]], sentences: list[str]) -> None:
        raw = [{"from": f"{a} mm", "to": f"{b} mm", "value": 1e-6} for a, b in pieces]
        assert told({"wire.bending_stiffness": raw}) == [f"wire.bending_stiffness.{sentence}" for sentence in sentences]

    @pytest.mark.parametrize(
        ("raw", "sentence"),
        [
            ([], ": has 0 pieces; 1 to 10000 are needed"),
            ({}, ": a mapping without table; write a list of {from, to, value}, or table: [[s, EI], ...]"),
            ({"tabel": []}, ".tabel: unknown key; did you mean 'table'? allowed: table, or a list of pieces"),
            ({"table": [[0, 1e-6]]}, ".table: has 1 row; at least 2 are needed"),
            ({"table": [[0, 1e-6], [0.15, 0]]}, ".table.1.1: 0 N*m^2 is outside the plausible 0.0001 N*mm^2 to 1e+06 "
                                                "N*mm^2"),
            ({"table": [[0.01, 1e-6], [0.15, 1e-6]]}, ".table.0: begins at 10 mm; the first row is at the tip, 0"),
            ({"table": [[0, 1e-6], [0.1, 1e-6], [0.05, 1e-6], [0.15, 1e-6]]},
             ".table.2: 50 mm comes after 100 mm; rows go from the tip on"),
            ([{"from": 0, "to": 0.15}], ".0: has no bending stiffness; give value (as value: 1.0 N*mm^2), or core and "
                                        "modulus"),
            ([{"from": 0, "to": 0.15, "value": "7 N"}], ".0.value: '7 N' is a force, not a bending stiffness; units "
                                                        "that fit: N*m^2, N*cm^2, N*mm^2"),
            ([3], ".0: 3 stands where a piece of the bending stiffness is needed: lines of 'key: value' with from, "
                  "to, value, core, modulus"),
        ],
    )  # fmt: skip
    def test_what_is_no_stiffness(self, raw: Any, sentence: str) -> None:
        assert told({"wire.bending_stiffness": raw}) == [f"wire.bending_stiffness{sentence}"]

    def test_it_is_checked_even_if_the_length_is_wrong(self) -> None:
        raw = [{"from": 0, "to": "7 N", "value": 1e-6}]
        assert len(told({"wire.length": "7 N", "wire.bending_stiffness": raw})) == 2


class TestPolygon:
    """Outlines from points and from CSV files."""

    def test_it_becomes_counter_clockwise_with_its_open_edges(self) -> None:
        given = made({"vessel": {"kind": "polygon", "points": SQUARE, "open_edges": [1]}}).vessel
        turned = made({"vessel": {"kind": "polygon", "points": SQUARE[::-1], "open_edges": [1]}}).vessel
        assert given.kind == turned.kind == "polygon"
        assert given.points == ((0.0, 0.0), (0.01, 0.0), (0.01, 0.01), (0.0, 0.01))
        assert given.open_edges == (1,)
        # Clockwise as given, edge 1 goes from (10, 10) to (10, 0); it must still join the same two corners.
        (edge,) = turned.open_edges
        assert {turned.points[edge], turned.points[edge + 1]} == {(0.01, 0.01), (0.01, 0.0)}
        assert (
            sum(
                x * v - u * y
                for (x, y), (u, v) in zip(turned.points, turned.points[1:] + turned.points[:1], strict=True)
            )
            > 0
        )

    def test_a_last_point_that_repeats_the_first_is_dropped(self) -> None:
        assert made({"vessel": {"kind": "polygon", "points": [*SQUARE, SQUARE[0]]}}) == made(
            {"vessel": {"kind": "polygon", "points": SQUARE}}
        )

    @pytest.mark.parametrize(
        ("vessel", "sentence"),
        [
            ({"points": SQUARE[:2]}, ".points: has 2 points; at least 3 are needed"),
            ({"points": [*SQUARE[:2], SQUARE[0]]}, ".points: has 2 different points; an outline needs at least 3"),
            ({"points": [SQUARE[0], SQUARE[2], SQUARE[1], SQUARE[3]]},
             ".points.0: the outline crosses itself at (5, 5) mm; give the corners in their order along the wall"),
            ({"points": [SQUARE[0], SQUARE[0], *SQUARE[1:]]},
             ".points.1: repeats the point before it, (0, 0) mm; remove one"),
            ({"points": [[0, 0], [1, 0], [2, 0]]}, ".points.0: the outline "),
            ({"points": [[0, 0], [9, 0], [9, 9], [-9, 9]]}, ".points: the outline measures 18 m by 9 m, plausible is "
                                                            "0.1 mm to 10 m; bare numbers are metres: "
             "write the unit, 'x [mm],y [mm]' in a CSV file, '1 mm' in a list"),
            ({"points": [*SQUARE, 3]}, ".points.4: 3 is no list; [x, y] is needed"),
            ({"points": SQUARE, "file": REMOVE}, ".points: stands beside file; give one of the two"),
            ({}, ".points: is missing: give file: outline.csv, or points: [[0 mm, 0 mm], ...]"),
            ({"points": SQUARE, "open_edges": [4]}, ".open_edges.0: there is no edge 4; the outline has 4, 0 to 3"),
            ({"points": SQUARE, "open_edges": [1, 1]}, ".open_edges.1: edge 1 is given twice"),
            ({"points": SQUARE, "open_edges": [-1]}, ".open_edges.0: -1 is out of range; a whole number from 0 to "
                                                     "100000 is needed"),
        ],
    )  # fmt: skip
    def test_what_is_no_outline(self, tmp_path: Path, vessel: dict[str, Any], sentence: str) -> None:
        if vessel.get("file") is REMOVE:
            (tmp_path / "o.csv").write_text("x,y\n0,0\n0.01,0\n0,0.01\n")
            vessel = {**vessel, "file": "o.csv"}
        (line,) = told({"vessel": {"kind": "polygon", **vessel}}, tmp_path)
        assert line.startswith(f"vessel{sentence}")

    @pytest.mark.parametrize("header", ["x,y", "x [m],y [m]"])
    def test_a_csv_file_in_metres(self, tmp_path: Path, header: str) -> None:
        (tmp_path / "o.csv").write_text(f"{header}\n0,0\n0.01,0\n0,1e-2\n")
        vessel = scenario_from_dict(changed({"vessel": {"kind": "polygon", "file": "o.csv"}}), folder=tmp_path).vessel
        assert vessel.kind == "polygon"
        assert vessel.points == ((0.0, 0.0), (0.01, 0.0), (0.0, 0.01))

    def test_a_csv_file_with_units_comments_open_ends_and_windows_line_ends(self, tmp_path: Path) -> None:
        text = "\ufeff# a comment\r\nopen, y [mm] ,x [mm]\r\n\r\n1,0,0\r\n0,0,0.36\r\n0,10,0\r\n0,0,0\r\n"
        (tmp_path / "o.csv").write_bytes(text.encode())
        vessel = scenario_from_dict(changed({"vessel": {"kind": "polygon", "file": "o.csv"}}), folder=tmp_path).vessel
        assert vessel.kind == "polygon"
        assert vessel.points == ((0.0, 0.0), (0.00036, 0.0), (0.0, 0.01))
        assert vessel.open_edges == (0,)

    @pytest.mark.parametrize(
        ("text", "sentences"),
        [
            ("", [":1: vessel.file: is empty; a header is needed, 'x,y' for metres or 'x [mm],y [mm]', with a column "
                  "'open' if you like, "
                  "then one point a line"]),
            ("0,0\n1,1\n", [":1: vessel.file: header '0' is not understood; write 'x,y' for metres or 'x [mm],y "
                            "[mm]', with a column 'open' if you like"]),
            ("x;y\n0;0\n", [":1: vessel.file: header 'x;y' is not understood; separate with commas, not semicolons; "
                            "write 'x,y' for metres or 'x [mm],y [mm]', with a column 'open' if you like"]),
            ("x [N],y [N]\n", [":1: vessel.file: header: 'N' is a force, not a length; units that fit: m, cm, mm, "
                               "um, in, Fr"]),
            ("x [mm],y\n", [":1: vessel.file: header gives x and y different units; give both the same"]),
            ("x,x\n", [":1: vessel.file: header has the columns x, x; write 'x,y' for metres or 'x [mm],y [mm]', "
                       "with a column 'open' if you like"]),
            ("x,y\n0,0\n1,oops\n1\n0,nan\n", [":3: vessel.file: y: 'oops' is no number; write it as 2.5 or 1e-3",
                                              ":4: vessel.file: row has 1 cells, the header 2; write x,y",
                                              ":5: vessel.file: y: 'nan' is no number; write it as 2.5 or 1e-3"]),
            ("x,y,open\n0,0,2\n", [":2: vessel.file: open: '2' is neither 0 (wall) nor 1 (open end)"]),
            ("x,y\n0,0\n60,0\n60,4\n", [":1: vessel.file: the outline measures 60 m by 4 m, plausible is 0.1 mm to "
                                        "10 m; bare numbers are metres: "
                                        "write the unit, 'x [mm],y [mm]' in a CSV file, '1 mm' in a list"]),
            ("x [mm],y [mm]\n0,0\n9,9\n9,0\n0,9\n", [":2: vessel.file: the outline crosses itself at (4.5, 4.5) mm; "
                                                     "give the corners in their order along the wall"]),
        ],
    )  # fmt: skip
    def test_what_is_wrong_in_a_csv_file_has_its_line(self, tmp_path: Path, text: str, sentences: list[str]) -> None:
        (tmp_path / "o.csv").write_text(text)
        lines = told({"vessel": {"kind": "polygon", "file": "o.csv"}}, tmp_path)
        assert lines == [f"{tmp_path / 'o.csv'}{sentence}" for sentence in sentences]

    def test_a_csv_file_that_is_not_there(self, tmp_path: Path) -> None:
        (line,) = told({"vessel": {"kind": "polygon", "file": "o.csv"}}, tmp_path)
        assert line == f"vessel.file: {tmp_path / 'o.csv'}: there is no such file"


class TestDrive:
    """Every form becomes a table of speed against time; the area under it is the travel."""

    @pytest.mark.parametrize(
        ("drive", "time", "speed"),
        [
            ({"speed": 0.002, "duration": 5}, (0, 5), (0.002, 0.002)),
            ({"speed": -0.002, "distance": 0.01}, (0, 5), (-0.002, -0.002)),
            ({"speed": 0.002, "distance": 0.01, "ramp": 2}, (0, 2, 6), (0, 0.002, 0.002)),
            ({"phases": [{"speed": 0.001, "duration": 1}, {"speed": 0, "duration": 2},
                         {"speed": -0.001, "distance": 0.001}]},
             (0, 1, 1, 3, 3, 4), (0.001, 0.001, 0, 0, -0.001, -0.001)),
            ({"phases": [{"speed": 0.001, "duration": 1}, {"speed": 0.001, "duration": 2}]},
             (0, 1, 3), (0.001, 0.001, 0.001)),
            ({"table": [[0, 0], [1, 0.001]]}, (0, 1), (0, 0.001)),
        ],
    )  # fmt: skip
    def test_forms(self, drive: dict[str, Any], time: tuple[float, ...], speed: tuple[float, ...]) -> None:
        found = made({"drive": {"kind": "speed", **drive}}).drive
        assert found.time == pytest.approx(time, rel=1e-12)
        assert found.speed == pytest.approx(speed, rel=1e-12)

    def test_a_distance_is_the_travel_of_its_phase_ramp_included(self) -> None:
        phases = [{"speed": 0.002, "distance": 0.05, "ramp": 0.5}, {"speed": -0.001, "distance": 0.02, "ramp": 0.7}]
        drive = made({"drive": {"kind": "speed", "phases": phases}}).drive
        assert np.trapezoid(drive.speed, drive.time) == pytest.approx(0.05 - 0.02, rel=1e-12)

    def test_times_never_fall_and_at_most_two_are_equal(self) -> None:
        phases = [{"speed": 0.002, "duration": 1, "ramp": 1}, {"speed": 0.001, "duration": 1, "ramp": 1}]
        drive = made({"drive": {"kind": "speed", "phases": phases}}).drive
        assert (drive.time, drive.speed) == ((0, 1, 2), (0, 0.002, 0.001))


class TestJsonSchema:
    """The schema of the file, for editors."""

    def test_it_describes_the_file_and_not_the_program(self) -> None:
        schema = json_schema()
        json.dumps(schema, allow_nan=False)
        assert schema["required"] == ["wire", "vessel", "catheter", "drive"]
        wire = schema["$defs"]["WireSpec"]
        assert "required" not in wire
        assert wire["additionalProperties"] is False
        assert {"type": "string"}.items() <= wire["properties"]["diameter"]["anyOf"][1].items()
        assert "phases" in schema["$defs"]["DriveForm"]["properties"]
        assert "file" in schema["$defs"]["PolygonForm"]["properties"]

    def test_every_key_is_described(self) -> None:
        for name, part in json_schema()["$defs"].items():
            for key, value in part.get("properties", {}).items():
                assert key == "kind" or value.get("description"), f"{name}.{key}"


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize(
    ("angle", "lead_in", "lead_out", "clear"),
    [
        (300, 30, 40, False),
        (300, 30, 1, True),
        (300, 30, 5, False),
        (300, 0, 0, True),
        (270, 30, 40, False),
        (270, 5, 40, True),
        (180, 30, 40, True),
        (360, 0, 0, False),
        (360, 30, 0, False),
        (340, 0, 0, True),
        (0.001, 30, 40, True),
    ],
)
def test_an_arc_keeps_clear_of_itself(side: int, angle: float, lead_in: float, lead_out: float, clear: bool) -> None:
    lengths = {"diameter": "4 mm", "radius": "10 mm", "lead_in": f"{lead_in} mm", "lead_out": f"{lead_out} mm"}
    vessel = {"kind": "arc", "angle": f"{side * angle} deg", **lengths}
    if clear:
        assert made({"vessel": vessel}).vessel.kind == "arc"
    else:
        with pytest.raises(ScenarioError, match=r"vessel\.angle: the arc's end runs across its beginning"):
            made({"vessel": vessel})


@pytest.mark.parametrize("radius", ["2.000001 mm", "2.1 mm", "4 m"])
def test_an_arc_with_a_tight_inner_wall_or_many_facets_is_clear_of_itself(radius: str) -> None:
    vessel = {"kind": "arc", "angle": "90 deg", "diameter": "4 mm", "radius": radius, "facets": 5000, "lead_in": 0.01}
    assert made({"vessel": vessel}).vessel.kind == "arc"
