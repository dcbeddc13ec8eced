"""The least-squares fit: scipy's trust-region reflective method on residuals that simulations give.

Parameters are relative to their ranges, 0 at the low end and 1 at the high end. Simulations are smooth only from one
contact event to the next, so derivatives are central differences over a step that such events do not decide on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

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

MOST_STEPS = 40
"""Points that the fit may try, those for derivatives apart."""

_ENOUGH = 0.01
"""Change of chi square, by degree of freedom's own, below which the fit has come to its end: a tenth of a standard
error, as one standard error changes it by 1."""

_STEP_TOLERANCE = 1e-4
"""The same of the relative parameters."""


@dataclass(frozen=True, eq=False)
class Step:
    """A point that was tried. point : (parameters,) relative. chi_square : sum of the squared residuals, NaN where
    the simulation failed. reason : why it failed.
    """

    point: Floats
    chi_square: float
    reason: str


@dataclass(eq=False)
class Fit:
    """How the fit ended.

    point : (p,) relative. residuals : (k,) in units of the noise. jacobian : (k, p) residuals by relative parameters.
    bends : (k, p) mean of the residuals on both sides of the point less those at it: how far a simulation is from the
    straight line that its derivative stands for; 0 where a side lacks. course : the fitted simulation. sides : per
    parameter the courses below and above, and how far these are apart, relative. converged, message : how it ended.
    steps : all points that were tried.
    """

    point: Floats
    residuals: Floats
    jacobian: Floats
    bends: Floats
    course: Course
    sides: list[tuple[Course, Course, float]]
    converged: bool
    message: str
    steps: list[Step] = field(default_factory=list)


@dataclass(frozen=True, eq=False)
class _Derivatives:
    """What was found at a point; as in `Fit`."""

    point: Floats
    jacobian: Floats
    bends: Floats
    sides: list[tuple[Course, Course, float]]


class _StuckError(Exception):
    """No derivative can be had where the fit stands."""


def fitted(
    calibration: Calibration, simulate: Simulations, look: Callable[[Step], None] = lambda _: None
) -> tuple[Fit, Observations]:
    """Fit, and what it was fitted to. look : called with every point that was tried.

    Raises SolverError where the start values give no simulation, ScenarioError where measured and simulated have no
    time in common, and what `simulate` raises.
    """
    from scipy.optimize import least_squares

    work = _Work(calibration, simulate, look)
    start = work.begin()
    try:
        found = least_squares(
            work.residuals,
            start,
            jac=work.jacobian,
            bounds=(0.0, 1.0),
            method="trf",
            ftol=_ENOUGH / work.count,
            xtol=_STEP_TOLERANCE,
            gtol=1e-8,
            max_nfev=MOST_STEPS,
        )
    except _StuckError as stuck:
        return work.fit(False, str(stuck)), work.observations
    words = {
        0: f"no end within {MOST_STEPS} steps",
        1: "the gradient vanishes",
        2: "the sum of squares no longer changes",
        3: "the parameters no longer change",
        4: "neither the sum of squares nor the parameters change any longer",
    }
    return work.fit(found.status > 0, words.get(found.status, str(found.message))), work.observations


class _Work:
    """What scipy calls: residuals and their derivatives, and the best point so far."""

    def __init__(self, calibration: Calibration, simulate: Simulations, look: Callable[[Step], None]) -> None:
        self._calibration, self._simulate, self._look = calibration, simulate, look
        self.observations: Observations
        self.count = 0  # of residuals
        self._steps: list[Step] = []
        self._best: tuple[float, Floats, Floats, Course] | None = None
        self._derivatives: _Derivatives | None = None

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
        (one,) = self._simulate(self._calibration, [point])
        found = self._of(one)
        chi_square = float(found @ found)
        reason = "" if np.isfinite(chi_square) else one.reason
        if np.isfinite(chi_square) and one.course is not None and (self._best is None or chi_square < self._best[0]):
            self._best = chi_square, point.copy(), found, one.course
        self._steps.append(Step(point.copy(), chi_square, reason))
        self._look(self._steps[-1])
        return found

    def _of(self, one: Simulated) -> Floats:
        return np.full(self.count, np.nan) if one.course is None else self.observations.residuals(one.course)

    def jacobian(self, point: Floats) -> Floats:
        """(k, p) Derivatives of the residuals by central differences; one-sided at a bound and beside a failure."""
        count = len(point)
        sides: list[tuple[Simulated, Simulated, float] | None] = [None] * count
        step = STEP
        for _ in range(HALVINGS + 1):
            for i, side in self._tried(point, [i for i in range(count) if sides[i] is None], step):
                sides[i] = side
            step /= 2
        lacking = [self._calibration.parameters[i].path for i in range(count) if sides[i] is None]
        if lacking:
            raise _StuckError(f"no simulation beside the best point works out for {', '.join(lacking)}")
        known = [side for side in sides if side is not None]
        columns = [(self._of(high) - self._of(low)) / apart for low, high, apart in known]
        jacobian = np.column_stack(columns)
        courses = [(low.course, high.course, apart) for low, high, apart in known]
        pairs = [(low, high, apart) for low, high, apart in courses if low is not None and high is not None]
        (here,) = self._simulate(self._calibration, [point])
        bends = [
            (self._of(high) + self._of(low)) / 2 - self._of(here) if here not in (low, high) else np.zeros(self.count)
            for low, high, _ in known
        ]
        self._derivatives = _Derivatives(point.copy(), jacobian, np.column_stack(bends), pairs)
        return jacobian

    def _tried(
        self, point: Floats, wanted: list[int], step: float
    ) -> list[tuple[int, tuple[Simulated, Simulated, float]]]:
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
                found.append((i, (below, above, high - low)))
        return found

    def _good(self, one: Simulated) -> bool:
        return one.course is not None and self.observations.covers(one.course)

    def fit(self, converged: bool, message: str) -> Fit:
        """The best point, with what is known there. Raises SolverError where there is no derivative at all."""
        if self._best is None:
            raise SolverError("no simulation worked out")
        _, point, residuals, course = self._best
        if self._derivatives is None or not np.array_equal(self._derivatives.point, point):
            try:
                self.jacobian(point)
            except _StuckError as stuck:
                if self._derivatives is None:
                    raise SolverError(f"{stuck}, so the fit cannot begin; take other start values") from None
        known = self._derivatives
        if known is None:
            raise SolverError("no derivative can be had")
        return Fit(point, residuals, known.jacobian, known.bends, course, known.sides, converged, message, self._steps)


def _moved(point: Floats, i: int, to: float) -> Floats:
    moved = point.copy()
    moved[i] = to
    return moved
