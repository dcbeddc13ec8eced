"""`check`, `info` and `schema`: what they write, and that programs can read it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import yaml

from gw_exudyn.scenario import list_shipped, load_scenario, scenario_from_dict
from gw_exudyn.scenario.shipped import shipped_folder

FIVE_MISTAKES = """\
name: five
wire: {model: universal-iii, segments: 3.7}
vessel: {kind: straight, length: 100 mm, diametre: 4 mm}
catheter: {bore: 1.2 kg}
drive: {kind: speed, speed: 2 mm/s}
"""

CORNER = """\
wire: {model: universal-ii}
vessel:
  kind: polygon
  points: [[0, -2 mm], [32 mm, -2 mm], [32 mm, 60 mm], [28 mm, 60 mm], [28 mm, 2 mm], [0, 2 mm]]
  open_edges: [2, 5]
catheter: {bore: 1.2 mm}
drive: {kind: speed, speed: 2 mm/s, distance: 60 mm}
"""


@pytest.fixture
def damaged(gw, solver):
    """Write a run, change the content of its run.json, and give the folder."""

    def change_run(change):
        gw("run", "straight", "-q", "--no-figures")
        file = Path("results/runs/straight/run.json")
        content = json.loads(file.read_text())
        change(content)
        file.write_text(json.dumps(content))
        return str(file.parent)

    return change_run


@pytest.mark.parametrize("name", list_shipped())
def test_every_shipped_scenario_passes(gw, name):
    outcome = gw("check", name)
    assert outcome.code == 0
    assert outcome.err == ""
    assert name in outcome.out


def test_the_summary_tells_what_would_be_run(gw):
    Path("corner.yaml").write_text(CORNER)
    rows = dict(line.split("  ", 1) for line in gw("check", "corner.yaml").out.splitlines())
    rows = {label: text.strip() for label, text in rows.items()}
    assert rows["wire"] == "universal-ii, 0.36 mm by 150 mm"
    assert rows["bending stiffness"] == "1 N*mm^2 to 7 N*mm^2"
    assert rows["segments"] == "200 of 0.75 mm"
    assert rows["vessel"] == "polygon, 4 walls, 1 corner into the lumen"
    assert rows["catheter"].endswith("bore 1.2 mm, 0.84 mm wider than the wire")
    assert rows["wall stiffness"].endswith("N/m, chosen")
    assert rows["drive"] == "60 mm in, 30 s in all"
    assert rows["solver steps"] == "about 600 of 50 ms"


def test_five_mistakes_are_told_at_once_with_their_lines(gw):
    Path("five.yaml").write_text(FIVE_MISTAKES)
    outcome = gw("check", "five.yaml")
    assert outcome.code == 3
    assert outcome.out == ""
    starts = [line.split(": ")[:2] for line in outcome.err.splitlines()]
    assert starts == [
        ["five.yaml:2", "wire.model"],
        ["five.yaml:2", "wire.segments"],
        ["five.yaml:3", "vessel.diametre"],
        ["five.yaml:4", "catheter.bore"],
        ["five.yaml:5", "drive.distance"],
    ]


def test_json_of_a_good_and_of_a_bad_scenario(gw):
    good = json.loads(gw("check", "straight", "--set", "wire.segments=50", "--json").out)
    assert good["valid"] is True
    assert good["model"]["wire.segments"] == 50
    Path("five.yaml").write_text(FIVE_MISTAKES)
    outcome = gw("check", "five.yaml", "--json")
    bad = json.loads(outcome.out)
    assert outcome.code == 3
    assert bad["valid"] is False
    assert len(bad["problems"]) == 5
    assert set(bad["problems"][0]) == {"path", "message", "file", "line"}


def test_an_override_is_checked_as_the_file_is(gw):
    outcome = gw("check", "straight", "--set", "wire.segmnts=3", "--set", "wire.diameter=0.36")
    assert outcome.code == 3
    assert "did you mean 'segments'" in outcome.err
    assert "0.36 mm" in outcome.err


@pytest.mark.parametrize("name", list_shipped())
def test_info_json_of_a_scenario_is_the_scenario(gw, name):
    assert scenario_from_dict(json.loads(gw("info", name, "--json").out)) == load_scenario(name)


def test_info_shows_units_and_what_the_file_leaves_out(gw):
    lines = gw("info", "push-hold-pull").out.splitlines()
    rows = dict(line.split(maxsplit=1) for line in lines)
    assert rows["wire.diameter"] == "0.36 mm"
    assert rows["wire.bending_stiffness.0"] == "0 mm to 45 mm from the tip: 1 N*mm^2"
    assert rows["catheter.exit"] == "[0 mm, 0 mm]"
    assert rows["contact.wall_stiffness"] == "auto"
    assert rows["drive.table.1"] == "at 0.5 s: 2 mm/s"
    assert rows["solver.step"] == "0.05 s"


def test_info_cuts_long_lists(gw):
    points = [[0.001 * i, 0] for i in range(60)] + [[0.001 * i, 0.004] for i in reversed(range(60))]
    Path("long.csv").write_text("x,y\n" + "".join(f"{x},{y}\n" for x, y in points))
    text = "vessel: {kind: polygon, file: long.csv}\nwire: {model: universal-ii}\ncatheter: {bore: 1 mm}\n"
    Path("long.yaml").write_text(text + "drive: {kind: speed, speed: 1 mm/s, distance: 1 mm}\n")
    assert "... and 108 more" in gw("info", "long.yaml").out


def test_info_of_a_run(gw, solver):
    gw("run", "straight", "-q", "--no-figures")
    outcome = gw("info", "results/runs/straight")
    assert outcome.code == 0
    assert "The run reached its end" in outcome.out
    assert "largest push force" in outcome.out
    assert json.loads(gw("info", "results/runs/straight/run.json", "--json").out)["name"] == "straight"


@pytest.mark.parametrize("arguments", [("info",), ("info", "--json"), ("plot",)])
@pytest.mark.parametrize(
    "key",
    [
        "name",
        "status",
        "wall_time",
        "metrics",
        "snaps",
        "counters",
        "command",
        "versions",
        "provenance",
        "files",
        "scenario",
    ],
)
def test_a_run_json_that_lacks_a_key_is_damaged(gw, damaged, arguments, key):
    outcome = gw(*arguments, damaged(lambda content: content.pop(key)))
    assert outcome.code == 7
    assert f"run.json: is damaged, it has no {key};" in outcome.err
    assert outcome.out == ""


@pytest.mark.parametrize("change", [lambda c: c.update(versions=None), lambda c: c.update(status={"name": "lost"})])
@pytest.mark.parametrize("arguments", [("info",), ("plot",)])
def test_a_run_json_with_other_content_is_damaged(gw, damaged, arguments, change):
    outcome = gw(*arguments, damaged(change))
    assert outcome.code == 7
    assert "run.json: is damaged" in outcome.err


def test_what_lacks_within_is_named(gw, damaged):
    assert "(it has no sentence);" in gw("info", damaged(lambda content: content["status"].pop("sentence"))).err
    assert "(it has no place);" in gw("plot", damaged(lambda content: content["status"].pop("place"))).err


@pytest.mark.parametrize("arguments", [("info", "."), ("plot", "."), ("plot", "nowhere")])
def test_a_folder_that_is_no_run_ends_with_7(gw, arguments):
    outcome = gw(*arguments)
    assert outcome.code == 7
    assert "run" in outcome.err


def test_an_empty_folder_does_not_hide_the_shipped_scenario_of_its_name(gw):
    Path("straight").mkdir()
    assert "vessel.length" in gw("info", "straight").out


def test_schema_goes_to_stdout_or_to_a_file(gw):
    outcome = gw("schema")
    assert json.loads(outcome.out)["title"] == "gw-exudyn scenario"
    assert gw("schema", "-o", "schema.json").out == ""
    assert json.loads(Path("schema.json").read_text()) == json.loads(outcome.out)


def test_a_schema_that_cannot_be_written_ends_with_7(gw):
    assert gw("schema", "-o", "nowhere/schema.json").code == 7


def test_the_schema_of_studies_names_their_keys_modes_and_distributions(gw):
    schema = json.loads(gw("schema", "--study").out)
    assert (schema["title"], schema["required"]) == ("gw-exudyn study", ["base"])
    assert schema["properties"]["mode"]["enum"] == ["grid", "zip", "list", "sample"]
    values = schema["properties"]["vary"]["additionalProperties"]["anyOf"]
    forms = {key for value in values for key in value.get("properties", {})}
    assert forms >= {"values", "linspace", "logspace", "normal", "triangular"}


def test_the_schema_of_studies_takes_the_shipped_one_and_no_mistakes(gw):
    schema = json.loads(gw("schema", "--study").out)
    jsonschema = pytest.importorskip("jsonschema")
    check = jsonschema.Draft202012Validator(schema)
    study = yaml.safe_load((shipped_folder() / "studies" / "friction-and-wire.yaml").read_text())
    check.validate(study)
    spaced = {"logspace": [1, 2]}
    for wrong in ({"mode": "gird"}, {"seed": -1}, {"varied": {}}, {"vary": {"wire.segments": spaced}}):
        assert not check.is_valid({**study, **wrong}), wrong
