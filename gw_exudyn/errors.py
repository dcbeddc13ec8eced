"""The errors of gw-exudyn: a small tree in which each class knows the exit code of the command line.

Error text names the value, the place, what is allowed and the remedy. Nothing here imports more than the standard
library.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

_LISTED = 100
"""How many problems the text of a `ScenarioError` lists; a file of nonsense would otherwise flood the terminal."""


class GwError(Exception):
    """Base of every error that gw-exudyn raises on purpose. `exit_code` is what the command line ends with."""

    exit_code = 4


class UsageError(GwError):
    """The command or the call does not make sense as given (unknown option, call in the wrong order)."""

    exit_code = 2


class UnitError(GwError, ValueError):
    """A text is no quantity, its unit is unknown, or its dimension is not the one that is needed."""

    exit_code = 3


@dataclass(frozen=True)
class Problem:
    """One thing wrong with the input.

    path : dotted path of the value, as `wire.diameter` or `vessel.points.3`; empty for the file as a whole.
    message : what is wrong; what is allowed, or the remedy.
    file : the file it stands in, or `--set wire.diameter` for an override; None if unknown.
    line : line in that file, counted from 1; None if unknown.
    """

    path: str
    message: str
    file: str | None = None
    line: int | None = None

    def __str__(self) -> str:
        place = self.file or ""
        if place and self.line is not None:
            place += f":{self.line}"
        return ": ".join(part for part in (place, self.path, self.message) if part)


class ScenarioError(GwError):
    """The scenario cannot be used. Holds everything that is wrong with it, not only the first thing.

    Parameters
    ----------
    problems : one `Problem`, or several.
    """

    exit_code = 3

    def __init__(self, problems: Problem | Iterable[Problem]) -> None:
        self.problems: tuple[Problem, ...] = (problems,) if isinstance(problems, Problem) else tuple(problems)
        super().__init__(self.problems)  # so that it survives pickling on its way back from a worker

    def __str__(self) -> str:
        lines = [str(problem) for problem in self.problems[:_LISTED]]
        if len(self.problems) > _LISTED:
            lines.append(f"... and {len(self.problems) - _LISTED} more problems")
        return "\n".join(lines)


class SolverError(GwError):
    """The solver failed, or the run cannot be trusted."""

    exit_code = 4


class SweepError(GwError):
    """A sweep is done, and some of its points failed."""

    exit_code = 5


class ComparisonError(GwError):
    """A comparison came out beyond its tolerance."""

    exit_code = 6


class StorageError(GwError):
    """Trouble with a file or the disk: not ours, half-written, no permission, full."""

    exit_code = 7


class Interrupted(GwError):  # noqa: N818  # it is no error of anybody's
    """The user interrupted the work (Ctrl-C); what was done so far is kept."""

    exit_code = 130
