"""What is wrong with the points of a study, each thing told once."""

from __future__ import annotations

from collections.abc import Iterable

from gw_exudyn.errors import Problem, ScenarioError
from gw_exudyn.scenario.problems import in_order

AT_POINT = "; first at point"
"""Goes before the point whose scenario is wrong at a place outside the study; problems that differ in it are one."""

MOST_PROBLEMS = 1000
"""More are read by nobody."""


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
            self._problems.setdefault(str(problem).partition(AT_POINT)[0], problem)

    def all(self) -> list[Problem]:
        """Everything noted."""
        return list(self._problems.values())

    @property
    def full(self) -> bool:
        """Whether there is no point in looking further."""
        return len(self._problems) >= MOST_PROBLEMS

    def raise_if_any(self) -> None:
        """Raise ScenarioError with everything noted, if anything was."""
        if self._problems:
            raise ScenarioError(in_order(self.all()))
