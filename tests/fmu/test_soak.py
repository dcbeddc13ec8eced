"""Many instances, and kills at random instants: nothing is left over, no host dies, no worker is orphaned.

Here a small number with a stand-in for the worker; with the environment variable GW_FMU_SOAK (`make soak`) a thousand
instances and a hundred kills, and both with real workers too.
"""

from __future__ import annotations

import gc
import os
import random
import signal
import subprocess
import sys
import threading
import time
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
import standin as stand
from fmpy import read_model_description
from standin import Wrapped, compile_c, processes_of, sanitizers

from gw_exudyn.fmi.resources import TABLE, Launch, table_text
from gw_exudyn.fmi.wrapper.build import fmi_headers

OK, FATAL = 0, 4
SOAK = bool(os.environ.get("GW_FMU_SOAK"))
INSTANCES, KILLS = (1000, 100) if SOAK else (1000, 10)
SEED = 20220611

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks into /proc")


@dataclass(frozen=True)
class Worker:
    """Resources and token of an FMU, and which worker it has."""

    kind: str
    folder: Path
    token: str


@pytest.fixture(params=["stand-in", *(["real"] if SOAK else [])])
def worker(request, standin) -> Worker:
    """The stand-in; in the soak the real one too."""
    return request.getfixturevalue("real") if request.param == "real" else Worker("stand-in", standin, stand.TOKEN)


@pytest.fixture(scope="session")
def real(fmus, tmp_path_factory) -> Worker:
    folder = tmp_path_factory.mktemp("gw-soak-real")
    with zipfile.ZipFile(fmus[2]) as archive:
        archive.extractall(folder)
    return Worker("real", folder / "resources", read_model_description(str(folder)).guid)


@pytest.fixture(scope="session")
def python(tmp_path_factory) -> Worker:
    """The real worker's process with an empty model: what it does about its host is all there."""
    script = Path(__file__).resolve().parents[2] / "benchmarks" / "empty_worker.py"
    package = script.parents[1]
    folder = tmp_path_factory.mktemp("gw-soak-python")
    launch = Launch(sys.executable, str(package), "", arguments=("-P", str(script)))
    from gw_exudyn import __version__

    text = table_text(stand.VARIABLES, stand.TOKEN, launch).replace("\nversion \n", f"\nversion {__version__}\n")
    (folder / TABLE).write_text(text, encoding="utf-8")
    return Worker("python", folder, stand.TOKEN)


@dataclass(frozen=True)
class Left:
    """What this process holds: open files, threads, processes of a folder, resident memory in bytes."""

    files: int
    threads: int
    processes: int
    memory: int

    @classmethod
    def now(cls, folder: Path) -> Left:
        gc.collect()
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        processes = sum(1 for _ in processes_of(folder))
        return cls(len(os.listdir("/proc/self/fd")), len(os.listdir("/proc/self/task")), processes,
                   pages * os.sysconf("SC_PAGE_SIZE"))  # fmt: skip


def one_life(native: Path, version: int, worker: Worker) -> None:
    with Wrapped(native, version, worker.folder, worker.token.encode()) as host:
        assert host.start() == OK
        for i in range(3):
            assert host.step(0.05 * i, 0.05) == OK
        if worker.kind == "stand-in":
            assert host.set("behaviour", stand.REFUSE) == OK
            assert host.step(0.15, 0.05) != OK
            assert host.call("Reset") == OK
            assert host.set("text", b"x" * 20000) == OK


@pytest.mark.parametrize("version", [2, 3])
def test_instances_leave_nothing_behind(native, worker, version):
    count = INSTANCES // 2
    for _ in range(count // 10):
        one_life(native, version, worker)
    before = Left.now(worker.folder)
    for _ in range(count):
        one_life(native, version, worker)
    after = Left.now(worker.folder)
    assert (after.files, after.threads, after.processes) == (before.files, before.threads, 0)
    # A leak of the instance itself, 25 kB with its table, would be 12 MB.
    if not sanitizers():
        assert after.memory - before.memory < 3e6


def busy(native: Path, version: int, worker: Worker) -> Iterator[int]:
    """Statuses of the start and of the steps of an instance that steps on and on; FATAL where none could be made."""
    with Wrapped(native, version, worker.folder, worker.token.encode()) as host:
        # A worker that is killed before its greeting makes no instance, which says so.
        status = host.start() if host.handle else FATAL
        assert host.handle or host.last
        yield status
        now, dt = 0.0, 1e-3
        while status == OK:
            status = host.step(now, dt)
            now += dt
            yield status


def test_a_worker_killed_at_any_instant_never_harms_its_host(native, worker):
    chance = random.Random(SEED)
    before = Left.now(worker.folder)
    for k in range(KILLS if SOAK else 3 * KILLS):
        version, after = 2 + k % 2, chance.uniform(0.0, 0.02 if worker.kind == "stand-in" else 0.5)

        def kill(after: float = after) -> None:
            time.sleep(after)
            until = time.monotonic() + 20
            while time.monotonic() < until:
                for process in processes_of(worker.folder):
                    os.kill(process, signal.SIGKILL)
                    return
                time.sleep(0.001)

        killer = threading.Thread(target=kill)
        killer.start()
        try:
            statuses = list(busy(native, version, worker))
        finally:
            killer.join()
        assert statuses == [OK] * (len(statuses) - 1) + [FATAL], (k, after)
        one_life(native, version, worker)
    after_all = Left.now(worker.folder)
    assert (after_all.files, after_all.threads, after_all.processes) == (before.files, before.threads, 0)


@pytest.mark.parametrize("which", ["python", *(["real"] if SOAK else [])])
def test_a_host_killed_at_any_instant_leaves_no_worker(native, request, tmp_path, which):
    worker: Worker = request.getfixturevalue(which)
    source = Path(__file__).with_name("life.c")
    host = compile_c(source, tmp_path / "life", f"-I{fmi_headers()}", "-ldl", *sanitizers())
    chance = random.Random(SEED)
    seen = 0
    for k in range(KILLS):
        command = [host, str(2 + k % 2), native, f"{worker.folder}/", worker.token, "0"]
        process = subprocess.Popen(command, stderr=subprocess.DEVNULL)
        try:
            time.sleep(chance.uniform(0.0, 0.5 if which == "python" else 2.0))
            seen += any(p != process.pid for p in processes_of(worker.folder))
            assert process.poll() is None  # it is the kill that ends it
        finally:
            process.kill()
            process.wait()
        until = time.monotonic() + 10
        while (orphans := list(processes_of(worker.folder))) and time.monotonic() < until:
            time.sleep(0.005)
        assert orphans == [], k
    assert seen > KILLS // 2
