"""The drive by a force on a hub that holds the wire."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, field_validator, model_validator

from gw_exudyn.scenario.drives.base import CourseDrive, Hold, Start
from gw_exudyn.scenario.drives.course import check_course, course_rows
from gw_exudyn.scenario.faults import wrong
from gw_exudyn.scenario.kinds import (
    DURATION,
    FORCE_OR_NONE,
    FORCE_TABLE,
    HUB_DAMPING,
    HUB_MASS,
    RAMP,
)
from gw_exudyn.scenario.section import Section


class ForceDrive(CourseDrive):
    """A force along the catheter's axis on a hub that holds the wire.

    force : N, one for each time; positive pushes in. hub_mass : kg. hub_damping : N s/m.
    """

    kind: Literal["force"] = "force"
    force: tuple[float, ...]
    hub_mass: float
    hub_damping: float

    def to_plain(self) -> dict[str, Any]:
        """The drive as a file could hold it."""
        hub = {"hub_mass": self.hub_mass, "hub_damping": self.hub_damping}
        return {**self._plain(self.kind, self.force), **hub}


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
