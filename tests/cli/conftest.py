"""The command line in this process, in a folder of its own, with a solver that makes its results up."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from types import SimpleNamespace
from typing import NamedTuple

import pytest
from synthetic import made_up_result

from gw_exudyn.cli import main
from gw_exudyn.result import Result, Status, StatusReport


class Outcome(NamedTuple):
    """What a command left behind."""

    code: int
    out: str
    err: str


@pytest.fixture(autouse=True)
def _own_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def gw(capsys) -> Callable[..., Outcome]:
    """Run a command, as `gw("check", "straight")`."""

    def run(*arguments: str) -> Outcome:
        capsys.readouterr()
        code = main(arguments)
        return Outcome(code, *capsys.readouterr())

    return run


@pytest.fixture
def solver(monkeypatch) -> SimpleNamespace:
    """Replace the simulation by one that takes no time. `status`: what it ends with. `during`: called half way.
    `scenarios`: what it was given.
    """
    from gw_exudyn import simulation

    control = SimpleNamespace(status=Status.COMPLETED, during=lambda: None, scenarios=[])

    def simulate(scenario, progress=None, should_stop=None) -> Result:
        control.scenarios.append(scenario)
        control.during()
        stopped = should_stop is not None and should_stop()
        report = StatusReport(Status.STOPPED if stopped else control.status, 12.5, "at node 7", "")
        return dataclasses.replace(made_up_result(segments=10, instants=5, status=report), scenario=scenario)

    monkeypatch.setattr(simulation, "simulate", simulate)
    return control
