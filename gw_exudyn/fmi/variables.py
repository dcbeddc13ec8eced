"""The table of an FMU's variables: made from the quantities and from what a scenario can be told.

Outputs bear the names of `_OUTPUTS`, units and meanings from the table of quantities. Parameters bear the scenario's
dotted paths, with unit, limits and meaning from the scenario's fields; they are all fixed, since a run is built with
them. The value reference of a variable is its place in the table.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from gw_exudyn.quantities import QUANTITIES
from gw_exudyn.result import Status
from gw_exudyn.scenario.fields import Choice, Number, Quantity, Section, Whole

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


COMMAND_SPEED, COMMAND_ACTIVE, SCENARIO_FILE, TIMEOUT = (
    "command.speed",
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


def status_code(status: Status) -> int:
    """0 while nothing is wrong, else the number of the status."""
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
        *_status(),
        *(_station(*row, stations) for row in _STATIONS if stations),
    ]


def _commands(scenario: Scenario) -> Iterator[Variable]:
    first = float(scenario.drive.speed[0])
    text = (
        "speed of the drive, positive into the vessel; it rules from the first step at which it differs from its start,"
        " or from the beginning with command.active; until then the scenario's own drive does"
    )
    yield Variable(COMMAND_SPEED, REAL, INPUT, text, first, "m/s", "mm/s")
    yield Variable(COMMAND_ACTIVE, BOOLEAN, FIXED, "command.speed rules from the beginning", False)


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
    for part in ("wire", "vessel", "catheter", "contact", "solver"):
        yield from _section(part, getattr(scenario, part), known)
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


def constant_speed(scenario: Scenario) -> float | None:
    """The speed, m/s, of a drive that has only one and moves; else None."""
    speeds = set(scenario.drive.speed)
    return float(speeds.pop()) if len(speeds) == 1 and 0.0 not in speeds else None


def _drive(scenario: Scenario) -> Iterator[Variable]:
    from gw_exudyn.scenario.kinds import SPEED, TRAVEL

    speed = constant_speed(scenario)
    if speed is not None:
        way = abs(speed) * scenario.drive.duration
        yield from _parameter("drive.speed", SPEED, speed, "speed of the drive, positive into the vessel")
        yield from _parameter("drive.distance", TRAVEL, way, "travel in the direction of the speed")


def _outputs(scalars: tuple[str, ...]) -> Iterator[Variable]:
    for name in scalars:
        quantity = QUANTITIES[name]
        kind = INTEGER if quantity.integer else REAL
        units = ("", "") if quantity.integer else (quantity.unit, quantity.display_unit)
        yield Variable(output_name(name), kind, OUTPUT, quantity.long_name, None, *units, source=name)


def _status() -> Iterator[Variable]:
    codes = ", ".join(f"{status_code(s)} {s.name}" for s in Status if status_code(s))
    yield Variable(STATUS_MESSAGE, TEXT, OUTPUT, "whether the run can be trusted and, if not, what to change", "")
    yield Variable(STATUS_CODE, INTEGER, OUTPUT, f"0 while nothing is wrong; {codes}")


def _station(name: str, quantity: str, text: str, stations: int) -> Variable:
    unit, display = QUANTITIES[quantity].unit, QUANTITIES[quantity].display_unit
    return Variable(name, REAL, OUTPUT, text, None, unit, display, size=stations)
