"""What it takes to run one point: a small interface, and its implementation by a simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any, Protocol

from gw_exudyn.errors import UsageError

SIMULATION = "gw_exudyn.sweep.runner:SimulationRunner"
"""The runner of scenarios, by module and class: workers on other machines import it by this name."""


@dataclass(frozen=True)
class Task:
    """A point to run.

    id : hash of what is run and by what. scenario : resolved, plain SI data. note : what run.json is to hold of the
    point under `provenance`. command : what a person types to repeat the sweep. whole : keep the whole run folder.
    """

    id: str
    scenario: Mapping[str, Any]
    note: Mapping[str, Any] = field(default_factory=dict)
    command: str = ""
    whole: bool = False


@dataclass(frozen=True)
class Outcome:
    """How a point went.

    status : name of a `gw_exudyn.result.Status` in small letters, or `timed_out`, `crashed`, `error`.
    sentence : what happened. trusted : the numbers can be believed. versions : of the software that ran it; empty
    where nothing ran to an end. files : what the point's folder is to hold, by name; run.json among them, unless
    nothing ran to an end.
    """

    status: str
    sentence: str
    trusted: bool = False
    versions: Mapping[str, str] = field(default_factory=dict)
    files: Mapping[str, bytes] = field(default_factory=dict)


class Runner(Protocol):
    """Runs points one after the other in a process of its own. Made once in that process, so that it may keep what is
    dear to set up; the outcome of a point must not depend on those before it.
    """

    def run(self, task: Task) -> Outcome:
        """Run a point. What it raises becomes the outcome `error`."""
        ...


class SimulationRunner:
    """Runs scenarios by `gw_exudyn.simulate`."""

    def __init__(self) -> None:
        # Loaded when the process starts, so that no point's time holds it: all that a run and its files need.
        for module in ("gw_exudyn.simulation", "gw_exudyn.sweep.encoding", "xarray", "h5netcdf", "shapely"):
            import_module(module)
        from gw_exudyn.engine.library import exudyn

        exudyn()

    def run(self, task: Task) -> Outcome:
        """Simulate a scenario and encode what its folder is to hold."""
        import dataclasses

        from gw_exudyn.scenario import scenario_from_dict
        from gw_exudyn.simulation import simulate
        from gw_exudyn.sweep.encoding import encoded

        result = simulate(scenario_from_dict(task.scenario))
        result = dataclasses.replace(result, provenance={**result.provenance, **task.note})
        return Outcome(
            status=result.status.status.name.lower(),
            sentence=result.status.sentence(),
            trusted=result.status.status.trusted,
            versions=result.provenance["versions"],
            files=encoded(result, task.command, task.whole),
        )


def make_runner(name: str) -> Runner:
    """The runner that a name as `module:Class` stands for, or `module:Class:text`, where the text is for the class."""
    module, _, rest = name.partition(":")
    attribute, *text = rest.split(":", 1)
    if not module or not attribute:
        raise UsageError(f"{name!r} names no runner; write module:Class, as {SIMULATION}")
    runner: Runner = getattr(import_module(module), attribute)(*text)
    return runner
