"""The process that runs points, one after the other: `python -m gw_exudyn.sweep.child PARENT RUNNER`.

It ends when its parent does, however that ends: on Linux the system kills it, elsewhere a thread sees the pipe from
the parent closing. It ends as well when it has had nothing to do for a while.
"""

from __future__ import annotations

import ctypes
import faulthandler
import os
import queue
import signal
import sys
import threading
import traceback
from typing import Any, BinaryIO

from gw_exudyn.sweep.frames import receive, send

IDLE = 60.0
"""Seconds without a point after which the child ends."""

READY = "ready"
_PR_SET_PDEATHSIG = 1


def main(parent: int, runner_name: str) -> None:
    """Say that it is ready, then answer every task with its outcome."""
    _die_with(parent)
    # Answers keep the pipe to themselves; what libraries print goes where errors go.
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    faulthandler.enable()
    tasks = _incoming(sys.stdin.buffer)
    runner = _made(runner_name, answers)
    send(answers, READY)
    while True:
        try:
            task = tasks.get(timeout=IDLE)
        except queue.Empty:
            os._exit(0)
        send(answers, _outcome(runner, task))


def _die_with(parent: int) -> None:
    """Have the system kill this process when its parent ends.

    The solver may hold the interpreter for long, so a thread of ours would see it late.
    """
    if sys.platform == "linux":
        ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:  # it ended before the line above
            os._exit(1)


def _incoming(stream: BinaryIO) -> queue.SimpleQueue[Any]:
    """A queue that a thread fills with what the parent sends; the end of the pipe is the end of the process."""
    tasks: queue.SimpleQueue[Any] = queue.SimpleQueue()

    def listen() -> None:
        try:
            while True:
                tasks.put(receive(stream))
        except (EOFError, OSError):
            os._exit(1)

    threading.Thread(target=listen, daemon=True).start()
    return tasks


def _made(runner_name: str, answers: BinaryIO) -> Any:
    from gw_exudyn.sweep.runner import make_runner

    try:
        return make_runner(runner_name)
    except Exception as error:
        send(answers, f"{type(error).__name__}: {error}")
        raise


def _outcome(runner: Any, task: Any) -> Any:
    from gw_exudyn.errors import GwError
    from gw_exudyn.sweep.runner import Outcome

    try:
        return runner.run(task)
    except GwError as error:
        return Outcome("error", str(error))
    except MemoryError:
        return Outcome("error", "there was not enough memory; fewer segments or a longer output.interval need less")
    except Exception as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        where = f"{os.path.basename(place.filename)}:{place.lineno}"
        return Outcome("error", f"{type(error).__name__}: {error} ({where})")


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2])
