"""A resolved scenario as rows of text: dotted path and value, in the units in which people give them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from gw_exudyn.scenario.fields import Quantity, Row
from gw_exudyn.scenario.kinds import (
    BENDING_STIFFNESS,
    COORDINATE,
    FORCE,
    FORCE_LIMIT,
    HUB_DAMPING,
    HUB_MASS,
    HUB_SPEED,
    SPEED,
)
from gw_exudyn.scenario.section import Section
from gw_exudyn.scenario.units import format_quantity

if TYPE_CHECKING:
    from gw_exudyn.scenario import ForceDrive, Scenario, SpeedDrive, StiffnessPiece, TipSpeedDrive

_SHOWN_ITEMS = 12
"""Longer lists are cut; JSON has them in full."""


def resolved_rows(scenario: Scenario) -> list[tuple[str, str]]:
    """Path and value of everything in the scenario, in the order of the file."""
    return list(_section(scenario, ""))


def _section(section: Section, above: str) -> Iterator[tuple[str, str]]:
    for name, info in type(section).model_fields.items():
        value, path = getattr(section, name), f"{above}{info.alias or name}"
        kind = next((found for found in info.metadata if isinstance(found, Quantity | Row)), None)
        if name == "bending_stiffness":
            yield from _listed(path, [_piece_text(piece) for piece in value])
        elif name == "drive":
            yield from _drive(path, value)
        elif name == "points":
            yield from _listed(path, [_text(point, Row(("x", "y"), (COORDINATE, COORDINATE))) for point in value])
        elif name == "supports":
            for i, support in enumerate(value):
                yield from _section(support, f"{path}.{i}.")
        elif isinstance(value, Section):
            yield from _section(value, f"{path}.")
        elif value is not None or (isinstance(kind, Quantity) and kind.word_for(value)):
            yield path, _text(value, kind)


def _text(value: Any, kind: Quantity | Row | None) -> str:
    if isinstance(kind, Quantity):
        return kind.word_for(value) or format_quantity(value, kind.usual)
    if isinstance(value, list | tuple):
        kinds: Sequence[Any] = kind.kinds if isinstance(kind, Row) else [None] * len(value)
        return f"[{', '.join(_text(item, one) for item, one in zip(value, kinds, strict=True))}]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _piece_text(piece: StiffnessPiece) -> str:
    start, end = format_quantity(piece.start, "mm"), format_quantity(piece.end, "mm")
    first, last = (format_quantity(value, BENDING_STIFFNESS.usual) for value in (piece.value, piece.value_end))
    return f"{start} to {end} from the tip: {first}" + ("" if piece.value == piece.value_end else f" to {last}")


_DRIVE_VALUES = {"max_speed": HUB_SPEED, "force_limit": FORCE_LIMIT, "hub_mass": HUB_MASS, "hub_damping": HUB_DAMPING}


def _drive(path: str, drive: SpeedDrive | ForceDrive | TipSpeedDrive) -> Iterator[tuple[str, str]]:
    values, kind = (drive.force, FORCE) if drive.kind == "force" else (drive.speed, SPEED)
    rows = zip(drive.time, values, strict=True)
    yield f"{path}.kind", drive.kind
    yield f"{path}.start", format_quantity(drive.start, "mm")
    yield f"{path}.hold", drive.hold
    yield from _listed(f"{path}.table", [f"at {format_quantity(t, 's')}: {_text(v, kind)}" for t, v in rows])
    plain = drive.to_plain()
    for name, kind in _DRIVE_VALUES.items():
        if name in plain:
            yield f"{path}.{name}", _text(plain[name], kind)


def _listed(path: str, texts: list[str]) -> Iterator[tuple[str, str]]:
    shown = texts[:_SHOWN_ITEMS]
    for i, text in enumerate(shown):
        yield f"{path}.{i}", text
    if len(texts) > len(shown):
        yield path, f"... and {len(texts) - len(shown)} more"
