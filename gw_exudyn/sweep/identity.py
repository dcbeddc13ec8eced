"""By what a point is known: a hash of what is run and of what runs it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gw_exudyn.result import software_versions

_DECIDE = ("python", "gw-exudyn", "exudyn", "numpy")
"""Packages whose version may change a number of a run; the others only write it down."""

PARTS = (
    "scenario",
    "model",
    "engine",
    "simulation.py",
    "sampling.py",
    "trust.py",
    "events.py",
    "quantities.py",
    "result.py",
    "metrics",
)
"""Parts of this package that decide on the numbers of a run; the version alone does not tell one state of a source
tree from the next."""

_LETTERS = 16


@dataclass(frozen=True)
class Maker:
    """What runs the points. runner : its name. versions : of the packages that decide. code : digest of our own."""

    runner: str
    versions: Mapping[str, str]
    code: str

    def point_id(self, scenario: Mapping[str, Any]) -> str:
        """The id of the point of a resolved scenario (plain data). Its name does not count: no number depends on it."""
        content = {
            "scenario": {key: value for key, value in scenario.items() if key != "name"},
            "versions": dict(self.versions),
            "code": self.code,
            "runner": self.runner,
        }
        text = json.dumps(content, sort_keys=True, ensure_ascii=True)
        return hashlib.sha256(text.encode()).hexdigest()[:_LETTERS]


def this_maker(runner: str) -> Maker:
    """What runs points here and now. What a runner's name says behind its class, as a file, decides on no number."""
    return Maker(":".join(runner.split(":")[:2]), decisive(software_versions()), _code_digest())


def decisive(versions: Mapping[str, str]) -> dict[str, str]:
    """Of versions, those that may change a number."""
    return {name: str(versions.get(name, "not installed")) for name in _DECIDE}


def _code_digest() -> str:
    package = Path(__file__).resolve().parents[1]
    digest = hashlib.sha256()
    for file in _files(package):
        digest.update(file.relative_to(package).as_posix().encode() + b"\0")
        # Line ends may differ between checkouts of the same source.
        digest.update(file.read_bytes().replace(b"\r\n", b"\n") + b"\0")
    return digest.hexdigest()[:_LETTERS]


def _files(package: Path) -> Iterator[Path]:
    for part in PARTS:
        path = package / part
        found = [path] if path.is_file() else sorted(path.rglob("*"))
        if not found:
            raise FileNotFoundError(f"{path}: part of what decides on a run's numbers, and not there")
        yield from (file for file in found if file.suffix in (".py", ".c", ".yaml"))
