"""The table of an FMU's variables: made from the quantities and from what a scenario can be told.

Outputs bear the names of `_OUTPUTS`, units and meanings from the table of quantities. Parameters bear the scenario's
dotted paths, with unit, limits and meaning from the scenario's fields; they are all fixed, since a run is built with
them. The value reference of a variable is its place in the table.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from gw_exudyn.quantities import QUANTITIES
from gw_exudyn.result import Status
from gw_exudyn.scenario.fields import Choice, Number, Quantity, Whole
from gw_exudyn.scenario.section import Section

if TYPE_CHECKING:
    from gw_exudyn.model import Model
    from gw_exudyn.scenario import Scenario

REAL, INTEGER, BOOLEAN, TEXT = "R", "I", "B", "S"
INDEPENDENT, INPUT, FIXED, TUNABLE, OUTPUT = "t", "i", "f", "u", "o"


@dataclass(frozen=True)
class Variable:
    """A variable of the FMU.

    kind : REAL, INTEGER, BOOLEAN or TEXT. role : INDEPENDENT, INPUT, FIXED or TUNABLE (parameters), OUTPUT.
    start : value that the exported scenario has; None where it is computed. unit : SI, "" for none. display_unit :
    what a person reads it in. low, high : limits, SI. size : number of values; above one it is an array. source : name
    of the quantity that an output shows, or dotted path of what a parameter sets; "" for what is the FMU's own.
    """

    name: str
    kind: str
    role: str
    description: str
    start: float | int | bool | str | None = None
    unit: str = ""
    display_unit: str = ""
    low: float | None = None
    high: float | None = None
    size: int = 1
    source: str = ""

    @property
    def settable(self) -> bool:
        """A host can give it a value."""
        return self.role in (INPUT, FIXED, TUNABLE)


COMMAND_SPEED, COMMAND_FORCE, COMMAND_ACTIVE, SCENARIO_FILE, TIMEOUT = (
    "command.speed",
    "command.force",
    "command.active",
    "scenarioFile",
    "worker.timeout",
)
STATUS_CODE, STATUS_MESSAGE = "status.code", "status.message"
STIFFNESS_FACTOR = "wire.bending_stiffness.factor"

_OUTPUTS: Mapping[str, str] = MappingProxyType(
    {
        "insertion_depth": "insertion.depth",
        "tip_x": "tip.x",
        "tip_y": "tip.y",
        "tip_angle": "tip.angle",
        "tip_force": "tip.force",
        "push_force": "push.force",
        "drive_speed": "push.speed",
        "drive_position": "push.position",
        "wall_force_x": "wall.force.x",
        "wall_force_y": "wall.force.y",
        "wall_force_normal": "wall.force.normal",
        "wall_force_tangential": "wall.force.tangential",
        "wall_force_max": "wall.force.max",
        "contacts": "wall.contacts",
        "penetration_max": "wall.penetration",
        "catheter_force_x": "catheter.force.x",
        "catheter_force_y": "catheter.force.y",
        "catheter_force_normal": "catheter.force.normal",
        "insertion_work": "energy.insertion_work",
        "elastic_energy": "energy.elastic",
        "wall_energy": "energy.wall",
        "kinetic_energy": "energy.kinetic",
        "friction_loss": "energy.friction_loss",
        "damping_loss": "energy.damping_loss",
        "numerical_loss": "energy.numerical_loss",
        "energy_error": "energy.error",
        "solver_steps": "solver.steps",
        "newton_iterations": "solver.iterations",
        "smallest_step": "solver.smallest_step",
    }
)
"""Name in the FMU of every scalar quantity; a quantity that is not here is named after the rule of `output_name`."""

_PEAKS: Mapping[str, str] = MappingProxyType(
    {
        "push_force": "push.force",
        "pull_force": "pull.force",
        "wall_force_max": "wall.force.max",
        "penetration_max": "wall.penetration",
    }
)
"""Name in the FMU of what a simulation keeps the largest value of, over all solver steps."""

PEAKS: tuple[str, ...] = tuple(_PEAKS)

_PLACE = {"x": "contact_x", "y": "contact_y", "arc_length": "contact_arc_length"}
PLACE_OF_LARGEST: Mapping[str, str] = MappingProxyType(
    {f"wall.force.max.{name}": quantity for name, quantity in _PLACE.items()}
)
"""Outputs that say where the vessel is pressed hardest, and the contact fields that they show."""

_STATIONS = (
    ("wire.station.arc_length", "node_arc_length", "place of the stations along the wire, from the tip"),
    ("wire.station.x", "node_x", "x of the wire's axis at the stations"),
    ("wire.station.y", "node_y", "y of the wire's axis at the stations"),
    (
        "wire.station.normal_force",
        "contact_normal_force",
        "normal force of the wire on vessel and catheter, summed over the contacts nearest to each station",
    ),
)
STATION_NAMES: tuple[str, ...] = tuple(name for name, _, _ in _STATIONS)


def output_name(quantity: str) -> str:
    """Name of a scalar quantity among the FMU's variables."""
    return _OUTPUTS.get(quantity, f"result.{quantity}")


