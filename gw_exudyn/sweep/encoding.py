"""A point's result as the files of its folder."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

from gw_exudyn.storage.manifest import MANIFEST, manifest, to_text
from gw_exudyn.storage.netcdf import DATA, to_netcdf
from gw_exudyn.storage.series import SERIES, series_text

if TYPE_CHECKING:
    from gw_exudyn.result import Result


def encoded(result: Result, command: str, whole: bool) -> dict[str, bytes]:
    """Content of series.csv and run.json by name; with `whole` also of run.nc, so that the folder is a run folder."""
    data = {SERIES: series_text(result).encode()}
    if whole:
        data[DATA] = to_netcdf(result)
    digests = {name: hashlib.sha256(content).hexdigest() for name, content in data.items()}
    return {**data, MANIFEST: to_text(manifest(result, command, digests)).encode()}
