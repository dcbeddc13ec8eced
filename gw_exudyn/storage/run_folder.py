"""Folders that appear as a whole: written under a hidden name beside their place, then renamed into it.

For a run folder `corner90` two hidden names occur beside it: `.corner90.writing-<random>`, which a process is
filling, and `.corner90.replaced-<random>`, an older run on its way out. Every change that others can see is one
rename, so that a crash, a kill or a second writer at the same time never leaves a mixture: of two writers the later
one wins. A process that fills a folder holds a lock on it, which the system drops when the process ends, however it
ends; that is how the next writer knows which leftovers it may remove.
"""

from __future__ import annotations

import errno
import os
import secrets
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from gw_exudyn.errors import StorageError
from gw_exudyn.storage.manifest import MANIFEST, is_ours

_ATTEMPTS = 100


def check_run_folder(folder: str | Path) -> None:
    """Find out before a long run whether its results may and can be written to `folder`. Makes missing parent
    folders; changes nothing else.

    Raises StorageError if the place is taken by something that is not a run of ours, or can't be written to.
    """
    place = _place(folder)
    with _as_storage_error(place):
        refuse_foreign(place)
        place.parent.mkdir(parents=True, exist_ok=True)
        probe, lock = _start_writing(place)
        _discard(probe, lock)


@contextmanager
def replaced_folder(folder: str | Path) -> Iterator[Path]:
    """Give an empty folder to fill; put it in the place of `folder` when the block ends well, remove it when the
    block fails.

    Raises StorageError for what `check_run_folder` refuses and for whatever the disk or the system refuses on the
    way; `folder` is then as it was.
    """
    place = _place(folder)
    with _as_storage_error(place):
        refuse_foreign(place)
        place.parent.mkdir(parents=True, exist_ok=True)
        recover(place)
        _remove_leftovers(place)
        writing, lock = _start_writing(place)
        try:
            yield writing
            _sync_folder(writing)
            _swap_in(writing, place)
        finally:
            _discard(writing, lock)
        _sync_folder(place.parent)


