"""What the README says is so: its example runs, its commands and exit codes are those of the program."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml

import gw_exudyn
from gw_exudyn.cli import outcome
from gw_exudyn.cli.main import COMMANDS
from gw_exudyn.errors import GwError
from gw_exudyn.scenario import load_scenario

REPOSITORY = Path(__file__).resolve().parents[2]
README = (REPOSITORY / "README.md").read_text(encoding="utf-8")


def block(language: str) -> str:
    return re.search(rf"```{language}\n(.*?)```", README, re.DOTALL)[1]


@pytest.fixture
def mine() -> Path:
    Path("mine.yaml").write_text(block("yaml"), encoding="utf-8")
    Path("lumen.csv").write_text(block("csv"), encoding="utf-8")
    return Path("mine.yaml")


def test_the_example_is_a_good_scenario(gw, mine):
    found = gw("check", str(mine))
    assert (found.code, found.err) == (0, "")
    assert "3.64 mm wider" in found.out


@pytest.mark.parametrize("line", re.findall(r"`(\{kind: (?:straight|arc).*?\})`", README.replace("\n", " ")))
def test_the_other_vessels_are_good(mine, line):
    load_scenario(mine, [f"vessel={line}"])


@pytest.mark.parametrize("line", re.findall(r"`((?:phases|table): .*?)`", README.replace("\n", " ")))
def test_the_other_drives_are_good(mine, line):
    load_scenario(mine, [f"drive={{kind: speed, {line}}}"])


def test_the_wires_described_otherwise_are_good(mine):
    flat = README.replace("\n", " ")
    (tip,) = re.findall(r"`floppy_tip: (\{.*?\})`", flat)
    load_scenario(mine, [f"wire={{model: backup-meier-shaft, floppy_tip: {tip}}}"])
    (piece,) = re.findall(r"`(\{from: 0 mm, to: 40 mm, core.*?\})`", flat)
    load_scenario(mine, ["wire.length=40 mm", f"wire.bending_stiffness=[{piece}]"])
    (factor,) = re.findall(r"`stiffness_factor: (\{.*?\})`", flat)
    load_scenario(mine, [f"wire={{model: universal-ii, stiffness_factor: {factor}}}"])


def test_the_other_vessels_and_drives_are_found():
    flat = README.replace("\n", " ")
    assert len(re.findall(r"`(\{kind: (?:straight|arc).*?\})`", flat)) == 2
    assert len(re.findall(r"`((?:phases|table): .*?)`", flat)) == 2


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
