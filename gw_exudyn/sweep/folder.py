"""The folder of a sweep: a lock that dies with the process, and points that appear as a whole or not at all."""

from __future__ import annotations

import errno
import json
import os
import secrets
import shutil
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from gw_exudyn.errors import StorageError
from gw_exudyn.storage.manifest import MANIFEST, MARKER, to_text
from gw_exudyn.storage.run_folder import write_file

SWEEP = "sweep.json"
SWEEP_MARKER = "gw_exudyn sweep"
POINTS = "points"
_WRITING = ".writing"
_LOCK = ".lock"


class SweepFolder:
    """A sweep's folder, locked while in use.

    Raises StorageError for a folder that is not ours, that another sweep is writing to, or that the system refuses;
    and for whatever the disk refuses later.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock: int | None = None

    def __enter__(self) -> SweepFolder:
        """Make the folder if it is missing, lock it, and clear away what a killed sweep was writing."""
        with as_storage_error(self.path):
            self._refuse_foreign()
            self.path.mkdir(parents=True, exist_ok=True)
            self._lock = _locked(self.path / _LOCK)
            try:
                self._refuse_foreign()
                shutil.rmtree(self.path / _WRITING, ignore_errors=True)
                (self.path / POINTS).mkdir(exist_ok=True)
            except BaseException:
                os.close(self._lock)
                raise
        return self

    def __exit__(self, *_: object) -> None:
        """Give the lock up."""
        shutil.rmtree(self.path / _WRITING, ignore_errors=True)
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    def _refuse_foreign(self) -> None:
        path = self.path
        if os.path.lexists(path) and not path.is_dir():
            raise StorageError(f"{path}: a file is in the way; remove it, or name another folder (--out)")
        if not path.is_dir() or is_sweep(path):
            return
        if any(entry.name not in (_LOCK, _WRITING, POINTS, f".{SWEEP}.part") for entry in path.iterdir()):
            raise StorageError(
                f"{path}: the folder exists and is not a sweep of gw-exudyn (it holds no {SWEEP} of ours), "
                "so it is left alone; empty or remove it, or name another folder (--out)"
            )

    def write(self, name: str, content: bytes) -> None:
        """Write a file of the sweep, in full or not at all."""
        with as_storage_error(self.path):
            write_file(self.path / name, content)

    def write_about(self, content: Mapping[str, Any]) -> None:
        """Write sweep.json."""
        self.write(SWEEP, to_text({"format": SWEEP_MARKER, "format_version": 1, **content}).encode())

    def point(self, point: str) -> Path:
        """The folder of a point."""
        return self.path / POINTS / point

    def add(self, point: str, files: Mapping[str, bytes]) -> None:
        """Put a point's folder in its place; an older one of it goes."""
        with as_storage_error(self.path):
            self._replace(self.point(point), files)

    def add_run(self, name: str, files: Mapping[str, bytes]) -> Path:
        """Put a run folder beside the points, in place of an older one, and return it."""
        with as_storage_error(self.path):
            self._replace(self.path / name, files)
        return self.path / name

    def _replace(self, place: Path, files: Mapping[str, bytes]) -> None:
        new = self.path / _WRITING / f"{place.name}-{secrets.token_hex(4)}"
        new.mkdir(parents=True)
        try:
            # The manifest last: a folder that has it is complete.
            for name in sorted(files, key=lambda name: name == MANIFEST):
                write_file(new / name, files[name])
            old = new.with_name(f"{new.name}-old")
            with suppress(FileNotFoundError):
                os.rename(place, old)
            os.rename(new, place)
        except BaseException:
            shutil.rmtree(new, ignore_errors=True)
            raise
        shutil.rmtree(old, ignore_errors=True)

    def clear(self) -> None:
        """Remove all points."""
        with as_storage_error(self.path):
            old = self.path / _WRITING / f"{POINTS}-old"
            old.parent.mkdir(exist_ok=True)
            os.rename(self.path / POINTS, old)
            (self.path / POINTS).mkdir()
        shutil.rmtree(old, ignore_errors=True)


def is_sweep(path: Path) -> bool:
    """Whether the folder is a sweep of ours."""
    try:
        content = json.loads((path / SWEEP).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    return isinstance(content, dict) and content.get("format") == SWEEP_MARKER


def read_point(folder: Path) -> dict[str, Any] | None:
    """The content of a point's run.json; None where the point is not there, or is damaged and has to be run again."""
    try:
        content = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    good = isinstance(content, dict) and content.get("format") == MARKER and isinstance(content.get("status"), dict)
    return content if good else None


@contextmanager
def as_storage_error(path: Path) -> Iterator[None]:
    """Whatever the system refuses within, as a StorageError with a remedy."""
    try:
        yield
    except OSError as error:
        full = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
        remedy = (
            "free some space and give the same command again; the points that are done are kept"
            if full
            else "name another folder (--out)"
        )
        where = f" ({error.filename})" if error.filename else ""
        raise StorageError(f"{path}: can't be written: {error.strerror or error}{where}; {remedy}") from error


def _locked(path: Path) -> int:
    """A lock on the file for as long as this process lives. Raises StorageError where another process has it."""
    handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    try:
        if sys.platform == "win32":
            import msvcrt

            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(handle)
        raise StorageError(
            f"{path.parent}: another sweep is writing to this folder; wait for it, or name another folder (--out)"
        ) from None
    return handle
