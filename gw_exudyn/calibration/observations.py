"""What was measured, set against a simulated course: residuals in units of their noise."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from gw_exudyn.calibration.form import TIP
from gw_exudyn.comparison import PATH, Course, at
from gw_exudyn.errors import ComparisonError
from gw_exudyn.measured import aligned
from gw_exudyn.result import Floats

_SAME_TIME = 1e-9
"""s; instants closer than this are one."""

_ALIGNED = 3
"""Values that turning and shifting a path takes from its data: an angle and two shifts."""


@dataclass(frozen=True, eq=False)
class Channel:
    """One measured quantity of one file against the simulated: (k,) each, in SI but for the residuals, which are
    (fitted - measured) / noise.
    """

    file: str
    quantity: str
    noise: float
    time: Floats
    measured: Floats
    fitted: Floats

    @property
    def residuals(self) -> Floats:
        """(k,) In units of the noise."""
        apart: Floats = (self.fitted - self.measured) / self.noise
        return apart


class Observations:
    """Measured courses, cut to the time that is simulated.

    end : s, of the simulation. Raises ComparisonError where nothing of a course lies in its time.
    """

    def __init__(self, measured: Sequence[Course], noise: Mapping[str, float], align: bool, end: float) -> None:
        self._noise = noise
        self.courses = [_until(course, end) for course in measured]
        self.left_out = sum(len(course.time) for course in measured) - sum(len(course.time) for course in self.courses)
        self.end = max(float(course.time[-1]) for course in self.courses)
        self._turned = [align and all(name in course.values for name in PATH) for course in self.courses]
        self.taken = _ALIGNED * sum(self._turned)
        """Values that aligning takes from the data, besides the parameters."""

    def channels(self, simulated: Course) -> Iterator[Channel]:
        """Each quantity of each file beside the simulated one."""
        for measured, turned in zip(self.courses, self._turned, strict=True):
            course = aligned(measured, simulated) if turned else measured
            for name, values in course.values.items():
                noise = self._noise.get(TIP if name in PATH else name)
                known = np.isfinite(values)
                if noise is not None and known.any():
                    time = course.time[known]
                    yield Channel(measured.name, name, noise, time, values[known], at(simulated, name, time))

    def residuals(self, simulated: Course) -> Floats:
        """(k,) All residuals, in units of their noise; NaN where the simulated course ends too early."""
        found = np.concatenate([channel.residuals for channel in self.channels(simulated)])
        return found if self.covers(simulated) else np.full_like(found, np.nan)

    def covers(self, simulated: Course) -> bool:
        """Whether a simulated course goes on to the last of the measured instants."""
        return bool(simulated.time[-1] >= self.end - _SAME_TIME)

    def times(self) -> Floats:
        """(k,) s. All instants at which something was measured."""
        return np.unique(np.concatenate([course.time for course in self.courses]))

    def quantities(self) -> set[str]:
        """What is fitted to, by name."""
        present = {name for course in self.courses for name in course.values}
        return {name for name in present if (TIP if name in PATH else name) in self._noise}


def _until(course: Course, end: float) -> Course:
    within = (course.time >= -_SAME_TIME) & (course.time <= end + _SAME_TIME)
    if not within.any():
        raise ComparisonError(
            f"{course.name} ({course.time[0]:g} to {course.time[-1]:g} s) has no time in common with the simulation "
            f"(0 to {end:g} s)"
        )
    cut = {name: values[within] for name, values in course.values.items()}
    return replace(course, time=course.time[within], values=cut)
