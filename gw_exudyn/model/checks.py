"""What cannot start: found before anything is built, reported all at once with its place in the scenario."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.errors import Problem, ScenarioError
from gw_exudyn.model.discs import Disc
from gw_exudyn.model.drive import AnyDrive, Drive, Force
from gw_exudyn.model.law import JUST_AHEAD
from gw_exudyn.model.outline import Outline
from gw_exudyn.model.walls import Tube, vessel_polylines

if TYPE_CHECKING:
    from gw_exudyn.scenario import Scenario

Floats = NDArray[np.float64]

_STEP = 1e-6
"""By how much, m, a wall may stand inside the bore at the exit: far less than the wire notices."""


def check(scenario: Scenario, outline: Outline, tube: Tube, drive: AnyDrive, discs: Sequence[Disc] = ()) -> None:
    """Raise ScenarioError with everything that keeps this wire from starting in this vessel.

    outline, tube and discs in the catheter's frame.
    """
    problems = _bore(scenario)
    if len(outline.points):
        problems += _exit(scenario, outline, tube) or _start(scenario, outline, tube)
    problems += _travel(scenario, drive) + _discs(scenario, discs)
    if problems:
        raise ScenarioError(problems)


def _bore(scenario: Scenario) -> list[Problem]:
    diameter, bore = scenario.wire.diameter, scenario.catheter.bore
    if not bore or diameter < bore:
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
    if scenario.catheter.bore is None:
        return []
    start, length = scenario.drive.start, scenario.wire.length
    if start > length:
        text = f"{_mm(start)} of a wire of {_mm(length)} cannot be inserted at the start"
        return [scenario.problem("drive.start", f"{text}; start with less, or take a longer wire (wire.length)")]
    furthest = travel_wanted(scenario, drive)
    if furthest is None or furthest <= length * (1 + 1e-12):
        return []
    text = (
        f"pushes {_mm(furthest)} of a wire of {_mm(scenario.wire.length)}: its end would leave the catheter; "
        "push less far, or take a longer wire (wire.length)"
    )
    return [scenario.problem("drive", text)]


def _start(scenario: Scenario, outline: Outline, tube: Tube) -> list[Problem]:
    """The straight wire is clear of the walls as far as it is inserted at the start."""
    start, radius = scenario.drive.start, scenario.wire.diameter / 2
    if start == 0:
        return []
    for points, closed in vessel_polylines(outline, tube):
        free = first_within(points, closed, radius)
        if free < start:
            text = (
                f"{_mm(start)} of straight wire would stand in a wall of the vessel, {_mm(max(free, 0.0))} from the "
                "catheter's exit; start with less, or turn the catheter (catheter.direction)"
            )
            return [scenario.problem("drive.start", text)]
    return []


def _discs(scenario: Scenario, discs: Sequence[Disc]) -> list[Problem]:
    """Each disc leaves room for the straight wire at the start."""
    tip, radius = scenario.drive.start, scenario.wire.diameter / 2
    problems = []
    for number, disc in enumerate(discs):
        x, y = disc.at
        beside = min(max(float(x), tip - scenario.wire.length), tip)
        room = float(np.hypot(x - beside, y)) - disc.radius
        ahead = beside == tip and x > tip
        side = ahead or disc.side * y > 0
        if side and room >= radius - _STEP:
            continue
        path = f"supports.{number}" if number < len(scenario.supports) else "nose"
        text = f"stands in the wire or on its other side; {_mm(disc.radius + radius)} from its axis are needed"
        problems.append(scenario.problem(f"{path}.at", f"{text}; move it away from the wire, or take another side"))
    return problems


def first_within(points: Floats, closed: bool, radius: float) -> float:
    """Least x >= 0, m, at which a polyline (m, 2) comes nearer than `radius` to the x axis; infinite if none."""
    a = points if closed else points[:-1]
    b = np.roll(points, -1, axis=0) if closed else points[1:]
    found = np.inf
    for (ax, ay), (bx, by) in zip(a, b, strict=True):
        # The part of the edge in the strip about the axis.
        low, high = 0.0, 1.0
        if ay == by:
            if abs(ay) >= radius:
                continue
        else:
            ends = sorted(((-radius - ay) / (by - ay), (radius - ay) / (by - ay)))
            low, high = max(low, ends[0]), min(high, ends[1])
            if low >= high:
                continue
        nearest, furthest = sorted((ax + low * (bx - ax), ax + high * (bx - ax)))
        if furthest > 0:
            found = min(found, max(nearest, 0.0))
    return float(found)


def travel_wanted(scenario: Scenario, drive: AnyDrive) -> float | None:
    """Furthest travel, m, of the proximal end, or of the tip where that is what is driven, with the length inserted at
    the start; None for a force, of which the run will tell."""
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
