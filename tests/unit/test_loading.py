"""Loading: files, names, overrides, and everything wrong at once with its line."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from gw_exudyn.errors import Problem, ScenarioError, UsageError
from gw_exudyn.scenario.loading import load_scenario, scenario_from_dict
from gw_exudyn.scenario.shipped import list_shipped, resolve, shipped_folder

SHIPPED = ", ".join(list_shipped())
FILE = """\
wire:
  model: universal-ii
  segments: 50
vessel:
  kind: polygon
  points: [[0 mm, -2 mm], [50 mm, -2 mm], [50 mm, 2 mm], [0 mm, 2 mm]]
catheter: {bore: 1.2 mm}
drive: {kind: speed, speed: 2 mm/s, distance: 30 mm}
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A scenario of the user's own."""
    path = tmp_path / "my case.yaml"
    path.write_text(FILE)
    return path


def told(path: Path | str, *overrides: str) -> list[str]:
    """What is wrong."""
    with pytest.raises(ScenarioError) as caught:
        load_scenario(path, overrides)
    return str(caught.value).split("\n")


def test_five_mistakes_give_five_good_lines(tmp_path: Path) -> None:
    path = tmp_path / "five.yaml"
    path.write_text(
        "wire:\n  model: universal-i\n  diamter: 0.36 mm\n  segments: 3.7\n"
        "vessel: {kind: straight, length: 100 mm, diameter: 4}\n"
        "catheter: {bore: 1.2 mm}\ncontact:\n  friction_coefficient: no\n"
        "drive: {kind: speed, speed: 2 mm/s, distance: 30 mm}\n"
    )
    allowed = (
        "model, diameter, length, estimate, floppy_tip, bending_stiffness, stiffness_factor, density, damping_time, "
        "segments, grading, tip_shape, imperfection, friction"
    )
    assert told(path) == [
        f"{path}:2: wire.model: 'universal-i' is not in the catalogue; did you mean 'universal-ii'? "
        "all of them: gw-exudyn list wires",
        f"{path}:3: wire.diamter: unknown key; did you mean 'diameter'? allowed: {allowed}",
        f"{path}:4: wire.segments: 3.7 is no whole number; a whole number from 1 to 5000 is needed",
        f"{path}:5: vessel.diameter: 4 m is outside the plausible 0.1 mm to 100 mm; "
        "a bare number is in SI (m): write '4 mm'",
        f"{path}:8: contact.friction_coefficient: 'no' is text; a plain number from 0 to 2 is needed",
    ]


def test_mistakes_of_the_text_and_of_the_content_come_together(tmp_path: Path) -> None:
    path = tmp_path / "two.yaml"
    path.write_text(FILE + "solver:\n  step: .inf\n  tolerance: 1\n  tolerance: 2\n")
    assert told(path) == [
        f"{path}:10: solver.step: .inf is no finite number",
        f"{path}:12: solver.tolerance: is given twice, in lines 11 and 12; remove one",
    ]


def test_the_name_is_that_of_the_file_unless_given(file: Path) -> None:
    assert load_scenario(file).name == "my-case"
    assert load_scenario(file, ["name=other"]).name == "other"


@pytest.mark.parametrize("name", list_shipped())
def test_every_shipped_scenario_loads_from_any_folder(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / name).mkdir()  # a folder of results of the same name is in nobody's way
    monkeypatch.chdir(tmp_path)
    scenario = load_scenario(name)
    assert scenario.name == name
    assert scenario_from_dict(scenario.to_dict()) == scenario
    assert scenario.drive.time[-1] * 0.002 < scenario.wire.length
    header = (shipped_folder() / f"{name}.yaml").read_text(encoding="utf-8").split("\nname:")[0]
    assert all(line.startswith("# ") for line in header.splitlines())
    assert "Shows" in header or "shows" in header


