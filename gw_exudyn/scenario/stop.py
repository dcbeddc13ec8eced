"""What ends a run before its drive does, and is no failure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, ClassVar, Self

from pydantic import Field, model_validator

from gw_exudyn.scenario.faults import refuse, wrong
from gw_exudyn.scenario.fields import Flag, Text
from gw_exudyn.scenario.kinds import FORCE_LIMIT, NEARNESS, POINT_OR_NONE, STALL_TRAVEL
from gw_exudyn.scenario.section import Section
from gw_exudyn.scenario.vessels.regions import Lumen
from gw_exudyn.scenario.words import did_you_mean, shown

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

USUAL_NEARNESS = 2e-3
"""Distance of the tip from a target point, m, that counts as reached where the file does not say."""


class TargetSpec(Section):
    """A place that the tip is to reach: a point, or any place in a branch.

    at : (x, y), m, or None. within : m, distance from the point that counts as reached; None with a branch. branch :
        name of a branch of the vessel, or None; the tip has reached it when its centre lies in it.
    """

    what: ClassVar[str] = "the target"

    at: Annotated[tuple[float, float] | None, POINT_OR_NONE] = Field(
        default=None, description="the point", examples=["[20 mm, 40 mm]"]
    )
    within: Annotated[float | None, NEARNESS] = Field(
        default=None, description="distance of the tip from the point that counts as reached; 2 mm if not given"
    )
    branch: Annotated[str | None, Text("name of a branch", optional=True)] = Field(
        default=None, description="instead of a point: the branch of the vessel that the tip is to enter"
    )

    @model_validator(mode="after")
    def _one_of_them(self) -> Self:
        if (self.at is None) == (self.branch is None):
            text = "is neither a point nor a branch" if self.at is None else "has both a point and a branch"
            raise wrong(f"{text}; give {{at: [20 mm, 40 mm], within: 2 mm}} or {{branch: target}}", missing=True)
        if self.branch is not None and self.within is not None:
            raise wrong("within belongs to a point; a branch is reached when the tip lies in it, leave within out")
        return self

    @property
    def words(self) -> str:
        """The target as a message names it."""
        if self.at is None:
            return f"branch {self.branch}"
        return f"({self.at[0] * 1e3:.6g}, {self.at[1] * 1e3:.6g}) mm within {self.nearness * 1e3:.4g} mm"

    @property
    def nearness(self) -> float:
        """Distance from the point that counts as reached, m."""
        return USUAL_NEARNESS if self.within is None else self.within

    def reached(self, vessel: Lumen, tips: ArrayLike) -> Sequence[bool]:
        """Whether each tip, (k, 2), m, in the scenario's plane, has reached the target; (k,) bool."""
        import numpy as np

        places = np.asarray(tips, dtype=float)
        if self.at is None:
            found = vessel.branch_at(places) == self.branch
        else:
            found = np.hypot(*(places - self.at).T) <= self.nearness
        return list(map(bool, found))


def check_target(target: TargetSpec | None, vessel: Lumen) -> None:
    """Check that the branch of a target is one of the vessel's."""
    if target is None or target.branch is None or target.branch in vessel.branch_names:
        return
    if vessel.has_branches:
        names = vessel.branch_names
        allowed = f"{did_you_mean(target.branch, names)}branches: {', '.join(names)}"
    else:
        allowed = "a vessel of this kind has none by name; give target: {at: [20 mm, 40 mm], within: 2 mm}"
    refuse(("target", "branch"), f"there is no branch {shown(target.branch)}; {allowed}")


class StopSpec(Section):
    """Events that end a run; they are looked for at the ends of nominal steps.

    tip_stall : m of travel of the proximal end in which a tip that moves less than a tenth of it has stalled; None is
        chosen by the model, infinite is off. push_force : N, None is off. target : a point or a branch, or None.
        at_target : whether reaching it ends the run.
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
    target: TargetSpec | None = Field(default=None, description="a point or a branch that the tip is to reach")
    at_target: Annotated[bool, Flag()] = Field(default=False, description="whether the run ends at the target")

    @model_validator(mode="after")
    def _has_a_target(self) -> Self:
        if self.at_target and self.target is None:
            raise wrong("at_target needs a target; give target: {at: [20 mm, 40 mm], within: 2 mm}", missing=True)
        return self
