"""Which parameter matters: Sobol' and Morris indices of metrics, by SALib (an extra: `sensitivity`)."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.result import Floats
from gw_exudyn.sweep.studies.axes import Axis
from gw_exudyn.sweep.studies.salib import problem_of, salib

if TYPE_CHECKING:
    from gw_exudyn.sweep.folder import SweepFolder
    from gw_exudyn.sweep.plan import Summary
    from gw_exudyn.sweep.studies.study import Study
    from gw_exudyn.sweep.table import Table

INDICES = "sensitivity.csv"
CONFIDENCE = 0.95
_LEVELS = 4  # of Morris' grid, as the design draws it
_RESAMPLES = 200
_FEWEST = 4
"""Base samples or trajectories that are needed at least."""

NAMES = {
    "S1": "first-order Sobol' index: share of the variance that the parameter has alone",
    "ST": "total Sobol' index: share of the variance that the parameter takes part in",
    "mu_star": "Morris' mean absolute elementary effect: change over the whole range of the parameter",
    "sigma": "Morris' standard deviation of the elementary effects: how much they depend on the rest",
}


@dataclass(frozen=True)
class Index:
    """An index of a metric to a parameter: value and half width of its confidence interval of 95 % (NaN: none)."""

    metric: str
    path: str
    name: str
    value: float
    confidence: float
    unit: str


def indices(study: Study, table: Table, metric: str, unit: str) -> tuple[list[Index], int]:
    """Indices of a metric, and how many base samples or trajectories were left out because a point of theirs failed.

    Raises ValueError where too few are left, or where the metric does not change.
    """
    axes = study.design.axes
    size = len(axes) + (2 if study.method == "sobol-indices" else 1)
    values = np.where(table.good, table.metrics[metric], np.nan).reshape(-1, size)
    whole = np.asarray(np.isfinite(values).all(axis=1))
    if whole.sum() < _FEWEST:
        raise ValueError(f"{int(whole.sum())} of {len(whole)} base samples came out whole; {_FEWEST} are needed")
    kept = values[whole].ravel()
    if np.ptp(kept) == 0:
        raise ValueError("it is the same at all points")
    if study.method == "sobol-indices":
        found = _sobol(axes, kept, study.seed)
    else:
        cube = np.asarray(study.design.unit_cube).reshape(-1, size, len(axes))[whole].reshape(-1, len(axes))
        found = _morris(axes, cube, kept, study.seed)
    named = [
        Index(metric, axis.path, name, float(value), float(half), "1" if name in ("S1", "ST") else unit)
        for name, (column, halves) in found.items()
        for axis, value, half in zip(axes, column, halves, strict=True)
    ]
    return named, int((~whole).sum())


def _sobol(axes: Sequence[Axis], values: Floats, seed: int) -> dict[str, tuple[Floats, Floats]]:
    found = salib("analyze.sobol").analyze(
        problem_of(axes),
        values,
        calc_second_order=False,
        num_resamples=_RESAMPLES,
        conf_level=CONFIDENCE,
        print_to_console=False,
        seed=seed,
    )
    return {name: (np.asarray(found[name]), np.asarray(found[f"{name}_conf"])) for name in ("S1", "ST")}


def _morris(axes: Sequence[Axis], cube: Floats, values: Floats, seed: int) -> dict[str, tuple[Floats, Floats]]:
    found = salib("analyze.morris").analyze(
        problem_of(axes),
        cube,
        values,
        num_levels=_LEVELS,
        num_resamples=_RESAMPLES,
        conf_level=CONFIDENCE,
        print_to_console=False,
        seed=seed,
    )
    none = np.full(len(axes), np.nan)
    return {
        "mu_star": (np.asarray(found["mu_star"]), np.asarray(found["mu_star_conf"])),
        "sigma": (np.asarray(found["sigma"]), none),
    }


def write_indices(study: Study, table: Table, place: SweepFolder, summary: Summary) -> None:
    """Write sensitivity.csv with the indices of all metrics of the study, and say in `summary` what is missing."""

    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["metric", "parameter", "index", "value", "confidence_95", "unit", "meaning"])
    for metric in study.metrics:
        try:
            found, left_out = indices(study, table, metric, study.metric_table[metric].unit)
        except ValueError as error:
            summary.notes.append(f"no sensitivity of {metric}: {error}")
            continue
        if left_out:
            summary.notes.append(f"sensitivity of {metric}: {left_out} base samples with a failed point are left out")
        for one in found:
            half = "" if np.isnan(one.confidence) else repr(one.confidence)
            writer.writerow([one.metric, one.path, one.name, repr(one.value), half, one.unit, NAMES[one.name]])
    place.write(INDICES, text.getvalue().encode())
    summary.files.append(place.path / INDICES)
