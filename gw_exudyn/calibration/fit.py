"""The least-squares fit: scipy's trust-region reflective method from one start or several, and a look round its end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from gw_exudyn.calibration.form import Calibration
from gw_exudyn.calibration.objective import Best, Objective, Step, StuckError
from gw_exudyn.calibration.observations import Observations
from gw_exudyn.calibration.probing import profiles
from gw_exudyn.calibration.simulations import Simulations
from gw_exudyn.calibration.statistics import statistics
from gw_exudyn.comparison import Course
from gw_exudyn.errors import SolverError
from gw_exudyn.result import Floats

MOST_STEPS = 40
"""Points that the fit may try from one start, those for derivatives apart."""

_ENOUGH = 0.01
"""Change of chi square, by degree of freedom's own, below which the fit has come to its end: a tenth of a standard
error, as one standard error changes it by 1."""

_STEP_TOLERANCE = 1e-4
"""The same of the relative parameters."""

_BETTER = 0.1
"""By how much chi square has to be lower beside the end for the fit to go on from there."""

_LOOKS = 5
"""How often a better point may be found so."""


@dataclass(frozen=True, eq=False)
class Descent:
    """A fit from one start. start : (p,) relative. best : None where the start gives no simulation. converged,
    message : how it ended.
    """

    start: Floats
    best: Best | None
    converged: bool
    message: str

    @property
    def chi_square(self) -> float:
        """At its end; infinite where there is none."""
        return np.inf if self.best is None else self.best.chi_square


@dataclass(eq=False)
class Fit:
    """How the fit ended.

    point : (p,) relative. residuals : (k,) in units of the noise. jacobian, bends, sides : as in `Derivatives`.
    course : the fitted simulation. converged, message : how it ended. descents : from each start, the best of which
    this is. steps : all points that were tried.
    """

    point: Floats
    residuals: Floats
    jacobian: Floats
    bends: Floats
    course: Course
    sides: list[tuple[Course, Course, float]]
    converged: bool
    message: str
    descents: list[Descent]
    steps: list[Step] = field(default_factory=list)


def fitted(
    calibration: Calibration, simulate: Simulations, look: Callable[[Step], None] = lambda _: None
) -> tuple[Fit, Observations]:
    """Fit, and what it was fitted to. look : called with every point that was tried.

    Raises SolverError where the start values give no simulation, ScenarioError where measured and simulated have no
    time in common, and what `simulate` raises.
    """
    work = Objective(calibration, simulate, look)
    first = work.begin()
    starts = [first, *spread(calibration.starts - 1, len(first))]
    simulate(calibration, starts)  # in parallel, before each descent asks for its own
    descents = [_descent(work, start) for start in starts]
    for _ in range(_LOOKS):
        best = min(descents, key=lambda one: one.chi_square)
        better = _better_beside(work, best) if best.converged else None
        if better is None:
            return _ended(work, best, descents), work.observations
        descents.append(_descent(work, better))
    best = min(descents, key=lambda one: one.chi_square)
    fit = _ended(work, best, descents)
    fit.converged, fit.message = False, f"a better point lay beside its end {_LOOKS} times: chi square is too rough"
    return fit, work.observations


def spread(count: int, dimensions: int) -> list[Floats]:
    """Relative points, evenly spread over all ranges (Sobol's sequence), the same at every call."""
    from scipy.stats.qmc import Sobol

    if count < 1:
        return []
    sequence = Sobol(dimensions, scramble=True, seed=0)
    return list(sequence.random_base2(max(1, (count - 1).bit_length()))[:count])


def _descent(work: Objective, start: Floats) -> Descent:
    """Least squares from a start."""
    from scipy.optimize import least_squares

    work.best = None
    failure = work.failure(start)
    if failure:
        return Descent(start, None, False, failure)
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
    except StuckError as stuck:
        return Descent(start, work.best, False, str(stuck))
    words = {
        0: f"no end within {MOST_STEPS} steps",
        1: "the gradient vanishes",
        2: "the sum of squares no longer changes",
        3: "the parameters no longer change",
        4: "neither the sum of squares nor the parameters change any longer",
    }
    return Descent(start, work.best, found.status > 0, words.get(found.status, str(found.message)))


def _better_beside(work: Objective, descent: Descent) -> Floats | None:
    """A better point on the profiles through the end of a descent, if there is one; all of them count as tried."""
    best = descent.best
    if best is None:
        return None
    try:
        known = work.derivatives(best.point)
    except StuckError:
        return None
    found = statistics(best.residuals, known.jacobian, known.bends, work.observations.taken)
    work.best = None
    work.tried(profiles(best.point, found))
    beside: Best | None = work.best
    return beside.point if beside is not None and beside.chi_square < best.chi_square - _BETTER else None


def _ended(work: Objective, descent: Descent, descents: list[Descent]) -> Fit:
    """The fit at the end of a descent. Raises SolverError where nothing is known there."""
    best = descent.best
    if best is None:
        raise SolverError("no simulation worked out")
    try:
        known = work.derivatives(best.point)
    except StuckError as stuck:
        raise SolverError(f"{stuck}, so the fit cannot begin; take other start values") from None
    return Fit(
        best.point,
        best.residuals,
        known.jacobian,
        known.bends,
        best.course,
        known.sides,
        descent.converged,
        descent.message,
        descents,
        work.steps,
    )
