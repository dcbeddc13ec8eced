"""The worker process of one FMU instance: `python -m gw_exudyn.fmi.worker RESOURCES`, started by the native wrapper.

It greets the wrapper before it loads the heavy packages, so that they load while the host prepares.
"""

from __future__ import annotations

import contextlib
import gc
import struct
import sys
import time
from collections.abc import Callable, Sequence
from typing import Protocol

import gw_exudyn
from gw_exudyn.errors import GwError
from gw_exudyn.fmi import channel as words
from gw_exudyn.fmi.channel import Channel, HostGone, Request, end_with_the_host, pack_texts, unpack_texts

_SIGN_OF_LIFE = 0.5
"""Seconds between two signs of life during a long step."""


class Plant(Protocol):
    """What a worker drives."""

    @property
    def time(self) -> float:
        """Time reached, s."""

    def start(self, numbers: bytes, texts: Sequence[str]) -> None:
        """Begin anew with these values of everything that can be set."""

    def step(self, target: float, numbers: bytes, alive: Callable[[], None]) -> int:
        """Go to a time, s; DONE, STOPPED or FAILED. Calls alive() now and then."""

    def outputs(self) -> tuple[bytes, Sequence[str]]:
        """The outputs: doubles, and texts, the first of which says how the run ended."""

    def get_state(self) -> bytes:
        """Everything that the further course depends on."""

    def set_state(self, state: bytes) -> None:
        """Go on from a state."""


def serve(channel: Channel, make: Callable[[], Plant]) -> None:
    """Answer requests until the host is gone. What goes wrong is answered with a sentence.

    The plant is made before the first request, in the time that the host takes for its own preparations. Where it can't
    be, the first request tries again, and is told why.
    """
    plant: Plant | None = None
    with contextlib.suppress(Exception):
        plant = make()
    while True:
        request = channel.receive()
        try:
            if plant is None:
                plant = make()
            _answer(channel, plant, request)
        except HostGone:
            raise
        except GwError as error:
            _refuse(channel, str(error))
        except MemoryError:
            _refuse(channel, "there is not enough memory; use fewer segments (wire.segments)")
        except ImportError as error:
            from gw_exudyn.fmi.resources import how_to_install

            _refuse(channel, f"{error}; gw-exudyn lacks what it needs, {how_to_install(gw_exudyn.__version__)}")
        except Exception as error:
            import traceback

            sys.stderr.write("".join(traceback.format_exception(error)))
            _refuse(channel, f"gw-exudyn made a mistake ({type(error).__name__}: {error}); this is a bug, report it")


def _refuse(channel: Channel, sentence: str) -> None:
    channel.reply(words.REFUSED, rest=sentence.encode("utf-8", "replace"))


def _answer(channel: Channel, plant: Plant, request: Request) -> None:
    kind = words.DONE
    if request.kind == words.STEP:
        kind = plant.step(request.extra, request.numbers, _signs_of_life(channel))
    elif request.kind == words.START:
        plant.start(request.numbers, unpack_texts(request.rest))
    elif request.kind == words.SET_STATE:
        plant.set_state(request.rest)
    elif request.kind == words.GET_STATE:
        channel.reply(words.STATE, rest=plant.get_state())
        return
    else:
        raise ValueError(f"request {request.kind}")
    numbers, texts = plant.outputs()
    channel.reply(kind, struct.pack("=d", plant.time) + numbers, pack_texts(texts))


def _signs_of_life(channel: Channel) -> Callable[[], None]:
    last = time.monotonic()

    def alive() -> None:
        nonlocal last
        if time.monotonic() - last > _SIGN_OF_LIFE:
            last = time.monotonic()
            channel.reply(words.ALIVE)

    return alive


def work(make: Callable[[], Plant], version: str = gw_exudyn.__version__) -> None:
    """Be the worker of the wrapper that started this process."""
    channel = Channel()
    end_with_the_host()
    channel.reply(words.HELLO, rest=version.encode())
    try:
        serve(channel, make)
    except HostGone:
        return


def main(arguments: Sequence[str]) -> None:
    """Serve the FMU whose resources are unpacked in the folder given."""
    (resources,) = arguments

    def load() -> Plant:
        # Next to nothing that is loaded here is ever freed, so looking for what could be only takes time.
        gc.disable()
        from gw_exudyn.engine.library import exudyn
        from gw_exudyn.fmi.plant import ScenarioPlant

        exudyn()
        gc.freeze()
        gc.enable()
        return ScenarioPlant(resources)

    work(load)


if __name__ == "__main__":
    main(sys.argv[1:])
