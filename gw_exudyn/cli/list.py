"""`gw-exudyn list`: what comes with gw-exudyn by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import click

from gw_exudyn.cli import options
from gw_exudyn.cli.console import put_json, put_table

if TYPE_CHECKING:
    from gw_exudyn.scenario.catalogue import CatalogueWire


@click.command(
    short_help="List the wires of the catalogue, or the shipped scenarios.",
    help="""List what may be taken by name: the WIRES of the catalogue, with their bending stiffness from the tip (best
    estimate, range, grade of confidence: A in the paper, B primary source, C secondary, D inference), or the shipped
    SCENARIOS. --json gives the whole catalogue, each number with its source.""",
)
@click.argument("what", type=click.Choice(["wires", "scenarios"]))
@options.as_json
def command(what: str, as_json: bool) -> int:
    """Read the table that is asked for, and write it."""
    content, rows = {"wires": _wires, "scenarios": _scenarios}[what]()
    if as_json:
        put_json(content)
    else:
        put_table(rows())
    return 0


def _wires() -> tuple[Mapping[str, Any], Callable[[], list[tuple[str, ...]]]]:
    from gw_exudyn.scenario.catalogue import load_catalogue

    wires = load_catalogue()
    return {name: wire.to_plain() for name, wire in wires.items()}, lambda: [
        (name, *_wire_texts(wire)) for name, wire in sorted(wires.items())
    ]


def _wire_texts(wire: CatalogueWire) -> tuple[str, str, str, str]:
    from gw_exudyn.scenario.units import format_quantity

    grade = f"grade {wire.bending_stiffness.confidence}"
    pieces = "; ".join(
        f"{_stiffness_text(piece.value, piece.low, piece.high)} to {format_quantity(piece.end, 'mm')}"
        for piece in wire.bending_stiffness.pieces
    )
    diameter = format_quantity(float(f"{wire.diameter.value:.3g}"), "mm")
    return wire.title, diameter, f"EI {pieces}", grade


def _stiffness_text(value: float | None, low: float | None, high: float | None) -> str:
    from gw_exudyn.scenario.units import format_quantity

    bounds = "" if low is None or high is None else f"{low * 1e6:g} to {format_quantity(high, 'N*mm^2')}"
    if value is None:
        return bounds
    return format_quantity(value, "N*mm^2") + (f" ({bounds})" if bounds else "")


def _scenarios() -> tuple[Mapping[str, Any], Callable[[], list[tuple[str, ...]]]]:
    from gw_exudyn.scenario import load_scenario
    from gw_exudyn.scenario.shipped import list_shipped, shipped_folder

    loaded = {name: load_scenario(name) for name in list_shipped()}
    facts = {
        name: {
            "wire": scenario.wire.model or "given inline",
            "vessel": scenario.vessel.kind,
            "drive": scenario.drive.kind,
            "file": str(shipped_folder() / f"{name}.yaml"),
        }
        for name, scenario in loaded.items()
    }
    return facts, lambda: [
        (name, fact["wire"], f"{fact['vessel']} vessel", f"{fact['drive']} drive") for name, fact in facts.items()
    ]
