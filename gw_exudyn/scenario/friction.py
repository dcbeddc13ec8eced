"""Where friction differs: along the wire (a coating), and along the walls (a calcified stretch)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, ClassVar

from pydantic import Field

from gw_exudyn.scenario.faults import Faults
from gw_exudyn.scenario.fields import Number
from gw_exudyn.scenario.kinds import ARC_LENGTH, FRICTION, PATCH_REACH, POINT
from gw_exudyn.scenario.section import Section
from gw_exudyn.scenario.units import format_quantity

Point = tuple[float, float]


class FrictionStretch(Section):
    """A stretch of the wire whose friction differs, as under a coating.

    start, end : m, arc length from the tip. factor : by which the friction coefficient of whatever wall it touches is
        multiplied there.
    """

    what: ClassVar[str] = "a stretch of the wire's friction"

    start: Annotated[float, ARC_LENGTH] = Field(
        alias="from", description="where it begins, from the tip", examples=["0 mm"]
    )
    end: Annotated[float, ARC_LENGTH] = Field(alias="to", description="where it ends, from the tip", examples=["50 mm"])
    factor: Annotated[float, Number(0.0, 20.0)] = Field(
        description="by which the walls' friction coefficient is multiplied there", examples=["0.3"]
    )


class FrictionPatch(Section):
    """Walls of the vessel whose friction differs: all within a distance of the straight line between two points.

    start, end : (x, y), m; the same point twice makes a circle. within : m. friction_coefficient : of these walls;
        where patches overlap the last one counts.
    """

    what: ClassVar[str] = "a patch of the walls"

    start: Annotated[Point, POINT] = Field(
        alias="from", description="one end of the line [x, y]", examples=["[10 mm, 2 mm]"]
    )
    end: Annotated[Point, POINT] = Field(
        alias="to", description="the other end of the line [x, y]", examples=["[20 mm, 2 mm]"]
    )
    within: Annotated[float, PATCH_REACH] = Field(
        description="how far from the line the patch reaches", examples=["1 mm"]
    )
    friction_coefficient: Annotated[float, FRICTION] = Field(
        description="Coulomb friction between wire and these walls", examples=["0.6"]
    )


def check_stretches(stretches: Sequence[FrictionStretch], length: float | None) -> None:
    """Check that stretches have a length, end on the wire (of `length`, m, where it is known) and do not overlap."""
    faults = Faults()
    for i, stretch in enumerate(stretches):
        if stretch.end <= stretch.start:
            faults.add((i, "to"), f"{_at(stretch.end)} is not beyond from, {_at(stretch.start)}")
        elif length is not None and stretch.end > length * (1 + 1e-9):
            faults.add((i, "to"), f"{_at(stretch.end)} is beyond the end of the wire, {_at(length)}")
        for other in stretches[:i]:
            if min(stretch.end, other.end) - max(stretch.start, other.start) > 1e-9:
                both = f"{_at(other.start)} to {_at(other.end)}"
                faults.add((i, "from"), f"the stretch overlaps another, {both}; let it begin or end there")
                break
    faults.raise_if_any()


def _at(place: float) -> str:
    return format_quantity(place, "mm")
