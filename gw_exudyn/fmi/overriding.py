"""An exported scenario with other values: those that a host sets, and those that a study puts into it.

An exported scenario says everything: its drive is a table of times, and the wire has the catalogue's values written
out. `opened` takes out what would stand against a value that is to be changed.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any

from gw_exudyn.errors import Problem, ScenarioError, UsageError
from gw_exudyn.fmi import variables as names
from gw_exudyn.fmi.parameters import command_of, constant_drive, path_of
from gw_exudyn.scenario import Scenario, scenario_from_dict
from gw_exudyn.scenario.overrides import OVERRIDE

_OF_THE_WIRE = ("diameter", "length", "density", "bending_stiffness")
"""What a wire of the catalogue fills in, where a file does not give it."""


def overridden(base: Scenario, changed: Mapping[str, Any]) -> Scenario:
    """A scenario with other values of an FMU's parameters, by their names. Raises ScenarioError."""
    plain = {path_of(name): value for name, value in changed.items() if not name.endswith(".factor")}
    factors = {name: value for name, value in changed.items() if name.endswith(".factor")}
    wrong = [*_not_of_the_drive(base, changed), *_out_of_range(factors)]
    for problem in wrong:
        plain.pop(problem.path, None)
    try:
        scenario = scenario_from_dict(opened(base, plain), plain)
        scenario = _scaled(scenario, factors) if factors and not wrong else scenario
    except ScenarioError as error:
        named = {path_of(name): name for name in changed}
        raise ScenarioError([*(_by_name(problem, named) for problem in error.problems), *wrong]) from error
    if wrong:
        raise ScenarioError(wrong)
    return scenario


def _by_name(problem: Problem, named: Mapping[str, str]) -> Problem:
    """As the host knows it: by the parameter's name, not by its path and as an override."""
    place = None if (problem.file or "").startswith(OVERRIDE) else problem.file
    return replace(problem, path=named.get(problem.path, problem.path), file=place)


OWN_FMU = "leave it at its start, or export the scenario that is to run as an FMU of its own"
"""What to do where a host has named another scenario, which lacks what the exported one has."""


def _not_of_the_drive(scenario: Scenario, changed: Mapping[str, Any]) -> list[Problem]:
    """Parameters that the exported scenario's drive has and this one's has not."""
    drive, command = scenario.drive, command_of(scenario)
    of_one_value = {command, "distance"} if drive.kind == "speed" else {command}
    wrong = []
    for name in changed:
        part, _, field = name.partition(".")
        if part != "drive":
            continue
        if field in of_one_value:
            if constant_drive(scenario) is None:
                text = f"the drive has no one {command}, but a table of it in time; {OWN_FMU}"
                wrong.append(Problem(name, text))
        elif field in ("speed", "force", "distance") or not hasattr(drive, field):
            wrong.append(Problem(name, f"a drive of kind {drive.kind} has none; {OWN_FMU}"))
    return wrong


def _out_of_range(factors: Mapping[str, Any]) -> list[Problem]:
    low, high = names.STIFFNESS_FACTOR_LIMITS
    return [
        Problem(name, f"{value:g} is out of range; allowed: {low:g} to {high:g}")
        for name, value in factors.items()
        if not low <= value <= high
    ]


def opened(base: Scenario, paths: Collection[str]) -> dict[str, Any]:
    """A scenario as plain data into which other values can be put at these dotted paths.

    A drive of one speed has a `speed` and a `distance` then, one of one force or tip speed that and a `duration`.
    Raises ScenarioError for a drive that has no one speed or force.
    """
    data = base.to_dict()
    if {"wire.model", "wire.length", "wire.estimate"} & set(paths):
        _leave_to_the_catalogue(data["wire"], base, paths)
    wanted = {"drive.speed", "drive.force", "drive.distance", "drive.duration"} & set(paths)
    if wanted:
        data["drive"] = _one_value(data["drive"], base, min(wanted))
    return data


def _one_value(drive: dict[str, Any], base: Scenario, path: str) -> dict[str, Any]:
    """The drive with its one speed or force instead of a table of it."""
    what, known = command_of(base), constant_drive(base)
    if known is None:
        text = f"the drive has no one {what}, but a table of it in time; change drive.table, or take another scenario"
        raise ScenarioError(Problem(path, text))
    kept = {name: value for name, value in drive.items() if name != "table"}
    if base.drive.kind == "speed" and path != "drive.duration":
        return {**kept, what: known, "distance": abs(known) * base.drive.duration}
    return {**kept, what: known, "duration": base.drive.duration}


def _leave_to_the_catalogue(wire: dict[str, Any], base: Scenario, paths: Collection[str]) -> None:
    """Take out what the exported wire has from the catalogue, so that another model, length or estimate fills it in
    anew."""
    model = wire.get("model")
    if model is None:
        if "wire.model" in paths:
            for name in _OF_THE_WIRE:
                wire.pop(name, None)
        return
    known = scenario_from_dict({**base.to_dict(), "wire": {"model": model, "estimate": base.wire.estimate}}).wire
    for name in _OF_THE_WIRE:
        if name == "bending_stiffness":
            ours, theirs = base.wire.bending_stiffness, known.bending_stiffness[: len(base.wire.bending_stiffness)]
            same = all(a.value == b.value for a, b in zip(ours, theirs, strict=False))
        else:
            same = getattr(known, name) == getattr(base.wire, name)
        if same:
            wire.pop(name, None)


def _scaled(scenario: Scenario, factors: Mapping[str, float]) -> Scenario:
    """With the bending stiffness times the factors: one of all pieces, and one a piece."""
    pieces = [piece.to_plain() for piece in scenario.wire.bending_stiffness]
    for name, factor in factors.items():
        if name == names.STIFFNESS_FACTOR:
            chosen = pieces
        else:
            index = int(name.partition("[")[2].partition("]")[0])
            if index >= len(pieces):
                raise UsageError(f"{name}: the wire has {len(pieces)} pieces of bending stiffness; leave it at 1")
            chosen = [pieces[index]]
        for piece in chosen:
            value = piece["value"]
            piece["value"] = [factor * v for v in value] if isinstance(value, list) else factor * value
    return scenario_from_dict(scenario.to_dict(), {"wire.bending_stiffness": pieces})
