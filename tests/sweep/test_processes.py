"""Sweeps as processes: killed, interrupted, and on a scheduler that was there before."""

from __future__ import annotations

import hashlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
import slow_sweep

from gw_exudyn.simulation import simulate
from gw_exudyn.storage.series import series_text
from gw_exudyn.sweep.run import run_sweep

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="looks at processes in /proc")

HERE = Path(__file__).parent
OUT = Path("out")
POINTS = "contact.friction_coefficient: {linspace: [0.1, 0.4, 8]}"
# About half a second a point.
LONGER = "{wire.segments: 10, solver.step: 5 ms, output.interval: 0.5 s, drive.distance: 6 mm}"


def until(condition: Callable[[], object], seconds: float = 90.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it did not come about"
        time.sleep(0.05)


def finished() -> set[Path]:
    return set(OUT.glob("points/*/run.json"))


def alive() -> dict[int, int]:
    """Parent of every process that is there and no zombie."""
    found = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, parent = stat.read_text().rpartition(")")[2].split()[:2]
        except (FileNotFoundError, ProcessLookupError):
            continue
        if state != "Z":
            found[int(stat.parent.name)] = int(parent)
    return found


def descendants(pid: int) -> set[int]:
    parents, found = alive(), {pid}
    while more := {child for child, parent in parents.items() if parent in found} - found:
        found |= more
    return found - {pid}


@contextmanager
def started(*command: str, **further) -> Iterator[subprocess.Popen[str]]:
    """A process in a session of its own, of which nothing is left behind."""
    process = subprocess.Popen([sys.executable, *command], text=True, start_new_session=True, **further)
    try:
        yield process
    finally:
        for pid in descendants(process.pid):
            os.kill(pid, signal.SIGKILL)
        process.kill()
        process.communicate()


def test_a_sweep_that_is_killed_leaves_whole_points_and_no_process_and_goes_on(study, tmp_path, monkeypatch):
    notes = tmp_path / "notes"
    notes.mkdir()
    monkeypatch.setenv("SLOW_NOTES", str(notes))
    found = study(POINTS)
    with started(str(HERE / "slow_sweep.py"), str(found.file), "out") as process:
        until(lambda: len(finished()) >= 3)
        family = descendants(process.pid)
        assert len(family) >= 4  # two workers and their children
        process.kill()
        until(lambda: not family & alive().keys(), 10.0)
    done = {file: file.read_bytes() for file in finished()}
    assert 3 <= len(done) < 8
    assert {file.parent for file in done} == set(OUT.glob("points/*"))
    for file, content in done.items():
        digests = json.loads(content)["files"]
        for name, entry in digests.items():
            assert hashlib.sha256((file.parent / name).read_bytes()).hexdigest() == entry["sha256"]

    summary = run_sweep(found, OUT, slow_sweep.OPTIONS)
    assert (summary.earlier, summary.run, summary.completed) == (len(done), 8 - len(done), 8)
    assert {file: file.read_bytes() for file in done} == done
    assert all(len((notes / file.parent.name).read_text().splitlines()) == 1 for file in done)
    # The same bits as in one process, whoever ran the point and whatever before it.
    series = [file.read_text() for file in OUT.glob("points/*/series.csv")]
    assert sorted(series) == sorted(series_text(simulate(found.scenario(point))) for point in range(8))


def test_a_worker_that_is_killed_is_replaced_and_no_point_is_lost(study, tmp_path, monkeypatch):
    monkeypatch.setenv("SLOW_NOTES", str(tmp_path))
    found = study(POINTS)
    with started(str(HERE / "slow_sweep.py"), str(found.file), "out") as process:
        until(lambda: len(finished()) >= 2)
        parents = alive()
        worker = next(parent for child, parent in parents.items() if parent in descendants(process.pid))
        children = descendants(worker)
        os.kill(worker, signal.SIGKILL)
        assert process.wait(timeout=90) == 0
    assert not children & alive().keys()
    assert len(finished()) == 8
    assert all(json.loads(file.read_text())["trusted"] for file in finished())


def test_ctrl_c_at_the_terminal_keeps_what_is_done(write_study):
    sweep = ("-m", "gw_exudyn", "sweep", str(write_study(POINTS, set=LONGER)))
    options = ("--out", "out", "--jobs", "2", "--json")
    with started(*sweep, *options, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        until(lambda: finished() or process.poll() is not None)
        family = descendants(process.pid)
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does: to everybody
        out, err = process.communicate(timeout=60)
        assert process.returncode == 130, err
        until(lambda: not family & alive().keys(), 10.0)
    assert "points left; the same command goes on" in err
    assert "Traceback" not in err
    told = json.loads(out)
    assert told["interrupted"]
    assert told["completed"] == len(finished()) > 0
    assert len((OUT / "sweep.csv").read_text().splitlines()) == 9


def test_a_scheduler_with_two_workers_of_which_one_is_killed(write_study, tmp_path):
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    address = tmp_path / "scheduler.json"
    local = ("--host", "127.0.0.1", "--no-dashboard", "--scheduler-file", str(address))
    worker = ("-m", "dask", "worker", *local, "--nthreads", "1", "--no-nanny", "--memory-limit", "0")
    sweep = ("-m", "gw_exudyn", "sweep", str(write_study(POINTS, set=LONGER)), "--out", "out", "--no-figures")
    with started("-m", "dask", "scheduler", *local, "--port", "0", **quiet):
        until(address.exists)
        scheduler = json.loads(address.read_text())["address"]
        assert scheduler.startswith("tcp://127.0.0.1:")
        with (
            started(*worker, **quiet) as first,
            started(*worker, **quiet) as second,
            started(*sweep, "--scheduler", scheduler, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process,
        ):
            until(lambda: len(finished()) >= 2 and descendants(first.pid) and descendants(second.pid))
            orphans = descendants(first.pid)
            first.kill()
            out, err = process.communicate(timeout=120)
            assert process.returncode == 0, err
            assert out == "out\n"
            assert "8 points completed, 0 failed" in err
            until(lambda: not (orphans | descendants(second.pid)) & alive().keys(), 10.0)
            assert second.poll() is None  # it is somebody else's
