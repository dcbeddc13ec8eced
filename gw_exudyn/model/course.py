"""A quantity over time, piecewise linear: the speed or the force that a drive is to have."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Course:
    """A table, linear in between, held after its end.

    time : (k,), s, rising, two equal times make a step. value : (k,). area : (k,), a start and the integral up to each
        time.
    """

    time: Floats
    value: Floats
    area: Floats

    @classmethod
    def of(cls, time: ArrayLike, value: ArrayLike, start: float = 0.0) -> Course:
        """The table with its integral, which begins at `start`."""
        t, v = np.asarray(time, dtype=float), np.asarray(value, dtype=float)
        return cls(t, v, start + np.concatenate([[0.0], np.cumsum(np.diff(t) * (v[1:] + v[:-1]) / 2)]))

    def at(self, time: float) -> float:
        """The value at a time, s; at a step of the table the later one."""
        return self._in_row(time, self._row(time))

    def area_to(self, time: float) -> float:
        """The start and the integral from 0 to a time, s."""
        i = self._row(time)
        mean = (float(self.value[i]) + self._in_row(time, i)) / 2
        return float(self.area[i]) + mean * (time - float(self.time[i]))

    def between(self, begin: float, end: float) -> Floats:
        """The values of the rows from `begin` to `end`, s."""
        return self.value[(self.time >= begin) & (self.time <= end)]

    def extreme_areas(self) -> tuple[float, float]:
        """Least and largest integral up to the table's end; a turning point between two rows is found too."""
        times = [float(t) for t in self.time]
        for i in range(len(times) - 1):
            before, after = float(self.value[i]), float(self.value[i + 1])
            if before * after < 0 and times[i + 1] > times[i]:
                times.append(times[i] + (times[i + 1] - times[i]) * before / (before - after))
        areas = [self.area_to(t) for t in times]
        return min(areas), max(areas)

    def _row(self, time: float) -> int:
        return max(0, int(np.searchsorted(self.time, time, side="right")) - 1)

    def _in_row(self, time: float, i: int) -> float:
        if i + 1 >= len(self.time):
            return float(self.value[-1])
        span = float(self.time[i + 1] - self.time[i])
        part = (time - float(self.time[i])) / span if span > 0 else 0.0
        return float(self.value[i]) + part * float(self.value[i + 1] - self.value[i])