def test_the_papers_wires_are_shipped_round_a_corner() -> None:
    universal, amplatz = load_scenario("corner90-universal"), load_scenario("corner90-amplatz.yaml")
    assert (universal.wire.model, amplatz.wire.model) == ("universal-ii", "amplatz-super-stiff")
    assert universal.wire.segments == amplatz.wire.segments == 200
    assert universal.vessel == amplatz.vessel
    assert amplatz.catheter.bore > amplatz.wire.diameter


def test_an_existing_file_wins_over_a_shipped_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert resolve("straight") == shipped_folder() / "straight.yaml"
    Path("straight").write_text(FILE)
    assert resolve("straight") == Path("straight")


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("corner90-univarsal", "corner90-univarsal: there is no such file, and no shipped scenario of that name; "
         "nearest: corner90-universal, corner90-amplatz"),
        ("zzz", f"zzz: there is no such file, and no shipped scenario of that name; shipped: {SHIPPED}"),
        ("", f"no scenario is named; give a YAML file or a shipped scenario: {SHIPPED}"),
        ("/", "/: is a folder; a scenario file is needed"),
        ("no/where/q.yaml", "no/where/q.yaml: there is no such file"),
    ],
)  # fmt: skip
def test_a_scenario_that_is_not_there(name: str, sentence: str) -> None:
    assert told(name) == [sentence]


class TestOverrides:
    """Values by dotted path."""

    def test_text_is_read_as_yaml(self, file: Path) -> None:
        scenario = load_scenario(
            file,
            ["wire.segments=100", "contact.friction_coefficient=2e-1", "drive.speed=1 mm/s", "catheter.exit=[1 mm, 0]"],
        )
        assert scenario.wire.segments == 100
        assert scenario.contact.friction_coefficient == 0.2
        assert scenario.drive.speed == (0.001, 0.001)
        assert scenario.catheter.exit == (0.001, 0.0)

    def test_a_mapping_holds_values_as_they_are(self, file: Path) -> None:
        assert load_scenario(file, {"wire.segments": 100, "wire.damping_time": "1 ms"}).wire.damping_time == 0.001
        with pytest.raises(ScenarioError) as caught:
            load_scenario(file, {"wire.segments": "100"})
        assert str(caught.value) == (
            "override wire.segments: wire.segments: '100' is text; a whole number from 1 to 5000 is needed, without "
            "quotes"
        )

    def test_plain_data_takes_them_too(self, file: Path) -> None:
        data = load_scenario(file).to_dict()
        assert scenario_from_dict(data, ["wire.segments=7"]).wire.segments == 7
        assert data["wire"]["segments"] == 50

    def test_an_item_of_a_list(self, file: Path) -> None:
        scenario = load_scenario(file, ["vessel.points.0=[1 mm, -2 mm]", "vessel.points.1.0=40 mm"])
        assert scenario.vessel.kind == "polygon"
        assert scenario.vessel.points[:2] == ((0.001, -0.002), (0.04, -0.002))

    def test_an_item_of_a_list_that_the_file_leaves_to_the_catalogue_or_the_default(self, file: Path) -> None:
        scenario = load_scenario(file, ["wire.bending_stiffness.1.value=8 N*mm^2", "catheter.exit.0=2 mm"])
        assert [piece.value for piece in scenario.wire.bending_stiffness] == [1e-6, 8e-6]
        assert scenario.catheter.exit == (0.002, 0.0)

    def test_a_new_section(self, file: Path) -> None:
        scenario = load_scenario(file, ["solver.step=20 ms", "wire.tip_shape={kind: arc, length: 1 cm, angle: 45 deg}"])
        assert scenario.solver.step == 0.02
        assert scenario.wire.tip_shape.length == 0.01

    def test_null_takes_a_value_away(self, file: Path) -> None:
        assert load_scenario(file, ["drive.distance=null", "drive.duration=3"]).drive.time == (0, 3)

    def test_the_last_wins_and_mends_the_file(self, tmp_path: Path) -> None:
        path = tmp_path / "bad.yaml"
        path.write_text(FILE.replace("segments: 50", "segments: .nan"))
        assert load_scenario(path, ["wire.segments=1", "wire.segments=2"]).wire.segments == 2

    @pytest.mark.parametrize(
        ("override", "sentence"),
        [
            ("wire.segments=abc", "'abc' is text; a whole number from 1 to 5000 is needed, without quotes"),
            ("wire.segmnts=1", "unknown key; did you mean 'segments'? allowed: model, diameter, length, estimate, "
                               "floppy_tip, bending_stiffness, stiffness_factor, density, "
             "damping_time, segments, grading, tip_shape, imperfection, friction"),
            ("wire.segments.x=1", "wire.segments is 50, a single value; there is no 'x' in it"),
            ("vessel.points.4=1", "there is no item '4'; vessel.points has 4 items, 0 to 3"),
            ("vessel.points.-1=1", "there is no item '-1'; vessel.points has 4 items, 0 to 3"),
            ("vessel.points.x=1", "there is no item 'x'; vessel.points has 4 items, 0 to 3"),
            ("vessel.points.0=3", "3 is no list; [x, y] is needed"),
            ("drive.phases.0=3", "drive.phases is no list in the file; set drive.phases as a whole"),
            ("wire.segments=", "nothing is no whole number; a whole number from 1 to 5000 is needed"),
            ("wire.diameter=.nan", ".nan is no finite number"),
            ("wire.diameter=*a", "alias '*a' is not supported; write the value out"),
            ("wire..diameter=1", "is no dotted path; write it as wire.segments or vessel.points.0"),
        ],
    )  # fmt: skip
    def test_what_is_wrong_is_placed_at_the_override(self, file: Path, override: str, sentence: str) -> None:
        path = override.partition("=")[0]
        assert told(file, override) == [f"--set {path}: {path}: {sentence}"]

    def test_a_wrong_key_above_it_is_placed_there_too(self, file: Path) -> None:
        (line,) = told(file, "foo.bar=1")
        assert line.startswith("--set foo.bar: foo: unknown key; allowed: name, wire")

    def test_several_are_told_at_once(self, file: Path) -> None:
        assert len(told(file, "wire.segments=0", "drive.speed=9 m/s", "catheter.bore.x=1")) == 3

    def test_what_is_no_override_is_a_usage_error(self, file: Path) -> None:
        with pytest.raises(UsageError, match=r"'wire\.segments' is no override; write path=value"):
            load_scenario(file, ["wire.segments"])


