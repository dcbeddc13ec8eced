"""What the how-to pages show works: every scenario piece is good, every study and calibration reads, every command of a
block runs, a simulation being replaced by a made-up one.

Only parsed, by the parser of the command that is meant, are: commands within a line of text; `sweep` on a cluster and
dask's own commands, which need one; and `fmu export --bundled`, which copies a whole Python. Python runs on the page on
reinforcement learning; elsewhere, where it needs a cluster or a sweep of minutes, it is compiled, and what it imports
from here is there.
"""

from __future__ import annotations

import ast
import re
import shlex
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import click
import pytest
import yaml

from gw_exudyn.calibration.form import load_calibration
from gw_exudyn.cli.main import gw_exudyn
from gw_exudyn.scenario import catalogue_names, scenario_from_dict

PAGES = Path(__file__).resolve().parents[2] / "docs" / "howto"
TEXTS = {page.stem: page.read_text(encoding="utf-8") for page in sorted(PAGES.glob("*.md"))}
PARSED_ONLY = ("--scheduler", "--bundled")
POINTS = {"uncertainty": 320, "sweep": 4 * len(catalogue_names())}
"""Of the page's study."""
BARE = ("gw-exudyn calibrate", "gw-exudyn sweep", "gw-exudyn fmu export")
"""Names of commands in a sentence, without what they take."""
BASE = {
    "wire": {"model": "universal-ii"},
    "vessel": {"kind": "straight", "length": 0.15, "diameter": 0.004},
    "catheter": {"bore": 0.0012},
    "drive": {"kind": "speed", "speed": 0.002, "duration": 1},
}


@pytest.fixture(autouse=True)
def _children_find_the_package(monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(PAGES.parents[1]))


def fenced(text):
    """Kind and body of each code block; found one after the other, so that no end is taken for a beginning."""
    return re.findall(r"^```([^\n]*)\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


def bodies(text, language):
    """The code blocks of one language."""
    return [body for kind, body in fenced(text) if kind == language]


def blocks(language):
    return [
        pytest.param(body, id=f"{name}-{number}")
        for name, text in TEXTS.items()
        for number, body in enumerate(bodies(text, language))
    ]


@pytest.mark.parametrize("piece", blocks("yaml"))
def test_a_piece_of_a_scenario_is_good(piece):
    scenario_from_dict({**BASE, **yaml.safe_load(piece)})


@pytest.mark.parametrize("name", POINTS)
def test_a_study_reads(name, gw):
    (text,) = bodies(TEXTS[name], "yaml study")
    Path("study.yaml").write_text(text, encoding="utf-8")
    outcome = gw("sweep", "study.yaml", "--dry-run")
    assert outcome.code == 0, outcome.err
    assert f"{POINTS[name]} points" in outcome.out + outcome.err


def test_a_calibration_reads():
    (text,) = bodies(TEXTS["calibrate"], "yaml calibration")
    Path("camera.csv").write_text("time [s],tip_x [mm],tip_y [mm]\n0,0,0\n1,2,0\n2,4,0\n", encoding="utf-8")
    Path("cell.csv").write_text("time [s],push_force [mN]\n0,0\n1,0.1\n", encoding="utf-8")
    Path("fit.yaml").write_text(text, encoding="utf-8")
    fitted = load_calibration("fit.yaml")
    assert [parameter.path for parameter in fitted.parameters] == list(yaml.safe_load(text)["fit"])


def test_no_block_is_of_a_kind_that_nothing_here_tries():
    tried = {"", "yaml", "yaml study", "yaml calibration", "python", "csv camera.csv"}
    kinds = {kind for text in TEXTS.values() for kind, _ in fenced(text)}
    assert kinds <= tried


@pytest.mark.parametrize("name", TEXTS)
def test_the_commands_of_a_page_run(name, gw, solver):
    if name == "fmu":
        pytest.importorskip("fmpy", reason="fmpy is not installed")
    for body in bodies(TEXTS[name], "csv camera.csv"):
        Path("camera.csv").write_text(body, encoding="utf-8")
    for line in [line for body in bodies(TEXTS[name], "") for line in body.splitlines()]:
        program, *arguments = shlex.split(line, comments=True)
        if program == "dask" or any(option in arguments for option in PARSED_ONLY):
            parse(program, *arguments)
            continue
        assert program == "gw-exudyn"
        outcome = gw(*arguments)
        assert outcome.code == 0, (line, outcome.err)


@pytest.mark.parametrize("name", TEXTS)
def test_the_commands_within_a_line_are_understood(name):
    for line in re.findall(r"`(gw-exudyn [^`]+)`", TEXTS[name]):
        if line not in BARE:
            parse(*shlex.split(line))


def parse(program, *arguments):
    """Take a command apart as its program does, without running it. Raises click.ClickException for a wrong one."""
    if program == "dask":
        pytest.importorskip("distributed")
        name, *arguments = arguments
        command, above = import_module(f"distributed.cli.dask_{name}").main, None
    else:
        command, above, name = gw_exudyn, None, "gw-exudyn"
    while isinstance(command, click.Group):
        above = click.Context(command, info_name=name, parent=above)
        name, *arguments = arguments
        command = command.get_command(above, name)
        assert command is not None, name
    command.make_context(name, list(arguments), parent=above)


@pytest.mark.parametrize(
    "arguments", [("run", "straight", "--sett", "a=1"), ("fmu", "exprt"), ("compare", "a", "b", "c")], ids=" ".join
)
def test_a_command_that_is_wrong_is_not_understood(arguments):
    with pytest.raises((click.ClickException, AssertionError)):
        parse("gw-exudyn", *arguments)


@pytest.mark.parametrize("piece", blocks("python"))
def test_what_python_imports_from_here_is_there(piece):
    for node in ast.walk(ast.parse(piece)):
        if isinstance(node, ast.ImportFrom) and node.module.startswith("gw_exudyn"):
            assert all(hasattr(import_module(node.module), alias.name) for alias in node.names)


def test_python_on_the_page_on_reinforcement_learning_runs():
    pytest.importorskip("gymnasium", reason="gymnasium is not installed")
    (piece,) = bodies(TEXTS["rl"], "python")
    done = subprocess.run([sys.executable, "-c", piece], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("The tip reached its target.")