def write_file(path: Path, content: bytes) -> None:
    """Write a file that is on the disk when this returns, and that is there in full or not at all."""
    part = path.with_name(f".{path.name}.part")
    with open(part, "wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
    os.replace(part, path)


def recovered(folder: str | Path) -> Path:
    """The folder, after bringing back an older run if there is need to; for reading."""
    recover(_place(folder))
    return Path(folder)


def recover(place: Path) -> None:
    """Bring back the older run if a writer was killed between moving it away and moving the new one in."""
    if os.path.lexists(place):
        return
    for old in _siblings(place, "replaced"):
        if is_ours(old):
            with suppress(OSError):
                os.rename(old, place)
            return


def refuse_foreign(place: Path) -> None:
    """Raise StorageError if `place` exists and is neither an empty folder nor a run of ours, or if it is where this
    process stands.
    """
    if place == Path.cwd() or place in Path.cwd().parents:
        raise StorageError(
            f"{place}: is the current folder, or holds it, and a run folder is replaced as a whole; "
            "name a folder inside it (--out)"
        )
    if not os.path.lexists(place):
        return
    if not place.is_dir():
        raise StorageError(f"{place}: a file is in the way; remove it, or name another folder (--out)")
    if not is_ours(place) and any(place.iterdir()):
        raise StorageError(
            f"{place}: the folder exists and is not a run of gw-exudyn (it holds no {MANIFEST} of ours), "
            "so it is left alone; empty or remove it, or name another folder (--out)"
        )


def _place(folder: str | Path) -> Path:
    """The folder's real path: behind a symbolic link, the folder that it names is replaced, not the link."""
    return Path(os.path.realpath(folder))


def _siblings(place: Path, state: str) -> list[Path]:
    with suppress(OSError):
        prefix = f".{place.name}.{state}-"
        return sorted(path for path in place.parent.iterdir() if path.name.startswith(prefix))
    return []


def _start_writing(place: Path) -> tuple[Path, int | None]:
    """A new hidden folder beside `place`, and the lock on it."""
    for _ in range(_ATTEMPTS):
        writing = place.with_name(f".{place.name}.writing-{secrets.token_hex(4)}")
        writing.mkdir()
        lock = _lock(writing)
        # Between the two lines above another writer may have taken the folder for a leftover.
        if writing.is_dir():
            return writing, lock
        _unlock(lock)
    raise StorageError(f"{place}: other processes keep removing what is written beside it; name another folder (--out)")


def _swap_in(writing: Path, place: Path) -> None:
    """Rename `writing` to `place`, after moving away what is there; again, if another writer came between."""
    moved: list[Path] = []
    # The lock keeps a writer that tidies up from removing the older run before the new one is in.
    lock = _lock(place, wait=False)
    try:
        for _ in range(_ATTEMPTS):
            refuse_foreign(place)
            old = place.with_name(f".{place.name}.replaced-{secrets.token_hex(4)}")
            if _rename_if_there(place, old):
                moved.append(old)
            if _renamed_unless_taken(writing, place):
                break
        else:
            raise StorageError(f"{place}: other processes keep writing to it; name another folder (--out)")
    except BaseException:  # Ctrl-C as well: the older run goes back before anything else happens
        _put_back(moved, place)
        raise
    finally:
        _unlock(lock)
    for old in moved:
        _remove_old(old)


def _renamed_unless_taken(writing: Path, place: Path) -> bool:
    try:
        os.rename(writing, place)
    except OSError as error:
        if error.errno in (errno.ENOTEMPTY, errno.EEXIST):
            return False
        raise
    return True


def _rename_if_there(place: Path, old: Path) -> bool:
    try:
        os.rename(place, old)
    except FileNotFoundError:
        return False
    return True


def _put_back(moved: list[Path], place: Path) -> None:
    if moved and moved[-1].exists() and not os.path.lexists(place):
        os.rename(moved[-1], place)


def _remove_leftovers(place: Path) -> None:
    """Remove what killed writers left. What can't be removed, or may still be in use, stays, under its telling name."""
    for leftover in _siblings(place, "writing"):
        lock = _lock(leftover, wait=False)
        if lock is not None:
            _discard(leftover, lock)
    if not is_ours(place):
        return
    for old in _siblings(place, "replaced"):
        lock = _lock(old, wait=False)
        if lock is not None:
            _remove_old(old)
            _unlock(lock)


def _remove_old(old: Path) -> None:
    # Without its run.json the folder is no run, so that a kill in the midst of this leaves nothing that `recover`
    # would take for one.
    with suppress(OSError):
        (old / MANIFEST).unlink(missing_ok=True)
    shutil.rmtree(old, ignore_errors=True)


def _discard(writing: Path, lock: int | None) -> None:
    """Remove a hidden folder (gone already if it was renamed into its place) and give up its lock."""
    shutil.rmtree(writing, ignore_errors=True)
    _unlock(lock)


def _sync_folder(folder: Path) -> None:
    """Have the system write the folder's list of names to the disk, where it can."""
    if sys.platform == "win32":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):  # not every file system does this for folders
            os.fsync(handle)
    finally:
        os.close(handle)


def _lock(folder: Path, wait: bool = True) -> int | None:
    """Lock a folder for as long as this process lives; None where that can't be had (without `wait`: also where
    another process has it).
    """
    if sys.platform == "win32":
        return None
    import fcntl

    try:
        handle = os.open(folder, os.O_RDONLY)
    except OSError:
        return None
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except OSError:
        os.close(handle)
        return None
    return handle


def _unlock(lock: int | None) -> None:
    if lock is not None:
        os.close(lock)


@contextmanager
def _as_storage_error(place: Path) -> Iterator[None]:
    """Whatever the system refuses within, as a StorageError with a remedy."""
    try:
        yield
    except OSError as error:
        raise StorageError(f"{place}: can't be written: {_reason(error)}; {_remedy(error)}") from error


def _reason(error: OSError) -> str:
    return f"{error.strerror or error}{f' ({error.filename})' if error.filename else ''}"


def _remedy(error: OSError) -> str:
    if error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):
        return (
            "free some space, or name a folder on another disk (--out); "
            "nothing of the run was kept, and what was there before is untouched"
        )
    if error.errno in (errno.EACCES, errno.EPERM, errno.EROFS):
        return "name a folder that you may write to (--out)"
    if error.errno in (errno.ENOTDIR, errno.EEXIST):
        return "a file is where a folder is needed; name another folder (--out)"
    if error.errno == errno.EBUSY:
        return "it is in use or a mount point; name a folder inside it (--out)"
    return "name another folder (--out)"
