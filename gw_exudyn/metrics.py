"""Single numbers that sum up a run, each with its unit and meaning."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.quantities import CONTACT_OWNERS, QUANTITIES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from gw_exudyn.result import Floats, Result

VESSEL = next(value for value, word in CONTACT_OWNERS if word == "vessel")

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
    return {
        **_tip(result),
        **_guidance(result),
        **_forces(result),
        **_contact(result),
        **_energy(result),
        **_solution(result),
    }


def _tip(result: Result) -> dict[str, Metric]:
    found = {f"final_{name}": _final(result, name) for name in ("tip_x", "tip_y", "tip_angle", "insertion_depth")}
    found["insertion_depth_max"] = _largest(result, "insertion_depth", "deepest insertion, at the outputs")
    path = np.hypot(np.diff(result.values("tip_x")), np.diff(result.values("tip_y")))
    found["tip_path_length"] = Metric(
        float(np.nansum(path)), QUANTITIES["tip_x"].unit, "length of the path of the tip, there and back"
    )
    return found


BLOCKED = 0.05
"""The tip counts as blocked where it moves less than this share of what the wire is pushed in."""


def _guidance(result: Result) -> dict[str, Metric]:
    """How the tip follows the hand: over the time in which the wire is pushed in, from output to output."""
    pushed = np.diff(result.values("insertion_depth"))
    step = np.column_stack([np.diff(result.values("tip_x")), np.diff(result.values("tip_y"))])
    angle = result.values("tip_angle")
    heading = (angle[:-1] + angle[1:]) / 2
    ahead = step[:, 0] * np.cos(heading) + step[:, 1] * np.sin(heading)
    moved = np.hypot(*step.T)
    inwards = pushed > 0
    length = QUANTITIES["tip_x"].unit
    pushed_in = float(np.nansum(pushed[inwards]))
    retreat = _largest_fall(np.nancumsum(np.where(inwards, ahead, 0.0)))
    diameter = result.scenario.wire.diameter
    return {
        "trackability": Metric(
            float(np.nansum(moved[inwards])) / pushed_in if pushed_in > 0 else float("nan"),
            "1",
            "path of the tip over the length pushed in, while pushing; none where nothing was pushed",
        ),
        "tip_retreat_max": Metric(
            retreat, length, "furthest that the tip went back along its own direction while the wire was pushed in"
        ),
        "prolapse": Metric(
            float(retreat > diameter), "1", "1 where the tip went back by more than the wire's diameter while pushed"
        ),
        "pushability": Metric(
            _pushability(result, inwards & (moved < BLOCKED * np.where(inwards, pushed, 0.0))),
            "1",
            f"rise of the tip force over rise of the push force while the tip is blocked (it moves less than "
            f"{BLOCKED:g} of what is pushed in); none where it never is",
        ),
    }


def _largest_fall(progress: Floats) -> float:
    """Largest fall of a curve from what it had reached before; 0 for one that never falls."""
    reached = np.maximum.accumulate(np.concatenate([[0.0], progress]))
    return float(np.max(reached[1:] - progress, initial=0.0))


def _pushability(result: Result, blocked: NDArray[np.bool_]) -> float:
    """Slope of tip force over push force by least squares over the outputs between which the tip is blocked."""
    there = np.concatenate([blocked, [False]]) | np.concatenate([[False], blocked])
    push, tip = result.values("push_force")[there], result.values("tip_force")[there]
    finite = np.isfinite(push) & np.isfinite(tip)
    push, tip = push[finite] - push[finite].mean() if finite.any() else push[finite], tip[finite]
    spread = float(push @ push)
    return float(push @ tip / spread) if len(push) > 2 and spread > 0 else float("nan")


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
    return found | _place_of_largest_force(result)


def _place_of_largest_force(result: Result) -> dict[str, Metric]:
    """Where the vessel was pressed hardest, at the output that shows it (of a peak between two, the nearest)."""
    force = np.hypot(result.values("contact_normal_force"), result.values("contact_tangential_force"))
    of_vessel = result.values("contact_owner") == VESSEL
    force = np.where(of_vessel & np.isfinite(force), force, -np.inf)
    instant, contact = np.unravel_index(int(np.argmax(force)), force.shape)
    touched = np.isfinite(force[instant, contact])
    places = {"x": "contact_x", "y": "contact_y", "arc_length": "contact_arc_length"}
    return {
        f"wall_force_max_{name}": Metric(
            float(result.values(field)[instant, contact]) if touched else float("nan"),
            QUANTITIES[field].unit,
            f"{QUANTITIES[field].long_name}, of the largest force of a single contact, at the outputs",
        )
        for name, field in places.items()
    }


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
