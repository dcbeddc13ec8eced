"""Single numbers that sum up a run, each with its unit and meaning."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.quantities import QUANTITIES

if TYPE_CHECKING:
    from gw_exudyn.result import Floats, Result


LEAST_WORK = 1e-7
"""Largest work, J, below which an energy error is not measured on it; the floor of the trust check."""


@dataclass(frozen=True)
class Metric:
    """A number of a run: value in SI (NaN where the run gives none), unit, meaning."""

    value: float
    unit: str
    meaning: str


def metrics(result: Result) -> dict[str, Metric]:
    """Metrics of a run by name, in the order in which a table shows them."""
    return {**_tip(result), **_forces(result), **_contact(result), **_energy(result), **_solution(result)}


def _tip(result: Result) -> dict[str, Metric]:
    found = {f"final_{name}": _final(result, name) for name in ("tip_x", "tip_y", "tip_angle", "insertion_depth")}
    found["insertion_depth_max"] = _largest(result, "insertion_depth", "deepest insertion, at the outputs")
    path = np.hypot(np.diff(result.values("tip_x")), np.diff(result.values("tip_y")))
    found["tip_path_length"] = Metric(
        float(np.nansum(path)), QUANTITIES["tip_x"].unit, "length of the path of the tip, there and back"
    )
    return found


def _forces(result: Result) -> dict[str, Metric]:
    resultant = np.hypot(result.values("wall_force_x"), result.values("wall_force_y"))
    cases = {
        "push_force_max": ("push_force", result.values("push_force"), "largest push force", ""),
        "pull_force_max": (
            "pull_force",
            -result.values("push_force"),
            "largest pull force",
            " (negative push force; zero or less: none)",
        ),
        "wall_force_max": (
            "wall_force_max",
            result.values("wall_force_max"),
            "largest force of a single contact with the vessel",
            "",
        ),
        "wall_force_resultant_max": ("", resultant, "largest resultant force on the vessel", ""),
        "tip_force_max": ("", result.values("tip_force"), "largest contact force on the tip", ""),
    }
    found: dict[str, Metric] = {}
    for name, (peak, values, meaning, remark) in cases.items():
        found |= _with_time(result, name, peak, values, QUANTITIES["push_force"].unit, meaning, remark)
    return found


def _contact(result: Result) -> dict[str, Metric]:
    return {
        "contacts_max": _largest(
            result, "contacts", "largest number of contacts with the vessel at once, at the outputs"
        ),
        **_with_time(
            result,
            "penetration_max",
            "penetration_max",
            result.values("penetration_max"),
            QUANTITIES["penetration_max"].unit,
            "deepest penetration of the wire's surface into a wall",
        ),
    }


def _energy(result: Result) -> dict[str, Metric]:
    error, _ = _peak(np.abs(result.values("energy_error")), result.time)
    work, _ = _peak(np.abs(result.values("insertion_work") + result.values("load_work")), result.time)
    released = [snap.released_energy for snap in result.snaps]
    unit = QUANTITIES["energy_error"].unit
    return {
        "insertion_work": _final(result, "insertion_work"),
        "friction_loss": _final(result, "friction_loss"),
        "energy_error_max": Metric(error, unit, "largest magnitude of what the energy balance leaves over"),
        "energy_error_relative": Metric(
            error / work if work >= LEAST_WORK else float("nan"),
            "1",
            f"the same over the largest work; none where that is below {LEAST_WORK:g} J",
        ),
        "snaps": Metric(float(len(released)), "1", "number of snap-through events"),
        "snap_energy_max": Metric(max(released, default=0.0), unit, "largest energy released by a snap-through"),
    }


def _solution(result: Result) -> dict[str, Metric]:
    steps, iterations = result.values("solver_steps")[-1], result.values("newton_iterations")[-1]
    per_step = float(iterations / steps) if steps > 0 else float("nan")
    return {
        "duration": Metric(float(result.time[-1]), QUANTITIES["time"].unit, "time that the run reached"),
        "solver_steps": _final(result, "solver_steps"),
        "newton_iterations_per_step": Metric(per_step, "1", "Newton iterations per solver step"),
        "smallest_step": _final(result, "smallest_step"),
    }


def _final(result: Result, name: str) -> Metric:
    return Metric(float(result.values(name)[-1]), QUANTITIES[name].unit, f"{QUANTITIES[name].long_name}; at the end")


def _largest(result: Result, name: str, meaning: str) -> Metric:
    return Metric(_peak(result.values(name), result.time)[0], QUANTITIES[name].unit, meaning)


def _with_time(
    result: Result, name: str, peak: str, values: Floats, unit: str, meaning: str, remark: str = ""
) -> dict[str, Metric]:
    """The largest value and its time: `peak` of the result's peaks where it has that, else the largest of `values`."""
    (value, instant), where = _peak(values, result.time), "at the outputs"
    kept = result.peaks.get(peak)
    if kept is not None and math.isfinite(kept[0]):
        (value, instant), where = kept, "over all steps"
    return {
        name: Metric(value, unit, f"{meaning}, {where}{remark}"),
        f"{name}_time": Metric(instant, QUANTITIES["time"].unit, f"time of the {meaning}, {where}"),
    }


def _peak(values: Floats, time: Floats) -> tuple[float, float]:
    """Largest finite value and its time; NaN for both where no value is finite (a run that broke at its start)."""
    finite = np.isfinite(values)
    if not finite.any():
        return float("nan"), float("nan")
    instant = int(np.argmax(np.where(finite, values, -np.inf)))
    return float(values[instant]), float(time[instant])
