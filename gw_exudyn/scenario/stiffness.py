"""Bending stiffness along a wire: the forms in which a file may give it, and the pieces that come of them.

Arc length is measured from the tip, as a maker's data is. Pieces are linear in between and may step where they meet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any

from pydantic import Field, TypeAdapter

from gw_exudyn.scenario.fields import Faults, Kind, Row, Section, Table, wrong
from gw_exudyn.scenario.kinds import ARC_LENGTH, BENDING_STIFFNESS
from gw_exudyn.scenario.units import format_quantity
from gw_exudyn.scenario.words import did_you_mean, nearest, plural, shown

_TOUCHING = 1e-9
"""m. Ends nearer than this meet; a piece is never so short."""

_MOST_PIECES = 10_000


@dataclass(frozen=True)
class Stiffness(Kind):
    """The value of a piece: one bending stiffness, or `[a, b]` at its start (nearer to the tip) and its end."""

    def read(self, value: Any) -> tuple[float, float]:
        """Start and end value, N m^2."""
        if isinstance(value, list | tuple):
            first, last = Row(("at from", "at to"), (BENDING_STIFFNESS, BENDING_STIFFNESS)).read(value)
            return first, last
        constant = BENDING_STIFFNESS.read(value)
        return constant, constant  # type: ignore[return-value]  # None only where a quantity is optional

    def json(self) -> dict[str, Any]:
        """One value or two."""
        one = BENDING_STIFFNESS.json()
        return {"anyOf": [*one["anyOf"], {"type": "array", "prefixItems": [one, one], "minItems": 2, "maxItems": 2}]}


class PieceForm(Section):
    """One stretch of the wire as a file gives it."""

    what = "a piece of the bending stiffness"

    start: Annotated[float, ARC_LENGTH] = Field(
        alias="from", description="where it begins, from the tip", examples=["0 mm"]
    )
    end: Annotated[float, ARC_LENGTH] = Field(alias="to", description="where it ends, from the tip", examples=["45 mm"])
    value: Annotated[tuple[float, float], Stiffness()] = Field(
        description="bending stiffness EI: one value, or [at from, at to]", examples=["1.0 N*mm^2"]
    )


class StiffnessPiece(Section):
    """Bending stiffness over one stretch of the wire, linear in between.

    start, end : m, arc length from the tip. value, value_end : N m^2, bending stiffness at start and at end.
    """

    start: float
    end: float
    value: float
    value_end: float

    def to_plain(self) -> dict[str, Any]:
        """The piece as a file could hold it."""
        value = self.value if self.value == self.value_end else [self.value, self.value_end]
        return {"from": self.start, "to": self.end, "value": value}


_PIECES = TypeAdapter(tuple[PieceForm, ...])
_TABLE = Table(Row(("arc length", "stiffness"), (ARC_LENGTH, BENDING_STIFFNESS)), 2, _MOST_PIECES)


def read_stiffness(raw: Any, length: float | None) -> tuple[StiffnessPiece, ...]:
    """Pieces in order from the tip that cover the wire, from any of the forms.

    Parameters
    ----------
    raw : one stiffness for the whole wire; a list of `{from, to, value}`; or `{table: [[s, EI], ...]}`.
    length : m, the wire's; None if it is not known because it is wrong itself, when only the rest is checked.

    Raises
    ------
    ValidationError or PydanticCustomError
        for values that are wrong, gaps and overlaps, and ends that are not those of the wire.
    """
    if isinstance(raw, dict):
        return _from_table(raw, length)
    if not isinstance(raw, list | tuple):
        value = BENDING_STIFFNESS.read(raw) or 0.0
        return (StiffnessPiece(start=0.0, end=length or 1.0, value=value, value_end=value),)
    if not 1 <= len(raw) <= _MOST_PIECES:
        raise wrong(f"has {plural(len(raw), 'piece')}; 1 to {_MOST_PIECES} are needed")
    if all(isinstance(piece, StiffnessPiece) for piece in raw):
        raw = [piece.to_plain() for piece in raw]
    forms = _PIECES.validate_python(raw)
    order = sorted(range(len(forms)), key=lambda i: (forms[i].start, forms[i].end))
    return _joined([forms[i] for i in order], order, length)


def _from_table(raw: dict[str, Any], length: float | None) -> tuple[StiffnessPiece, ...]:
    faults = Faults()
    for key in raw:
        if key != "table":
            faults.add((key,), f"unknown key; {did_you_mean(str(key), ['table'])}allowed: table, or a list of pieces")
    if "table" not in raw and not any(nearest(str(key), ["table"]) for key in raw):
        faults.add((), f"{shown(raw)} without table; write a list of {{from, to, value}}, or table: [[s, EI], ...]")
    rows = faults.read(("table",), _TABLE.read, raw.get("table")) if "table" in raw else None
    faults.raise_if_any()
    pieces, rows = [], rows or ()
    for i, ((start, value), (end, value_end)) in enumerate(pairwise(rows)):
        if end < start:
            faults.add(("table", i + 1), f"{_at(end)} comes after {_at(start)}; rows go from the tip on")
        elif end - start > _TOUCHING:
            pieces.append(StiffnessPiece(start=start, end=end, value=value, value_end=value_end))
        elif i in (0, len(rows) - 2):
            faults.add(("table", i + 1), f"a step at {_at(end)}, an end of the table; steps lie inside")
    if rows and rows[0][0] > _TOUCHING:
        faults.add(("table", 0), f"begins at {_at(rows[0][0])}; the first row is at the tip, 0")
    if rows and length is not None and abs(rows[-1][0] - length) > _TOUCHING:
        faults.add(("table", len(rows) - 1), f"ends at {_at(rows[-1][0])}, the wire at {_at(length)}; {_END}")
    faults.raise_if_any()
    return tuple(pieces)


_END = "the last end is the wire's length"


def _joined(forms: Sequence[PieceForm], places: Sequence[int], length: float | None) -> tuple[StiffnessPiece, ...]:
    """Pieces without gap or overlap, their ends made to meet exactly. `places` are their positions in the file."""
    faults = Faults()
    pieces: list[StiffnessPiece] = []
    reached = 0.0
    for form, place in zip(forms, places, strict=True):
        if form.end - form.start <= _TOUCHING:
            faults.add((place,), f"goes from {_at(form.start)} to {_at(form.end)}; 'to' must lie beyond 'from'")
            continue
        if form.start > reached + _TOUCHING:
            faults.add((place,), f"a gap: nothing from {_at(reached)} to {_at(form.start)}; pieces must meet")
        elif form.start < reached - _TOUCHING:
            end = min(reached, form.end)
            faults.add((place,), f"an overlap: {_at(form.start)} to {_at(end)} is given twice; pieces must meet")
        pieces.append(StiffnessPiece(start=reached, end=form.end, value=form.value[0], value_end=form.value[1]))
        reached = max(reached, form.end)
    if length is not None and pieces and abs(reached - length) > _TOUCHING:
        short = "the rest of the wire has no stiffness" if reached < length else "it goes beyond the wire"
        faults.add((places[-1],), f"ends at {_at(reached)}, the wire at {_at(length)}: {short}; {_END}")
    faults.raise_if_any()
    if length is not None:
        pieces[-1] = pieces[-1].model_copy(update={"end": length})
    return tuple(pieces)


def clipped(pieces: Sequence[StiffnessPiece], length: float) -> tuple[StiffnessPiece, ...]:
    """The distal `length` (m) of pieces that are longer, as when a shorter wire is cut from a known one."""
    kept = []
    for piece in pieces:
        if piece.start >= length - _TOUCHING:
            break
        if piece.end > length:
            share = (length - piece.start) / (piece.end - piece.start)
            value_end = piece.value + share * (piece.value_end - piece.value)
            piece = piece.model_copy(update={"end": length, "value_end": value_end})
        kept.append(piece)
    return tuple(kept)


def stiffness_json() -> dict[str, Any]:
    """JSON schema of the three forms."""
    piece = {
        "type": "object",
        "properties": {"from": ARC_LENGTH.json(), "to": ARC_LENGTH.json(), "value": Stiffness().json()},
        "required": ["from", "to", "value"],
        "additionalProperties": False,
    }
    table = {
        "type": "object",
        "properties": {"table": _TABLE.json()},
        "required": ["table"],
        "additionalProperties": False,
    }
    pieces = {"type": "array", "items": piece, "minItems": 1, "maxItems": _MOST_PIECES}
    return {"anyOf": [*BENDING_STIFFNESS.json()["anyOf"], pieces, table, {"type": "null"}]}


def _at(position: float) -> str:
    return format_quantity(position, "mm")