def peak_names(peak: str) -> tuple[str, str]:
    """Names, among the FMU's variables, of a peak and of its time."""
    return f"{_PEAKS[peak]}.peak", f"{_PEAKS[peak]}.peak_time"


def status_code(status: Status) -> int:
    """0 while the run goes on and nothing is wrong, else the number of the status."""
    return 0 if status in (Status.COMPLETED, Status.STOPPED) else list(Status).index(status)


def table(model: Model, scalars: tuple[str, ...], stations: int = 0) -> list[Variable]:
    """All variables of a scenario's FMU.

    scalars : names of the quantities that become outputs. stations : points along the wire for arrays; 0 for none.
    """
    return [
        Variable("time", REAL, INDEPENDENT, "time", unit="s"),
        *_commands(model.scenario),
        *_own_parameters(),
        *_parameters(model),
        *_outputs(scalars),
        *_places(),
        *_peaks(),
        *_status(),
        *(_station(*row, stations) for row in _STATIONS if stations),
    ]


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
    yield Variable(STIFFNESS_FACTOR, REAL, FIXED, factor, 1.0, "1", "1", 1e-3, 1e3)
    for i in range(len(scenario.wire.bending_stiffness)):
        name = f"wire.bending_stiffness[{i}].factor"
        yield Variable(name, REAL, FIXED, f"{factor}, of piece {i} from the tip", 1.0, "1", "1", 1e-3, 1e3)
    for part in ("wire", "vessel", "catheter", "contact", "stop", "solver"):
        section = getattr(scenario, part)
        if section is not None:
            yield from _section(part, section, known)
    yield from _drive(scenario)


def _section(part: str, section: Section, chosen: Mapping[str, Any]) -> Iterator[Variable]:
    for field, info in type(section).model_fields.items():
        path, value = f"{part}.{field}", getattr(section, field)
        if value is None:
            value = chosen.get(path)
        kind = next((k for k in info.metadata if isinstance(k, Quantity | Number | Whole | Choice)), None)
        if kind is not None and value is not None and field not in ("kind", "model"):
            yield from _parameter(path, kind, value, info.description or field)


def _parameter(path: str, kind: Quantity | Number | Whole | Choice, value: Any, text: str) -> Iterator[Variable]:
    if isinstance(kind, Quantity):
        yield Variable(path, REAL, FIXED, text, float(value), kind.unit, kind.usual, kind.low, kind.high, source=path)
    elif isinstance(kind, Number):
        yield Variable(path, REAL, FIXED, text, float(value), "1", "1", kind.low, kind.high, source=path)
    elif isinstance(kind, Whole):
        yield Variable(path, INTEGER, FIXED, text, int(value), low=kind.low, high=kind.high, source=path)
    elif len(kind.words) > 1:
        yield Variable(path, TEXT, FIXED, f"{text}; one of {', '.join(kind.words)}", str(value), source=path)


def constant_drive(scenario: Scenario) -> float | None:
    """The speed, m/s, or force, N, of a drive that has only one and moves; else None."""
    values = set(_course(scenario))
    return float(values.pop()) if len(values) == 1 and 0.0 not in values else None


def _drive(scenario: Scenario) -> Iterator[Variable]:
    from gw_exudyn.scenario import kinds

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
        yield from _parameter("drive.distance", kinds.TRAVEL, way, "travel in the direction of the speed")
    for field, kind, text in (
        ("hub_mass", kinds.HUB_MASS, "mass of the hub"),
        ("hub_damping", kinds.HUB_DAMPING, "damping of the hub"),
        ("max_speed", kinds.HUB_SPEED, "largest speed of the hub"),
        ("force_limit", kinds.FORCE_LIMIT, "push force above which the hub waits"),
    ):
        known = getattr(drive, field, None)
        if known is not None and math.isfinite(known):
            yield from _parameter(f"drive.{field}", kind, known, text)


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
        yield Variable(name, REAL, OUTPUT, f"largest {what} over all solver steps so far; 0 for none", None, *unit)
        yield Variable(when, REAL, OUTPUT, f"time of the largest {what}", None, "s")


def _status() -> Iterator[Variable]:
    codes = ", ".join(f"{status_code(s)} {s.name}" for s in Status if status_code(s))
    yield Variable(STATUS_MESSAGE, TEXT, OUTPUT, "whether the run can be trusted and, if not, what to change", "")
    yield Variable(STATUS_CODE, INTEGER, OUTPUT, f"0 while the run goes on and nothing is wrong; {codes}")


def _station(name: str, quantity: str, text: str, stations: int) -> Variable:
    unit, display = QUANTITIES[quantity].unit, QUANTITIES[quantity].display_unit
    return Variable(name, REAL, OUTPUT, text, None, unit, display, size=stations)
