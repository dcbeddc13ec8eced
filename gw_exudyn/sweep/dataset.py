"""`sweep.nc`: parameters, metrics and time series of all points in one netCDF-4 file, written piece by piece."""

from __future__ import annotations

import math
import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from gw_exudyn.errors import StorageError
from gw_exudyn.quantities import QUANTITIES, SERIES_COLUMNS
from gw_exudyn.result import Floats
from gw_exudyn.sweep.folder import SweepFolder, as_storage_error
from gw_exudyn.sweep.plan import Plan
from gw_exudyn.sweep.studies.axes import Axis
from gw_exudyn.sweep.studies.study import Study
from gw_exudyn.sweep.table import Table, read_series

DATASET = "sweep.nc"
METRIC = "metric_"
"""Before the names of metrics, some of which are also those of time series."""

CURVES: tuple[str, ...] = SERIES_COLUMNS[1:]

_AT_ONCE = 2_000_000
"""Numbers of a time series that are held at once, of all points together."""


def names_of(axes: tuple[Axis, ...]) -> dict[str, str]:
    """Name in the data set of each path: `contact_friction_coefficient`."""
    taken = {"point", "id", "status", "trusted", "wall_time", "output", *SERIES_COLUMNS}
    names: dict[str, str] = {}
    for axis in axes:
        name = axis.path.replace(".", "_")
        while name in taken:
            name += "_parameter"
        taken.add(name)
        names[axis.path] = name
    return names


def common_times(table: Table) -> Floats | None:
    """(t,) s. Output times of all points, where those of each are the first of the longest; else None."""
    return table.times[0] if len(table.times) == 1 else None


def write_dataset(study: Study, plan: Plan, place: SweepFolder, table: Table) -> None:
    """Write sweep.nc: the parameters are its dimensions for a grid, else `point` is.

    Time series have the dimension `time` where all points give their outputs at the same times; else `output`, with
    `time` as a series of its own. A point that ended between two outputs has its last sample in its own series.csv
    only.
    """
    times = common_times(table)
    length = len(times) if times is not None else len(table.times[0])
    _check_room(place.path, len(plan.ids), length, len(study.metric_table))
    part = place.path / f".{DATASET}.part"
    with as_storage_error(place.path):
        try:
            _write(part, study, plan, place, table, times, length)
        except RuntimeError as error:  # what HDF5 makes of a disk that is full
            raise StorageError(f"{part}: can't be written: {error}; free some space, what is done is kept") from error
        with open(part, "rb+") as file:
            os.fsync(file.fileno())
        os.replace(part, place.path / DATASET)


def _check_room(folder: Path, points: int, length: int, metrics: int) -> None:
    """HDF5 does not get over a disk that fills up while it writes; so its room is made sure of before."""
    # Random numbers shrink to nine tenths at worst; time series to much less.
    needed = 8 * points * (length * len(CURVES) + metrics + 10) + 1_000_000
    free = shutil.disk_usage(folder).free
    if free < needed:
        raise StorageError(
            f"{folder}: {needed / 1e6:.0f} MB may be needed for {DATASET} and {free / 1e6:.0f} MB are free; "
            "free some space and give the same command again, the points that are done are kept"
        )


def _write(
    part: Path, study: Study, plan: Plan, place: SweepFolder, table: Table, times: Floats | None, length: int
) -> None:
    import h5netcdf

    design, names = study.design, names_of(study.design.axes)
    # What a reader is to take for coordinates, besides the dimensions' own.
    further = {"coordinates": " ".join(["id", *(() if design.grid else names.values())])}
    dims = tuple(names.values()) if design.grid else ("point",)
    along = "output" if times is None else "time"
    with h5netcdf.File(part, "w") as file:
        file.dimensions = {**dict(zip(dims, design.shape, strict=True)), along: length}
        file.attrs.update(_about(study))
        for axis in design.axes:
            _write_axis(file, study, axis, names[axis.path])
        _put(file, "id", dims, np.array(plan.ids, dtype=object).reshape(design.shape), {"long_name": "id of the point"})
        status = np.array(table.status, dtype=object).reshape(design.shape)
        _put(file, "status", dims, status, {"long_name": "how the point ended", **further})
        attrs = {"units": "1", "long_name": "1: the numbers of the point can be trusted; 0: it failed", **further}
        _put(file, "trusted", dims, table.good.astype(np.int8).reshape(design.shape), attrs)
        attrs = {"units": "s", "long_name": "time of the solution on the clock", **further}
        _put(file, "wall_time", dims, table.wall_time.reshape(design.shape), attrs)
        for name, metric in study.metric_table.items():
            attrs = {"units": metric.unit, "long_name": metric.meaning, **further}
            _put(file, f"{METRIC}{name}", dims, table.metrics[name].reshape(design.shape), attrs)
        if times is not None:
            _put(file, "time", ("time",), times, _attributes("time"))
        _write_curves(file, plan, place, (*dims, along), design.shape, times, length, further)


