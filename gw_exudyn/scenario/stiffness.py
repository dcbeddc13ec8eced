"""Bending stiffness along a wire: the forms in which a file may give it, and the pieces that come of them.

Arc length is measured from the tip, as a maker's data is. Pieces are linear in between and may step where they meet.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any

from pydantic import Field, TypeAdapter, model_validator

from gw_exudyn.scenario.faults import Faults, wrong
from gw_exudyn.scenario.fields import Kind, Quantity, Row, Table
from gw_exudyn.scenario.kinds import ARC_LENGTH, BENDING_STIFFNESS, CORE_DIAMETER, MODULUS
from gw_exudyn.scenario.section import Section
from gw_exudyn.scenario.units import format_quantity
from gw_exudyn.scenario.words import did_you_mean, nearest, plural, shown

_TOUCHING = 1e-9
"""m. Ends nearer than this meet; a piece is never so short."""

_MOST_PIECES = 10_000


@dataclass(frozen=True)
class AtEnds(Kind):
    """What a piece has along its length: one value, or `[a, b]` at its start (nearer to the tip) and its end."""

    quantity: Quantity

    def read(self, value: Any) -> tuple[float, float] | None:
        """Start and end value, in SI; None where the file gives none."""
        if value is None:
            return None
        if isinstance(value, list | tuple):
            first, last = Row(("at from", "at to"), (self.quantity, self.quantity)).read(value)
            return first, last
        constant = self.quantity.read(value)
        return constant, constant  # type: ignore[return-value]  # None only where a quantity is optional

    def json(self) -> dict[str, Any]:
        """One value or two."""
        one = self.quantity.json()
        return {"anyOf": [*one["anyOf"], {"type": "array", "prefixItems": [one, one], "minItems": 2, "maxItems": 2}]}


class PieceForm(Section):
    """One stretch of the wire as a file gives it: its bending stiffness, or the core that has it."""

    what = "a piece of the bending stiffness"

    start: Annotated[float, ARC_LENGTH] = Field(
        alias="from", description="where it begins, from the tip", examples=["0 mm"]
    )
    end: Annotated[float, ARC_LENGTH] = Field(alias="to", description="where it ends, from the tip", examples=["45 mm"])
    value: Annotated[tuple[float, float] | None, AtEnds(BENDING_STIFFNESS)] = Field(
        default=None, description="bending stiffness EI: one value, or [at from, at to]", examples=["1.0 N*mm^2"]
    )
    core: Annotated[tuple[float, float] | None, AtEnds(CORE_DIAMETER)] = Field(
        default=None,
        description="diameter of a round, solid core, instead of a value: one, or [at from, at to] of a taper",
        examples=["[0.1 mm, 0.3 mm]"],
    )
    modulus: Annotated[tuple[float, float] | None, AtEnds(MODULUS)] = Field(
        default=None, description="Young's modulus of the core: one value, or [at from, at to]", examples=["60 GPa"]
    )

    @model_validator(mode="after")
    def _one_of_both(self) -> PieceForm:
        if self.value is not None and (self.core is not None or self.modulus is not None):
            raise wrong("has a value and a core; give value, or core and modulus")
        if self.value is None and (self.core is None or self.modulus is None):
            have = "only a core" if self.core else "only a modulus" if self.modulus else "no bending stiffness"
            raise wrong(f"has {have}; give value (as value: 1.0 N*mm^2), or core and modulus")
        return self

    def stiffness(self) -> tuple[tuple[float, float], ...]:
        """(share of the length, EI in N m^2) from start to end: two rows, or as many as a taper needs.

        EI = E pi d^4 / 64 of a round section; between two rows the linear EI is off by less than 0.1 %.
        """
        if self.core is None or self.modulus is None:  # then there is a value, as _one_of_both has seen to
            first, last = self.value or (math.nan, math.nan)
            return (0.0, first), (1.0, last)
        steps = _taper_steps(self.core, self.modulus)
        rows = []
        for i in range(steps + 1):
            share = i / steps
            core, modulus = (ends[0] + share * (ends[1] - ends[0]) for ends in (self.core, self.modulus))
            rows.append((share, math.pi / 64 * modulus * core**4))
        return tuple(rows)


def _taper_steps(core: tuple[float, float], modulus: tuple[float, float]) -> int:
    """Linear stretches that follow EI ~ E d^4 within 0.1 %.

    The error of a chord is at most h^2/8 times the second derivative, that is 3/2 ((d2 - d1)/d)^2 of EI for the
    diameter, and d alone; it is largest at the thin end.
    """
    thin, change = min(core), abs(core[1] - core[0])
    weak, stiffer = min(modulus), abs(modulus[1] - modulus[0])
    bent = 12 * (change / thin) ** 2 + 8 * (change / thin) * (stiffer / weak)
    return max(1, math.ceil(math.sqrt(bent / 8 / 1e-3)))


class StiffnessPiece(Section):
    """Bending stiffness over one stretch of the wire, linear in between.

    start, end : m, arc length from the tip. value, value_end : N m^2, bending stiffness at start and at end.
    """

    start: float
    end: float
    value: float
    value_end: float

    def times(self, factor: float) -> StiffnessPiece:
        """The piece with `factor` times its bending stiffness."""
        return self.model_copy(update={"value": self.value * factor, "value_end": self.value_end * factor})

    def value_at(self, place: float) -> float:
        """Bending stiffness, N m^2, at `place`, m from the tip."""
        share = (place - self.start) / (self.end - self.start)
        return self.value + share * (self.value_end - self.value)

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
    raw : one stiffness for the whole wire; a list of `{from, to, value}` or `{from, to, core, modulus}`; or
        `{table: [[s, EI], ...]}`.
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
        for (share, value), (share_end, value_end) in pairwise(form.stiffness()):
            begin, end = (reached + part * (form.end - reached) for part in (share, share_end))
            pieces.append(StiffnessPiece(start=begin, end=end, value=value, value_end=value_end))
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
            piece = piece.model_copy(update={"end": length, "value_end": piece.value_at(length)})
        kept.append(piece)
    return tuple(kept)


def pieces_before_step(pieces: Sequence[StiffnessPiece]) -> int:
    """How many pieces, from the tip, lie before the first step of the bending stiffness; all where there is none."""
    for i, (piece, following) in enumerate(pairwise(pieces)):
        if abs(piece.value_end - following.value) > 1e-9 * following.value:
            return i + 1
    return len(pieces)


def with_floppy_tip(
    pieces: Sequence[StiffnessPiece], length: float, value: float, taper: float
) -> tuple[StiffnessPiece, ...]:
    """The pieces with a soft distal `length` (m) of bending stiffness `value` (N m^2) laid over, and behind it a
    `taper` (m) on which it rises linearly to what the pieces have there.

    Laid over twice, it is the same as once.
    """
    end = length + taper
    laid = [StiffnessPiece(start=0.0, end=length, value=value, value_end=value)] if length > 0 else []
    rest = [piece for piece in pieces if piece.end > end + _TOUCHING]
    if rest and rest[0].start < end:
        rest[0] = rest[0].model_copy(update={"start": end, "value": rest[0].value_at(end)})
    if taper > 0:
        reached = rest[0].value if rest else pieces[-1].value_end
        laid.append(StiffnessPiece(start=length, end=end, value=value, value_end=reached))
    return (*laid, *rest)


def stiffness_json() -> dict[str, Any]:
    """JSON schema of the three forms."""
    piece = {
        "type": "object",
        "properties": {
            "from": ARC_LENGTH.json(),
            "to": ARC_LENGTH.json(),
            "value": AtEnds(BENDING_STIFFNESS).json(),
            "core": AtEnds(CORE_DIAMETER).json(),
            "modulus": AtEnds(MODULUS).json(),
        },
        "required": ["from", "to"],
        "oneOf": [{"required": ["value"]}, {"required": ["core", "modulus"]}],
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
