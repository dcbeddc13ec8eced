"""Runners that do to their process what a solver may do to it. The friction of a point says what."""

from __future__ import annotations

import ctypes
import os
import time
from pathlib import Path

from gw_exudyn.sweep.runner import Outcome, SimulationRunner, Task

HANG, EXIT, SEGFAULT, RAISE, MEMORY = 0.51, 0.52, 0.53, 0.54, 0.55


def misbehave(friction: float) -> None:
    """Do what the friction stands for; nothing for others."""
    if friction == HANG:
        end = time.monotonic() + 600
        while time.monotonic() < end:
            sum(range(10_000_000))  # holds the interpreter for long stretches, as a solver does
    elif friction == EXIT:
        os._exit(3)
    elif friction == SEGFAULT:
        ctypes.string_at(0)
    elif friction == RAISE:
        raise RuntimeError("a matrix is singular")
    elif friction == MEMORY:
        raise MemoryError


class LightRunner:
    """Simulates nothing, so that its process starts in no time."""

    def __init__(self) -> None:
        self._count = 0

    def run(self, task: Task) -> Outcome:
        """Misbehave, or say how many points this process has run and which it is."""
        misbehave(task.scenario["friction"])
        print("libraries print what they like")  # noqa: T201  # and must not disturb the answers
        self._count += 1
        return Outcome("completed", f"{self._count} {os.getpid()}", True)


class OddRunner(SimulationRunner):
    """Simulates, but for the points that misbehave."""

    def run(self, task: Task) -> Outcome:
        """Misbehave or simulate."""
        misbehave(task.scenario["contact"]["friction_coefficient"])
        return super().run(task)


class NoRunner:
    """Cannot be made."""

    def __init__(self) -> None:
        raise OSError("the licence has expired")


class SlowRunner(SimulationRunner):
    """Takes its time, and leaves a note of every point that it begins in the folder of $SLOW_NOTES."""

    def run(self, task: Task) -> Outcome:
        """Note, wait, simulate."""
        with open(Path(os.environ["SLOW_NOTES"], task.id), "a") as notes:
            notes.write(f"{os.getpid()}\n")
        time.sleep(float(os.environ.get("SLOW_SECONDS", "0.3")))
        return super().run(task)
