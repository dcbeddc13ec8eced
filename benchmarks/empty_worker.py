"""A worker with an empty model, to see what the channel alone costs."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from gw_exudyn.fmi.channel import DONE
from gw_exudyn.fmi.resources import read_table
from gw_exudyn.fmi.variables import OUTPUT, TEXT
from gw_exudyn.fmi.worker import work


class EmptyPlant:
    """Computes nothing; its outputs are zero."""

    def __init__(self, resources: str) -> None:
        table = read_table(Path(resources))
        self._outputs = bytes(8 * sum(v.size for v in table if v.role == OUTPUT and v.kind != TEXT))
        self.time = 0.0

    def start(self, numbers: bytes, texts: Sequence[str]) -> None:
        """Begin anew."""
        self.time = 0.0

    def step(self, target: float, numbers: bytes, alive: Callable[[], None]) -> int:
        """Be there."""
        self.time = target
        return DONE

    def outputs(self) -> tuple[bytes, Sequence[str]]:
        """Zeros."""
        return self._outputs, [""]

    def get_state(self) -> bytes:
        """Nothing."""
        return b" "

    def set_state(self, state: bytes) -> None:
        """Nothing."""


if __name__ == "__main__":
    work(lambda: EmptyPlant(sys.argv[1]))
