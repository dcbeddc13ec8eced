"""Distributions of an uncertain parameter, through their quantile functions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from gw_exudyn.result import Floats

FORMS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "uniform": ("low", "high"),
        "loguniform": ("low", "high"),
        "triangular": ("low", "most likely", "high"),
        "normal": ("mean", "standard deviation"),
        "lognormal": ("median", "standard deviation of the natural logarithm"),
    }
)
"""Each distribution with the meaning of its numbers. All are quantities of the parameter, but the last one's second
is a pure number."""

_EDGE = 1e-12
"""Probabilities nearer to 0 or 1 than this are taken as this: a quantile there may be infinite."""


@dataclass(frozen=True)
class Distribution:
    """A distribution, cut off at `low` and `high` where they are given. numbers : SI, in the order of FORMS."""

    form: str
    numbers: tuple[float, ...]
    low: float | None = None
    high: float | None = None

    @property
    def bounded(self) -> bool:
        """Whether it has a smallest and a largest value."""
        return self.form not in ("normal", "lognormal") or (self.low is not None and self.high is not None)

    def quantile(self, probability: Floats) -> Floats:
        """Values at probabilities (any shape, 0 to 1)."""
        law = self._law()
        below = 0.0 if self.low is None else law.cdf(self.low)
        within = (1.0 if self.high is None else law.cdf(self.high)) - below
        values = law.ppf(below + np.clip(probability, _EDGE, 1 - _EDGE) * within)
        return np.asarray(
            np.clip(values, self.low, self.high) if self.low is not None or self.high is not None else values
        )

    def fault(self) -> str | None:
        """What is wrong with the numbers, in a sentence, or None."""
        numbers = self.numbers
        if self.form in ("uniform", "loguniform", "triangular") and not numbers[0] < numbers[-1]:
            return f"low, {numbers[0]:g}, is not below high, {numbers[-1]:g}"
        if self.form == "triangular" and not numbers[0] <= numbers[1] <= numbers[2]:
            return f"the most likely value, {numbers[1]:g}, is not between {numbers[0]:g} and {numbers[2]:g}"
        if self.form in ("loguniform", "lognormal") and not numbers[0] > 0:
            return f"{numbers[0]:g} is not positive, which a {self.form} distribution needs"
        if self.form in ("normal", "lognormal") and not numbers[1] > 0:
            return f"the {FORMS[self.form][1]}, {numbers[1]:g}, is not positive"
        if self.low is not None and self.high is not None and not self.low < self.high:
            return f"the cut-off low, {self.low:g}, is not below high, {self.high:g}"
        law = self._law()
        if (self.low is not None and not law.cdf(self.low) < 1) or (
            self.high is not None and not law.cdf(self.high) > 0
        ):
            return "the cut-offs leave nothing of the distribution"
        return None

    def _law(self) -> Any:
        from scipy import stats

        a = self.numbers
        if self.form == "uniform":
            return stats.uniform(a[0], a[1] - a[0])
        if self.form == "loguniform":
            return stats.loguniform(a[0], a[1])
        if self.form == "triangular":
            return stats.triang((a[1] - a[0]) / (a[2] - a[0]), a[0], a[2] - a[0])
        if self.form == "normal":
            return stats.norm(a[0], a[1])
        return stats.lognorm(a[1], scale=a[0])


def describe(form: str) -> str:
    """How a distribution is written: `{normal: [mean, standard deviation]}`."""
    return f"{{{form}: [{', '.join(FORMS[form])}]}}"


def is_pure(form: str, index: int) -> bool:
    """Whether a number of a distribution has no unit, whatever the parameter's is."""
    return form == "lognormal" and index == 1


def names() -> Sequence[str]:
    """The known distributions."""
    return tuple(FORMS)
