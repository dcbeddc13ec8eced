"""What the fit makes small: residuals that simulations give, and their derivatives.

Parameters are relative to their ranges, 0 at the low end and 1 at the high end. Simulations are smooth only from one
contact event to the next, so derivatives are central differences over a step that such events do not decide on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from gw_exudyn.calibration.form import Calibration
from gw_exudyn.calibration.observations import Observations
from gw_exudyn.calibration.simulations import Simulated, Simulations
from gw_exudyn.comparison import Course
from gw_exudyn.errors import ComparisonError, Problem, ScenarioError, SolverError
from gw_exudyn.result import Floats

STEP = 0.01
"""To each side for a central difference, relative to the parameter's range."""

HALVINGS = 3
"""How often the step is halved where no simulation next to a point works out."""


@dataclass(frozen=True, eq=False)
class Step:
    """A point that was tried. point : (parameters,) relative. chi_square : sum of the squared residuals, NaN where
    the simulation failed. reason : why it failed.
    """

    point: Floats
    chi_square: float
    reason: str


@dataclass(frozen=True, eq=False)
class Best:
    """The best point of some, its residuals (k,) in units of the noise, and its simulation."""

    point: Floats
    chi_square: float
    residuals: Floats
    course: Course


@dataclass(frozen=True, eq=False)
class Derivatives:
    """What was found beside a point.

    jacobian : (k, p) residuals by relative parameters. bends : (k, p) residuals on the straight line between both
    sides, at the point, less those at it: how far a simulation is from the line that its derivative stands for; 0
    where a side lacks. sides : per parameter the courses below and above, and how far these are apart, relative.
    """

    point: Floats
    jacobian: Floats
    bends: Floats
    sides: list[tuple[Course, Course, float]]


@dataclass(frozen=True, eq=False)
class _Sides:
    """Simulations below and above a point along a parameter. apart : how far, relative. share : where between them the
    point lies, 0 below, 1 above; at a bound, and beside a failure, it is one of the two.
    """

    below: Simulated
    above: Simulated
    apart: float
    share: float


class StuckError(Exception):
    """No derivative can be had where the fit stands."""


