"""FMUs unpacked in the user's cache: once, whole, and as the FMU says."""

from __future__ import annotations

import json
import os
import threading
import zipfile
from pathlib import Path

import pytest

from gw_exudyn.errors import StorageError
from gw_exudyn.fmi import cache
from gw_exudyn.fmi.resources import HASHES
from gw_exudyn.fmi.session import FmuSession


@pytest.fixture(autouse=True)
def root(tmp_path, monkeypatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "gw-exudyn" / "fmu"


def test_the_second_time_nothing_is_unpacked(fmus, root):
    entry = cache.unpacked(fmus[2])
    assert entry.parent == root
    assert root.stat().st_mode & 0o777 == 0o700
    assert entry.stat().st_mode & 0o777 == 0o700
    before = {file: file.stat().st_ino for file in entry.rglob("*")}
    assert cache.unpacked(fmus[2]) == entry
    assert {file: file.stat().st_ino for file in entry.rglob("*")} == before
    assert cache.unpacked(fmus[3]) != entry


def added(entry: Path) -> None:
    (entry / "resources" / "more.py").write_text("")


def changed(entry: Path) -> None:
    (entry / "resources" / "scenario.json").write_text("{}")


def removed(entry: Path) -> None:
    (entry / "resources" / "scenario.json").unlink()


def replaced_by_a_link(entry: Path) -> None:
    file = entry / "resources" / "scenario.json"
    file.rename(entry.parent / "elsewhere")
    file.symlink_to(entry.parent / "elsewhere")


@pytest.mark.parametrize("tamper", [added, changed, removed, replaced_by_a_link])
def test_what_was_tampered_with_is_unpacked_anew(fmus, tamper):
    entry = cache.unpacked(fmus[2])
    good = {file.relative_to(entry): file.read_bytes() for file in entry.rglob("*") if file.is_file()}
    tamper(entry)
    assert cache.unpacked(fmus[2]) == entry
    files = [file for file in entry.rglob("*") if not file.is_dir()]
    assert not any(file.is_symlink() for file in files)
    assert {file.relative_to(entry): file.read_bytes() for file in files} == good


def test_an_fmu_that_is_not_what_it_says_is_refused(tmp_path):
    file = tmp_path / "a.fmu"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("resources/big", "content")
        archive.writestr(HASHES, json.dumps({"resources/big": "0" * 64}))
    with pytest.raises(StorageError, match="not those that it says"):
        FmuSession(file)


def test_many_at_once_get_one_whole_folder(fmus, root):
    found = []
    threads = [threading.Thread(target=lambda: found.append(cache.unpacked(fmus[2]))) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 8
    assert set(found) == set(root.iterdir())


def test_what_nobody_has_used_for_long_goes(fmus):
    entry = cache.unpacked(fmus[2])
    os.utime(entry, (0, 0))
    other = cache.unpacked(fmus[3])
    assert (entry.exists(), other.exists()) == (False, True)


def test_without_a_cache_folder_it_is_unpacked_apart(fmus, root):
    root.parent.write_text("in the way")
    with FmuSession(fmus[2]) as session:
        place = session.resources
        assert (place / "scenario.json").is_file()
    assert not place.exists()
