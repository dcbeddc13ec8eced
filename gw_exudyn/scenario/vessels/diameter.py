"""The diameter along a branch: one, two for its ends, or a table."""

from __future__ import annotations

from typing import Any

from gw_exudyn.scenario.faults import wrong
from gw_exudyn.scenario.fields import Kind, Quantity, Row, Table
from gw_exudyn.scenario.kinds import BRANCH_PLACE, VESSEL_DIAMETER

Diameters = float | tuple[float, float] | tuple[tuple[float, float], ...]

MOST_ROWS = 10_000
_ENDS = Row(("from", "to"), (VESSEL_DIAMETER, VESSEL_DIAMETER))
_PLACE = Quantity("m", BRANCH_PLACE.low, BRANCH_PLACE.high, "mm")
_TABLE = Table(Row(("place", "diameter"), (_PLACE, VESSEL_DIAMETER)), 2, MOST_ROWS)


class DiameterKind(Kind):
    """`4 mm`, `[4 mm, 2 mm]` from the beginning to the end, or `[[0 mm, 4 mm], [10 mm, 3 mm]]` along the length."""

    def read(self, value: Any) -> Diameters:
        """m; a table's places rise from 0, and come twice at most, for a step."""
        if not isinstance(value, list | tuple):
            found: Diameters = VESSEL_DIAMETER.read(value)  # type: ignore[assignment]
            return found
        if not value or not all(isinstance(row, list | tuple) for row in value):
            return _ENDS.read(value)
        rows = _TABLE.read(value) or ()
        places = [place for place, _ in rows]
        if places[0] != 0:
            raise wrong(f"begins at {places[0] * 1e3:.6g} mm; the first place is 0, the branch's beginning")
        for i in range(1, len(places)):
            if places[i] < places[i - 1]:
                raise wrong(f"row {i} goes back to {places[i] * 1e3:.6g} mm; places rise along the branch")
            if i > 1 and places[i] == places[i - 2]:
                raise wrong(f"row {i} is the third at {places[i] * 1e3:.6g} mm; two make a step")
        return rows

    def json(self) -> dict[str, Any]:
        """Any of the three."""
        return {"anyOf": [VESSEL_DIAMETER.json(), _ENDS.json(), _TABLE.json()]}


DIAMETER = DiameterKind()
