"""Ctrl-C during a simulation: the first ends it cleanly, so that what it has got to is kept; the second gives it up."""

from __future__ import annotations

import signal
from types import FrameType, TracebackType
from typing import Any, Self

from gw_exudyn.cli.console import tell

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Stop:
    """While in use, Ctrl-C (or a polite kill) is noted instead of raised; a simulation asks `should_stop`."""

    def __init__(self) -> None:
        self._count = 0
        self._before: dict[signal.Signals, Any] = {}

    def __enter__(self) -> Self:
        """Take over the signals; where that can't be had (outside the main thread) they stay as they are."""
        for number in _SIGNALS:
            try:
                self._before[number] = signal.signal(number, self._note)
            except ValueError:
                break
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Give the signals back. Whatever goes wrong after somebody asked twice comes of that, and is a
        KeyboardInterrupt."""
        for number, handler in self._before.items():
            signal.signal(number, handler if handler is not None else signal.SIG_DFL)
        if self._count > 1 and isinstance(error, Exception):
            raise KeyboardInterrupt from error

    @property
    def asked(self) -> bool:
        """Whether anybody wants to stop."""
        return self._count > 0

    def should_stop(self) -> bool:
        """The same, to be called by a simulation."""
        return self.asked

    def leave_if_pressed_again(self) -> None:
        """Raise KeyboardInterrupt if somebody asked twice: nothing is to be kept then."""
        if self._count > 1:
            raise KeyboardInterrupt

    def _note(self, number: int, frame: FrameType | None) -> None:
        self._count += 1
        if self._count == 1:
            tell("stopping; what is done is kept (again: give it up)")
        else:
            raise KeyboardInterrupt
