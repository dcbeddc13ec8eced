"""A study whose file was read: its points, and the scenario of each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from gw_exudyn.errors import Problem, ScenarioError
from gw_exudyn.fmi.overriding import opened
from gw_exudyn.metrics import Metric
from gw_exudyn.scenario import Scenario
from gw_exudyn.scenario.loading import scenario_from_source
from gw_exudyn.scenario.overrides import OVERRIDE
from gw_exudyn.scenario.shipped import resolve
from gw_exudyn.scenario.yaml_source import Place, YamlSource
from gw_exudyn.sweep.studies.design import Design
from gw_exudyn.sweep.studies.metric_names import metric_table
from gw_exudyn.sweep.studies.problems import AT_POINT


@dataclass(frozen=True)
class Study:
    """A study, checked; its points give scenarios.

    metrics : the metrics that figures and sensitivities are about; by the first, the smaller the better.
    """

    name: str
    file: Path
    base: str
    mode: str
    method: str
    samples: int
    seed: int
    metrics: tuple[str, ...]
    design: Design
    fixed: Mapping[str, Any]
    _source: YamlSource = field(repr=False)
    _folder: Path = field(repr=False)
    _places: Mapping[str, Place] = field(repr=False)

    @property
    def fmu(self) -> Path | None:
        """The FMU whose scenario is varied; None where the base is a scenario's file."""
        path = base_file(self.base, self.file)
        return path if path.suffix == ".fmu" else None

    def __len__(self) -> int:
        """How many points there are."""
        return len(self.design)

    def scenario(self, point: int) -> Scenario:
        """The scenario of a point. Raises ScenarioError, with the places in the study file of what is wrong."""
        try:
            given = {**self.fixed, **self.design.values(point)}
            overrides = {path: self.beside(path, value) for path, value in given.items()}
            source = self._source if self._exported is None else YamlSource(opened(self._exported, overrides))
            return scenario_from_source(source, overrides, self._folder)
        except ScenarioError as error:
            raise ScenarioError(self.placed(error.problems, point)) from None

    @cached_property
    def _exported(self) -> Scenario | None:
        """The scenario in the FMU that is the base."""
        return None if self.fmu is None else scenario_from_source(self._source, {}, self._folder)

    @cached_property
    def metric_table(self) -> Mapping[str, Metric]:
        """What a run of the first point tells, by name: units and meanings of the study's metrics."""
        return metric_table(self.scenario(0))

    def beside(self, path: str, value: Any) -> Any:
        """A file that the study names, beside the study; one that is not there is looked for beside the base."""
        if path.rpartition(".")[2] == "file" and isinstance(value, str) and (self.file.parent / value).is_file():
            return str((self.file.parent / value).absolute())
        return value

    def placed(self, problems: Iterable[Problem], point: int) -> list[Problem]:
        """Problems of a point's scenario, those with an override told at its place in the study file."""
        return [self._placed(problem, point) for problem in problems]

    def _placed(self, problem: Problem, point: int) -> Problem:
        path = (problem.file or "").removeprefix(OVERRIDE)
        if not (problem.file or "").startswith(OVERRIDE):
            labels = ", ".join(f"{path} {label}" for path, label in self.design.labels(point).items())
            return Problem(problem.path, f"{problem.message}{AT_POINT} {point} ({labels})", problem.file, problem.line)
        file, line = self._place(path, point)
        return Problem(problem.path, problem.message, file, line)

    def place(self, path: str) -> Place:
        """File and line of a value of the study."""
        return self._places.get(path, (str(self.file), None))

    def _place(self, path: str, point: int) -> Place:
        for number, axis in enumerate(self.design.axes):
            if axis.path == path:
                item = self.design.indices(point)[number] if self.design.grid else point
                places = [f"{axis.listed}.{item}", f"vary.{path}"] if axis.listed else [f"vary.{path}"]
                return next((self._places[key] for key in places if key in self._places), (str(self.file), None))
        return self._places.get(f"set.{path}", (str(self.file), None))


def base_file(base: str, file: Path) -> Path:
    """The file of the base: beside the study, or elsewhere. Raises ScenarioError."""
    beside = file.parent / base
    return beside if beside.is_file() else resolve(base)
