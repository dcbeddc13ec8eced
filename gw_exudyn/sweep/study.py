"""The study file: what is varied, and how; read as strictly as a scenario."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path
from typing import Annotated, Any, ClassVar, TypeVar, cast

from pydantic import Field, ValidationError, field_validator

from gw_exudyn.errors import Problem, ScenarioError, StorageError
from gw_exudyn.fmi.overriding import opened
from gw_exudyn.fmi.resources import scenario_in
from gw_exudyn.metrics import Metric
from gw_exudyn.scenario import Scenario
from gw_exudyn.scenario.fields import Choice, Faults, Kind, Section, Table, Text, Whole, wrong
from gw_exudyn.scenario.loading import name_from, scenario_from_source
from gw_exudyn.scenario.overrides import OVERRIDE, split_override
from gw_exudyn.scenario.problems import in_order, problems_of
from gw_exudyn.scenario.schema import schema_of
from gw_exudyn.scenario.shipped import resolve, shipped_folder
from gw_exudyn.scenario.words import did_you_mean, nearest, shown
from gw_exudyn.scenario.yaml_source import Place, YamlSource, read_yaml
from gw_exudyn.sweep.axes import Axis, axis_schema, read_axis
from gw_exudyn.sweep.design import FOR_INDICES, METHODS, MOST_POINTS, Design, count_of, grid, sampled, zipped
from gw_exudyn.sweep.metric_names import metric_table
from gw_exudyn.sweep.point_list import read_points

MODES = ("grid", "zip", "list", "sample")
STUDIES = "studies"
"""The folder of shipped studies beside the shipped scenarios."""

_MOST_PROBLEMS = 1000
_NAME = re.compile(r"\w[\w.+-]{0,99}")
_AT = "; first at point"
"""Goes before the point whose scenario is wrong at a place outside the study; problems that differ in it are one."""

Form = TypeVar("Form", bound=Section)

NONE = "-"
"""Stands for a base that the file does not give, which is told already."""


def folder_name(name: str | None) -> str | None:
    """The name, if it can be that of a folder. Raises what `wrong` makes."""
    if name is not None and _NAME.fullmatch(name) is None:
        allowed = "letters, digits and _ . + - are allowed, a letter or digit first, 100 in all"
        raise wrong(f"{shown(name)} cannot name a folder; {allowed}")
    return name


@dataclass(frozen=True)
class Paths(Kind):
    """A mapping of dotted paths. values : JSON schema of what may stand behind a path."""

    values: Mapping[str, Any] = field(default_factory=dict)

    def read(self, value: Any) -> dict[str, Any]:
        """The mapping, as it is."""
        if not isinstance(value, dict):
            raise wrong(f"{shown(value)} stands where dotted paths are needed: lines as 'wire.segments: ...'")
        return dict(value)

    def json(self) -> dict[str, Any]:
        """An object of such values."""
        return {"type": "object", "additionalProperties": dict(self.values)} if self.values else {"type": "object"}


class StudyForm(Section):
    """What a study file holds."""

    what: ClassVar[str] = "a study"

    name: Annotated[str | None, Text("name", optional=True)] = Field(
        default=None, description="name of the study and of its folder; the file's name if not given"
    )
    base: Annotated[str, Text("scenario")] = Field(
        description="the scenario that is varied: a file, a shipped one's name, or an FMU",
        examples=["corner90-universal"],
    )
    fixed: Annotated[dict[str, Any], Paths()] = Field(
        default_factory=dict, alias="set", description="dotted paths of the scenario: their values in all points"
    )
    vary: Annotated[dict[str, Any], Paths(axis_schema())] = Field(
        default_factory=dict, description="dotted paths of the scenario: the values they take, or their distributions"
    )
    points: Annotated[str | None, Text("name of a CSV file", optional=True)] = Field(
        default=None, description="mode list: a CSV file with a row a point, headed by dotted paths"
    )
    mode: Annotated[str, Choice(MODES)] = Field(
        default="grid",
        description="grid: all combinations; zip: first values, second values, ...; list: the rows of "
        "a CSV file; sample: drawn at random",
    )
    samples: Annotated[int | None, Whole(1, MOST_POINTS)] = Field(
        default=None, description="mode sample: how many points are drawn"
    )
    method: Annotated[str, Choice(METHODS)] = Field(
        default="latin-hypercube", description="mode sample: how points are drawn"
    )
    seed: Annotated[int, Whole(0, 2**31 - 1)] = Field(
        default=0, description="mode sample: the same seed draws the same points"
    )
    metrics: Annotated[tuple[str, ...], Table(Text("metric"), 1, 200, "metric")] = Field(
        default=("push_force_max",),
        description="what figures and indices are about; by the first, the smallest is the best",
    )

    @field_validator("name", mode="after")
    @classmethod
    def _names_a_folder(cls, name: str | None) -> str | None:
        return folder_name(name)


def study_schema() -> dict[str, Any]:
    """JSON schema of a study file."""
    return schema_of(StudyForm, "gw-exudyn study")


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
        path = _beside(self.base, self.file)
        return path if path.suffix == ".fmu" else None

    def __len__(self) -> int:
        """How many points there are."""
        return len(self.design)

    def scenario(self, point: int) -> Scenario:
        """The scenario of a point. Raises ScenarioError, with the places in the study file of what is wrong."""
        try:
            given = {**self.fixed, **self.design.values(point)}
            overrides = {path: self._beside(path, value) for path, value in given.items()}
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

    def _beside(self, path: str, value: Any) -> Any:
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
            return Problem(problem.path, f"{problem.message}{_AT} {point} ({labels})", problem.file, problem.line)
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


def load_study(path_or_name: str | os.PathLike[str], overrides: Sequence[str] = ()) -> Study:
    """Read a study file and check it; `make_plan` checks its points.

    path_or_name : a YAML file, or the name of a shipped study. overrides : `path=value`, for all points, beside those
    of the file's `set`.

    Raises ScenarioError with all that is wrong, UsageError for an override that is none.
    """
    file = _study_file(os.fspath(path_or_name))
    source = read_yaml(file)
    problems = list(source.problems)
    form = read_form(StudyForm, source, problems, {"base": NONE})
    fixed, places = read_fixed(form.fixed, form.vary, ("varied", "vary"), source, overrides, problems)
    axes = _axes(form, source, problems)
    base, folder = read_base(form.base, file, source, problems)
    design = None
    if not problems:
        design = _design(form, axes, file, source, places, problems)
    if base is not None and problems:
        # What can be told of the values all the same: of whole points, or of each value by itself.
        designs = [design] if design is not None else [grid([]), *(grid([axis]) for axis in axes if axis.values)]
        for one in designs:
            problems += value_problems(_study(form, file, fixed, base, folder, places, one))
    if base is not None:
        problems += _metric_problems(_study(form, file, fixed, base, folder, places, design or grid([])))
    if problems or base is None or design is None:
        raise ScenarioError(in_order(told_once(problems)))
    return _study(form, file, fixed, base, folder, places, design)


def _study(
    form: StudyForm,
    file: Path,
    fixed: Mapping[str, Any],
    base: YamlSource,
    folder: Path,
    places: Mapping[str, Place],
    design: Design,
) -> Study:
    name = form.name or name_from(file)
    given = (name, file, form.base, form.mode, form.method, form.samples or 0, form.seed, form.metrics)
    return Study(*given, design, fixed, base, folder, places)


def value_problems(study: Study) -> list[Problem]:
    """What is wrong with values that the study puts into the scenario, as far as its points show it."""
    found, mine = ProblemList(), [*study.fixed, *(axis.path for axis in study.design.axes)]
    for point in range(min(len(study), _MOST_PROBLEMS)):
        try:
            study.scenario(point)
        except ScenarioError as error:
            # Told at a value of the study: its own path may differ, where a branch is meant by its name.
            found.add(p for p in error.problems if _AT not in p.message or any(_overlap(p.path, path) for path in mine))
    return found.all()


def _metric_problems(study: Study) -> list[Problem]:
    """Metrics that no run of the study tells; nothing where the first point's scenario is wrong itself."""
    try:
        known = study.metric_table
    except ScenarioError:
        return []
    found = []
    for i, name in enumerate(study.metrics):
        if name not in known:
            text = f"{shown(name)} is no metric of a run; {did_you_mean(name, list(known))}known: {', '.join(known)}"
            file, line = study.place(f"metrics.{i}")
            found.append(Problem(f"metrics.{i}", text, file, line))
    return found


