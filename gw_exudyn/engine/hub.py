"""The hub in Exudyn: the body that holds the wire's proximal end on the catheter's axis, placed or pushed."""

from __future__ import annotations

from typing import Any, Protocol

from gw_exudyn.model.drive import Drive, Force
from gw_exudyn.model.hub import HubInstant
from gw_exudyn.model.tip_speed import TipSpeed

_FASTER = 1.2
"""Room for a hub that moves freely to gain speed before its step is refused as too long."""


class Hub(Protocol):
    """What the stepping asks of the hub.

    constraints : how many of its coordinates are held; their multipliers come first. moves_freely : how far it goes in
        a step is not known in advance.
    """

    constraints: int
    moves_freely: bool

    def aim(self, mbs: Any, drive: Any, end: float) -> None:
        """A step that ends at `end`, s, begins."""

    def travel(self, drive: Any, now: HubInstant, begin: float, end: float) -> float:
        """Travel, m, to expect from the time reached, `begin`, to `end`, s."""

    def fastest(self, drive: Any, now: HubInstant, begin: float, end: float) -> float:
        """Largest speed, m/s, without its sign, to expect on the way."""

    def instant(self, mbs: Any, drive: Any, time: float) -> HubInstant:
        """The hub at the time reached, s."""


class PlacedHub:
    """A constraint places it; it has a segment's mass, whose inertia is not the wire's and is taken out of the push
    force."""

    constraints = 3
    moves_freely = False

    def __init__(self, mbs: Any, items: Any, ground: int, along: int, mass: float) -> None:
        self._mass = mass
        self._constraint = mbs.AddObject(items.CoordinateConstraint(markerNumbers=[ground, along], offset=0.0))

    def aim(self, mbs: Any, drive: Drive | TipSpeed, end: float) -> None:
        """Place it where the drive is at the step's end."""
        mbs.SetObjectParameter(self._constraint, "offset", drive.position_at(end))

    def travel(self, drive: Drive | TipSpeed, now: HubInstant, _begin: float, end: float) -> float:
        """As the drive says."""
        return drive.position_at(end) - now.travel

    def fastest(self, drive: Drive | TipSpeed, _now: HubInstant, begin: float, end: float) -> float:
        """As the drive says."""
        return drive.fastest(begin, end)

    def instant(self, mbs: Any, drive: Drive | TipSpeed, time: float) -> HubInstant:
        """Travel and speed are the drive's; the push force is the constraint's, less the hub's inertia."""
        data = mbs.systemData
        acceleration = float(data.GetODE2Coordinates_tt()[0])
        push = -float(data.GetAECoordinates()[0]) - self._mass * acceleration
        return HubInstant(drive.position_at(time), drive.speed_at(time), acceleration, push, push)


class PushedHub:
    """A force pushes it against a damper and the wire."""

    constraints = 2
    moves_freely = True

    def __init__(self, mbs: Any, items: Any, ground: int, along: int, damping: float) -> None:
        mbs.AddObject(items.CoordinateSpringDamper(markerNumbers=[ground, along], stiffness=0.0, damping=damping))
        self._load = mbs.AddLoad(items.LoadCoordinate(markerNumber=along, load=0.0))

    def aim(self, mbs: Any, drive: Force, end: float) -> None:
        """The force of the step's end acts through the step, as all forces do in this integrator."""
        mbs.SetLoadParameter(self._load, "load", drive.force_at(end))

    def travel(self, _drive: Force, now: HubInstant, begin: float, end: float) -> float:
        """It goes on as it does; a step that takes it much further is refused and cut."""
        return now.speed * (end - begin)

    def fastest(self, _drive: Force, now: HubInstant, _begin: float, _end: float) -> float:
        """It goes on as it does, or somewhat faster."""
        return _FASTER * abs(now.speed)

    def instant(self, mbs: Any, drive: Force, time: float) -> HubInstant:
        """From its own motion; the push force is that of the wire's first joint."""
        data = mbs.systemData
        return HubInstant(
            travel=float(data.GetODE2Coordinates()[0]),
            speed=float(data.GetODE2Coordinates_t()[0]),
            acceleration=float(data.GetODE2Coordinates_tt()[0]),
            force=drive.force_at(time),
            push=-float(data.GetAECoordinates()[self.constraints]),
        )
