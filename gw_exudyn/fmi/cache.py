"""FMUs unpacked in the user's cache folder, one folder a content, so that none is unpacked twice.

An entry is used only if every file in it has the hash that the FMU says, so that what was damaged or changed there
never runs. It appears as a whole, by a rename: of two hosts at once the second uses what the first has put there.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
import stat
import sys
import tempfile
import time
import zipfile
from collections.abc import Iterator
from pathlib import Path

from gw_exudyn.fmi.resources import HASHES

_BLOCK = 1 << 20
_KEPT = 30 * 86400.0
"""Seconds without use after which an entry is removed."""


def may_run(folder: Path) -> bool:
    """Programs and libraries in a folder may be run, as far as the system tells: it is not mounted with noexec."""
    return sys.platform == "win32" or not os.statvfs(folder).f_flag & getattr(os, "ST_NOEXEC", 0)


def cache_folder() -> Path | None:
    """The folder of unpacked FMUs, made if missing, for this user alone; None where there can be none, or nothing in
    it may be run."""
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA", "")
    elif sys.platform == "darwin":
        base = os.path.expanduser("~/Library/Caches")
    else:
        base = os.environ.get("XDG_CACHE_HOME", "") or os.path.expanduser("~/.cache")
    if not os.path.isabs(base):
        return None
    folder = Path(base, "gw-exudyn", "fmu")
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        found = folder.lstat()
        if not stat.S_ISDIR(found.st_mode) or not os.access(folder, os.W_OK | os.X_OK):
            return None
        if sys.platform != "win32":
            if found.st_uid != os.getuid():
                return None
            folder.chmod(0o700)
        if not may_run(folder):
            return None
    except OSError:
        return None
    return folder


def unpacked(file: str | os.PathLike[str]) -> Path | None:
    """The folder that holds the FMU `file` unpacked; None where there is no cache folder.

    Raises OSError and zipfile.BadZipFile for a file that can't be unpacked.
    """
    root = cache_folder()
    if root is None:
        return None
    with open(file, "rb") as content:
        name = hashlib.file_digest(content, "sha256").hexdigest()
    entry = root / name
    with zipfile.ZipFile(file) as archive:
        hashes = _hashes(archive)
        if not _intact(entry, hashes):
            _put(archive, root, entry, hashes)
    os.utime(entry)
    _remove_old(root)
    return entry


def _put(archive: zipfile.ZipFile, root: Path, entry: Path, hashes: dict[str, str]) -> None:
    """Unpack under a hidden name and rename; what is there already goes, unless another has just made it well."""
    part = Path(tempfile.mkdtemp(prefix=f".{entry.name}.", dir=root))
    try:
        archive.extractall(part)
        if not _intact(part, hashes):
            raise OSError("its files are not those that it says it holds; export it again")
        while True:
            try:
                part.rename(entry)
                return
            except OSError:
                if not entry.exists() or _intact(entry, hashes):
                    break
                _remove(entry)
        if not entry.exists():
            raise OSError(f"{entry} can't be made")
    finally:
        shutil.rmtree(part, ignore_errors=True)


def _remove(entry: Path) -> None:
    """Out of the way first, in one go: nobody sees half of it."""
    gone = Path(tempfile.mkdtemp(prefix=f".{entry.name}.", dir=entry.parent))
    with contextlib.suppress(FileNotFoundError):  # another was faster
        entry.rename(gone / "old")
    shutil.rmtree(gone, ignore_errors=True)


def _remove_old(root: Path) -> None:
    before = time.time() - _KEPT
    for entry in root.iterdir():
        with contextlib.suppress(OSError):
            if entry.lstat().st_mtime < before:
                _remove(entry)


def _hashes(archive: zipfile.ZipFile) -> dict[str, str]:
    """SHA-256 of every file of an FMU by name: as the FMU tells them, else from the contents, which takes longer."""
    names = [entry.filename for entry in archive.infolist() if not entry.is_dir()]
    told: dict[str, str] = json.loads(archive.read(HASHES)) if HASHES in names else {}
    found = {}
    for name in names:
        if name in told:
            found[name] = told[name]
        else:
            with archive.open(name) as content:
                found[name] = _digest(iter(lambda content=content: content.read(_BLOCK), b""))  # type: ignore[misc]
    return found


def _digest(blocks: Iterator[bytes]) -> str:
    digest = hashlib.sha256()
    for block in blocks:
        digest.update(block)
    return digest.hexdigest()


def _intact(entry: Path, hashes: dict[str, str]) -> bool:
    """An entry holds these files, as they should be, and nothing else."""
    found = set()
    try:
        for place, _, names in os.walk(entry):
            for name in names:
                path = Path(place, name)
                inside = path.relative_to(entry).as_posix()
                if inside not in hashes or not stat.S_ISREG(path.lstat().st_mode):
                    return False
                with path.open("rb") as content:
                    if hashlib.file_digest(content, "sha256").hexdigest() != hashes[inside]:
                        return False
                found.add(inside)
    except OSError:
        return False
    return found == set(hashes)
