"""The drives: what moves the proximal end along the catheter's axis, positive into the vessel.

`Drive` and `TipSpeed` place the end (a position at every time), `Force` acts on a hub that moves as it will.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.model.course import Course
from gw_exudyn.model.tip_speed import Leg, TipSpeed

if TYPE_CHECKING:
    from gw_exudyn.scenario import ForceDrive, SpeedDrive, TipSpeedDrive


@dataclass(frozen=True)
class Drive:
    """A prescribed speed: a table until somebody takes over.

    course : speed over time, m/s; its area is the length inserted. taken_over : empty, or (time, position, speed) from
        which on the speed comes from outside and is constant.
    """

    course: Course
    taken_over: tuple[float, ...] = ()

    def position_at(self, time: float) -> float:
        """Length inserted, m, at a time, s."""
        if self.taken_over and time >= self.taken_over[0]:
            since, position, speed = self.taken_over
            return position + speed * (time - since)
        return self.course.area_to(time)

    def speed_at(self, time: float) -> float:
        """Speed, m/s; at a step of the table the later one."""
        if self.taken_over and time >= self.taken_over[0]:
            return self.taken_over[2]
        return self.course.at(time)

    def fastest(self, begin: float, end: float) -> float:
        """Largest speed, m/s, without its sign, between two times."""
        speeds = [self.speed_at(begin), self.speed_at(end)]
        if not self.taken_over:
            speeds += list(self.course.between(begin, end))
        return float(np.abs(speeds).max())

    def extremes(self) -> tuple[float, float]:
        """Least and largest length inserted until the table ends, m; a turning point inside a ramp is found too."""
        return self.course.extreme_areas()

    def taken_over_at(self, time: float, speed: float) -> Drive:
        """The constant `speed` from `time` on, without a jump in travel.

        What an earlier take-over did is forgotten: before `time` the result is the table again, so ask it only later.
        """
        return replace(self, taken_over=(time, self.position_at(time), speed))


@dataclass(frozen=True)
class Force:
    """A prescribed force on a hub of this mass (kg) and damping (N s/m), which moves along the axis and does not turn.

    course : force over time, N. taken_over : empty, or (time, force) from which on it comes from outside.
    """

    course: Course
    hub_mass: float
    hub_damping: float
    taken_over: tuple[float, ...] = ()

    def force_at(self, time: float) -> float:
        """Force on the hub, N; at a step of the table the later one."""
        if self.taken_over and time >= self.taken_over[0]:
            return self.taken_over[1]
        return self.course.at(time)

    def taken_over_at(self, time: float, force: float) -> Force:
        """The constant `force` from `time` on."""
        return replace(self, taken_over=(time, force))


AnyDrive = Drive | Force | TipSpeed


def build_drive(spec: SpeedDrive | ForceDrive | TipSpeedDrive) -> AnyDrive:
    """The drive of a scenario."""
    if spec.kind == "force":
        return Force(Course.of(spec.time, spec.force), spec.hub_mass, spec.hub_damping)
    course = Course.of(spec.time, spec.speed, spec.start)
    if spec.kind == "speed":
        return Drive(course)
    return TipSpeed(course, spec.max_speed, spec.force_limit, Leg(position=spec.start))
