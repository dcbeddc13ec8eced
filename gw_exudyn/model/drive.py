"""The drive: how far the proximal end has been moved at a time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from gw_exudyn.scenario import SpeedDrive

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Drive:
    """A prescribed speed along the catheter's axis, positive into the vessel: a table until somebody takes over.

    time : (k,), s, rising, two equal times make a step. speed : (k,), m/s, linear in between, held after the end.
    travelled : (k,), m, the length inserted at the start and the integral of the speed up to each time.
    taken_over : None, or (time, position, speed) from which on the speed comes from outside and is constant.
    """

    time: Floats
    speed: Floats
    travelled: Floats
    taken_over: tuple[float, float, float] | None = None

    def position_at(self, time: float) -> float:
        """Length inserted, m, at a time, s."""
        if self.taken_over is not None and time >= self.taken_over[0]:
            since, position, speed = self.taken_over
            return position + speed * (time - since)
        i = self._row(time)
        passed = time - float(self.time[i])
        mean = (float(self.speed[i]) + self._table_speed(time, i)) / 2
        return float(self.travelled[i]) + mean * passed

    def speed_at(self, time: float) -> float:
        """Speed, m/s; at a step of the table the later one."""
        if self.taken_over is not None and time >= self.taken_over[0]:
            return self.taken_over[2]
        return self._table_speed(time, self._row(time))

    def fastest(self, begin: float, end: float) -> float:
        """Largest speed, m/s, without its sign, between two times."""
        speeds = [self.speed_at(begin), self.speed_at(end)]
        if self.taken_over is None:
            speeds += list(self.speed[(self.time >= begin) & (self.time <= end)])
        return float(np.abs(speeds).max())

    def extremes(self) -> tuple[float, float]:
        """Least and largest length inserted until the table ends, m; a turning point inside a ramp is found too."""
        times = [float(t) for t in self.time]
        for i in range(len(times) - 1):
            before, after = float(self.speed[i]), float(self.speed[i + 1])
            if before * after < 0 and times[i + 1] > times[i]:
                times.append(times[i] + (times[i + 1] - times[i]) * before / (before - after))
        travels = [self.position_at(t) for t in times]
        return min(travels), max(travels)

    def taken_over_at(self, time: float, speed: float) -> Drive:
        """The constant `speed` from `time` on, without a jump in travel.

        What an earlier take-over did is forgotten: before `time` the result is the table again, so ask it only later.
        """
        return replace(self, taken_over=(time, self.position_at(time), speed))

    def _row(self, time: float) -> int:
        return max(0, int(np.searchsorted(self.time, time, side="right")) - 1)

    def _table_speed(self, time: float, i: int) -> float:
        if i + 1 >= len(self.time):
            return float(self.speed[-1])
        span = float(self.time[i + 1] - self.time[i])
        part = (time - float(self.time[i])) / span if span > 0 else 0.0
        return float(self.speed[i]) + part * float(self.speed[i + 1] - self.speed[i])


def build_drive(spec: SpeedDrive) -> Drive:
    """The drive of a scenario."""
    time, speed = np.array(spec.time), np.array(spec.speed)
    steps = np.diff(time) * (speed[1:] + speed[:-1]) / 2
    return Drive(time, speed, spec.start + np.concatenate([[0.0], np.cumsum(steps)]))
