"""Reading a study file: as strictly as a scenario, everything that is wrong told at once."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, TypeVar, cast

from pydantic import ValidationError

from gw_exudyn.errors import Problem, ScenarioError, StorageError
from gw_exudyn.fmi.resources import scenario_in
from gw_exudyn.scenario.faults import Faults
from gw_exudyn.scenario.loading import name_from
from gw_exudyn.scenario.overrides import split_override
from gw_exudyn.scenario.problems import in_order, problems_of
from gw_exudyn.scenario.section import Section
from gw_exudyn.scenario.shipped import shipped_folder
from gw_exudyn.scenario.words import did_you_mean, nearest, shown
from gw_exudyn.scenario.yaml_source import Place, YamlSource, read_yaml
from gw_exudyn.sweep.studies.axes import Axis, read_axis
from gw_exudyn.sweep.studies.design import MOST_POINTS, Design, grid, sampled, zipped
from gw_exudyn.sweep.studies.form import StudyForm, check_form
from gw_exudyn.sweep.studies.point_list import read_points
from gw_exudyn.sweep.studies.problems import AT_POINT, MOST_PROBLEMS, ProblemList, told_once
from gw_exudyn.sweep.studies.study import Study, base_file

STUDIES = "studies"
"""The folder of shipped studies beside the shipped scenarios."""

NONE = "-"
"""Stands for a base that the file does not give, which is told already."""

Form = TypeVar("Form", bound=Section)


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
    for point in range(min(len(study), MOST_PROBLEMS)):
        try:
            study.scenario(point)
        except ScenarioError as error:
            # Told at a value of the study: its own path may differ, where a branch is meant by its name.
            found.add(
                p for p in error.problems if AT_POINT not in p.message or any(_overlap(p.path, path) for path in mine)
            )
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
        check_form(form, axes, faults)  # else it is not known what the mode needs
    try:
        faults.raise_if_any()
    except ValidationError as error:
        problems += problems_of(error, source.places)
    return axes


def read_base(base: str, file: Path, source: YamlSource, problems: list[Problem]) -> tuple[YamlSource | None, Path]:
    """The scenario that is varied, read, and the folder that its files are relative to."""
    if base == NONE:
        return None, file.parent
    try:
        path = base_file(base, file)
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