def _study_file(text: str) -> Path:
    path = Path(text)
    shipped = shipped_folder() / STUDIES
    if not path.exists() and path.name == text:
        found = shipped / (text if path.suffix in (".yaml", ".yml") else f"{text}.yaml")
        if found.is_file():
            return found
        near = nearest(path.stem, [file.stem for file in shipped.glob("*.yaml")])
        hint = f"; nearest: {', '.join(near)}" if near else ""
        raise ScenarioError(Problem("", f"there is no such file, and no shipped study of that name{hint}", text))
    return path


def read_form(form: type[Form], source: YamlSource, problems: list[Problem], missing: Mapping[str, Any]) -> Form:
    """The file's form; what is wrong with a key is noted, and the key left out. missing : what stands for keys that
    have to be there.
    """
    try:
        return form.model_validate(source.data)
    except ValidationError as error:
        problems += problems_of(error, source.places)
        wrong_keys = {str(details["loc"][0]) for details in error.errors(include_url=False) if details["loc"]}
    rest = {key: value for key, value in source.data.items() if key not in wrong_keys}
    return form.model_validate({**missing, **rest})


def read_fixed(
    given: Mapping[str, Any],
    free: Iterable[str],
    words: tuple[str, str],
    source: YamlSource,
    overrides: Sequence[str],
    problems: list[Problem],
) -> tuple[dict[str, Any], dict[str, Place]]:
    """What `set` and --set put into all points, and the places of all values of the file.

    free : paths that are not fixed. words : for what is done with those, as ("varied", "vary").
    """
    fixed, places, free = dict(given), dict(source.places), tuple(free)
    for text in overrides:
        path, place, read = split_override(text)
        fixed[path] = read()
        places[f"set.{path}"] = (place, None)
    for path in fixed:
        if any(_overlap(path, other) for other in free):
            file, line = places.get(f"set.{path}", (None, None))
            problems.append(Problem(path, f"is {words[0]} as well; set it or {words[1]} it", file, line))
    return fixed, places


