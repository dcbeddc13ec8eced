"""A finished fit in SI and in words: what fit.json, the table and the figures are made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gw_exudyn.calibration.advice import Advice, advice
from gw_exudyn.calibration.fit import Fit
from gw_exudyn.calibration.form import TIP, Calibration, Parameter
from gw_exudyn.calibration.observations import Channel, Observations
from gw_exudyn.calibration.probing import widened
from gw_exudyn.calibration.statistics import (
    FOLLOWING,
    Doubt,
    Statistics,
    autocorrelation,
    doubts,
    statistics,
    widening,
)
from gw_exudyn.comparison import PATH
from gw_exudyn.quantities import display

_MISFIT = 2.0
"""Reduced chi square from which, and below whose inverse, the stated noise is told not to fit."""


_WIDER = 1.05
"""Factor from which it is told that an interval is wider than linear theory has it."""

_ELSEWHERE = 1.0
"""Distance in standard errors from which the ends of two starts are different places."""


@dataclass(frozen=True)
class Estimate:
    """A fitted parameter, in SI. roughness : the part of the standard error that the simulations have. half_width : of
    the 95 % interval. doubts : sentences; none where it is identified.
    """

    parameter: Parameter
    value: float
    standard_error: float
    roughness: float
    half_width: float
    doubts: tuple[str, ...]

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % interval; it may reach beyond the limits of the fit."""
        return self.value - self.half_width, self.value + self.half_width


@dataclass(frozen=True, eq=False)
class Report:
    """A fit, what is known of it, and what a person has to be told."""

    calibration: Calibration
    fit: Fit
    observations: Observations
    channels: tuple[Channel, ...]
    statistics: Statistics
    estimates: tuple[Estimate, ...]
    notes: tuple[str, ...]


def report_of(calibration: Calibration, fit: Fit, observations: Observations) -> Report:
    """Everything that follows from a fit."""
    channels = tuple(observations.channels(fit.course))
    linear = statistics(fit.residuals, fit.jacobian, fit.bends, observations.taken)
    found = widened(linear, fit.point, fit.steps)
    help_by = advice(fit, observations, found, calibration.noise)
    values = calibration.values(fit.point)
    estimates = []
    for i, (parameter, reasons) in enumerate(zip(calibration.parameters, doubts(fit.point, found), strict=True)):
        estimates.append(
            Estimate(
                parameter,
                values[i],
                float(found.standard_errors[i]) * parameter.range,
                float(found.roughness[i]) * parameter.range,
                float(found.half_widths[i]) * parameter.range,
                tuple(_sentences(parameter, reasons, help_by[i], calibration.parameters)),
            )
        )
    notes = (
        *_notes(fit, observations, channels, found),
        *_widened(calibration, linear, found),
        *_other_minima(calibration, fit, found),
    )
    return Report(calibration, fit, observations, channels, found, tuple(estimates), notes)


def _sentences(
    parameter: Parameter, reasons: Sequence[Doubt], helps: Advice | None, parameters: Sequence[Parameter]
) -> list[str]:
    told = []
    for doubt in reasons:
        if doubt.reason == "wide":
            told.append("its interval is wider than half its range")
        elif doubt.reason == "bound":
            end = parameter.low if doubt.side == "low" else parameter.high
            told.append(f"it lies at its {doubt.side} end, {parameter.text(end)}: widen the range")
        else:
            names = ", ".join(f"{parameters[j].path} ({value:+.3f})" for j, value in doubt.partners)
            told.append(f"it is correlated with {names}, which can stand in for it")
    if {doubt.reason for doubt in reasons} - {"bound"}:
        told.append(_help(parameter, helps))
    return told


def _help(parameter: Parameter, helps: Advice | None) -> str:
    if helps is None:
        return (
            "no further quantity of this run would settle it: use a scene that depends on it more (another vessel, a "
            "longer way, contact), or set it"
        )
    name, words = (PATH[0], "the tip's path") if helps.quantity == TIP else (helps.quantity, helps.quantity)
    width = parameter.text(helps.half_width * parameter.range, 2)
    return f"{words} measured as well, with a noise of {display(name, helps.noise)}, would bring it to +- {width}"


def _notes(fit: Fit, observations: Observations, channels: Sequence[Channel], found: Statistics) -> list[str]:
    notes = []
    if not fit.converged:
        notes.append(f"the fit did not converge ({fit.message}); its values are the best so far, not an estimate")
    scale = f"{found.reduced**0.5:.2g}"
    if found.reduced > _MISFIT:
        notes.append(
            f"the residuals are {scale} times the stated noise: the model does not fit, or the noise is larger than "
            "stated; the intervals are scaled by it, and say nothing of an error of the model"
        )
    elif found.reduced < 1 / _MISFIT:
        notes.append(
            f"the residuals are {scale} of the stated noise, which is overstated; the intervals are scaled by it"
        )
    if (found.roughness > found.standard_errors / 2).any():
        notes.append(
            "simulations jump between neighbouring points by what counts beside the noise, which the intervals hold; a "
            "smaller solver.step makes them smoother"
        )
    worst = max(channels, key=autocorrelation)
    following = autocorrelation(worst)
    if following > FOLLOWING:
        notes.append(
            f"residuals of {worst.quantity} in {worst.file} follow each other (autocorrelation {following:.2f}): the "
            f"intervals, which take them for independent, may be too narrow {widening(channels):.1f} times or so"
        )
    if observations.left_out:
        notes.append(f"{observations.left_out} measured rows lie outside the simulated time and were left out")
    return notes


def _widened(calibration: Calibration, linear: Statistics, found: Statistics) -> list[str]:
    wider = [
        one.path
        for one, before, now in zip(calibration.parameters, linear.half_widths, found.half_widths, strict=True)
        if now > _WIDER * before
    ]
    if not wider:
        return []
    return [
        f"chi square is no parabola round its end: the interval of {' and of '.join(wider)} is wider than linear "
        "theory has it, to hold all points that fit as well"
    ]


def _other_minima(calibration: Calibration, fit: Fit, found: Statistics) -> list[str]:
    """Ends of other starts that fit as well as the best and lie elsewhere."""
    told: list[str] = []
    for descent in fit.descents:
        best = descent.best
        if best is None or best.chi_square > found.chi_square + found.factor**2 * found.reduced:
            continue
        if (np.abs(best.point - fit.point) > _ELSEWHERE * found.standard_errors).any():
            values = zip(calibration.parameters, calibration.values(best.point), strict=True)
            place = ", ".join(f"{one.path} {one.text(value)}" for one, value in values)
            told.append(f"another start ended at {place} with chi square {best.chi_square:.6g}, which is as good")
    return told
