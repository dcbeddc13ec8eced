"""The points of a study: which value each parameter has at each of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from gw_exudyn.result import Floats
from gw_exudyn.sweep.studies.axes import Axis

MOST_POINTS = 100_000
METHODS = ("latin-hypercube", "sobol", "sobol-indices", "morris")
"""How `mode: sample` draws: two that fill the space evenly, and two schemes of points that sensitivity indices need."""
FOR_INDICES = ("sobol-indices", "morris")

_MORRIS_LEVELS = 4
_MORRIS_CUT = 0.02
"""Probability that Morris' levels leave out at each end of a distribution without end."""


@dataclass(frozen=True)
class Design:
    """Points and their parameters.

    axes : the parameters. shape : of the points; one number each axis for a grid, else how many there are.
    rows : per axis value and coordinate of every point; None for a grid, where they follow from the axes.
    unit_cube : (k, axes) probabilities of sampled points, for sensitivity indices; None else.
    """

    axes: tuple[Axis, ...]
    shape: tuple[int, ...]
    rows: tuple[Sequence[tuple[Any, float | str]], ...] | None = None
    unit_cube: Floats | None = None

    @property
    def grid(self) -> bool:
        """Whether the points are all combinations of the axes' values."""
        return self.rows is None

    def __len__(self) -> int:
        """How many points there are."""
        return math.prod(self.shape)

    def indices(self, point: int) -> tuple[int, ...]:
        """Index on each axis of a grid's point."""
        return tuple(int(i) for i in np.unravel_index(point, self.shape))

    def values(self, point: int) -> dict[str, Any]:
        """What the point puts at each path of the scenario."""
        return {axis.path: value for axis, (value, _) in zip(self.axes, self._row(point), strict=True)}

    def labels(self, point: int) -> dict[str, float | str]:
        """The point's coordinates by path: SI numbers or words."""
        return {axis.path: label for axis, (_, label) in zip(self.axes, self._row(point), strict=True)}

    def _row(self, point: int) -> list[tuple[Any, float | str]]:
        if self.rows is not None:
            return [column[point] for column in self.rows]
        return [(axis.values[i], axis.labels[i]) for axis, i in zip(self.axes, self.indices(point), strict=True)]


def grid(axes: Sequence[Axis]) -> Design:
    """All combinations of the axes' values, the last axis fastest."""
    return Design(tuple(axes), tuple(len(axis.values) for axis in axes))


def zipped(axes: Sequence[Axis]) -> Design:
    """The first values of all axes, the second values, and so on; all axes have equally many."""
    rows = tuple(list(zip(axis.values, axis.labels, strict=True)) for axis in axes)
    return Design(tuple(axes), (len(axes[0].values),), rows)


def sampled(axes: Sequence[Axis], method: str, samples: int, seed: int) -> Design:
    """Points drawn from the axes' distributions. samples : points, or for the methods of FOR_INDICES base samples and
    trajectories.
    """
    cube = _unit_cube(axes, method, samples, seed)
    rows = tuple(axis.drawn(cube[:, i]) for i, axis in enumerate(axes))
    return Design(tuple(axes), (len(cube),), rows, cube)


def count_of(method: str, samples: int, axes: int) -> int:
    """How many points a sample has."""
    return samples * {"sobol-indices": axes + 2, "morris": axes + 1}.get(method, 1)


def _unit_cube(axes: Sequence[Axis], method: str, samples: int, seed: int) -> Floats:
    if method in FOR_INDICES:
        return _for_indices(axes, method, samples, seed)
    from scipy.stats import qmc

    engine = qmc.Sobol if method == "sobol" else qmc.LatinHypercube
    return np.asarray(engine(len(axes), rng=np.random.default_rng(seed)).random(samples))


def _for_indices(axes: Sequence[Axis], method: str, samples: int, seed: int) -> Floats:
    """Saltelli's scheme without second-order indices, or Morris' trajectories, in the unit cube, by SALib."""
    from gw_exudyn.sweep.studies.salib import problem_of, salib

    problem = problem_of(axes)
    if method == "sobol-indices":
        sample = salib("sample.sobol").sample
        return np.asarray(sample(problem, samples, calc_second_order=False, seed=seed))
    cube = np.asarray(salib("sample.morris").sample(problem, samples, num_levels=_MORRIS_LEVELS, seed=seed))
    for i, axis in enumerate(axes):
        if axis.distribution is not None and not axis.distribution.bounded:
            cube[:, i] = _MORRIS_CUT + cube[:, i] * (1 - 2 * _MORRIS_CUT)
    return cube
