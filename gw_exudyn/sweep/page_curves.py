"""The time series of a sweep's points that its page takes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from gw_exudyn.report.curves import Curves, chosen
from gw_exudyn.report.pack import READINGS
from gw_exudyn.sweep.dataset import DATASET
from gw_exudyn.sweep.folder import POINTS
from gw_exudyn.sweep.table import read_series

_ABSCISSA = "insertion_depth"


def read_curves(folder: Path, ids: Sequence[str], metrics: Sequence[str], whole: bool) -> Curves | None:
    """Curves of the points, from the data set, or from the points where there is none of these; None where there are
    none, or no room for them.

    metrics : of the study; their curves come first. whole : the data set may be there.
    """
    wanted = tuple(dict.fromkeys([*_of_metrics(metrics)[:1], _ABSCISSA, *_of_metrics(metrics), *READINGS]))
    if whole and (folder / DATASET).is_file():
        import h5netcdf

        with h5netcdf.File(folder / DATASET, "r") as file:
            there = [text.decode() if isinstance(text, bytes) else str(text) for text in file["id"][...].ravel()]
            if there == list(ids):
                return _from_dataset(file, wanted)
    return _from_points(folder, ids, wanted)


def _of_metrics(metrics: Sequence[str]) -> list[str]:
    """The quantities that the metrics are of, as far as there are curves of them."""
    found = [max((q for q in READINGS if metric.startswith(q)), key=len, default="") for metric in metrics]
    return list(dict.fromkeys(name for name in found if name)) or ["push_force"]


def _from_dataset(file: Any, wanted: Sequence[str]) -> Curves | None:
    length = file[wanted[0]].shape[-1]
    points = int(np.prod(file[wanted[0]].shape[:-1]))
    own = file["time"].ndim > 1
    names, instants = chosen(("time", *wanted) if own else wanted, points, length, 3 if own else 2)
    if not names:
        return None
    time = None if own else np.asarray(file["time"][...])[instants]
    return Curves(time, {name: np.asarray(file[name][..., instants]).reshape(points, -1) for name in names})


def _from_points(folder: Path, ids: Sequence[str], wanted: Sequence[str]) -> Curves | None:
    kept = ("time", *wanted)
    if not chosen(kept, len(ids), 2, 3)[0]:
        return None  # no room for so many: not read at all
    read = (read_series(folder / POINTS / point) for point in ids)
    found = [one and {name: one[name] for name in kept} for one in read]
    length = max((len(one["time"]) for one in found if one is not None), default=0)
    if not length:
        return None
    names, instants = chosen(kept, len(ids), length, 3)
    if not names:
        return None
    series = {name: np.full((len(ids), length), np.nan) for name in names}
    for row, one in enumerate(found):
        if one is None:
            continue
        for name in names:
            series[name][row, : len(one[name])] = one[name]
    return Curves(None, {name: values[:, instants] for name, values in series.items()})
