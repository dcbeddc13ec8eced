"""What the how-to pages show works: every scenario piece is good, every study reads, every command runs."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
import yaml

from gw_exudyn.scenario import scenario_from_dict

PAGES = Path(__file__).resolve().parents[2] / "docs" / "howto"
OURS = ("wire", "segments-and-step", "forces", "drives", "coming-from", "uncertainty")
TEXTS = {name: (PAGES / f"{name}.md").read_text(encoding="utf-8") for name in OURS}
BASE = {
    "wire": {"model": "universal-ii"},
    "vessel": {"kind": "straight", "length": 0.15, "diameter": 0.004},
    "catheter": {"bore": 0.0012},
    "drive": {"kind": "speed", "speed": 0.002, "duration": 1},
}


def bodies(text, language):
    """The code blocks of one language; found one after the other, so that no end is taken for a beginning."""
    found = re.findall(r"^```([^\n]*)\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    return [body for kind, body in found if kind == language]


def blocks(language):
    return [
        pytest.param(body, id=f"{name}-{number}")
        for name, text in TEXTS.items()
        for number, body in enumerate(bodies(text, language))
    ]


@pytest.mark.parametrize("piece", blocks("yaml"))
def test_a_piece_of_a_scenario_is_good(piece):
    scenario_from_dict({**BASE, **yaml.safe_load(piece)})


@pytest.mark.parametrize("text", blocks("yaml study"))
def test_a_study_reads(text, gw):
    Path("study.yaml").write_text(text, encoding="utf-8")
    outcome = gw("sweep", "study.yaml", "--dry-run")
    assert outcome.code == 0, outcome.err
    assert "320" in outcome.out + outcome.err


@pytest.mark.parametrize("name", OURS)
def test_the_commands_of_a_page_run(name, gw, solver):
    commands = [line for body in bodies(TEXTS[name], "") for line in body.splitlines()]
    for line in commands:
        program, *arguments = shlex.split(line)
        assert program == "gw-exudyn"
        outcome = gw(*arguments)
        assert outcome.code == 0, (line, outcome.err)
