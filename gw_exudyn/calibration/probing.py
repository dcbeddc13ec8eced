"""A look round the end of a fit: whether there are better points, and whether others are as good, further away than
linear theory has it.

Where contact comes and goes between neighbouring points, chi square is no parabola. So it is simulated along each
parameter's profile, the line on which linear theory has the others follow it, out to some half widths of its interval.
Points where chi square is above its minimum by less than the square of Student's factor belong to the interval (profile
likelihood; Seber and Wild, Nonlinear Regression, 1989, section 5.9.3): it is widened to hold them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from gw_exudyn.calibration.objective import Step
from gw_exudyn.calibration.statistics import Statistics
from gw_exudyn.result import Floats

_OUT_TO = (0.5, 1.0, 1.5, 2.0, 3.0)
"""Where a profile is simulated, in half widths."""


def profiles(point: Floats, found: Statistics) -> list[Floats]:
    """Points, each (p,) relative, along the profiles of all parameters, both ways and inside the limits."""
    points = []
    for i in range(len(point)):
        along = found.covariance[:, i] / found.covariance[i, i] * found.half_widths[i]
        for way in (along, -along):
            room = _room(point, way)
            points += [point + share * way for share in _OUT_TO if share < room]
            if 0 < room <= _OUT_TO[-1]:
                points.append(np.clip(point + room * way, 0.0, 1.0))
    return points


def widened(found: Statistics, point: Floats, steps: Iterable[Step]) -> Statistics:
    """The statistics with intervals that hold every point that was tried and is as good as those of the interval."""
    limit = found.chi_square + found.factor**2 * found.reduced
    reach = [np.abs(step.point - point) for step in steps if step.chi_square <= limit]
    return replace(found, half_widths=np.max([found.half_widths, *reach], axis=0))


def _room(point: Floats, way: Floats) -> float:
    """How far one can go a way within the limits, in lengths of it."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.where(way > 0, (1 - point) / way, np.where(way < 0, -point / way, np.inf))
    return float(ends.min())
