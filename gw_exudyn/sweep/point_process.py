"""A worker's child process: points run in it, so that one that hangs or crashes costs itself alone.

Exudyn holds the interpreter lock while it solves; a limit on time, or a death by a signal, can be dealt with only from
outside the process.
"""

from __future__ import annotations

import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
from contextlib import suppress
from typing import Any, BinaryIO

from gw_exudyn.errors import SolverError
from gw_exudyn.sweep.child import READY
from gw_exudyn.sweep.frames import receive, send
from gw_exudyn.sweep.runner import Outcome, Task

START_LIMIT = 300.0
"""Seconds that a child may take to get ready: the first import on a cluster's network disk is slow."""

_LAST_WORDS = 20_000  # bytes of what a child said that are looked at
_ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


class PointProcess:
    """Runs points in a child process, which is started with the first of them and again after each that killed it.

    For one thread. runner : name, as `module:Class`. timeout : s on the clock for one point; None for no limit.
    """

    def __init__(self, runner: str, timeout: float | None = None) -> None:
        self._runner, self._timeout = runner, timeout
        self._process: subprocess.Popen[bytes] | None = None
        self._answers: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._errors: Any = None
        self._closed = False

    def run(self, task: Task) -> Outcome:
        """Run a point and say how it went. Raises SolverError where no child can be had."""
        self._hand_over(task)
        try:
            answer = self._answers.get(timeout=self._timeout)
        except queue.Empty:
            self._kill()
            return Outcome("timed_out", f"The point took longer than the limit of {self._timeout:g} s.")
        return answer if isinstance(answer, Outcome) else self._after_crash()

    def close(self) -> None:
        """End the child, whatever it is doing, and start no other."""
        self._closed = True
        self._kill()

    def _hand_over(self, task: Task) -> None:
        """Send the task to a child that lives."""
        for _ in range(3):
            process = self._process if self._process is not None else self._start()
            try:
                if process.poll() is None:
                    send(_pipe(process.stdin), task)
                    return
            except OSError:
                pass
            self._kill()  # it ended while it had nothing to do, which is no fault of this point
        raise SolverError("the process that runs points ends before it gets one")

    def _start(self) -> subprocess.Popen[bytes]:
        if self._closed:
            raise SolverError("the sweep has ended")
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115  # it lives as long as the child
        command = [sys.executable, "-m", "gw_exudyn.sweep.child", str(os.getpid()), self._runner]
        self._process = process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            env={**os.environ, **dict.fromkeys(_ONE_THREAD, "1"), "MPLBACKEND": "Agg"},
            start_new_session=True,  # Ctrl-C at the terminal is for the sweep to hear
        )
        self._answers = _listen(_pipe(process.stdout))
        try:
            said = self._answers.get(timeout=START_LIMIT)
        except queue.Empty:
            said = f"it was not ready within {START_LIMIT:g} s"
        if said != READY:
            self._kill()
            raise SolverError(f"the process that runs points does not start: {said or self._last_words()}")
        return process

    def _after_crash(self) -> Outcome:
        process = self._process
        code = process.wait() if process is not None else 0
        words = self._last_words()
        self._kill()
        return Outcome("crashed", f"The point crashed its process ({_cause(code)}{f'; {words}' if words else ''}).")

    def _last_words(self) -> str:
        """The first line of how the child's end was told, as of `Fatal Python error`; empty where nothing was said."""
        try:
            size = self._errors.seek(0, os.SEEK_END)
            self._errors.seek(max(0, size - _LAST_WORDS))
            lines = self._errors.read().decode(errors="replace").splitlines()
        except (OSError, ValueError):
            return ""
        told = [line for line in lines if line.strip()]
        fatal = [line for line in told if line.startswith("Fatal Python error")]
        last: str = (fatal or told[-1:] or [""])[0]
        return last.strip()[:300]

    def _kill(self) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        with suppress(OSError):
            if sys.platform == "win32":
                process.kill()
            else:
                os.killpg(process.pid, signal.SIGKILL)  # with whatever it has started itself
        process.wait()
        with suppress(OSError):
            _pipe(process.stdin).close()
        self._errors.close()


def _pipe(stream: Any) -> BinaryIO:
    found: BinaryIO = stream
    return found


def _listen(stream: BinaryIO) -> queue.SimpleQueue[Any]:
    """A queue that a thread fills with what the child sends; None is its end."""
    answers: queue.SimpleQueue[Any] = queue.SimpleQueue()

    def listen() -> None:
        try:
            while True:
                answers.put(receive(stream))
        except Exception:  # the pipe ended, or what came out of it is no message
            answers.put(None)
        finally:
            stream.close()

    threading.Thread(target=listen, daemon=True).start()
    return answers


def _cause(code: int) -> str:
    """An exit code in words."""
    if code >= 0:
        return f"exit code {code}"
    try:
        name = signal.Signals(-code).name
    except ValueError:
        return f"signal {-code}"
    memory = ", by somebody or by a system short of memory" if name == "SIGKILL" else ""
    return f"killed by {name}{memory}"
