"""Ctrl-C during a solver step: it waits for the step's end, so that the state stays whole."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def after_the_step() -> Iterator[None]:
    """Hold back Ctrl-C, and raise its KeyboardInterrupt when the block is done.

    Exudyn turns an exception out of its callbacks into one of its own, with the step half done. Only where Python's own
    handler is in place; another one, or another thread, is left alone.
    """
    ours = threading.current_thread() is threading.main_thread()
    if not ours or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield
        return
    asked: list[int] = []
    signal.signal(signal.SIGINT, lambda number, _frame: asked.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if asked:
        raise KeyboardInterrupt
