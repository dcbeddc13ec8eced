"""`run.nc`: every quantity of a run in one flat netCDF-4 file, which xarray, MATLAB and Julia open as it is."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gw_exudyn.quantities import QUANTITIES
from gw_exudyn.result import attributes

if TYPE_CHECKING:
    import xarray as xr

    from gw_exudyn.result import Floats, Result

DATA = "run.nc"
WALLS = ("vessel_wall", "catheter_wall")
_COMPRESSION = {"zlib": True, "complevel": 4, "shuffle": True}


def to_netcdf(result: Result) -> bytes:
    """The file's bytes. Made in memory: HDF5 does not get over a disk that fills up while it writes, we do."""
    dataset = result.dataset.assign(_wall_variables(result)).assign_attrs(_global_attributes(result))
    encoding = {str(name): dict(_COMPRESSION) for name in dataset.variables}
    return bytes(dataset.to_netcdf(engine="h5netcdf", format="NETCDF4", encoding=encoding))


def from_netcdf(path: Path) -> tuple[xr.Dataset, dict[str, tuple[Floats, ...]]]:
    """Dataset and wall polylines (by the names in WALLS).

    Raises OSError, ValueError or KeyError for a file that is damaged or not ours.
    """
    import xarray as xr

    with xr.open_dataset(path, engine="h5netcdf") as file:
        dataset = file.load()
    walls = {wall: _split(dataset[f"{wall}_x"].values, dataset[f"{wall}_y"].values) for wall in WALLS}
    return dataset.drop_vars([f"{wall}_{axis}" for wall in WALLS for axis in "xy"]).drop_attrs(deep=False), walls


def _wall_variables(result: Result) -> dict[str, Any]:
    variables: dict[str, Any] = {}
    for wall, lines in zip(WALLS, (result.vessel_outline, result.catheter_outline), strict=True):
        joined = _join(lines)
        for axis in range(2):
            quantity = QUANTITIES[f"{wall}_{'xy'[axis]}"]
            variables[quantity.name] = (quantity.dims, joined[:, axis], attributes(quantity))
    return variables


def _global_attributes(result: Result) -> dict[str, Any]:
    """Strings only, so that a reader without JSON still sees what the file is."""
    return {
        "Conventions": "CF-1.11",
        "title": f"Guidewire insertion: {result.scenario.name}",
        "source": "gw_exudyn " + str(result.provenance.get("versions", {}).get("gw-exudyn", "")),
        "status": result.status.status.name.lower(),
        "status_sentence": result.status.sentence(),
        "scenario": json.dumps(result.scenario.to_dict()),
    }


def _join(lines: Sequence[Floats]) -> Floats:
    """Polylines as one (k, 2) array with a row of NaN between two of them; a single such row where there are none."""
    gap = np.full((1, 2), np.nan)
    pieces = [piece for line in lines for piece in (line, gap)][:-1]
    return np.concatenate(pieces or [gap])


def _split(x: Floats, y: Floats) -> tuple[Floats, ...]:
    points = np.column_stack([x, y]).astype(float)
    gaps = np.flatnonzero(np.isnan(points[:, 0]))
    pieces = np.split(points, gaps)
    return tuple(kept for piece in pieces if len(kept := piece[~np.isnan(piece[:, 0])]))
