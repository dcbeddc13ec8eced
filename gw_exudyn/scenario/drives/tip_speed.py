"""The drive by a wanted speed of the tip, which a controller of the hub's speed serves."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, ValidationInfo, field_validator, model_validator

from gw_exudyn.scenario.drives.base import CourseDrive, Hold, Start
from gw_exudyn.scenario.drives.course import check_course, course_rows
from gw_exudyn.scenario.faults import wrong
from gw_exudyn.scenario.kinds import (
    DURATION,
    FORCE_LIMIT,
    HUB_SPEED,
    RAMP,
    TIP_SPEED_OR_NONE,
    TIP_SPEED_TABLE,
)
from gw_exudyn.scenario.section import Section
from gw_exudyn.scenario.units import format_quantity


class TipSpeedDrive(CourseDrive):
    """A wanted speed of the tip along its path.

    speed : m/s, one for each time, never negative. max_speed : m/s, of the hub, which never moves back.
    force_limit : N, of the push force.
    """

    kind: Literal["tip_speed"] = "tip_speed"
    speed: tuple[float, ...]
    max_speed: float
    force_limit: float

    def to_plain(self) -> dict[str, Any]:
        """The drive as a file could hold it."""
        limit = {} if math.isinf(self.force_limit) else {"force_limit": self.force_limit}
        return {**self._plain(self.kind, self.speed), "max_speed": self.max_speed, **limit}


class TipSpeedForm(Section):
    """A wanted speed of the tip: one speed with its duration, or a table of speed against time."""

    what: ClassVar[str] = "the drive"

    kind: Literal["tip_speed"]
    speed: Annotated[float | None, TIP_SPEED_OR_NONE] = Field(
        default=None, description="one wanted speed of the tip along its path"
    )
    duration: Annotated[float | None, DURATION] = Field(default=None, description="how long it lasts")
    ramp: Annotated[float | None, RAMP] = Field(
        default=None, description="time over which the wanted speed rises linearly from 0 at the start"
    )
    table: Annotated[tuple[tuple[float, float], ...] | None, TIP_SPEED_TABLE] = Field(
        default=None, description="[[time, speed], ...] from time 0, linear in between; two equal times make a step"
    )
    max_speed: Annotated[float, HUB_SPEED] = Field(
        description="largest speed of the hub, which never moves back", examples=["10 mm/s"]
    )
    force_limit: Annotated[float | None, FORCE_LIMIT] = Field(
        default=None, description="push force at which the hub is held; no limit if not given"
    )
    start: Start = 0.0
    hold: Hold = "clamped"

    @field_validator("max_speed", mode="after")
    @classmethod
    def _not_below_the_tip(cls, most: float, info: ValidationInfo) -> float:
        wanted = [info.data.get("speed") or 0.0, *(speed for _, speed in info.data.get("table") or ())]
        if most < max(wanted):
            text = f"{format_quantity(most, 'mm/s')} is below the wanted speed of the tip, "
            raise wrong(f"{text}{format_quantity(max(wanted), 'mm/s')}; allow the hub that at least")
        return most

    @model_validator(mode="after")
    def _one_form(self) -> Self:
        check_course("speed", self.speed, self.duration, self.ramp, self.table)
        return self

    def resolve(self) -> TipSpeedDrive:
        """The table of the wanted speed against time."""
        rows = self.table or course_rows(self.speed or 0.0, self.duration or 0.0, self.ramp)
        return TipSpeedDrive(
            time=tuple(t for t, _ in rows),
            speed=tuple(v for _, v in rows),
            max_speed=self.max_speed,
            force_limit=math.inf if self.force_limit is None else self.force_limit,
            start=self.start,
            hold=self.hold,
        )
