"""What a variable of the FMU is, and the names of those that are not a parameter of the scenario."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from gw_exudyn.result import Status

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
STIFFNESS_FACTOR_LIMITS = (1e-3, 1e3)
"""Of it, and of the factor of each piece."""

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

STATIONS = (
    ("wire.station.arc_length", "node_arc_length", "place of the stations along the wire, from the tip"),
    ("wire.station.x", "node_x", "x of the wire's axis at the stations"),
    ("wire.station.y", "node_y", "y of the wire's axis at the stations"),
    (
        "wire.station.normal_force",
        "contact_normal_force",
        "normal force of the wire on vessel and catheter, summed over the contacts nearest to each station",
    ),
)
STATION_NAMES: tuple[str, ...] = tuple(name for name, _, _ in STATIONS)


def output_name(quantity: str) -> str:
    """Name of a scalar quantity among the FMU's variables."""
    return _OUTPUTS.get(quantity, f"result.{quantity}")


def peak_names(peak: str) -> tuple[str, str]:
    """Names, among the FMU's variables, of a peak and of its time."""
    return f"{_PEAKS[peak]}.peak", f"{_PEAKS[peak]}.peak_time"


def status_code(status: Status) -> int:
    """0 while the run goes on and nothing is wrong, else the number of the status."""
    return 0 if status in (Status.COMPLETED, Status.STOPPED) else list(Status).index(status)
