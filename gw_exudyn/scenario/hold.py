"""What every drive says of the proximal end: how far the wire is inserted at the start, and how the end is held."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from gw_exudyn.scenario.fields import Choice
from gw_exudyn.scenario.kinds import START

Start = Annotated[float, START, Field(description="length inserted at the start, straight")]
Hold = Annotated[
    str,
    Choice(("clamped", "pinned", "axial")),
    Field(description="of the proximal end: clamped; pinned: it may turn; axial: it may also move square to the axis"),
]
