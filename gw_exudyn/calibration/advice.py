"""What measurement would help a parameter that cannot be identified: worked out from the simulations of the fit.

Each of these holds all quantities, measured or not. So it is known how much each would change with the parameters, and
with it how narrow the interval would be, were it measured as well.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from gw_exudyn.calibration.fit import Fit
from gw_exudyn.calibration.form import TIP
from gw_exudyn.calibration.observations import Observations
from gw_exudyn.calibration.statistics import CORRELATED, WIDE, Statistics, inverse
from gw_exudyn.comparison import COMPARED, PATH, at
from gw_exudyn.quantities import QUANTITIES
from gw_exudyn.result import Floats

PRECISION = 0.01
"""Noise of a measurement that is thought of, relative to how far the quantity varies in the run; where something of
the same unit is measured, its noise is taken instead."""

_CANDIDATES = (TIP, *(name for name in COMPARED if name != "insertion_depth"))


@dataclass(frozen=True)
class Advice:
    """A measurement that would help. quantity : `tip` for its path. noise : SI, taken for it. half_width : relative, of
    the parameter's interval with it.
    """

    quantity: str
    noise: float
    half_width: float


def advice(fit: Fit, observations: Observations, found: Statistics, noise: Mapping[str, float]) -> list[Advice | None]:
    """For each parameter the quantity, not measured so far, that would narrow its interval most, if that is enough to
    identify it; else None. noise : SI, of what is measured.
    """
    count = len(fit.point)
    best: list[Advice | None] = [None] * count
    if len(fit.sides) < count:
        return best
    scale = max(found.reduced, 1e-300)
    known = fit.jacobian / np.sqrt(scale)
    for quantity in _CANDIDATES:
        names = PATH if quantity == TIP else (quantity,)
        if observations.quantities() & set(names):
            continue
        thought = _noise(fit, observations.times(), names, noise)
        if not thought > 0:
            continue
        jacobian = _derivatives(fit, observations.times(), names) / thought
        _, values, directions = np.linalg.svd(np.vstack([known, jacobian]), full_matrices=False)
        covariance = inverse(values, directions)
        errors = np.sqrt(np.diag(covariance))
        correlation = np.abs(covariance / np.outer(errors, errors)) - np.eye(count)
        for i, half_width in enumerate(found.factor * errors):
            helps = 2 * half_width <= WIDE and not (correlation[i] > CORRELATED).any()
            before = best[i]
            if helps and (before is None or half_width < before.half_width):
                best[i] = Advice(quantity, thought, float(half_width))
    return best


def _noise(fit: Fit, times: Floats, names: tuple[str, ...], noise: Mapping[str, float]) -> float:
    """The noise, SI, with which quantities might be measured."""
    unit = QUANTITIES[names[0]].unit
    for name, value in noise.items():
        if QUANTITIES[PATH[0] if name == TIP else name].unit == unit:
            return value
    return PRECISION * max(float(np.ptp(at(fit.course, name, times))) for name in names)


def _derivatives(fit: Fit, times: Floats, names: tuple[str, ...]) -> Floats:
    """(k, p) Derivatives of quantities, SI, at the measured instants by the relative parameters."""
    columns = [
        np.concatenate([at(high, name, times) - at(low, name, times) for name in names]) / apart
        for low, high, apart in fit.sides
    ]
    return np.column_stack(columns)
