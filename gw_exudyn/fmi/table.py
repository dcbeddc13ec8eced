"""The table of an FMU's variables: what a host can set, and what it is told.

Outputs bear the names of `output_name`, units and meanings from the table of quantities. The value reference of a
variable is its place in the table.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from gw_exudyn.fmi.parameters import settable
from gw_exudyn.fmi.variables import (
    INDEPENDENT,
    INTEGER,
    OUTPUT,
    PEAKS,
    PLACE_OF_LARGEST,
    REAL,
    STATIONS,
    STATUS_CODE,
    STATUS_MESSAGE,
    TEXT,
    Variable,
    output_name,
    peak_names,
    status_code,
)
from gw_exudyn.quantities import QUANTITIES, SCALARS
from gw_exudyn.result import Status

if TYPE_CHECKING:
    from gw_exudyn.model import Model
    from gw_exudyn.scenario import Scenario

DEFAULT_STATIONS = 51
"""Points along the wire at which FMI 3 shows its shape and forces, unless told otherwise."""


def variables_of(scenario: Scenario, fmi: int, stations: int = DEFAULT_STATIONS) -> list[Variable]:
    """The variables of a scenario's FMU. Raises ScenarioError for one that cannot start."""
    from gw_exudyn.model import build

    return table(build(scenario), SCALARS, stations if fmi == 3 else 0)


def table(model: Model, scalars: tuple[str, ...], stations: int = 0) -> list[Variable]:
    """All variables of a scenario's FMU.

    scalars : names of the quantities that become outputs. stations : points along the wire for arrays; 0 for none.
    """
    return [
        Variable("time", REAL, INDEPENDENT, "time", unit="s"),
        *settable(model),
        *_outputs(scalars),
        *_places(),
        *_peaks(),
        *_status(),
        *(_station(*row, stations) for row in STATIONS if stations),
    ]


def _outputs(scalars: tuple[str, ...]) -> Iterator[Variable]:
    for name in scalars:
        quantity = QUANTITIES[name]
        kind = INTEGER if quantity.integer else REAL
        units = ("", "") if quantity.integer else (quantity.unit, quantity.display_unit)
        yield Variable(output_name(name), kind, OUTPUT, quantity.long_name, None, *units, source=name)


def _places() -> Iterator[Variable]:
    for name, quantity in PLACE_OF_LARGEST.items():
        text = f"{QUANTITIES[quantity].long_name}, of the largest force of a single contact with the vessel; 0 for none"
        yield Variable(name, REAL, OUTPUT, text, None, QUANTITIES[quantity].unit, QUANTITIES[quantity].display_unit)


def _peaks() -> Iterator[Variable]:
    for peak in PEAKS:
        known = QUANTITIES["push_force" if peak == "pull_force" else peak]
        what = "pull force (negative push force)" if peak == "pull_force" else known.long_name
        (name, when), unit = peak_names(peak), (known.unit, known.display_unit)
        yield Variable(name, REAL, OUTPUT, f"maximum over all solver steps so far, 0 for none, of: {what}", None, *unit)
        yield Variable(when, REAL, OUTPUT, f"time of the maximum of: {what}", None, "s")


def _status() -> Iterator[Variable]:
    codes = ", ".join(f"{status_code(s)} {s.name}" for s in Status if status_code(s))
    yield Variable(STATUS_MESSAGE, TEXT, OUTPUT, "whether the run can be trusted and, if not, what to change", "")
    yield Variable(STATUS_CODE, INTEGER, OUTPUT, f"0 while the run goes on and nothing is wrong; {codes}")


def _station(name: str, quantity: str, text: str, stations: int) -> Variable:
    unit, display = QUANTITIES[quantity].unit, QUANTITIES[quantity].display_unit
    return Variable(name, REAL, OUTPUT, text, None, unit, display, size=stations)
