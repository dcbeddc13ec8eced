"""What ends a run before its drive does, and is no failure."""

from __future__ import annotations

from typing import Annotated, ClassVar, Self

from pydantic import Field, model_validator

from gw_exudyn.scenario.fields import Flag, Section, wrong
from gw_exudyn.scenario.kinds import FORCE_LIMIT, NEARNESS, POINT, STALL_TRAVEL


class TargetSpec(Section):
    """A place that the tip is to reach. at : (x, y), m. within : m, distance that counts as reached."""

    what: ClassVar[str] = "the target"

    at: Annotated[tuple[float, float], POINT] = Field(description="the point", examples=["[20 mm, 40 mm]"])
    within: Annotated[float, NEARNESS] = Field(
        default=2e-3, description="distance of the tip from the point that counts as reached"
    )


class StopSpec(Section):
    """Events that end a run; they are looked for at the ends of nominal steps.

    tip_stall : m of travel of the proximal end in which a tip that moves less than a tenth of it has stalled; None is
        chosen by the model, infinite is off. push_force : N, None is off. target : None or a point. at_target : whether
        reaching it ends the run.
    """

    what: ClassVar[str] = "what ends the run"

    tip_stall: Annotated[float | None, STALL_TRAVEL] = Field(
        default=None,
        description="the run ends where the tip moves less than a tenth of this while the wire is pushed in by this; "
        "auto is 1.25 lumens at the catheter's exit, 5 mm at least; off goes on",
    )
    push_force: Annotated[float | None, FORCE_LIMIT] = Field(
        default=None, description="push force at which the run ends"
    )
    target: TargetSpec | None = Field(default=None, description="a point that the tip is to reach")
    at_target: Annotated[bool, Flag()] = Field(default=False, description="whether the run ends at the target")

    @model_validator(mode="after")
    def _has_a_target(self) -> Self:
        if self.at_target and self.target is None:
            raise wrong("at_target needs a target; give target: {at: [20 mm, 40 mm], within: 2 mm}", missing=True)
        return self
