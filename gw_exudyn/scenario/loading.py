"""Loading a scenario: by the path of its file, by the name of a shipped one, or from plain data."""

from __future__ import annotations

import copy
import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from gw_exudyn.errors import Problem, ScenarioError
from gw_exudyn.scenario.overrides import Overrides, apply_overrides
from gw_exudyn.scenario.problems import in_order, problems_of
from gw_exudyn.scenario.schema import Scenario, with_places
from gw_exudyn.scenario.shipped import resolve
from gw_exudyn.scenario.vessels.shared_vessel import insert_vessel
from gw_exudyn.scenario.yaml_source import YamlSource, read_yaml


def load_scenario(path_or_name: str | os.PathLike[str], overrides: Overrides = ()) -> Scenario:
    """Load a scenario and check it.

    Parameters
    ----------
    path_or_name : a YAML file, or the bare name of a shipped scenario.
    overrides : `["wire.segments=100"]`, each value read as YAML, or `{"wire.segments": 100}`, values taken as they
        are. Dotted paths; items of a list by their index. They go through the same checks as the file. The last of
        equal paths wins.

    Raises
    ------
    ScenarioError
        with everything that is wrong: file, line, path, and what is allowed.
    UsageError
        for an override that is no `path=value`.
    """
    path = resolve(path_or_name)
    source = read_yaml(path)
    source.data.setdefault("name", name_from(path))
    return _checked(source, overrides, path.parent)


def scenario_from_dict(
    data: Mapping[str, Any], overrides: Overrides = (), folder: str | os.PathLike[str] = "."
) -> Scenario:
    """A scenario from plain data, as a file would hold it. Relative files in it are relative to `folder`. Raises
    ScenarioError.
    """
    if not isinstance(data, Mapping):
        raise ScenarioError(Problem("", f"a scenario is a mapping, not {type(data).__name__}"))
    return _checked(YamlSource(copy.deepcopy(dict(data))), overrides, Path(folder))


def scenario_from_source(source: YamlSource, overrides: Overrides, folder: Path) -> Scenario:
    """A scenario from a file that was read before, which stays as it is: for many scenarios that differ in their
    overrides. Relative files are relative to `folder`. Raises ScenarioError.
    """
    mine = YamlSource(copy.deepcopy(source.data), dict(source.places), list(source.problems))
    return _checked(mine, overrides, folder)


def _checked(source: YamlSource, overrides: Overrides, folder: Path) -> Scenario:
    insert_vessel(source, folder)
    if overrides:
        apply_overrides(source, overrides, lambda: _validated(source, folder).to_dict())
    scenario = _validated(source, folder)
    return with_places(scenario, source.places)


def _validated(source: YamlSource, folder: Path) -> Scenario:
    problems = list(source.problems)
    try:
        scenario = Scenario.model_validate(source.data, context={"folder": folder})
    except ValidationError as error:
        told = {problem.path for problem in problems if problem.path}  # what the text got wrong is no second mistake
        if any(path.startswith("vessel.file") for path in told):
            told.add("vessel")  # the vessel's own file could not be read: that is the one mistake
        problems += [problem for problem in problems_of(error, source.places) if problem.path not in told]
    if problems:
        raise ScenarioError(in_order(problems))
    return scenario


def name_from(path: Path) -> str:
    """A name that a folder may have, from the name of the file."""
    return re.sub(r"[^\w.+-]", "-", path.stem).lstrip(".+-")[:100] or "scenario"
