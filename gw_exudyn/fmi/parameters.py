"""What a host can set: the drive's command, the FMU's own parameters, and those of the scenario.

Parameters bear the scenario's dotted paths (but see `_PATHS`), with unit, limits and meaning from the scenario's
fields; items of a list are in brackets, as FMI writes them: `supports[0].at[1]` is the path supports.0.at.1. They are
all fixed, since a run is built with them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from gw_exudyn.fmi.variables import (
    BOOLEAN,
    COMMAND_ACTIVE,
    COMMAND_FORCE,
    COMMAND_SPEED,
    FIXED,
    INPUT,
    INTEGER,
    REAL,
    SCENARIO_FILE,
    STIFFNESS_FACTOR,
    STIFFNESS_FACTOR_LIMITS,
    TEXT,
    TIMEOUT,
    TUNABLE,
    Variable,
)
from gw_exudyn.quantities import QUANTITIES
from gw_exudyn.scenario import kinds
from gw_exudyn.scenario.fields import Choice, Kind, Number, OrNone, Quantity, Row, Whole
from gw_exudyn.scenario.section import Section

if TYPE_CHECKING:
    from gw_exudyn.model import Model
    from gw_exudyn.scenario import Scenario

_SECTIONS = ("wire", "vessel", "catheter", "contact", "tip", "nose", "stop", "solver")
_INNER = ("stiffness_factor", "tip_shape", "target")
"""Sections within those that are told as well; what a floppy tip was laid over is not known any more."""

_PATHS = {"tip.dead_force": "tip.force"}
"""Path of what has another name here, since an output has its own."""

_SHOWN_IN = {QUANTITIES["push_force"].unit: QUANTITIES["push_force"].display_unit}
"""Forces all in one unit, parameters as outputs."""

_NAMES = {path: name for name, path in _PATHS.items()}


def settable(model: Model) -> Iterator[Variable]:
    """Everything that a host can set."""
    yield from _commands(model.scenario)
    yield from _own_parameters()
    yield from _parameters(model)


def path_of(name: str) -> str:
    """The scenario's dotted path of a parameter."""
    own, bracket, rest = name.partition("[")
    return f"{_PATHS.get(own, own)}{bracket}{rest}".replace("[", ".").replace("]", "")


def command_of(scenario: Scenario) -> str:
    """What the scenario's drive takes from outside: "speed" or "force"."""
    return "force" if scenario.drive.kind == "force" else "speed"


def _course(scenario: Scenario) -> tuple[float, ...]:
    """Speed, m/s, or force, N, of the drive at the times of its table."""
    course: tuple[float, ...] = getattr(scenario.drive, command_of(scenario))
    return course


def _commands(scenario: Scenario) -> Iterator[Variable]:
    name, what, unit, display = {
        "speed": (COMMAND_SPEED, "speed of the drive", "m/s", "mm/s"),
        "tip_speed": (COMMAND_SPEED, "wanted speed of the tip", "m/s", "mm/s"),
        "force": (COMMAND_FORCE, "force of the drive on the hub", "N", "mN"),
    }[scenario.drive.kind]
    text = (
        f"{what}, positive into the vessel; it rules from the first step at which it differs from its start, "
        "or from the beginning with command.active; until then the scenario's own drive does"
    )
    yield Variable(name, REAL, INPUT, text, float(_course(scenario)[0]), unit, display)
    yield Variable(COMMAND_ACTIVE, BOOLEAN, FIXED, f"{name} rules from the beginning", False)


def _own_parameters() -> Iterator[Variable]:
    text = "another scenario file, or a shipped scenario's name, to run in place of the exported one"
    yield Variable(SCENARIO_FILE, TEXT, FIXED, text, "")
    text = "time without a sign of life after which the worker is given up; 0 waits for ever"
    yield Variable(TIMEOUT, REAL, TUNABLE, text, 300.0, "s", "s", 0.0)


