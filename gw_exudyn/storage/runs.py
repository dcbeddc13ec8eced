"""A run to its folder, and back."""

from __future__ import annotations

import hashlib
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gw_exudyn.errors import StorageError
from gw_exudyn.storage.manifest import (
    MANIFEST,
    as_damaged,
    manifest,
    peaks_of,
    read_manifest,
    snaps_of,
    status_of,
    to_text,
)
from gw_exudyn.storage.netcdf import DATA, from_netcdf, to_netcdf
from gw_exudyn.storage.run_folder import recovered, replaced_folder, write_file
from gw_exudyn.storage.series import SERIES, series_text

if TYPE_CHECKING:
    from gw_exudyn.result import Floats, Result

FIGURES = "figures"
_ATTEMPTS = 20


def write_run(result: Result, folder: str | Path, command: str | Sequence[str] = "", *, figures: bool = True) -> Path:
    """Write a run to `folder` (made if missing; replaced as a whole if it is an older run of ours) and return the
    folder.

    `command` is what a person types to repeat the run. With `figures` the folder gets `figures/`; a figure that can't
    be drawn is a warning, not the loss of the run.

    Raises StorageError if the folder is not ours to replace, or for a full disk, a missing permission and the like:
    an older run is then untouched.
    """
    with replaced_folder(folder) as writing:
        data = to_netcdf(result)
        series = series_text(result).encode()
        write_file(writing / DATA, data)
        write_file(writing / SERIES, series)
        if figures:
            _draw(result, writing / FIGURES)
        digests = {name: hashlib.sha256(content).hexdigest() for name, content in ((DATA, data), (SERIES, series))}
        write_file(writing / MANIFEST, to_text(manifest(result, command, digests)).encode())
    return Path(folder)


def read_run(folder: str | Path) -> Result:
    """Read a run folder.

    Raises StorageError for a folder that is no run, is half-written or damaged, or has a format newer than this
    version reads.
    """
    for _ in range(_ATTEMPTS):
        folder = recovered(folder)
        before = _identity(folder)
        try:
            return _read(folder)
        except StorageError:
            # A writer may have put a new run in the place while this one was being read.
            if _identity(folder) == before:
                raise
    raise StorageError(f"{folder}: other processes keep writing to it; read it when they are done")


def _identity(folder: Path) -> tuple[int, int] | None:
    """What tells one run in this place from the next; None where there is no run."""
    try:
        found = (folder / MANIFEST).stat()
    except OSError:
        return None
    return found.st_ino, found.st_mtime_ns


def _read(folder: Path) -> Result:
    from gw_exudyn.result import Result

    content = read_manifest(folder)
    dataset, walls = _read_data(folder, content)
    with as_damaged(folder):
        return Result(
            dataset=dataset,
            status=status_of(content),
            scenario=_scenario(content),
            snaps=snaps_of(content),
            vessel_outline=walls["vessel_wall"],
            catheter_outline=walls["catheter_wall"],
            provenance={**content["provenance"], "versions": dict(content["versions"]), "command": content["command"]},
            wall_time=float("nan") if content["wall_time"] is None else float(content["wall_time"]),
            counters={str(name): int(count) for name, count in content["counters"].items()},
            peaks=peaks_of(content),
        )


def _draw(result: Result, folder: Path) -> None:
    try:
        files = _rendered(result)
    except Exception as error:  # an hour of computing is not given up for a picture
        warnings.warn(
            f"the figures could not be drawn ({type(error).__name__}: {error}); the results are complete",
            RuntimeWarning,
            stacklevel=3,
        )
        return
    folder.mkdir()
    for name, content in files.items():
        write_file(folder / name, content)


def _rendered(result: Result) -> dict[str, bytes]:
    from gw_exudyn.plots.save import render_figures

    return render_figures(result)


def _read_data(folder: Path, content: dict[str, Any]) -> tuple[Any, dict[str, tuple[Floats, ...]]]:
    path = folder / DATA
    with as_damaged(folder):
        expected = content["files"][DATA]["sha256"]
    try:
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        if digest != expected:
            raise StorageError(
                f"{path}: damaged or half-copied, it is not the file that {MANIFEST} was written for; "
                "copy it again or run again"
            )
        return from_netcdf(path)
    except FileNotFoundError as error:
        raise StorageError(
            f"{path}: missing; the run folder is incomplete, copy it again or run the scenario again"
        ) from error
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise StorageError(f"{path}: can't be read ({error}); run the scenario again") from error


def _scenario(content: dict[str, Any]) -> Any:
    from gw_exudyn.scenario.loading import scenario_from_dict

    return scenario_from_dict(content["scenario"])
