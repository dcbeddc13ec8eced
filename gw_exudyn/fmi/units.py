"""Units as FMI wants them: named, with their exponents of base units, and display units with a factor."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from gw_exudyn.fmi.variables import Variable
from gw_exudyn.scenario.units import parse_unit


@dataclass(frozen=True)
class FmiUnit:
    """A unit. exponents : of base units, by FMI's name, zeros left out. displays : name and number of them in one."""

    name: str
    exponents: dict[str, int]
    displays: dict[str, float]


def fmi_name(unit: str) -> str:
    """A unit, of the quantities (`m s-1`) or of the scenario (`N*mm^2`), as FMI and Modelica write it: `m/s`,
    `N.mm2`."""
    text = _scenario_name(unit) if unit else ""
    return text.replace("*", ".").replace("^", "")


def _scenario_name(unit: str) -> str:
    """In the notation of the scenario's units."""
    above, below = [], []
    for word in unit.split():
        match = re.fullmatch(r"([A-Za-z]+)-(\d)", word)
        if match is None:
            above.append(word)
        else:
            below.append(match[1] if match[2] == "1" else f"{match[1]}^{match[2]}")
    return "/".join(["*".join(above) or "1", *below])


def definitions(variables: Iterable[Variable]) -> list[FmiUnit]:
    """Every unit that the variables need, with its display units, by name."""
    found: dict[str, FmiUnit] = {}
    for variable in variables:
        if not variable.unit:
            continue
        name = fmi_name(variable.unit)
        unit = found.setdefault(name, FmiUnit(name, _exponents(variable.unit), {}))
        display = fmi_name(variable.display_unit)
        if display and display != name:
            unit.displays[display] = 1.0 / float(parse_unit(_scenario_name(variable.display_unit)).factor)
    return [found[name] for name in sorted(found)]


def _exponents(unit: str) -> dict[str, int]:
    if unit == "1":
        return {}
    length, mass, time, angle = parse_unit(_scenario_name(unit)).dimension
    powers = {"kg": mass, "m": length, "s": time, "rad": angle}
    return {name: power for name, power in powers.items() if power}