def test_a_later_problem_finds_its_line(file: Path) -> None:
    scenario = load_scenario(file, ["catheter.bore=1 mm"])
    assert scenario.locate("wire.segments") == (str(file), 3)
    assert scenario.locate("wire.bending_stiffness.0") == (str(file), 1)
    assert scenario.locate("vessel.points.2.1") == (str(file), 6)
    assert scenario.locate("contact.wall_stiffness") == (str(file), None)
    assert scenario.problem("catheter.bore", "too narrow") == Problem(
        "catheter.bore", "too narrow", "--set catheter.bore", None
    )
    assert str(scenario.problem("drive", "too far")) == f"{file}:8: drive: too far"
    assert scenario_from_dict(scenario.to_dict()).locate("wire") is None


def test_plain_data_must_be_a_mapping() -> None:
    with pytest.raises(ScenarioError, match="a scenario is a mapping, not list"):
        scenario_from_dict([])  # type: ignore[arg-type]


def test_importing_errors_and_the_package_of_scenarios_loads_nothing_heavy() -> None:
    code = (
        "import sys, gw_exudyn.errors, gw_exudyn.scenario\n"
        "print(sorted({'pydantic', 'yaml', 'shapely', 'numpy', 'exudyn'} & set(sys.modules)))\n"
        "from gw_exudyn.scenario import Scenario, load_scenario\n"
        "print(sorted({'shapely', 'numpy', 'exudyn'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n")[:2] == ["[]", "[]"]
