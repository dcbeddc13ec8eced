"""From pydantic's errors to our problems: dotted path, and the file and line where the value stands."""

from __future__ import annotations

from collections.abc import Mapping

from pydantic import ValidationError

from gw_exudyn.errors import Problem
from gw_exudyn.scenario.section import KIND_TAG
from gw_exudyn.scenario.words import path_text
from gw_exudyn.scenario.yaml_source import Place


def problems_of(error: ValidationError, places: Mapping[str, Place], prefix: int = 0) -> list[Problem]:
    """All faults as problems. `prefix`: how many leading parts of a path the file does not have."""
    problems = []
    for details in error.errors(include_url=False):
        path = path_text(part for part in details["loc"][prefix:] if not str(part).startswith(KIND_TAG))
        context = details.get("ctx", {})
        place = (context["file"], context["line"]) if context.get("file") else place_of(path, places)
        file, line = place or (None, None)
        problems.append(Problem(path, str(context.get("text", details["msg"])), file, line))
    return problems


def place_of(path: str, places: Mapping[str, Place]) -> Place | None:
    """Where the value of a path stands, or the nearest thing above it that the file has; None if it has none."""
    while path:
        if path in places:
            return places[path]
        path = path.rpartition(".")[0]
    return places.get("")


def in_order(problems: list[Problem]) -> list[Problem]:
    """Problems in the order of the lines of their files; those without a line last, in the order in which they came."""
    return sorted(problems, key=_line)


def _line(problem: Problem) -> tuple[bool, str, int]:
    if problem.line is None:
        return True, "", 0
    return False, problem.file or "", problem.line