def _overlap(one: str, other: str) -> bool:
    return one == other or one.startswith(f"{other}.") or other.startswith(f"{one}.")


def _axes(form: StudyForm, source: YamlSource, problems: list[Problem]) -> list[Axis]:
    axes, faults = [], Faults()
    for path, raw in form.vary.items():
        axis = faults.read(("vary", path), partial(read_axis, path), raw)
        if axis is not None:
            axes.append(axis)
        if any(other != path and path.startswith(f"{other}.") for other in form.vary):
            faults.add(("vary", path), "a part of it is varied by another path; vary one of the two")
    if not any(problem.path == "mode" for problem in problems):
        _check_form(form, axes, faults)  # else it is not known what the mode needs
    try:
        faults.raise_if_any()
    except ValidationError as error:
        problems += problems_of(error, source.places)
    return axes


def _check_form(form: StudyForm, axes: Sequence[Axis], faults: Faults) -> None:
    """What the mode needs and does not take."""
    if form.mode == "list":
        if form.points is None:
            faults.add(("points",), "is missing: mode list takes its points from a CSV file; points: file.csv")
        if form.vary:
            faults.add(("vary",), "stands beside mode: list, whose points come from the CSV file; remove it")
        return
    if form.points is not None:
        faults.add(("points",), f"is for mode: list; the mode is {form.mode}")
    if not form.vary:
        faults.add(("vary",), "is missing: what is varied; as contact.friction_coefficient: [0.2, 0.4]")
    if form.mode == "sample":
        _check_sample(form, faults)
        return
    if form.samples is not None:
        faults.add(("samples",), f"is for mode: sample; the mode is {form.mode}")
    for axis in axes:
        if axis.distribution is not None:
            faults.add(("vary", axis.path), f"a distribution is for mode: sample; the mode is {form.mode}")
    lengths = {axis.path: len(axis.values) for axis in axes if axis.distribution is None}
    if form.mode == "zip" and len(set(lengths.values())) > 1:
        told = ", ".join(f"{path} has {count}" for path, count in lengths.items())
        faults.add(("mode",), f"zip needs equally many values everywhere: {told}")


