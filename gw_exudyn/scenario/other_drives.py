"""The drives that do not prescribe the proximal end's place: by a force on a hub, and by the speed of the tip."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, ValidationInfo, field_validator, model_validator

from gw_exudyn.scenario.course import check_course, course_rows
from gw_exudyn.scenario.fields import Section, wrong
from gw_exudyn.scenario.hold import Hold, Start
from gw_exudyn.scenario.kinds import (
    DURATION,
    FORCE_LIMIT,
    FORCE_OR_NONE,
    FORCE_TABLE,
    HUB_DAMPING,
    HUB_MASS,
    HUB_SPEED,
    RAMP,
    TIP_SPEED_OR_NONE,
    TIP_SPEED_TABLE,
)
from gw_exudyn.scenario.units import format_quantity


class ForceDrive(Section):
    """A force along the catheter's axis on a hub that holds the wire, piecewise linear in time.

    time : s, begins at 0, never falls; two equal times make a step. force : N, as many; positive pushes in. hub_mass :
        kg. hub_damping : N s/m. start, hold : as of SpeedDrive. The drive ends at time[-1].
    """

    kind: Literal["force"] = "force"
    time: tuple[float, ...]
    force: tuple[float, ...]
    hub_mass: float
    hub_damping: float
    start: float = 0.0
    hold: str = "clamped"

    @property
    def duration(self) -> float:
        """End of the drive, s."""
        return self.time[-1]

    def to_plain(self) -> dict[str, Any]:
        """The drive as a file could hold it."""
        rows = [list(row) for row in zip(self.time, self.force, strict=True)]
        hub = {"hub_mass": self.hub_mass, "hub_damping": self.hub_damping}
        return {"kind": self.kind, "start": self.start, "hold": self.hold, "table": rows, **hub}


class ForceForm(Section):
    """A force on the hub: one force with its duration, or a table of force against time."""

    what: ClassVar[str] = "the drive"

    kind: Literal["force"]
    force: Annotated[float | None, FORCE_OR_NONE] = Field(
        default=None, description="one constant force on the hub; positive pushes in"
    )
    duration: Annotated[float | None, DURATION] = Field(default=None, description="how long it lasts")
    ramp: Annotated[float | None, RAMP] = Field(
        default=None, description="time over which the force rises linearly from 0 at the start"
    )
    table: Annotated[tuple[tuple[float, float], ...] | None, FORCE_TABLE] = Field(
        default=None, description="[[time, force], ...] from time 0, linear in between; two equal times make a step"
    )
    hub_mass: Annotated[float, HUB_MASS] = Field(description="mass of the hub", examples=["10 g"])
    hub_damping: Annotated[float, HUB_DAMPING] = Field(
        description="damping of the hub: a wire that nothing holds moves with force / hub_damping",
        examples=["5 N*s/m"],
    )
    start: Start = 0.0
    hold: Hold = "clamped"

    @field_validator("hold", mode="after")
    @classmethod
    def _on_its_axis(cls, hold: str) -> str:
        if hold == "axial":
            raise wrong("a hub that a force pushes moves along the axis alone; take hold: clamped or pinned")
        return hold

    @model_validator(mode="after")
    def _one_form(self) -> Self:
        check_course("force", self.force, self.duration, self.ramp, self.table)
        return self

    def resolve(self) -> ForceDrive:
        """The table of force against time."""
        rows = self.table or course_rows(self.force or 0.0, self.duration or 0.0, self.ramp)
        return ForceDrive(
            time=tuple(t for t, _ in rows),
            force=tuple(f for _, f in rows),
            hub_mass=self.hub_mass,
            hub_damping=self.hub_damping,
            start=self.start,
            hold=self.hold,
        )


class TipSpeedDrive(Section):
    """A wanted speed of the tip along its path, piecewise linear in time, which a controller of the hub's speed serves.

    time : s, begins at 0, never falls; two equal times make a step. speed : m/s, as many, never negative. max_speed :
        m/s, of the hub, which never moves back. force_limit : N, of the push force. start, hold : as
        of SpeedDrive. The drive ends at time[-1].
    """

    kind: Literal["tip_speed"] = "tip_speed"
    time: tuple[float, ...]
    speed: tuple[float, ...]
    max_speed: float
    force_limit: float
    start: float = 0.0
    hold: str = "clamped"

    @property
    def duration(self) -> float:
        """End of the drive, s."""
        return self.time[-1]

    def to_plain(self) -> dict[str, Any]:
        """The drive as a file could hold it."""
        rows = [list(row) for row in zip(self.time, self.speed, strict=True)]
        limit = {} if math.isinf(self.force_limit) else {"force_limit": self.force_limit}
        held = {"start": self.start, "hold": self.hold}
        return {"kind": self.kind, **held, "table": rows, "max_speed": self.max_speed, **limit}


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
