"""Time series of many points, packed small: as many as a page takes without growing heavy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from gw_exudyn.report.pack import LEVELS, NO_NUMBER
from gw_exudyn.report.packing import base64_text, floats, spread

if TYPE_CHECKING:
    from gw_exudyn.result import Floats

ROOM = 1_400_000
"""Bytes for all curves of a page, before base64."""

_MOST, _FEWEST = 300, 30
"""Instants of a curve."""


@dataclass(frozen=True)
class Curves:
    """time : (t,) s, of all points; None where `series` has each point's own. series : (points, t) in SI by name."""

    time: Floats | None
    series: dict[str, Floats]

    def packed(self) -> dict[str, Any]:
        """For the page's scripts: 16 bits a number, between the lowest and the highest of its point."""
        length = next(iter(self.series.values())).shape[1]
        time = None if self.time is None else floats(self.time)
        return {"time": time, "length": length, "series": {name: _levels(x) for name, x in self.series.items()}}


def _levels(values: Floats) -> dict[str, str]:
    known = np.isfinite(values)
    low = np.where(known, values, np.inf).min(axis=1, initial=np.inf)
    high = np.where(known, values, -np.inf).max(axis=1, initial=-np.inf)
    low, high = (np.where(np.isfinite(end), end, 0.0) for end in (low, high))
    span = np.where(high > low, high - low, 1.0)[:, None]
    levels = np.where(known, np.where(known, values - low[:, None], 0.0) / span * LEVELS, NO_NUMBER)
    return {"values": base64_text(levels.round(), "<u2"), "ends": floats(np.stack([low, high], axis=1).ravel())}


def chosen(names: Sequence[str], points: int, length: int, always: int, room: int = ROOM) -> tuple[list[str], Floats]:
    """Which of the curves a page takes, and at which of their instants: fewer curves before too few instants.

    names : dearest first; the first `always` are of no use without each other. Empty where not even those have room.
    """
    for count in range(len(names), always - 1, -1):
        instants = (room // (points * max(count, 1)) - 8) // 2
        if instants >= min(length, _FEWEST * 2 if count > always else _FEWEST):
            return list(names[:count]), spread(length, min(length, _MOST, instants))
    return [], spread(length, 2)