def _about(study: Study) -> dict[str, str]:
    return {
        "Conventions": "CF-1.11",
        "title": f"Sweep of guidewire insertions: {study.name}",
        "base": study.base,
        "mode": study.mode,
    }


def _write_axis(file: Any, study: Study, axis: Axis, name: str) -> None:
    design = study.design
    if design.grid:
        labels: list[float | str] = list(axis.labels)
    else:
        labels = [design.labels(point)[axis.path] for point in range(len(design))]
    attrs = {"long_name": f"{axis.path} of the scenario", "path": axis.path}
    if axis.unit is not None:
        attrs["units"] = axis.unit.replace("*", " ")
    values = np.array(labels, dtype=object if axis.unit is None else float)
    _put(file, name, (name,) if design.grid else ("point",), values, attrs)


def _attributes(name: str) -> dict[str, str]:
    return {"units": QUANTITIES[name].unit, "long_name": QUANTITIES[name].long_name}


def _put(file: Any, name: str, dims: tuple[str, ...], values: Any, attrs: dict[str, str]) -> None:
    """Write a whole variable; text where `values` are objects."""
    import h5py

    if values.dtype == object:
        variable = file.create_variable(name, dims, dtype=h5py.string_dtype())
    else:
        fill = np.nan if values.dtype.kind == "f" else None
        variable = file.create_variable(name, dims, dtype=values.dtype, fillvalue=fill)
    variable[...] = values
    variable.attrs.update(attrs)


def _write_curves(
    file: Any,
    plan: Plan,
    place: SweepFolder,
    dims: tuple[str, ...],
    shape: tuple[int, ...],
    times: Floats | None,
    length: int,
    further: dict[str, str],
) -> None:
    """Write all time series, a block of neighbouring points at a time."""
    names = CURVES if times is not None else SERIES_COLUMNS
    most = max(1, _AT_ONCE // (length * len(names)))
    tail = _tail(shape, most)
    variables = {}
    for name in names:
        chunks = (*(1 for _ in shape[:-1]), min(shape[-1], max(1, most), max(1, 100_000 // length)), length)
        variables[name] = file.create_variable(
            name,
            dims,
            dtype=float,
            fillvalue=np.nan,
            chunks=chunks,
            compression="gzip",
            compression_opts=4,
            shuffle=True,
        )
        variables[name].attrs.update({**_attributes(name), **further})
    for start, index, block_shape in _blocks(shape, tail, most):
        count = math.prod(block_shape)
        blocks = {name: np.full((count, length), np.nan) for name in names}
        for row in range(count):
            _fill(blocks, row, read_series(place.point(plan.ids[start + row])), times, length)
        for name in names:
            variables[name][(*index, slice(None))] = blocks[name].reshape(*block_shape, length)


def _tail(shape: tuple[int, ...], most: int) -> int:
    """How many of the last dimensions make a block of at most so many points; one at least."""
    tail = 1
    while tail < len(shape) and math.prod(shape[-tail - 1 :]) <= most:
        tail += 1
    return tail


def _blocks(shape: tuple[int, ...], tail: int, most: int) -> Iterator[tuple[int, tuple[Any, ...], tuple[int, ...]]]:
    """Number of the first point, index and shape of every block: all of the last `tail` dimensions, or, where there
    is one alone, pieces of it.
    """
    inner = shape[len(shape) - tail :]
    step = min(inner[0], most) if tail == 1 else inner[0]
    for outer in np.ndindex(*shape[: len(shape) - tail]):
        begin = int(np.ravel_multi_index((*outer, *(0,) * tail), shape))
        for low in range(0, inner[0], step):
            high = min(low + step, inner[0])
            index = (*outer, slice(low, high), *(slice(None),) * (tail - 1))
            yield begin + low * math.prod(inner[1:]), index, (high - low, *inner[1:])


def _fill(
    blocks: dict[str, Floats], row: int, series: dict[str, Floats] | None, times: Floats | None, length: int
) -> None:
    if series is None:
        return
    if times is None:
        count = min(len(series["time"]), length)
        for name, block in blocks.items():
            block[row, :count] = series[name][:count]
        return
    # A run that ended on its way has a last sample at a time of its own.
    places = np.searchsorted(times, series["time"])
    there = (places < length) & (times[np.minimum(places, length - 1)] == series["time"])
    for name, block in blocks.items():
        block[row, places[there]] = series[name][there]