def _parameters(model: Model) -> Iterator[Variable]:
    scenario = model.scenario
    # What the scenario leaves to the model.
    known = {**model.describe(), "catheter.friction_coefficient": scenario.contact.friction_coefficient}
    yield Variable("wire.model", TEXT, FIXED, "wire of the catalogue, by name", scenario.wire.model or "", source="-")
    factor = "factor on the wire's bending stiffness"
    rest = (1.0, "1", "1", *STIFFNESS_FACTOR_LIMITS)
    yield Variable(STIFFNESS_FACTOR, REAL, FIXED, factor, *rest)
    for i in range(len(scenario.wire.bending_stiffness)):
        name = f"wire.bending_stiffness[{i}].factor"
        yield Variable(name, REAL, FIXED, f"{factor}, of piece {i} from the tip", *rest)
    for part in _SECTIONS:
        section = getattr(scenario, part)
        if section is not None:
            yield from _section(part, section, known)
    for i, support in enumerate(scenario.supports):
        yield from _section(f"supports[{i}]", support, known)
    yield from _drive(scenario)


def _section(part: str, section: Section, chosen: Mapping[str, Any]) -> Iterator[Variable]:
    for field, info in type(section).model_fields.items():
        path, value = f"{part}.{field}", getattr(section, field)
        if value is None:
            value = chosen.get(path)
        kind = next((k for k in info.metadata if isinstance(k, Kind)), None)
        if field in _INNER and value is not None:
            yield from _section(path, value, chosen)
        elif kind is not None and value is not None and field not in ("kind", "model"):
            yield from _parameter(path, kind, value, info.description or field)


def _parameter(name: str, kind: Kind, value: Any, text: str) -> Iterator[Variable]:
    name, path = _NAMES.get(name, name), path_of(name)
    if isinstance(kind, OrNone):
        yield from _parameter(name, kind.kind, value, text)
    elif isinstance(kind, Row):
        for i, (item, of_item) in enumerate(zip(kind.names, kind.kinds, strict=True)):
            yield from _parameter(f"{name}[{i}]", of_item, value[i], f"{text}: {item}")
    elif isinstance(kind, Quantity) and kind.low <= value <= kind.high:  # not what a word stands for, as off
        text, shown = _without_words(text, kind), _SHOWN_IN.get(kind.unit, kind.usual)
        yield Variable(name, REAL, FIXED, text, float(value), kind.unit, shown, kind.low, kind.high, source=path)
    elif isinstance(kind, Number):
        yield Variable(name, REAL, FIXED, text, float(value), "1", "1", kind.low, kind.high, source=path)
    elif isinstance(kind, Whole):
        yield Variable(name, INTEGER, FIXED, text, int(value), low=kind.low, high=kind.high, source=path)
    elif isinstance(kind, Choice) and len(kind.words) > 1:
        yield Variable(name, TEXT, FIXED, f"{text}; one of {', '.join(kind.words)}", str(value), source=path)


def _without_words(text: str, kind: Quantity) -> str:
    """A meaning without what it says of words, such as auto, and of leaving the key out: a Real takes numbers alone."""
    words = ("auto", "off", "may be left out", *filter(None, [kind.zero]))
    return "; ".join(part for part in text.split("; ") if not part.startswith(words))


_TRAVEL = "travel in the direction of the speed; it does not end a run inside a host: beyond it the last speed is kept"


def constant_drive(scenario: Scenario) -> float | None:
    """The speed, m/s, or force, N, of a drive that has only one and moves; else None."""
    values = set(_course(scenario))
    return float(values.pop()) if len(values) == 1 and 0.0 not in values else None


def _drive(scenario: Scenario) -> Iterator[Variable]:
    drive, value = scenario.drive, constant_drive(scenario)
    if value is not None:
        kind, text = {
            "speed": (kinds.SPEED, "speed of the drive, positive into the vessel"),
            "tip_speed": (kinds.TIP_SPEED_OR_NONE, "wanted speed of the tip"),
            "force": (kinds.FORCE_OR_NONE, "force on the hub, positive into the vessel"),
        }[drive.kind]
        yield from _parameter(f"drive.{command_of(scenario)}", kind, value, text)
    if value is not None and drive.kind == "speed":
        way = abs(value) * drive.duration
        yield from _parameter("drive.distance", kinds.TRAVEL, way, _TRAVEL)
    for field, kind, text in (
        ("hub_mass", kinds.HUB_MASS, "mass of the hub"),
        ("hub_damping", kinds.HUB_DAMPING, "damping of the hub"),
        ("max_speed", kinds.HUB_SPEED, "largest speed of the hub"),
        ("force_limit", kinds.FORCE_LIMIT, "push force above which the hub waits"),
    ):
        known = getattr(drive, field, None)
        if known is not None and math.isfinite(known):
            yield from _parameter(f"drive.{field}", kind, known, text)
