"""The drive that gives the wire's tip a wanted speed along its path, by the hub's speed.

The controller decides once in every nominal step of the solver, from the state there alone, and holds the hub's speed
through the step; what it remembers is part of the saved state.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from gw_exudyn.model.course import Course

RESPONSE = 0.1
"""s, in which the hub's speed follows most of a difference in the tip's speed."""

_APPROACH = 0.5
"""Share of the push force that is left to the limit that one nominal step may use up."""

_FORGET = 0.5
"""The stiffness against pushing that was found may fall to this share in a nominal step; it rises at once."""

_LESS = 0.9
"""A leg that is slowed down aims at this share of the push force that is left to the limit."""

_SAME_TIME = 1e-9


@dataclass(frozen=True)
class Leg:
    """What was decided last, and from what: all that the controller remembers.

    since : s. position : m, of the hub there. speed : m/s, of the hub since. wanted : m/s, of the tip then.
    x, y : m, the tip then. push : N, then. stiffness : N/m, rise of the push force over the hub's travel.
    """

    since: float = 0.0
    position: float = 0.0
    speed: float = 0.0
    wanted: float = 0.0
    x: float = 0.0
    y: float = 0.0
    push: float = 0.0
    stiffness: float = 0.0


@dataclass(frozen=True)
class TipSpeed:
    """A wanted speed of the tip, m/s, over time, and the hub's speed that serves it.

    max_speed : m/s, of the hub, which never moves back. force_limit : N, of the push force, or infinite. leg : see Leg.
    taken_over : empty, or (time, speed) from which on the wanted speed comes from outside.
    """

    course: Course
    max_speed: float
    force_limit: float = math.inf
    leg: Leg = Leg()
    taken_over: tuple[float, ...] = ()

    def position_at(self, time: float) -> float:
        """Travel of the hub since the start, m, at a time within the present leg, s."""
        return self.leg.position + self.leg.speed * (time - self.leg.since)

    def speed_at(self, _time: float) -> float:
        """Speed of the hub in the present leg, m/s."""
        return self.leg.speed

    def fastest(self, _begin: float, _end: float) -> float:
        """Largest speed of the hub in the present leg, m/s."""
        return self.leg.speed

    def wanted_at(self, time: float) -> float:
        """Wanted speed of the tip, m/s."""
        if self.taken_over and time >= self.taken_over[0]:
            return self.taken_over[1]
        return self.course.at(time)

    def taken_over_at(self, time: float, speed: float) -> TipSpeed:
        """The constant wanted `speed` of the tip from `time` on."""
        return replace(self, taken_over=(time, speed))

    def decided(self, time: float, tip: tuple[float, float], push: float, step: float) -> TipSpeed:
        """The drive with the leg that begins at `time`, s. tip : its place, m. push : N. step : s, nominal.

        The hub's speed follows the difference between wanted and reached speed of the tip (integral control of the
        speed, so that way lost while the tip stuck is not made up in a rush), and a change of the wanted speed at once.
        """
        leg, wanted = self.leg, self.wanted_at(time)
        passed = time - leg.since
        speed = leg.speed + wanted - leg.wanted
        stiffness = leg.stiffness
        if passed > _SAME_TIME:
            reached = math.hypot(tip[0] - leg.x, tip[1] - leg.y) / passed
            speed += passed / (passed + RESPONSE) * (leg.wanted - reached)
            stiffness = self._stiffness(push, passed)
        most = min(self.max_speed, self._speed_to_limit(push, stiffness, step))
        speed = min(max(speed, 0.0), most)
        return replace(self, leg=Leg(time, self.position_at(time), speed, wanted, tip[0], tip[1], push, stiffness))

    def is_too_fast(self, push: float) -> bool:
        """A push force, N, at the leg's end is above the limit, and a slower leg may help."""
        return push > self.force_limit and self.leg.speed > 0

    def slowed(self, before: float, push: float, *, last: bool) -> TipSpeed:
        """The drive with a slower leg, where this one takes the push force from `before` to `push`, N, above the limit.

        last : stand still.
        """
        share = 0.0 if last else max(0.0, _LESS * (self.force_limit - before) / (push - before))
        return replace(self, leg=replace(self.leg, speed=self.leg.speed * share))

    def _stiffness(self, push: float, passed: float) -> float:
        travel = self.leg.speed * passed
        if travel < 1e-3 * self.max_speed * passed:
            return self.leg.stiffness
        return max((push - self.leg.push) / travel, _FORGET * self.leg.stiffness, 0.0)

    def _speed_to_limit(self, push: float, stiffness: float, step: float) -> float:
        room = self.force_limit - push
        if room <= 0:
            return 0.0
        return _APPROACH * room / (stiffness * step) if stiffness > 0 else math.inf
