"""Peaks of a force, and which of the phantom's corners the wire's tip was at."""

from __future__ import annotations

import numpy as np
from shared import Floats

from gw_exudyn import Result

PROMINENCE = 0.1
"""A peak rises above its surroundings by this share of the largest force."""

NEAR = 8e-3
"""m. The tip is at a corner while it is no farther than the widest lumen from where the centre lines meet."""

CORNERS = {"left": "first", "target": "second"}
"""The phantom's corners on the wire's way, by the branch that begins there."""


def peaks(result: Result, force: Floats) -> list[tuple[int, str]]:
    """Every peak of the magnitude of `force` (at the run's outputs): output instant (an index), corner of the tip.

    A force that is still rising at the end of the run counts as a peak there.
    """
    from scipy.signal import find_peaks

    size = np.abs(force)
    if not size.any():
        return []
    found, _ = find_peaks(np.concatenate([[0.0], size, [0.0]]), prominence=PROMINENCE * size.max())
    return [(int(i), corner_at(result, int(i))) for i in found - 1]


def corner_at(result: Result, instant: int) -> str:
    """The corner that the tip is at: first, second, or none."""
    tip = np.array([result.values("tip_x")[instant], result.values("tip_y")[instant]])
    lines = {name: region.centre_line for name, region in result.scenario.vessel.regions().items()}
    for branch, corner in CORNERS.items():
        line = lines[branch]
        if line is not None and np.hypot(*(tip - line[0])) <= NEAR:
            return corner
    return "none"
