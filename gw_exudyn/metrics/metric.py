"""One number of a run, and the usual ways to one: the last of a series, its largest, with or without its time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.quantities import QUANTITIES

if TYPE_CHECKING:
    from gw_exudyn.result import Floats, Result


@dataclass(frozen=True)
class Metric:
    """A number of a run: value in SI (NaN where the run gives none), unit, meaning; of a coded one, what the value
    stands for as `label`.
    """

    value: float
    unit: str
    meaning: str
    label: str = ""


def final(result: Result, name: str) -> Metric:
    return Metric(float(result.values(name)[-1]), QUANTITIES[name].unit, f"{QUANTITIES[name].long_name}; at the end")


def largest(result: Result, name: str, meaning: str) -> Metric:
    return Metric(peak_of(result.values(name), result.time)[0], QUANTITIES[name].unit, meaning)


def with_time(
    result: Result, name: str, peak: str, values: Floats, unit: str, meaning: str, remark: str = ""
) -> dict[str, Metric]:
    """The largest value and its time: `peak` of the result's peaks where it has that, else the largest of `values`."""
    (value, instant), where = peak_of(values, result.time), "at the outputs"
    kept = result.peaks.get(peak)
    if kept is not None and math.isfinite(kept[0]):
        (value, instant), where = kept, "over all steps"
    return {
        name: Metric(value, unit, f"{meaning}, {where}{remark}"),
        f"{name}_time": Metric(instant, QUANTITIES["time"].unit, f"time of the {meaning}, {where}"),
    }


def peak_of(values: Floats, time: Floats) -> tuple[float, float]:
    """Largest finite value and its time; NaN for both where no value is finite (a run that broke at its start)."""
    finite = np.isfinite(values)
    if not finite.any():
        return float("nan"), float("nan")
    instant = int(np.argmax(np.where(finite, values, -np.inf)))
    return float(values[instant]), float(time[instant])
