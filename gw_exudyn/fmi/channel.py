"""The worker's end of the channel to the native wrapper (fmu/request.c speaks the same): a head, numbers, bytes.

Also what makes the worker end with its host, however busy it is. Imports next to nothing: it is there before the
heavy packages are loaded.
"""

from __future__ import annotations

import os
import struct
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass

START, STEP, GET_STATE, SET_STATE = 1, 2, 3, 4
HELLO, DONE, STOPPED, FAILED, REFUSED, ALIVE, STATE = 100, 101, 102, 103, 104, 105, 106

_HEAD = struct.Struct("=IIII")
_CHANNEL, _LIFELINE = 3, 4
_SPIN, _QUICK = 200e-6, 500e-6
"""How long, s, the next request is awaited without sleep, since a waking costs more than a quick host takes; not where
the last one was awaited for longer than the second of these, which that of a quick host is not even with a waking."""

_BLOCK = 1 << 16
_WINDOWS = sys.platform == "win32"


class HostGone(Exception):  # noqa: N818  # the usual end, no error
    """The host has closed its end."""


@dataclass(frozen=True)
class Request:
    """What the wrapper asks. extra : the number that belongs to the request itself. numbers : bytes of the values that
    can be set, doubles. rest : texts, or a state."""

    kind: int
    extra: float
    numbers: bytes
    rest: bytes


class Channel:
    """The wrapper's requests and our replies. Everything else that this process prints goes nowhere near it."""

    def __init__(self) -> None:
        if _WINDOWS:
            self._reading, self._writing = _private_standard_streams()
        else:
            self._reading = self._writing = _CHANNEL
            os.set_inheritable(_CHANNEL, False)
            os.set_blocking(_CHANNEL, False)
            os.set_blocking(2, False)  # last words that nobody reads must not hold us up
        self._held = b""
        self._slow = False

    def receive(self) -> Request:
        """The next request. Raises HostGone at the end."""
        kind, numbers, size, _ = _HEAD.unpack(self._take(_HEAD.size))
        values = self._take(8 * numbers)
        return Request(kind, struct.unpack_from("=d", values)[0], values[8:], self._take(size) if size else b"")

    def reply(self, kind: int, numbers: bytes = b"", rest: bytes = b"") -> None:
        """Send a reply; numbers : doubles as bytes."""
        self._send(_HEAD.pack(kind, len(numbers) // 8, len(rest), 0) + numbers + rest)

    def _take(self, size: int) -> bytes:
        if len(self._held) < size:
            parts, there = [self._held], len(self._held)
            while there < size:
                parts.append(self._read())
                there += len(parts[-1])
            self._held = b"".join(parts)
        taken, self._held = self._held[:size], self._held[size:]
        return taken

    def _read(self) -> bytes:
        began = time.perf_counter()
        until = began if self._slow else began + _SPIN
        while True:
            try:
                block = os.read(self._reading, _BLOCK)
            except BlockingIOError:
                if time.perf_counter() < until:
                    os.sched_yield()
                else:
                    _wait(self._reading, writing=False)
                continue
            except ConnectionError:
                block = b""
            if not block:
                raise HostGone
            self._slow = time.perf_counter() - began > _QUICK
            return block

    def _send(self, data: bytes) -> None:
        rest = memoryview(data)
        while rest:
            try:
                rest = rest[os.write(self._writing, rest) :]
            except BlockingIOError:
                _wait(self._writing, writing=True)
            except OSError as error:
                raise HostGone from error


def _wait(descriptor: int, *, writing: bool) -> None:
    import select

    watch = select.poll()
    watch.register(descriptor, select.POLLOUT if writing else select.POLLIN)
    watch.poll()


def _private_standard_streams() -> tuple[int, int]:
    """On Windows the channel comes as stdin and stdout: keep copies, and let the streams themselves go nowhere."""
    if sys.platform != "win32":
        raise NotImplementedError
    import msvcrt

    reading, writing = os.dup(0), os.dup(1)
    for descriptor in (reading, writing):
        msvcrt.setmode(descriptor, os.O_BINARY)
    nowhere = os.open(os.devnull, os.O_RDWR)
    os.dup2(nowhere, 0)
    os.dup2(nowhere, 1)
    os.close(nowhere)
    return reading, writing


def end_with_the_host() -> None:
    """See that this process ends when the host does; on Windows the wrapper's job object does that.

    The host holds the other end of the lifeline and never writes to it, so a signal about it can only mean that it is
    closed; the signal's default action ends us even in the middle of a solver step. A process that the host forked may
    hold a copy of that end: where the system tells of a process's end, that counts too.
    """
    if sys.platform == "win32":
        return
    import _thread
    import fcntl
    import select
    import signal

    os.set_inheritable(_LIFELINE, False)
    os.closerange(_LIFELINE + 1, 1024)  # whatever else the host left open
    signal.signal(signal.SIGIO, signal.SIG_DFL)
    fcntl.fcntl(_LIFELINE, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(_LIFELINE, fcntl.F_SETFL, fcntl.fcntl(_LIFELINE, fcntl.F_GETFL) | os.O_ASYNC)
    watched = select.poll()
    watched.register(_LIFELINE, select.POLLIN)
    if hasattr(os, "pidfd_open"):
        try:
            watched.register(os.pidfd_open(os.getppid()), select.POLLIN)
        except OSError:  # an old kernel, or the host is gone already
            if os.getppid() == 1:
                os._exit(0)
    if watched.poll(0):
        os._exit(0)

    def watch() -> None:
        watched.poll()
        os._exit(0)

    _thread.start_new_thread(watch, ())


def pack_texts(texts: Sequence[str]) -> bytes:
    """Texts, each after its length."""
    return b"".join(struct.pack("=I", len(text)) + text for text in (t.encode("utf-8", "replace") for t in texts))


def unpack_texts(data: bytes) -> list[str]:
    """The texts again."""
    texts, place = [], 0
    while place < len(data):
        (size,) = struct.unpack_from("=I", data, place)
        texts.append(data[place + 4 : place + 4 + size].decode("utf-8", "replace"))
        place += 4 + size
    return texts
