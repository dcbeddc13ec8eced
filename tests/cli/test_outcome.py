"""Every way in which a command can end has its exit code and its sentence; none shows a traceback."""

from __future__ import annotations

import builtins
import re
import warnings
from pathlib import Path

import pytest

from gw_exudyn.cli import main, outcome
from gw_exudyn.errors import GwError, Interrupted, Problem, ScenarioError, SolverError, StorageError, UsageError

ENDINGS = [
    (UsageError("called wrongly"), 2),
    (ScenarioError(Problem("wire", "is missing", "a.yaml", 3)), 3),
    (SolverError("no balance"), 4),
    (GwError("something"), 4),
    (StorageError("disk full"), 7),
    (Interrupted("stopped"), 130),
    (KeyboardInterrupt(), 130),
    (MemoryError(), 4),
    (ModuleNotFoundError("No module named 'shapely'", name="shapely"), 7),
    (ImportError("libfoo.so.1: cannot open shared object file: No such file or directory"), 7),
    (ZeroDivisionError("division by zero"), 1),
    (ModuleNotFoundError("No module named 'gw_exudyn.lost'", name="gw_exudyn.lost"), 1),
]

WHAT_EXUDYN_SAYS = """\
Exudyn could not import its compiled module. Tried, in order:
  .exudynCPP  ->  libGL.so.1: cannot open shared object file: No such file or directory
  exudynCPP  ->  No module named 'exudynCPP'
Check that the wheel matches this Python version and platform, or reinstall."""


@pytest.mark.parametrize(("error", "code"), ENDINGS, ids=lambda value: type(value).__name__)
def test_every_error_has_its_exit_code_and_a_sentence(error, code, capsys):
    def fails():
        raise error

    assert outcome.exit_code_of(fails) == code
    out, err = capsys.readouterr()
    assert out == ""
    assert err.strip()
    assert "Traceback" not in err
    assert str(error).splitlines()[:1] == [] or code in (1, 4, 7, 130) or str(error) in err


def caused(error, cause):
    error.__cause__ = cause
    return error


@pytest.mark.parametrize(
    "error",
    [
        RuntimeError("Error in Python function: KeyboardInterrupt: \n  at line 3"),
        SolverError("Exudyn failed: KeyboardInterrupt"),
        caused(ValueError("no step"), KeyboardInterrupt()),
    ],
)
def test_an_interruption_in_another_guise_is_one(error, capsys):
    def fails():
        raise error

    assert outcome.exit_code_of(fails) == 130
    assert capsys.readouterr().err == "interrupted\n"


def test_a_file_named_after_the_interruption_is_none(gw):
    assert gw("check", "KeyboardInterrupt.yaml").code == 3


def test_ctrl_c_while_the_outcome_is_told_ends_with_130(monkeypatch):
    def pressed(_):
        raise KeyboardInterrupt

    monkeypatch.setattr(outcome, "tell", pressed)
    assert outcome.exit_code_of(lambda: 1 / 0) == 130


def test_a_bug_leaves_its_traceback_in_a_file(capsys, monkeypatch, tmp_path):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))

    def fails():
        raise RuntimeError("first line\nsecond line")

    assert outcome.exit_code_of(fails) == 1
    err = capsys.readouterr().err
    assert "report" in err
    assert "second line" not in err
    text = Path(re.search(r"traceback is in (\S+)", err).group(1)).read_text()
    assert "Traceback" in text
    assert "second line" in text


def test_a_missing_system_library_names_the_packages(gw, monkeypatch):
    real = builtins.__import__

    def without_gl(name, *further, **named):
        if name.split(".")[0] == "exudyn":
            raise ImportError(WHAT_EXUDYN_SAYS)
        return real(name, *further, **named)

    monkeypatch.setattr(builtins, "__import__", without_gl)
    found = gw("run", "straight", "-q")
    assert found.code == SolverError.exit_code
    assert "apt-get install libgl1 libx11-6" in found.err
    assert len(found.err.splitlines()) == 1


def test_a_warning_is_one_line(capsys):
    def warns():
        warnings.warn("the figures could not be drawn", RuntimeWarning, stacklevel=1)

    assert outcome.exit_code_of(warns) == 0
    assert capsys.readouterr().err == "warning: the figures could not be drawn\n"


def test_a_number_is_the_exit_code_and_anything_else_is_success():
    assert outcome.exit_code_of(lambda: 4) == 4
    assert outcome.exit_code_of(lambda: None) == 0


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["rnu"], "did you mean 'run'"),
        (["run"], "SCENARIO"),
        (["check", "straight", "--jsn"], "--json"),
        (["check", "straight", "--set", "segments"], "path=value"),
        ([], "Usage"),
    ],
)
def test_wrong_use_ends_with_2_and_says_what_is_right(arguments, part, capsys):
    assert main(arguments) == 2
    out, err = capsys.readouterr()
    assert part in err
    assert out == ""


def test_a_scenario_that_is_not_there_ends_with_3_and_names_the_nearest(gw):
    found = gw("check", "corner90-univeral")
    assert found.code == 3
    assert "corner90-universal" in found.err
