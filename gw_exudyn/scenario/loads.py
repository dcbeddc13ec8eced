"""What holds and loads the wire besides vessel, catheter and drive: its tip, supports, a loading nose."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field, ValidationInfo, field_validator

from gw_exudyn.scenario.faults import wrong
from gw_exudyn.scenario.fields import Choice, Row
from gw_exudyn.scenario.kinds import (
    ANGLE,
    DISC_RADIUS,
    DISC_STIFFNESS,
    FORCE,
    INSTANT,
    MOMENT,
    NOSE_SPEED,
    NOSE_TRAVEL,
    POINT,
)
from gw_exudyn.scenario.section import Section

_PAIR = (FORCE, FORCE)


class TipSpec(Section):
    """What holds the wire's tip, and the loads on it.

    hold : `free`; `pinned`, its place is fixed; `clamped`, its direction too. slides : the direction of the catheter's
        axis (`along`) or square to it (`across`) in which the held place is free to move, or `none`.
    force : (Fx, Fy), N, fixed in space, in the scenario's plane. follower_force : N, (along the wire's direction at
        the tip, to its left). moment : N m, counter-clockwise. ramp : s, over which all of them rise linearly from 0.
    """

    what: ClassVar[str] = "the tip"

    hold: Annotated[str, Choice(("free", "pinned", "clamped"))] = Field(
        default="free", description="free; pinned: its place is held; clamped: its direction too"
    )
    slides: Annotated[str, Choice(("none", "along", "across"))] = Field(
        default="none", description="where the held place may slide: along the catheter's axis, or across it"
    )
    force: Annotated[tuple[float, float], Row(("x", "y"), _PAIR)] = Field(
        default=(0.0, 0.0), description="dead load, fixed in space, in the scenario's x and y"
    )
    follower_force: Annotated[tuple[float, float], Row(("axial", "transverse"), _PAIR)] = Field(
        default=(0.0, 0.0), description="load that turns with the tip: along the wire, and to its left"
    )
    moment: Annotated[float, MOMENT] = Field(default=0.0, description="couple, counter-clockwise")
    ramp: Annotated[float, INSTANT] = Field(default=0.0, description="time over which the loads rise from 0")

    @field_validator("slides", mode="after")
    @classmethod
    def _needs_a_hold(cls, slides: str, info: ValidationInfo) -> str:
        if slides != "none" and info.data.get("hold") == "free":
            raise wrong("a free tip slides everywhere; take hold: pinned or clamped, or leave slides out")
        return slides


class DiscSpec(Section):
    """A disc without friction that the wire may touch.

    at : (x, y), m, its centre at the start. radius : m. side : of the wire, towards its tip, on which the disc lies,
        `auto` that on which it stands at the start. stiffness : N/m of its contact; None is chosen by the model.
    """

    what: ClassVar[str] = "a support"

    at: Annotated[tuple[float, float], POINT] = Field(description="centre", examples=["[20 mm, -2 mm]"])
    radius: Annotated[float, DISC_RADIUS] = Field(description="radius", examples=["1 mm"])
    side: Annotated[str, Choice(("auto", "left", "right"))] = Field(
        default="auto", description="side of the wire on which it lies, seen towards the tip; auto: as at the start"
    )
    stiffness: Annotated[float | None, DISC_STIFFNESS] = Field(
        default=None, description="stiffness of its contact; auto: far above the wire's"
    )


class NoseSpec(DiscSpec):
    """A disc without friction that moves from its place at the start, straight on, and then stands.

    direction : rad, of its way, from +x to the left. speed : m/s. travel : m, after which it stands.
    """

    what: ClassVar[str] = "the nose"

    direction: Annotated[float, ANGLE] = Field(description="direction of its way", examples=["-90 deg"])
    speed: Annotated[float, NOSE_SPEED] = Field(description="its speed", examples=["1 mm/s"])
    travel: Annotated[float, NOSE_TRAVEL] = Field(description="length of its way", examples=["1 mm"])
