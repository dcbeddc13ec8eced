"""What cannot start: found before anything is built, reported all at once with its place in the scenario."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.errors import Problem, ScenarioError
from gw_exudyn.model.drive import AnyDrive, Drive, Force
from gw_exudyn.model.law import JUST_AHEAD
from gw_exudyn.model.outline import Outline
from gw_exudyn.model.walls import Tube, vessel_polylines

if TYPE_CHECKING:
    from gw_exudyn.scenario import Scenario

Floats = NDArray[np.float64]

_STEP = 1e-6
"""By how much, m, a wall may stand inside the bore at the exit: far less than the wire notices."""


def check(scenario: Scenario, outline: Outline, tube: Tube, drive: AnyDrive) -> None:
    """Raise ScenarioError with everything that keeps this wire from starting in this vessel.

    outline and tube in the catheter's frame.
    """
    problems = _bore(scenario) + _exit(scenario, outline, tube) + _travel(scenario, drive)
    if problems:
        raise ScenarioError(problems)


def _bore(scenario: Scenario) -> list[Problem]:
    diameter, bore = scenario.wire.diameter, scenario.catheter.bore
    if diameter < bore:
        return []
    text = (
        f"{_mm(bore)} is no wider than the wire, {_mm(diameter)}; "
        "take a wider bore or a thinner wire (wire.diameter, wire.model)"
    )
    return [scenario.problem("catheter.bore", text)]


def _exit(scenario: Scenario, outline: Outline, tube: Tube) -> list[Problem]:
    """The exit lies in the lumen, and the wire's tip has room there."""
    if not contains(outline.points, np.array([JUST_AHEAD, 0.0])):
        x, y = scenario.catheter.exit
        text = (
            f"({_mm(x)}, {_mm(y)}) is outside the lumen; "
            "move it inside, or turn catheter.direction so that it points into the vessel"
        )
        return [scenario.problem("catheter.exit", text)]
    lines, radius = vessel_polylines(outline, tube), scenario.wire.diameter / 2
    room = min((distance(points, closed) for points, closed in lines), default=np.inf)
    if room < radius:
        text = (
            f"leaves {_mm(room)} to the nearest wall of the vessel, less than the wire's radius {_mm(radius)}; "
            "move it away from the wall, or take a thinner wire"
        )
        return [scenario.problem("catheter.exit", text)]
    # A wall that begins inside the mouth: the wire could leave the bore on the wall's outside.
    ends = [end for points, closed in lines if not closed for end in (points[0], points[-1])]
    inside = [abs(float(y)) for x, y in ends if abs(x) < _STEP and abs(y) < tube.bore / 2 - _STEP]
    if not inside:
        return []
    text = (
        f"{_mm(tube.bore)} is wider than the lumen at the exit, where a wall of the vessel stands "
        f"{_mm(min(inside))} from the catheter's axis; "
        "take a narrower bore, or move catheter.exit further into the lumen"
    )
    return [scenario.problem("catheter.bore", text)]


def _travel(scenario: Scenario, drive: AnyDrive) -> list[Problem]:
    """The proximal end stays behind the exit: the drive holds it on the catheter's axis."""
    furthest = travel_wanted(scenario, drive)
    if furthest is None or furthest < scenario.wire.length:
        return []
    text = (
        f"pushes {_mm(furthest)} of a wire of {_mm(scenario.wire.length)}: its end would leave the catheter; "
        "push less far, or take a longer wire (wire.length)"
    )
    return [scenario.problem("drive", text)]


def travel_wanted(scenario: Scenario, drive: AnyDrive) -> float | None:
    """Furthest travel, m, of the proximal end, or of the tip where that is what is driven; None for a force, of which
    the run will tell."""
    if isinstance(drive, Force):
        return None
    return drive.extremes()[1] if isinstance(drive, Drive) else drive.course.area_to(scenario.drive.duration)


def contains(polygon: Floats, point: Floats) -> bool:
    """Whether a point (2,) lies inside a closed polygon (m, 2) (even-odd rule)."""
    a, b = polygon, np.roll(polygon, -1, axis=0)
    straddles = (a[:, 1] > point[1]) != (b[:, 1] > point[1])
    rise = np.where(straddles, b[:, 1] - a[:, 1], 1.0)
    x = a[:, 0] + (point[1] - a[:, 1]) / rise * (b[:, 0] - a[:, 0])
    return bool(np.count_nonzero(straddles & (point[0] < x)) % 2)


def distance(points: Floats, closed: bool) -> float:
    """Distance, m, of the frame's origin from a polyline (m, 2)."""
    a = points if closed else points[:-1]
    b = np.roll(points, -1, axis=0) if closed else points[1:]
    d = b - a
    part = np.clip(-(a * d).sum(axis=1) / (d * d).sum(axis=1), 0.0, 1.0)
    return float(np.hypot(*(a + part[:, None] * d).T).min())


def _mm(value: float) -> str:
    return f"{value * 1e3:.6g} mm"
