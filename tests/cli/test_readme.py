"""What the README says is so: its examples run, its commands and exit codes are those of the program."""

from __future__ import annotations

import json
import re
import shlex
import textwrap
from pathlib import Path

import pytest
import yaml

import gw_exudyn
from gw_exudyn.cli import outcome
from gw_exudyn.cli.main import COMMANDS
from gw_exudyn.errors import GwError
from gw_exudyn.model import build
from gw_exudyn.scenario import load_scenario

REPOSITORY = Path(__file__).resolve().parents[2]
README = (REPOSITORY / "README.md").read_text(encoding="utf-8")


FLAT = " ".join(README.split())
VESSELS = re.findall(r"`(\{kind: (?:straight|arc).*?\})`", FLAT)
DRIVES = re.findall(r"`(\{kind: (?:force|tip_speed).*?\})`", FLAT)
SPEEDS = re.findall(r"`((?:phases|table): .*?)`", FLAT)
STOPS = re.findall(r"`stop: (\{.*?\})`", FLAT)
FROM_FILES = re.findall(r"`(\{kind: (?:polygon|centreline), file: .*?\})` and, in `(\S+)`", FLAT)


def blocks(language: str) -> list[str]:
    """The text of the code blocks, without the margin of a list."""
    return [textwrap.dedent(found) for found in re.findall(rf"^ *```{language}\n(.*?)^ *```", README, re.DOTALL | re.M)]


BRANCHES = blocks("yaml")[1]
FILES = {"tree.csv": blocks("text")[0], "vein.svg": blocks("xml")[0]}


@pytest.fixture
def mine() -> Path:
    Path("mine.yaml").write_text(blocks("yaml")[0], encoding="utf-8")
    Path("lumen.csv").write_text(blocks("csv")[0], encoding="utf-8")
    return Path("mine.yaml")


def test_the_example_is_a_good_scenario(gw, mine):
    found = gw("check", str(mine))
    assert (found.code, found.err) == (0, "")
    assert "3.64 mm wider" in found.out


def test_the_commands_on_the_example_work(gw, mine, solver):
    """As they stand there, in their order; the drawing where it is said to be."""
    (lines,) = blocks("sh")
    for line in lines.splitlines():
        words = shlex.split(line, comments=True)
        assert words[0] == "gw-exudyn"
        found = gw(*words[1:])
        assert found.code == 0, (line, found.err)
    assert Path("mine.png").exists()
    assert Path("results/runs/mine/run.json").exists()


def test_the_overrides_are_good(mine):
    (line,) = re.findall(r"`gw-exudyn run mine.yaml (--set .*?)`", FLAT)
    load_scenario(mine, [word for word in shlex.split(line) if word != "--set"])


@pytest.mark.parametrize("line", VESSELS)
def test_the_other_vessels_are_good(mine, line):
    build(load_scenario(mine, [f"vessel={line}"]))


def test_the_branches_are_good(mine):
    vessel = yaml.safe_load(BRANCHES)["vessel"]
    built = build(load_scenario(mine, {"vessel": vessel}))
    assert built.scenario.vessel.branch_names == ("main", "side")


@pytest.mark.parametrize(("line", "file"), FROM_FILES)
def test_the_vessels_from_files_are_good(mine, line, file):
    Path(file).write_text(FILES[file], encoding="utf-8")
    entrance = {"tree.csv": "[0 mm, 0 mm]", "vein.svg": "[0 mm, 40 mm]"}[file]
    built = build(load_scenario(mine, [f"vessel={line}", f"catheter.exit={entrance}"]))
    assert not built.warnings
    if file == "tree.csv":
        assert built.scenario.vessel.branch_names == ("main", "side", "deep")
    else:
        left_end = [y for x, y in built.scenario.vessel.points if x == 0]
        assert sorted(left_end) == pytest.approx([38e-3, 42e-3])


