"""The calibration file: what is fitted to what; read as strictly as a scenario."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field, ValidationError, field_validator

from gw_exudyn.comparison import COMPARED, PATH, Course
from gw_exudyn.errors import Problem, ScenarioError, StorageError
from gw_exudyn.measured import read_measured
from gw_exudyn.quantities import QUANTITIES
from gw_exudyn.result import Floats
from gw_exudyn.scenario import Scenario
from gw_exudyn.scenario.faults import Faults, wrong
from gw_exudyn.scenario.fields import Flag, Kind, Quantity, Table, Text, Whole
from gw_exudyn.scenario.loading import name_from
from gw_exudyn.scenario.problems import in_order, problems_of
from gw_exudyn.scenario.section import Section
from gw_exudyn.scenario.units import NUMBER, parse_unit
from gw_exudyn.scenario.words import did_you_mean, shown
from gw_exudyn.scenario.yaml_source import Place, YamlSource, read_yaml
from gw_exudyn.sweep.studies.axes import Axis, read_number
from gw_exudyn.sweep.studies.design import grid, zipped
from gw_exudyn.sweep.studies.form import Paths, folder_name
from gw_exudyn.sweep.studies.loading import NONE, read_base, read_fixed, read_form
from gw_exudyn.sweep.studies.loading import value_problems as problems_of_values
from gw_exudyn.sweep.studies.problems import told_once
from gw_exudyn.sweep.studies.study import Study
from gw_exudyn.sweep.studies.value_kinds import value_kind

TIP = "tip"
"""Stands in `noise` for both coordinates of the tip."""

ENDS = ("start", "low", "high")
_MOST_FILES = 100


class Noise(Kind):
    """A mapping of measured quantities to the standard deviation of their noise; `off` leaves a quantity out."""

    def read(self, value: Any) -> dict[str, float]:
        """Standard deviations in SI, infinite for what is left out."""
        if not isinstance(value, dict):
            raise wrong(f"{shown(value)} stands where standard deviations are needed: as {{tip: 0.2 mm}}")
        faults, found = Faults(), {}
        for name, given in value.items():
            if name not in (TIP, *COMPARED):
                known = (TIP, *COMPARED)
                faults.add((name,), f"is no quantity; {did_you_mean(name, known)}known: {', '.join(known)}")
                continue
            quantity = QUANTITIES[PATH[0] if name == TIP else name]
            kind = Quantity(quantity.unit, 1e-12, 1e3, quantity.display_unit, off=True)
            found[name] = faults.read((name,), kind.read, given)
        faults.raise_if_any()
        return found

    def json(self) -> dict[str, Any]:
        """An object."""
        return {"type": "object"}


class CalibrationForm(Section):
    """What a calibration file holds."""

    what: ClassVar[str] = "a calibration"

    name: Annotated[str | None, Text("name", optional=True)] = None
    base: Annotated[str, Text("scenario")] = Field(
        description="the scenario whose values are fitted: a file, or a shipped one's name",
        examples=["phantom-universal"],
    )
    fixed: Annotated[dict[str, Any], Paths()] = Field(default_factory=dict, alias="set")
    measured: Annotated[tuple[str, ...], Table(Text("name of a CSV file"), 1, _MOST_FILES, "file")] = Field(
        description="CSV files of what was measured", examples=["[camera.csv]"]
    )
    noise: Annotated[dict[str, float], Noise()] = Field(
        description="the standard deviation of each measured quantity", examples=["{tip: 0.2 mm, push_force: 2 mN}"]
    )
    fit: Annotated[dict[str, Any], Paths()] = Field(
        description="what is fitted, and within which limits",
        examples=["{contact.friction_coefficient: {start: 0.3, low: 0.05, high: 0.8}}"],
    )
    align: Annotated[bool, Flag()] = False
    starts: Annotated[int, Whole(1, 64)] = Field(
        default=1, description="how many fits: from the start values, and from points spread over all ranges"
    )

    @field_validator("name", mode="after")
    @classmethod
    def _names_a_folder(cls, name: str | None) -> str | None:
        return folder_name(name)


_ABSENT: Mapping[str, Any] = {"base": NONE, "measured": (NONE,), "noise": {}, "fit": {}}


@dataclass(frozen=True)
class Parameter:
    """What is fitted. path : dotted, in the scenario. unit : in SI, `1` for a pure number. start, low, high : in SI.
    told : the unit in which the file gives it and people read it.
    """

    path: str
    unit: str
    start: float
    low: float
    high: float
    told: str

    def in_told(self, value: float) -> float:
        """A value in SI in the unit in which people read it."""
        return value if self.told == "1" else value / float(parse_unit(self.told).factor)

    def text(self, value: float, digits: int = 4) -> str:
        """A value in SI as people read it, with its unit."""
        number = f"{self.in_told(value):.{digits}g}"
        return number if self.told == "1" else f"{number} {self.told}"

    @property
    def label(self) -> str:
        """The path as words with the unit, for an axis."""
        words = self.path.replace("_", " ").replace(".", ": ")
        return words if self.told == "1" else f"{words} [{self.told}]"

    @property
    def range(self) -> float:
        """From the lowest to the highest value, in SI."""
        return self.high - self.low


@dataclass(frozen=True)
class Calibration:
    """A calibration, checked.

    noise : standard deviation in SI by quantity (`tip` for both coordinates), without those that are left out.
    measured : the courses as they were read. align : turn and shift measured paths. starts : how many fits.
    """

    name: str
    file: Path
    base: str
    parameters: tuple[Parameter, ...]
    measured: tuple[Course, ...]
    measured_files: tuple[Path, ...]
    noise: Mapping[str, float]
    align: bool
    starts: int
    fixed: Mapping[str, Any]
    _study: Study = field(repr=False)

    def study(self, points: Sequence[Floats]) -> Study:
        """The points as a study that the engine can run. points : each (parameters,), relative: 0 at the low end, 1 at
        the high end.
        """
        columns = [[self.values(point)[i] for point in points] for i in range(len(self.parameters))]
        axes = [
            Axis(one.path, one.unit, tuple(values), tuple(values))
            for one, values in zip(self.parameters, columns, strict=True)
        ]
        return replace(self._study, design=zipped(axes))

    def values(self, point: Floats) -> list[float]:
        """The parameters at a relative point, in SI, within their limits to the last digit."""
        return [
            float(np.clip(one.low + u * one.range, one.low, one.high))
            for one, u in zip(self.parameters, point, strict=True)
        ]

    def start(self) -> Floats:
        """(parameters,) The relative point at which the fit begins."""
        return np.array([(one.start - one.low) / one.range for one in self.parameters])

    def scenario(self, point: Floats) -> Scenario:
        """The scenario at a relative point. Raises ScenarioError."""
        return self.study([point]).scenario(0)


def load_calibration(path: str | os.PathLike[str], overrides: Sequence[str] = ()) -> Calibration:
    """Read a calibration file and check it.

    overrides : `path=value`, beside those of the file's `set`. Raises ScenarioError with all that is wrong, UsageError
    for an override that is none.
    """
    file = Path(path)
    source = read_yaml(file)
    problems = list(source.problems)
    form = read_form(CalibrationForm, source, problems, _ABSENT)
    fixed, places = read_fixed(form.fixed, form.fit, ("fitted", "fit"), source, overrides, problems)
    parameters = _parameters(form, source, problems)
    files = [file.parent / name for name in form.measured if name != NONE]
    measured = _measured(files, source, problems)
    noise = _noise(form, measured, source, problems)
    base, folder = read_base(form.base, file, source, problems)
    if base is not None:
        name, shape = form.name or name_from(file), ("zip", "", 0, 0, ("push_force_max",))
        study = Study(name, file, form.base, *shape, grid([]), fixed, base, folder, _aliases(places, parameters))
        problems += _value_problems(study, parameters)
    if problems or base is None:
        raise ScenarioError(in_order(told_once(problems)))
    lists = tuple(parameters), tuple(measured), tuple(files)
    calibration = Calibration(name, file, form.base, *lists, noise, form.align, form.starts, fixed, study)
    _check_start(calibration)
    return calibration


def _check_start(calibration: Calibration) -> None:
    """Find out whether the scenario can start. Raises ScenarioError with places in the calibration file."""
    from gw_exudyn import model

    study = calibration.study([calibration.start()])
    scenario = study.scenario(0)
    try:
        model.build(scenario)
    except ScenarioError as error:
        raise ScenarioError(study.placed(error.problems, 0)) from None


def _parameters(form: CalibrationForm, source: YamlSource, problems: list[Problem]) -> list[Parameter]:
    faults, found = Faults(), []
    for path, raw in form.fit.items():
        parameter = faults.read(("fit", path), partial(_parameter, path), raw)
        if parameter is not None:
            found.append(parameter)
        if any(other != path and path.startswith(f"{other}.") for other in form.fit):
            faults.add(("fit", path), "a part of it is fitted by another path; fit one of the two")
    if not form.fit and "fit" in source.data and not any(problem.path == "fit" for problem in problems):
        faults.add(
            ("fit",), "is empty: nothing is fitted; as contact.friction_coefficient: {start: 0.3, low: 0, high: 1}"
        )
    _note(faults, source, problems)
    return found


def _parameter(path: str, raw: Any) -> Parameter:
    """A parameter, from what stands behind its path. Raises ValidationError with all that is wrong."""
    faults = Faults()
    try:
        kind = value_kind(path)
    except LookupError as error:
        raise wrong(str(error)) from None
    if kind.unit is None or kind.whole:
        raise wrong(f"takes {'whole numbers' if kind.whole else 'no number'}; what is fitted has to be a real number")
    unit = kind.unit
    if not isinstance(raw, Mapping):
        raise wrong(f"{shown(raw)} stands where {{start: ..., low: ..., high: ...}} is needed")
    for key in raw:
        if key not in ENDS:
            faults.add((key,), f"unknown key; {did_you_mean(str(key), ENDS)}allowed: {', '.join(ENDS)}")
    for key in ENDS:
        if key not in raw:
            faults.add((), f"{key} is missing; start, low and high are needed")
    given = {key: faults.read((key,), lambda value: read_number(value, unit), raw[key]) for key in ENDS if key in raw}
    faults.raise_if_any()
    start, low, high = (given[key] for key in ENDS)
    if not low < high:
        raise wrong(f"low {shown(raw['low'])} is not below high {shown(raw['high'])}")
    if not low <= start <= high:
        raise wrong(f"start {shown(raw['start'])} is not between low {shown(raw['low'])} and high {shown(raw['high'])}")
    return Parameter(path, unit, start, low, high, _unit_in(raw["start"], unit))


def _unit_in(text: Any, unit: str) -> str:
    """The unit in which a quantity was written."""
    match = NUMBER.match(text.strip()) if isinstance(text, str) else None
    return text.strip()[match.end() :].strip() if match is not None else unit


def _measured(files: Sequence[Path], source: YamlSource, problems: list[Problem]) -> list[Course]:
    found = []
    for i, file in enumerate(files):
        place = source.places.get(f"measured.{i}", source.places.get("measured", (None, None)))
        try:
            found.append(read_measured(file))
        except ScenarioError as error:
            problems += error.problems
        except StorageError as error:
            problems.append(Problem(f"measured.{i}", str(error), *place))
    return found


def _noise(
    form: CalibrationForm, measured: Sequence[Course], source: YamlSource, problems: list[Problem]
) -> dict[str, float]:
    """The noise of what is fitted to; what lacks and what is for nothing is noted."""
    if any(problem.path.partition(".")[0] in ("noise", "measured") for problem in problems) or not measured:
        return {}
    faults = Faults()
    present = {TIP if name in PATH else name for course in measured for name in course.values}
    for name in sorted(present - form.noise.keys()):
        faults.add(
            ("noise",), f"{name} is measured, and its noise is missing: a standard deviation, or off to leave it out"
        )
    for name in form.noise:
        if name not in present:
            faults.add(("noise", name), f"is measured by no file; measured: {', '.join(sorted(present))}")
    noise = {name: value for name, value in form.noise.items() if math.isfinite(value)}
    if form.noise and not noise:
        faults.add(("noise",), "everything is off, so there is nothing to fit to")
    if form.align and TIP not in noise:
        faults.add(("align",), "turns measured paths, and no path is fitted to; remove it")
    _note(faults, source, problems)
    return noise


def _note(faults: Faults, source: YamlSource, problems: list[Problem]) -> None:
    try:
        faults.raise_if_any()
    except ValidationError as error:
        problems += problems_of(error, source.places)


def _aliases(places: Mapping[str, Place], parameters: Sequence[Parameter]) -> dict[str, Place]:
    """Places under the names by which a study looks for those of its values."""
    found = dict(places)
    for one in parameters:
        above = f"fit.{one.path}"
        for i, key in enumerate(ENDS):
            found[f"{above}.{i}"] = places.get(f"{above}.{key}", places.get(above, ("", None)))
        found[f"vary.{one.path}"] = places.get(above, ("", None))
    return found


def _value_problems(study: Study, parameters: Sequence[Parameter]) -> list[Problem]:
    """What is wrong with `set`, and with start and limits of each parameter by itself."""
    found = list(problems_of_values(study))
    for one in parameters:
        values = (one.start, one.low, one.high)
        axis = Axis(one.path, one.unit, values, values, listed=f"fit.{one.path}")
        found += problems_of_values(replace(study, design=grid([axis])))
    return found