def _check_sample(form: StudyForm, faults: Faults) -> None:
    if form.samples is None:
        faults.add(("samples",), "is missing: how many points to draw, as samples: 64")
        return
    if form.method in ("sobol", "sobol-indices") and form.samples & (form.samples - 1):
        below = 1 << (form.samples.bit_length() - 1)
        faults.add(("samples",), f"{form.samples} is no power of 2, which Sobol's points need: {below} or {2 * below}")
    total = count_of(form.method, form.samples, len(form.vary))
    if total > MOST_POINTS:
        faults.add(("samples",), f"makes {total} points; at most {MOST_POINTS} are allowed")
    if form.method in FOR_INDICES:
        from gw_exudyn.sweep.sensitivity import missing_library

        missing = missing_library()
        if missing:
            faults.add(("method",), missing)


def read_base(base: str, file: Path, source: YamlSource, problems: list[Problem]) -> tuple[YamlSource | None, Path]:
    """The scenario that is varied, read, and the folder that its files are relative to."""
    if base == NONE:
        return None, file.parent
    try:
        path = _beside(base, file)
        read = YamlSource(scenario_in(path)) if path.suffix == ".fmu" else read_yaml(path)
    except StorageError as error:
        problems.append(Problem("base", str(error), *source.places.get("base", (str(file), None))))
        return None, file.parent
    except ScenarioError as error:
        place = source.places.get("base", (str(file), None))
        for problem in error.problems:
            known = problem.line is not None
            problems.append(problem if known else Problem("base", f"{base}: {problem.message}", *place))
        return None, file.parent
    read.data.setdefault("name", name_from(path))
    return read, path.parent


def _beside(base: str, file: Path) -> Path:
    """The file of the base: beside the study, or elsewhere. Raises ScenarioError."""
    beside = file.parent / base
    return beside if beside.is_file() else resolve(base)


def _design(
    form: StudyForm,
    axes: Sequence[Axis],
    file: Path,
    source: YamlSource,
    places: dict[str, Place],
    problems: list[Problem],
) -> Design | None:
    if form.mode == "list":
        try:
            axes, lines, faults = read_points(file.parent / cast(str, form.points))
        except ScenarioError as error:
            problems += error.problems
            return None
        places |= lines
        problems += faults
        return zipped(axes)
    if form.mode == "zip":
        return zipped(axes)
    if form.mode == "sample":
        return sampled(axes, form.method, form.samples or 0, form.seed)
    design = grid(axes)
    if len(design) > MOST_POINTS:
        place = source.places.get("vary", (str(file), None))
        problems.append(Problem("vary", f"makes {len(design)} points; at most {MOST_POINTS} are allowed", *place))
        return None
    return design


def told_once(problems: Iterable[Problem]) -> list[Problem]:
    """The problems without those that say the same again."""
    found = ProblemList()
    found.add(problems)
    return found.all()


class ProblemList:
    """Problems of many points, each told once. Full after so many that nobody reads them all."""

    def __init__(self) -> None:
        self._problems: dict[str, Problem] = {}

    def add(self, problems: Iterable[Problem]) -> None:
        """Note problems that were not noted yet."""
        for problem in problems:
            self._problems.setdefault(str(problem).partition(_AT)[0], problem)

    def all(self) -> list[Problem]:
        """Everything noted."""
        return list(self._problems.values())

    @property
    def full(self) -> bool:
        """Whether there is no point in looking further."""
        return len(self._problems) >= _MOST_PROBLEMS

    def raise_if_any(self) -> None:
        """Raise ScenarioError with everything noted, if anything was."""
        if self._problems:
            raise ScenarioError(in_order(self.all()))
