"""What every drive has: its course over time, how far the wire is inserted at the start, and how its end is held."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

from pydantic import Field

from gw_exudyn.scenario.fields import Choice
from gw_exudyn.scenario.kinds import START
from gw_exudyn.scenario.section import Section

Start = Annotated[float, START, Field(description="length inserted at the start, straight")]
Hold = Annotated[
    str,
    Choice(("clamped", "pinned", "axial")),
    Field(description="of the proximal end: clamped; pinned: it may turn; axial: it may also move square to the axis"),
]


class CourseDrive(Section):
    """A drive whose command is piecewise linear in time.

    time : s, begins at 0, never falls; two equal times make a step. The drive ends at time[-1].
    start : m, length inserted at the start. hold : of the proximal end: `clamped`, `pinned` (it may turn), `axial` (it
        may also move square to the axis).
    """

    time: tuple[float, ...]
    start: float = 0.0
    hold: str = "clamped"

    @property
    def duration(self) -> float:
        """End of the drive, s."""
        return self.time[-1]

    def _plain(self, kind: str, values: Sequence[float]) -> dict[str, Any]:
        """The drive as a file could hold it: its table."""
        table = [list(row) for row in zip(self.time, values, strict=True)]
        return {"kind": kind, "start": self.start, "hold": self.hold, "table": table}
