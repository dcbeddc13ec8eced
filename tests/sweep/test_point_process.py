"""The child process of a worker: a point that hangs or crashes costs itself alone, and nobody is left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import odd_runners
import pytest

from gw_exudyn.errors import SolverError
from gw_exudyn.sweep.point_process import PointProcess
from gw_exudyn.sweep.runner import Task

LIGHT = "odd_runners:LightRunner"


def task(friction: float) -> Task:
    return Task("point", {"friction": friction})


@pytest.fixture
def process():
    found = PointProcess(LIGHT, timeout=1.0)
    yield found
    found.close()


def is_alive(pid: int) -> bool:
    """Whether a process is there and no zombie."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def until(condition, seconds: float = 20.0) -> bool:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.02)
    return bool(condition())


def test_one_child_runs_one_point_after_the_other(process):
    first, second = (process.run(task(0.1)).sentence.split() for _ in range(2))
    assert (first[0], second[0]) == ("1", "2")
    assert first[1] == second[1] != str(os.getpid())


@pytest.mark.parametrize(
    ("friction", "status", "reason"),
    [
        (odd_runners.HANG, "timed_out", "longer than the limit of 1 s"),
        (odd_runners.EXIT, "crashed", "exit code 3"),
        (odd_runners.SEGFAULT, "crashed", "SIGSEGV; Fatal Python error: Segmentation fault"),
        (odd_runners.RAISE, "error", r"RuntimeError: a matrix is singular \(odd_runners.py:"),
        (odd_runners.MEMORY, "error", "not enough memory"),
    ],
)
def test_a_bad_point_is_told_and_the_next_one_runs(process, friction, status, reason):
    import re

    outcome = process.run(task(friction))
    assert outcome.status == status
    assert re.search(reason, outcome.sentence)
    assert not outcome.trusted
    assert process.run(task(0.1)).status == "completed"


def test_a_child_killed_at_work_is_a_crash_and_killed_at_rest_is_nothing(process):
    pid = int(process.run(task(0.1)).sentence.split()[1])
    os.kill(pid, signal.SIGKILL)
    assert until(lambda: not is_alive(pid))
    again = process.run(task(0.1))
    assert again.status == "completed"
    assert int(again.sentence.split()[1]) != pid


def test_close_ends_the_child_and_no_other_is_started(process):
    pid = int(process.run(task(0.1)).sentence.split()[1])
    process.close()
    assert not is_alive(pid)
    with pytest.raises(SolverError, match="the sweep has ended"):
        process.run(task(0.1))


def test_a_runner_that_cannot_be_made_is_told():
    for runner, reason in (
        ("odd_runners:NoRunner", "the licence has expired"),
        ("no_such_module:X", "No module named"),
    ):
        process = PointProcess(runner)
        with pytest.raises(SolverError, match=reason):
            process.run(task(0.1))
        process.close()


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the child notices by its pipe, when it gets to it")
def test_a_child_that_holds_the_interpreter_dies_with_a_parent_that_is_killed():
    code = (
        "import odd_runners, threading\n"
        "from gw_exudyn.sweep.point_process import PointProcess\n"
        "from gw_exudyn.sweep.runner import Task\n"
        f"process = PointProcess({LIGHT!r})\n"
        "print(process.run(Task('a', {'friction': 0.1})).sentence.split()[1], flush=True)\n"
        "process.run(Task('b', {'friction': odd_runners.HANG}))\n"
    )
    parent = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    try:
        child = int(parent.stdout.readline())
        assert is_alive(child)
    finally:
        parent.kill()
        parent.wait()
        parent.stdout.close()
    assert until(lambda: not is_alive(child), 5.0)
