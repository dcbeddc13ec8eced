"""What a piece of evidence is: a measured number, the number it should be, and how far it may be off, and why.

Each module of this package gathers one group of cases in a tuple `CASES`; the tests assert every row of every case,
and `gw-exudyn verify` prints, draws and writes the same rows. There is no second list.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Evidence:
    """One row of the table.

    quantity : what was measured, in words. unit : of all the numbers here, SI, "1" where there is none.
    rule : `within` holds where |measured - expected| <= tolerance; `at_most` and `at_least` compare the measured number
        with the expected one, and the tolerance is not used.
    tolerance_source : where the tolerance, or the bound, comes from. source : of the expected number (equation, paper).
    """

    quantity: str
    unit: str
    measured: float
    expected: float
    tolerance: float
    tolerance_source: str
    source: str
    rule: Literal["within", "at_most", "at_least"] = "within"

    @property
    def holds(self) -> bool:
        """The measured number is where it should be; never true of a number that is not finite."""
        if not np.isfinite(self.measured):
            return False
        if self.rule == "within":
            return abs(self.measured - self.expected) <= self.tolerance
        return self.measured <= self.expected if self.rule == "at_most" else self.measured >= self.expected


@dataclass(frozen=True, eq=False)
class Curve:
    """Points to draw: `line` for theory, `points` for what was measured."""

    label: str
    x: Floats
    y: Floats
    style: Literal["line", "points"] = "points"


@dataclass(frozen=True, eq=False)
class Chart:
    """A figure of a case. name : of its file. Labels carry their unit, as in `tip x / mm`."""

    name: str
    title: str
    x_label: str
    y_label: str
    curves: tuple[Curve, ...]
    scales: Literal["linear", "log"] = "linear"


@dataclass(frozen=True)
class Finding:
    """What a case gave."""

    rows: tuple[Evidence, ...]
    charts: tuple[Chart, ...] = ()


@dataclass(frozen=True)
class Case:
    """A case of a group. find : runs it, alone and without side effects; it may take seconds, not minutes."""

    group: str
    name: str
    find: Callable[[], Finding]
