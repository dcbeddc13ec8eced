"""Bands of a curve over the points of a sample: median and quantiles at each insertion depth or time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.result import Floats
from gw_exudyn.sweep.studies.study import Study

if TYPE_CHECKING:
    import xarray as xr

_FEWEST = 2
"""Points that must reach a place for it to have a band."""

_STEPS = 200  # of the abscissa, where the points do not share one


@dataclass(frozen=True)
class Band:
    """name, abscissa : quantities. x : (k,) SI. low, median, high : (k,) SI, 5 %, 50 % and 95 % of the points that
    reach x. count : (k,) how many do.
    """

    name: str
    abscissa: str
    x: Floats
    low: Floats
    median: Floats
    high: Floats
    count: Floats


def band(study: Study, dataset: xr.Dataset, name: str) -> Band:
    """The band of a curve over insertion depth where all runs only push in, else over time."""
    good = dataset["trusted"].values.ravel() == 1
    depth, values = (_rows(dataset, one)[good] for one in ("insertion_depth", name))
    if _rising(depth):
        abscissa, places = "insertion_depth", depth
    else:
        abscissa = "time"
        times = np.asarray(dataset["time"].values, dtype=float)
        places = np.broadcast_to(times, values.shape) if times.ndim == 1 else _rows(dataset, "time")[good]
    x, table = _on_one_abscissa(places, values)
    count = np.isfinite(table).sum(axis=0).astype(float)
    there = count >= _FEWEST
    low, median, high = np.nanquantile(table[:, there], (0.05, 0.5, 0.95), axis=0)
    return Band(name, abscissa, x[there], low, median, high, count[there])


def _rows(dataset: xr.Dataset, name: str) -> Floats:
    values = np.asarray(dataset[name].values, dtype=float)
    return values.reshape(-1, values.shape[-1])


def _rising(depth: Floats) -> bool:
    steps = np.diff(depth, axis=1)
    return bool((steps[np.isfinite(steps)] > 0).all())


def _on_one_abscissa(places: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Common places (k,), and the values of every point there (points, k); NaN where a point does not get."""
    longest = places[int(np.argmax(np.isfinite(places).sum(axis=1)))]
    shared = np.isclose(places, longest, rtol=0, atol=1e-9 * np.nanmax(places)) | ~np.isfinite(places)
    if shared.all():
        there = np.isfinite(longest)
        return longest[there], values[:, there]
    x = np.linspace(np.nanmin(places), np.nanmax(places), _STEPS)
    rows = []
    for place, row in zip(places, values, strict=True):
        there = np.isfinite(place) & np.isfinite(row)
        rows.append(np.interp(x, place[there], row[there], left=np.nan, right=np.nan))
    return x, np.stack(rows)