@pytest.mark.parametrize("line", SPEEDS)
def test_the_other_speeds_are_good(mine, line):
    build(load_scenario(mine, [f"drive={{kind: speed, {line}}}"]))


@pytest.mark.parametrize("line", DRIVES)
def test_the_other_drives_are_good(mine, line):
    build(load_scenario(mine, [f"drive={line}"]))


@pytest.mark.parametrize("line", STOPS)
def test_the_stops_are_good(mine, line):
    vessel = json.dumps(yaml.safe_load(BRANCHES)["vessel"])
    load_scenario(mine, [f"vessel={vessel}", f"stop={line}"])


def test_the_wires_described_otherwise_are_good(mine):
    (tip,) = re.findall(r"`floppy_tip: (\{.*?\})`", FLAT)
    load_scenario(mine, [f"wire={{model: backup-meier-shaft, floppy_tip: {tip}}}"])
    (piece,) = re.findall(r"`(\{from: 0 mm, to: 40 mm, core.*?\})`", FLAT)
    load_scenario(mine, ["wire.length=40 mm", f"wire.bending_stiffness=[{piece}]"])
    (factor,) = re.findall(r"`stiffness_factor: (\{.*?\})`", FLAT)
    load_scenario(mine, [f"wire={{model: universal-ii, stiffness_factor: {factor}}}"])
    (friction,) = re.findall(r"`friction: (\[.*?\])`", FLAT)
    load_scenario(mine, [f"wire.friction={friction}"])


def test_all_of_them_are_found():
    counts = [len(found) for found in (VESSELS, FROM_FILES, SPEEDS, DRIVES, STOPS)]
    assert counts == [2, 2, 2, 2, 4]


def test_the_python_example_runs(monkeypatch, capsys):
    """Its first millimetres, with few segments: the tip is still in the trunk."""
    (code,) = blocks("python")
    load = gw_exudyn.load_scenario
    short = {"wire.segments": 20, "drive.distance": 2e-3}
    monkeypatch.setattr(gw_exudyn, "load_scenario", lambda name, overrides: load(name, overrides | short))
    exec(compile(code, "README.md", "exec"), {})
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("The run reached its end")
    assert lines[-1] == "trunk"


def test_the_figure_is_there_and_small():
    (file,) = re.findall(r"!\[.*?\]\((.*?)\)", README)
    content = (REPOSITORY / file).read_bytes()
    assert content.startswith(b"\x89PNG")
    assert len(content) < 200_000
    makefile = (REPOSITORY / "Makefile").read_text(encoding="utf-8")
    assert f"docs/figures/{Path(file).name}" in re.search(r"^figure:.*?\n\n", makefile, re.DOTALL | re.MULTILINE)[0]


def test_make_runs_the_phantom_s_scenarios():
    makefile = (REPOSITORY / "Makefile").read_text(encoding="utf-8")
    (names,) = re.findall(r"^WIRES := (.*)$", makefile, re.MULTILINE)
    assert names.split() == ["phantom-universal", "phantom-amplatz"]
    assert all(load_scenario(name).wire.segments == 200 for name in names.split())


def test_the_tables_name_all_commands_and_exit_codes():
    assert set(re.findall(r"^\| `gw-exudyn (\w+)", README, re.MULTILINE)) == set(COMMANDS)
    told = {int(code) for code in re.findall(r"^\| (\d+) \|", README, re.MULTILINE)}
    assert {0, outcome.BUG} | {error.exit_code for error in GwError.__subclasses__()} == told


def test_every_name_of_the_python_example_is_public():
    for name in set(re.findall(r"\bgw\.(\w+)", README)):
        assert name in gw_exudyn.__all__


def test_the_version_stands_in_the_changelog_and_the_citation():
    assert f"## {gw_exudyn.__version__}" in (REPOSITORY / "CHANGELOG.md").read_text(encoding="utf-8")
    citation = yaml.safe_load((REPOSITORY / "CITATION.cff").read_text(encoding="utf-8"))
    assert str(citation["version"]) == gw_exudyn.__version__
