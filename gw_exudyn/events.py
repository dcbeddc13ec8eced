"""What ends a run without being a failure: a tip that stalls, a force limit, a target, the end of the hub's travel.

Looked for at the ends of nominal steps only, so that it does not matter how time is cut into calls.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from gw_exudyn.engine.stepper import Stepper
from gw_exudyn.model.drive import Drive
from gw_exudyn.model.tip_speed import TipSpeed
from gw_exudyn.result import Status, StatusReport

STALLED = 0.1
"""A tip that moves by less than this share of the proximal end's travel stays where it is."""

_AT_THE_END = 1e-5
"""m: a hub that the solver could not take further is at the end of its travel if it is this near."""


@dataclass(frozen=True)
class Anchor:
    """Where the tip was last seen to move on: the proximal end's travel there (m), and the tip's place (m)."""

    travel: float
    x: float
    y: float


def moved_anchor(anchor: Anchor, length: float, travel: float, tip: tuple[float, float]) -> Anchor:
    """The anchor after a look: it moves along with a tip that got away from it, and with a wire that is pulled back.

    length : m, the travel in which a tip stalls.
    """
    away = math.hypot(tip[0] - anchor.x, tip[1] - anchor.y)
    return Anchor(travel, *tip) if away >= STALLED * length or travel < anchor.travel else anchor


class Watch:
    """Looks for events in a run; `anchor` is all that it remembers."""

    def __init__(self, stepper: Stepper) -> None:
        self._stepper = stepper
        self._spec = stepper.model.scenario.stop
        self.reset()

    def reset(self) -> None:
        """At the start of a run: the tip is on the catheter's axis, as far out as the wire is inserted."""
        start = self._stepper.model.scenario.drive.start
        self.anchor = Anchor(start, start, 0.0)

    def look(self) -> StatusReport | None:
        """The event that ends the run at the nominal time reached, or None."""
        return self._target() or self._force() or self._stall() or self._end_of_travel()

    def out_of_travel(self) -> StatusReport | None:
        """END_OF_TRAVEL where that is why the solver found no way on, else None."""
        back, far = self._stepper.model.travel_range
        travel = self._stepper.hub.travel
        free = self._stepper.system.hub.moves_freely
        return self._at_end(travel) if free and min(far - travel, travel - back) < _AT_THE_END else None

    def _target(self) -> StatusReport | None:
        target = self._spec.target
        if target is None or not self._spec.at_target:
            return None
        x, y = self._stepper.model.frame.points_out(self._tip())
        distance = math.hypot(x - target.at[0], y - target.at[1])
        if distance > target.within:
            return None
        return self._report(Status.TARGET_REACHED, f"{distance * 1e3:.4g} mm from it")

    def _force(self) -> StatusReport | None:
        limit, push = self._spec.push_force, self._stepper.instant.push
        if limit is None or push <= limit:
            return None
        return self._report(Status.FORCE_LIMIT, f"limit {limit:.4g} N")

    def _stall(self) -> StatusReport | None:
        length, travel = self._stepper.model.stall_travel, self._stepper.instant.travel
        self.anchor = moved_anchor(self.anchor, length, travel, self._tip())
        if travel - self.anchor.travel < length:
            return None
        return self._report(Status.TIP_STALLED, f"pushed in by {length * 1e3:.4g} mm meanwhile")

    def _end_of_travel(self) -> StatusReport | None:
        """What does not prescribe the travel may leave the range in the next step."""
        stepper = self._stepper
        if isinstance(stepper.drive, Drive):
            return None
        speed = stepper.drive.max_speed if isinstance(stepper.drive, TipSpeed) else stepper.hub.speed
        back, far = stepper.model.travel_range
        next_travel = stepper.hub.travel + speed * stepper.model.scenario.solver.step
        return None if back < next_travel < far else self._at_end(stepper.hub.travel)

    def _at_end(self, travel: float) -> StatusReport:
        return self._report(Status.END_OF_TRAVEL, f"travel {travel * 1e3:.4g} mm")

    def _tip(self) -> tuple[float, float]:
        return self._stepper.tip()

    def _report(self, status: Status, detail: str) -> StatusReport:
        x, y = self._stepper.model.frame.points_out(self._tip()) * 1e3
        push = f"push force {self._stepper.instant.push:.4g} N"
        return StatusReport(status, self._stepper.time, f"tip at ({x:.4g}, {y:.4g}) mm", f"{detail}, {push}")
