"""A resolved scenario as rows of text: dotted path and value, in the units in which people give them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from gw_exudyn.scenario.fields import Quantity, Row, Section
from gw_exudyn.scenario.kinds import BENDING_STIFFNESS, COORDINATE, SPEED
from gw_exudyn.scenario.units import format_quantity

if TYPE_CHECKING:
    from gw_exudyn.scenario import Scenario, SpeedDrive, StiffnessPiece

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
            yield f"{path}.kind", value.kind
            yield f"{path}.start", format_quantity(value.start, "mm")
            yield f"{path}.hold", value.hold
            yield from _listed(f"{path}.table", _drive_texts(value))
        elif name == "points":
            yield from _listed(path, [_text(point, Row(("x", "y"), (COORDINATE, COORDINATE))) for point in value])
        elif name == "supports":
            for i, support in enumerate(value):
                yield from _section(support, f"{path}.{i}.")
        elif isinstance(value, Section):
            yield from _section(value, f"{path}.")
        elif value is not None or (isinstance(kind, Quantity) and kind.auto):
            yield path, _text(value, kind)


def _text(value: Any, kind: Quantity | Row | None) -> str:
    if value is None:
        return "auto"
    if isinstance(kind, Quantity):
        return format_quantity(value, kind.usual)
    if isinstance(value, list | tuple):
        kinds: Sequence[Any] = kind.kinds if isinstance(kind, Row) else [None] * len(value)
        return f"[{', '.join(_text(item, one) for item, one in zip(value, kinds, strict=True))}]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _piece_text(piece: StiffnessPiece) -> str:
    start, end = format_quantity(piece.start, "mm"), format_quantity(piece.end, "mm")
    first, last = (format_quantity(value, BENDING_STIFFNESS.usual) for value in (piece.value, piece.value_end))
    return f"{start} to {end} from the tip: {first}" + ("" if piece.value == piece.value_end else f" to {last}")


def _drive_texts(drive: SpeedDrive) -> list[str]:
    return [
        f"at {format_quantity(time, 's')}: {format_quantity(speed, SPEED.usual)}"
        for time, speed in zip(drive.time, drive.speed, strict=True)
    ]


def _listed(path: str, texts: list[str]) -> Iterator[tuple[str, str]]:
    shown = texts[:_SHOWN_ITEMS]
    for i, text in enumerate(shown):
        yield f"{path}.{i}", text
    if len(texts) > len(shown):
        yield path, f"... and {len(texts) - len(shown)} more"
