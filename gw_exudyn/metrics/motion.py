"""Where the tip went, and how well it follows the hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.metrics.metric import Metric, final, largest
from gw_exudyn.quantities import QUANTITIES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from gw_exudyn.result import Floats, Result

BLOCKED = 0.05
"""The tip counts as blocked where it moves less than this share of what the wire is pushed in."""


def tip(result: Result) -> dict[str, Metric]:
    """Place and path of the tip."""
    found = {f"final_{name}": final(result, name) for name in ("tip_x", "tip_y", "tip_angle", "insertion_depth")}
    found["insertion_depth_max"] = largest(result, "insertion_depth", "deepest insertion, at the outputs")
    path = np.hypot(np.diff(result.values("tip_x")), np.diff(result.values("tip_y")))
    found["tip_path_length"] = Metric(
        float(np.nansum(path)), QUANTITIES["tip_x"].unit, "length of the path of the tip, there and back"
    )
    return found


def guidance(result: Result) -> dict[str, Metric]:
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