class Objective:
    """Residuals of a calibration and their derivatives, from simulations, as scipy asks for them.

    observations : what is compared, once `begin` was called. count : of residuals. steps : all points that were tried.
    best : of those since it was last set to None.
    """

    def __init__(self, calibration: Calibration, simulate: Simulations, look: Callable[[Step], None]) -> None:
        self._calibration, self._simulate, self._look = calibration, simulate, look
        self.observations: Observations
        self.count = 0
        self.steps: list[Step] = []
        self.best: Best | None = None
        self._derivatives: Derivatives | None = None

    def begin(self) -> Floats:
        """The start, once its simulation says until when there is something to compare."""
        start = self._calibration.start()
        (one,) = self._simulate(self._calibration, [start])
        if one.course is None:
            raise SolverError(f"the simulation at the start values failed: {one.reason}; take others")
        until = max(float(course.time[-1]) for course in self._calibration.measured)
        end = float(one.course.time[-1])
        if not one.completed and end < until:
            raise SolverError(
                f"the simulation at the start values ends at {end:g} s, before what was measured ({until:g} s): "
                f"{one.reason}; take other start values, or cut the measured files"
            )
        given = self._calibration
        try:
            self.observations = Observations(given.measured, given.noise, given.align, end)
            self.count, free = len(self.observations.residuals(one.course)), len(start) + self.observations.taken
            if self.count <= free:
                raise ComparisonError(f"{self.count} measured values are too few for {free} unknowns")
        except ComparisonError as error:
            raise ScenarioError(Problem("measured", str(error), str(given.file))) from None
        return start

    def residuals(self, point: Floats) -> Floats:
        """(k,) Residuals at a point; NaN where its simulation failed, which makes scipy refuse the step."""
        return self.tried([point])[0]

    def failure(self, point: Floats) -> str:
        """Why a point gives no residuals; empty where it does. It does not count as tried."""
        (one,) = self._simulate(self._calibration, [point])
        return "" if np.isfinite(self._of(one)).all() else one.reason

    def tried(self, points: Sequence[Floats]) -> list[Floats]:
        """The residuals at several points, simulated in parallel; each counts as a step."""
        found = []
        for point, one in zip(points, self._simulate(self._calibration, points), strict=True):
            residuals = self._of(one)
            chi_square = float(residuals @ residuals)
            good = bool(np.isfinite(chi_square)) and one.course is not None
            if good and one.course is not None and (self.best is None or chi_square < self.best.chi_square):
                self.best = Best(point.copy(), chi_square, residuals, one.course)
            self.steps.append(Step(point.copy(), chi_square, "" if good else one.reason))
            self._look(self.steps[-1])
            found.append(residuals)
        return found

    def _of(self, one: Simulated) -> Floats:
        return np.full(self.count, np.nan) if one.course is None else self.observations.residuals(one.course)

    def jacobian(self, point: Floats) -> Floats:
        """(k, p) Derivatives of the residuals."""
        return self._derive(point).jacobian

    def _derive(self, point: Floats) -> Derivatives:
        """By central differences; one-sided at a bound and beside a failure."""
        count = len(point)
        sides: list[_Sides | None] = [None] * count
        step = STEP
        for _ in range(HALVINGS + 1):
            for i, side in self._beside(point, [i for i in range(count) if sides[i] is None], step):
                sides[i] = side
            step /= 2
        lacking = [self._calibration.parameters[i].path for i in range(count) if sides[i] is None]
        if lacking:
            raise StuckError(f"no simulation beside the best point works out for {', '.join(lacking)}")
        known = [side for side in sides if side is not None]
        columns = [(self._of(one.above) - self._of(one.below)) / one.apart for one in known]
        courses = [(one.below.course, one.above.course, one.apart) for one in known]
        pairs = [(low, high, apart) for low, high, apart in courses if low is not None and high is not None]
        (here,) = self._simulate(self._calibration, [point])
        bends = [
            (1 - one.share) * self._of(one.below) + one.share * self._of(one.above) - self._of(here) for one in known
        ]
        self._derivatives = Derivatives(point.copy(), np.column_stack(columns), np.column_stack(bends), pairs)
        return self._derivatives

    def _beside(self, point: Floats, wanted: list[int], step: float) -> list[tuple[int, _Sides]]:
        """The simulations on both sides of a point, for those of the wanted parameters where they work out."""
        ends = [(max(point[i] - step, 0.0), min(point[i] + step, 1.0)) for i in wanted]
        moved = [_moved(point, i, end) for i, pair in zip(wanted, ends, strict=True) for end in pair]
        if not moved:
            return []
        here, *done = self._simulate(self._calibration, [point, *moved])
        found = []
        for number, (i, (low, high)) in enumerate(zip(wanted, ends, strict=True)):
            below, above = done[2 * number : 2 * number + 2]
            if not self._good(below):
                below, low = here, float(point[i])
            if not self._good(above):
                above, high = here, float(point[i])
            if high > low:
                found.append((i, _Sides(below, above, high - low, (float(point[i]) - low) / (high - low))))
        return found

    def _good(self, one: Simulated) -> bool:
        return one.course is not None and self.observations.covers(one.course)

    def derivatives(self, point: Floats) -> Derivatives:
        """What is known beside a point, or beside the last where no simulation works out there. Raises StuckError where
        that is nothing."""
        known = self._derivatives
        if known is not None and np.array_equal(known.point, point):
            return known
        try:
            return self._derive(point)
        except StuckError:
            if known is None:
                raise
            return known


def _moved(point: Floats, i: int, to: float) -> Floats:
    moved = point.copy()
    moved[i] = to
    return moved
