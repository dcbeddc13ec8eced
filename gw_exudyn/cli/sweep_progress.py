"""Progress of a sweep on stderr, and Ctrl-C during it."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from gw_exudyn.cli.console import stderr_console, tell
from gw_exudyn.cli.stopping import Stop

if TYPE_CHECKING:
    from gw_exudyn.sweep.plan import Options, Progress

_SECONDS_A_LINE = 10.0
"""Between two lines of progress where stderr is no terminal."""


def cores() -> int:
    """Processor cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@contextmanager
def checking(points: int, quiet: bool) -> Iterator[Callable[[int], None]]:
    """Give a function to call with the number of points that were checked."""
    last = time.monotonic()

    def look(checked: int) -> None:
        nonlocal last
        if not quiet and time.monotonic() - last >= _SECONDS_A_LINE:
            last = time.monotonic()
            tell(f"checked {checked} of {points} points")

    yield look


@contextmanager
def running(name: str, options: Options, quiet: bool) -> Iterator[tuple[Callable[[Progress], None], Stop]]:
    """Give a function that shows how far a sweep is, and what notes Ctrl-C."""
    console = stderr_console()
    with Stop() as stop:
        if quiet:
            yield lambda _: None, stop
        elif not console.is_terminal:
            yield _Lines(name).report, stop
        else:
            from rich.progress import BarColumn, TextColumn
            from rich.progress import Progress as Bars

            columns = (TextColumn("{task.description}", markup=False), BarColumn(), TextColumn("{task.fields[told]}"))
            with Bars(*columns, console=console, transient=True) as bars:
                task = bars.add_task(name, total=None, told="starting")
                clock = _Clock()

                def report(progress: Progress) -> None:
                    done = progress.earlier + progress.done
                    bars.update(task, completed=done, total=progress.points, told=_told(progress, clock))

                yield report, stop


class _Clock:
    """Time since the first point came in, which leaves out the start of the workers."""

    def __init__(self) -> None:
        self._first: tuple[float, int] | None = None

    def left(self, progress: Progress) -> float | None:
        """Seconds left by the rate so far; None where there is none yet."""
        if progress.done and self._first is None:
            self._first = time.monotonic(), progress.done
        if self._first is None:
            return None
        began, done = self._first
        if progress.done == done:
            return None
        rate = (progress.done - done) / (time.monotonic() - began)
        return (progress.points - progress.earlier - progress.done) / rate


class _Lines:
    """A line of progress from time to time."""

    def __init__(self, name: str) -> None:
        self._name, self._clock, self._last = name, _Clock(), float("-inf")

    def report(self, progress: Progress) -> None:
        """Show it, if it is time."""
        now = time.monotonic()
        if now - self._last >= _SECONDS_A_LINE or progress.earlier + progress.done == progress.points:
            self._last = now
            tell(f"{self._name}: {_told(progress, self._clock)}")


def _told(progress: Progress, clock: _Clock) -> str:
    done = f"{progress.earlier + progress.done} of {progress.points} done, {progress.failed} failed"
    if not progress.threads and progress.earlier < progress.points and not progress.done:
        return f"{done}, waiting for workers"
    left = clock.left(progress)
    if progress.earlier + progress.done == progress.points or left is None:
        return done
    return f"{done}, {_duration(left)} left"


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
