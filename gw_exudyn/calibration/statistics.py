"""What a fit knows of its parameters: intervals, correlations, singular values, and the limits of all of these.

Linear theory at the best point: covariance s^2 (J^T J)^-1 with s^2 = chi^2 / degrees of freedom from the residuals
themselves, half widths by Student's t (Seber and Wild, Nonlinear Regression, 1989, sections 2.1.2 and 5.1). It takes
residuals for independent of each other; `autocorrelation` says how far they are from it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from gw_exudyn.calibration.observations import Channel
from gw_exudyn.result import Floats

CONFIDENCE = 0.95

WIDE = 0.5
"""Width of an interval, relative to the parameter's range, from which the parameter is not identified."""

CORRELATED = 0.98
AT_BOUND = 1e-3
"""Distance to a bound, relative to the range, below which a parameter lies at it."""

FOLLOWING = 0.3
"""Autocorrelation of neighbouring residuals from which it is told."""

_SMALLEST = 1e-9
"""Singular values below this, relative to the largest (or to 1, a change of one noise over the range), count as this:
a direction without effect gives wide intervals, not a division by zero."""


@dataclass(frozen=True, eq=False)
class Statistics:
    """All relative to the parameters' ranges.

    degrees : of freedom. chi_square, reduced : sum of squares, and by degree of freedom. factor : Student's t.
    covariance : (p, p). roughness : (p,) the part of the standard errors that simulations have, not the data.
    half_widths : (p,) of the 95 % intervals. correlation : (p, p). singular_values : (p,) of the
    Jacobian, largest first. directions : (p, p), a row each singular value.
    """

    degrees: int
    chi_square: float
    reduced: float
    factor: float
    covariance: Floats
    roughness: Floats
    half_widths: Floats
    correlation: Floats
    singular_values: Floats
    directions: Floats

    @property
    def standard_errors(self) -> Floats:
        """(p,) Of the parameters, relative."""
        errors: Floats = np.sqrt(np.diag(self.covariance))
        return errors


def statistics(residuals: Floats, jacobian: Floats, bends: Floats, taken: int = 0) -> Statistics:
    """The statistics of a fit. residuals : (k,) in units of the noise. jacobian, bends : (k, p), as in `Fit`. taken :
    unknowns besides the parameters. k is more than all unknowns.

    The covariance is that of linear theory, and added to it what a simulation's departure from a straight line within
    the step of the differences would move the best point by: next to contact events that can be more than the noise.
    """
    from scipy.stats import t

    degrees = len(residuals) - jacobian.shape[1] - taken
    chi_square = float(residuals @ residuals)
    reduced = chi_square / degrees
    _, values, directions = np.linalg.svd(jacobian, full_matrices=False)
    shape = inverse(values, directions)
    moved = shape @ jacobian.T @ bends
    covariance = reduced * shape + moved @ moved.T
    spread = np.sqrt(np.diag(shape))
    factor = float(t.ppf(0.5 + CONFIDENCE / 2, degrees))
    return Statistics(
        degrees=degrees,
        chi_square=chi_square,
        reduced=reduced,
        factor=factor,
        covariance=covariance,
        roughness=np.sqrt(np.sum(moved**2, axis=1)),
        half_widths=factor * np.sqrt(np.diag(covariance)),
        correlation=shape / np.outer(spread, spread),
        singular_values=values,
        directions=directions,
    )


def inverse(values: Floats, directions: Floats) -> Floats:
    """(p, p) The inverse of J^T J from the singular values of J, where those that vanish count as small."""
    floor = _SMALLEST * max(float(values[0]), 1.0)
    found: Floats = (directions.T / np.maximum(values, floor) ** 2) @ directions
    return found


def autocorrelation(channel: Channel) -> float:
    """Correlation of residuals that follow each other, less their mean; 0 for fewer than three."""
    apart = channel.residuals - channel.residuals.mean()
    power = float(apart @ apart)
    return float(apart[1:] @ apart[:-1]) / power if len(apart) > 2 and power > 0 else 0.0


def widening(channels: Iterable[Channel]) -> float:
    """By what factor intervals are too narrow, roughly, because residuals follow each other: the square root of
    (1 + r) / (1 - r) for a first-order process with the largest autocorrelation r of the channels.
    """
    largest = max((autocorrelation(channel) for channel in channels), default=0.0)
    return math.sqrt((1 + largest) / (1 - largest)) if 0 < largest < 1 else 1.0


@dataclass(frozen=True)
class Doubt:
    """Why a parameter is not identified. reason : `wide`, `bound` or `correlated`. partners : numbers of the parameters
    that can stand in for it, with the correlation. side : `low` or `high` for a bound.
    """

    reason: str
    partners: tuple[tuple[int, float], ...] = ()
    side: str = ""


def doubts(point: Floats, found: Statistics) -> list[list[Doubt]]:
    """For each parameter why it is not identified; nothing where it is."""
    told: list[list[Doubt]] = []
    for i in range(len(point)):
        mine = []
        if not 2 * found.half_widths[i] <= WIDE:
            mine.append(Doubt("wide"))
        if point[i] <= AT_BOUND or point[i] >= 1 - AT_BOUND:
            mine.append(Doubt("bound", side="low" if point[i] <= AT_BOUND else "high"))
        partners = tuple(
            (j, float(found.correlation[i, j]))
            for j in range(len(point))
            if j != i and abs(found.correlation[i, j]) > CORRELATED
        )
        if partners:
            mine.append(Doubt("correlated", partners))
        told.append(mine)
    return told
