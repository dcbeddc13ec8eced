"""`run.json`: how a run ended, its metrics, and what it takes to repeat it.

Its presence with our marker is what makes a folder a run of ours.
"""

from __future__ import annotations

import json
import math
import shlex
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gw_exudyn.errors import ScenarioError, StorageError
from gw_exudyn.metrics import Metric, metrics
from gw_exudyn.result import SnapEvent, Status, StatusReport

if TYPE_CHECKING:
    from gw_exudyn.result import Result

MANIFEST = "run.json"
MARKER = "gw_exudyn run"
FORMAT_VERSION = 1
"""Raised whenever a reader of the version before would misread a folder."""

_KEYS = (
    "name",
    "status",
    "wall_time",
    "metrics",
    "snaps",
    "counters",
    "command",
    "versions",
    "provenance",
    "files",
    "scenario",
)
"""What every run.json has had; `peaks` came later."""


def manifest(result: Result, command: str | Sequence[str], files: Mapping[str, str]) -> dict[str, Any]:
    """The content of run.json. `files` maps the name of a data file to its SHA-256 digest."""
    further = {name: value for name, value in result.provenance.items() if name not in ("versions", "command")}
    return {
        "format": MARKER,
        "format_version": FORMAT_VERSION,
        "name": result.scenario.name,
        "status": _status_entry(result.status),
        "trusted": result.status.status.trusted,
        "wall_time": result.wall_time,
        "metrics": {name: _metric_entry(metric) for name, metric in metrics(result).items()},
        "snaps": [{"time": snap.time, "released_energy": snap.released_energy} for snap in result.snaps],
        "counters": dict(result.counters),
        "peaks": {name: {"value": value, "time": time} for name, (value, time) in result.peaks.items()},
        "command": command if isinstance(command, str) else shlex.join(command),
        "versions": dict(result.provenance.get("versions", {})),
        "provenance": further,
        "files": {name: {"sha256": digest} for name, digest in files.items()},
        "scenario": result.scenario.to_dict(),
    }


def to_text(content: Mapping[str, Any]) -> str:
    """JSON that every reader takes: numbers that are not finite become null."""
    return json.dumps(_plain(content), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def is_ours(folder: Path) -> bool:
    """Whether the folder holds a run.json with our marker, of whatever format version."""
    try:
        content = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    return isinstance(content, dict) and content.get("format") == MARKER


def read_manifest(folder: Path) -> dict[str, Any]:
    """run.json of a run folder.

    Raises StorageError for a folder that is no run, a damaged file, or a format newer than this version knows.
    """
    path = folder / MANIFEST
    if not path.is_file():
        raise StorageError(_no_run(folder))
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise StorageError(f"{path}: can't be read ({error.strerror or error})") from error
    except ValueError as error:
        raise StorageError(f"{path}: damaged, it is not valid JSON ({error}); run the scenario again") from error
    if not isinstance(content, dict) or content.get("format") != MARKER:
        raise StorageError(f'{path}: was not written by gw-exudyn (no "format": "{MARKER}"); give the folder of a run')
    version = content.get("format_version")
    if not isinstance(version, int):
        raise StorageError(
            f"{path}: damaged, format_version is {version!r}, not a whole number; run the scenario again"
        )
    if version > FORMAT_VERSION:
        raise StorageError(
            f"{path}: format version {version}, this gw-exudyn reads up to {FORMAT_VERSION}; "
            "update gw-exudyn, or run the scenario again"
        )
    missing = [key for key in _KEYS if key not in content]
    if missing:
        raise StorageError(f"{path}: is damaged, it has no {', '.join(missing)}; run the scenario again")
    return content


@contextmanager
def as_damaged(folder: Path) -> Iterator[None]:
    """Whatever is missing from or wrong with the content of the folder's run.json, as a StorageError."""
    try:
        yield
    except (KeyError, TypeError, ValueError, AttributeError, ScenarioError) as error:
        what = f"it has no {error.args[0]}" if isinstance(error, KeyError) and error.args else str(error)
        raise StorageError(
            f"{folder / MANIFEST}: is damaged, or of another version ({what}); run the scenario again"
        ) from error


def status_of(content: Mapping[str, Any]) -> StatusReport:
    """The status in a run.json. Raises KeyError, TypeError or ValueError where it is damaged."""
    entry = content["status"]
    name = str(entry["name"])
    if name.upper() not in Status.__members__:
        raise ValueError(f"status {name!r} is not known")
    time = None if entry["time"] is None else float(entry["time"])
    return StatusReport(Status[name.upper()], time, str(entry["place"]), str(entry["detail"]))


def snaps_of(content: Mapping[str, Any]) -> tuple[SnapEvent, ...]:
    """The snap-through events in a run.json. Raises KeyError, TypeError or ValueError where they are damaged."""
    return tuple(SnapEvent(float(entry["time"]), float(entry["released_energy"])) for entry in content["snaps"])


def peaks_of(content: Mapping[str, Any]) -> dict[str, tuple[float, float]]:
    """The peaks in a run.json, none where it is older than they are. Raises KeyError, TypeError or ValueError where
    they are damaged.
    """
    return {
        str(name): (_number(entry["value"]), _number(entry["time"])) for name, entry in content.get("peaks", {}).items()
    }


def _number(value: Any) -> float:
    """A number of a run.json, in which null stands for one that is not finite."""
    return float("nan") if value is None else float(value)


def _status_entry(report: StatusReport) -> dict[str, Any]:
    return {
        "name": report.status.name.lower(),
        "sentence": report.sentence(),
        "time": report.time,
        "place": report.place,
        "detail": report.detail,
    }


def _metric_entry(metric: Metric) -> dict[str, Any]:
    """A coded number has a label besides."""
    label = {"label": metric.label} if metric.label else {}
    return {"value": metric.value, **label, "unit": metric.unit, "meaning": metric.meaning}


def _no_run(folder: Path) -> str:
    if not folder.exists():
        return f"{folder}: no such folder; give the folder of a run, as `gw-exudyn run` names it"
    if not folder.is_dir():
        return f"{folder}: is a file; give the folder of a run"
    if (folder / "run.nc").exists():
        return (
            f"{folder}: half-written or half-copied, it has run.nc but no {MANIFEST} (which is written last); "
            "run the scenario again"
        )
    return f"{folder}: not a run folder (no {MANIFEST}); give the folder of a run, as `gw-exudyn run` names it"


def _plain(value: Any) -> Any:
    """The value with plain Python numbers only, and None for those that are not finite."""
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    if hasattr(value, "tolist"):  # numpy scalars and arrays
        return _plain(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value
