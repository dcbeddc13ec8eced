"""The one table of result quantities: name, unit, symbol, meaning, where each lives, and the unit a person reads it in.

Result variables, CSV headers, netCDF attributes and axis labels all read units and meanings from here; nothing states
a unit twice.

Signs and frames, for all of them: the frame is the scenario's own plane, x to the right and y up; angles count
counter-clockwise from x. A wall force is the force of the wire **on** the vessel, as a load cell under the phantom
reads it; the catheter is counted apart. The push force is positive when pushing. Arc length on the wire is measured
from the tip.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

TIME = ("time",)
NODE = ("time", "node")
JOINT = ("time", "joint")
CONTACT = ("time", "contact")


@dataclass(frozen=True)
class Quantity:
    """One quantity of a result.

    `unit` is SI in the notation of CF and UDUNITS ("N m", "1" for a pure number); `dims` says where it lives;
    `display_unit` is the unit in which a figure or a table shows it; `flags` gives the meaning of the values of a
    coded quantity; `integer` marks counts and codes.
    """

    name: str
    unit: str
    symbol: str
    long_name: str
    dims: tuple[str, ...]
    display_unit: str
    integer: bool = False
    flags: tuple[tuple[int, str], ...] = ()

    @property
    def label(self) -> str:
        """The name as words, as an axis or a legend shows it."""
        return self.name.replace("_", " ")

    @property
    def heading(self) -> str:
        """Name and SI unit, as a CSV column is headed: `tip_x [m]`."""
        return f"{self.name} [{self.unit}]"


# What a unit may be shown as: (name, number of them in one SI unit), fine to coarse. A figure moves on to the coarser
# one where numbers get too long.
_DISPLAY: Mapping[str, tuple[tuple[str, float], ...]] = MappingProxyType(
    {
        "m": (("um", 1e6), ("mm", 1e3), ("m", 1.0)),
        "N": (("mN", 1e3), ("N", 1.0)),
        "J": (("uJ", 1e6), ("mJ", 1e3), ("J", 1.0)),
        "rad": (("deg", 180.0 / math.pi), ("rad", 1.0)),
        "N m": (("uN m", 1e6), ("mN m", 1e3), ("N m", 1.0)),
        "m s-1": (("mm/s", 1e3), ("m/s", 1.0)),
        "s": (("ms", 1e3), ("s", 1.0)),
        "1": (("1", 1.0),),
    }
)
# A coarser unit is taken from this number on: along an axis five digits before the point, in a text four.
_TOO_LONG_ON_AXIS = 1e4
_TOO_LONG_IN_TEXT = 1e3

CONTACT_KINDS = (
    (-1, "none"),
    (0, "node_on_wall"),
    (1, "wall_corner_on_wire"),
    (2, "tip_disc_on_corner"),
    (3, "disc_on_wire"),
)
CONTACT_OWNERS = ((-1, "none"), (0, "vessel"), (1, "catheter"), (2, "support"), (3, "nose"))

_SERIES = (
    Quantity("time", "s", "t", "time since the start of the run", TIME, "s"),
    Quantity("insertion_depth", "m", "d", "travel of the drive since the start, positive into the vessel", TIME, "mm"),
    Quantity("tip_x", "m", "x_tip", "x of the centre of the wire's tip", TIME, "mm"),
    Quantity("tip_y", "m", "y_tip", "y of the centre of the wire's tip", TIME, "mm"),
    Quantity("tip_angle", "rad", "phi_tip", "direction of the wire at its tip, counter-clockwise from x", TIME, "deg"),
    Quantity(
        "push_force",
        "N",
        "F_push",
        "force of the drive on the wire along the catheter, positive when pushing",
        TIME,
        "mN",
    ),
    Quantity(
        "tip_force", "N", "F_tip", "magnitude of the resultant of the contact forces on the tip's disc", TIME, "mN"
    ),
    Quantity(
        "wall_force_x", "N", "F_x", "x of the resultant force of the wire on the vessel (catheter apart)", TIME, "mN"
    ),
    Quantity(
        "wall_force_y", "N", "F_y", "y of the resultant force of the wire on the vessel (catheter apart)", TIME, "mN"
    ),
    Quantity("wall_force_normal", "N", "F_n", "sum of the normal forces of all contacts with the vessel", TIME, "mN"),
    Quantity(
        "wall_force_max",
        "N",
        "F_max",
        "largest force, normal and tangential together, of a single contact with the vessel",
        TIME,
        "mN",
    ),
    Quantity("contacts", "1", "n_c", "number of contacts with the vessel that carry force", TIME, "1", integer=True),
    Quantity(
        "penetration_max",
        "m",
        "u_max",
        "deepest penetration of the wire's surface into a wall, zero where nothing touches",
        TIME,
        "um",
    ),
    Quantity("insertion_work", "J", "W", "work of the drive on the wire since the start", TIME, "uJ"),
    Quantity("elastic_energy", "J", "E_el", "bending energy of the wire, zero in its shape without load", TIME, "uJ"),
    Quantity(
        "wall_energy", "J", "E_wall", "energy stored in the walls' contact springs, normal and tangential", TIME, "uJ"
    ),
    Quantity("kinetic_energy", "J", "E_kin", "kinetic energy of the wire", TIME, "uJ"),
    Quantity("friction_loss", "J", "D_fric", "energy lost to friction since the start", TIME, "uJ"),
    Quantity(
        "damping_loss", "J", "D_damp", "energy lost to the joints' and walls' dampers since the start", TIME, "uJ"
    ),
    Quantity("numerical_loss", "J", "D_num", "energy lost to the time integration since the start", TIME, "uJ"),
    Quantity(
        "energy_error", "J", "E_err", "work less all stored and lost energies: what the balance leaves over", TIME, "uJ"
    ),
    Quantity("load_work", "J", "W_load", "work of the loads at the tip and of the nose since the start", TIME, "uJ"),
    Quantity("support_force_x", "N", "F_sx", "x of the resultant force of the wire on all supports", TIME, "mN"),
    Quantity("support_force_y", "N", "F_sy", "y of the resultant force of the wire on all supports", TIME, "mN"),
    Quantity("nose_force", "N", "F_nose", "force of the nose on the wire in the direction of its way", TIME, "mN"),
    Quantity("nose_travel", "m", "d_nose", "way of the nose since the start", TIME, "mm"),
    Quantity("tip_hold_force_x", "N", "F_hx", "x of the force of the wire on what holds its tip", TIME, "mN"),
    Quantity("tip_hold_force_y", "N", "F_hy", "y of the force of the wire on what holds its tip", TIME, "mN"),
)
_FURTHER_SCALARS = (
    Quantity(
        "wall_force_tangential",
        "N",
        "F_t",
        "sum of the tangential forces on the vessel, positive towards the wire's tip",
        TIME,
        "mN",
    ),
    Quantity("catheter_force_x", "N", "F_cx", "x of the resultant force of the wire on the catheter", TIME, "mN"),
    Quantity("catheter_force_y", "N", "F_cy", "y of the resultant force of the wire on the catheter", TIME, "mN"),
    Quantity(
        "catheter_force_normal", "N", "F_cn", "sum of the normal forces of all contacts with the catheter", TIME, "mN"
    ),
    Quantity("drive_force", "N", "F_drive", "force of the drive on the hub, or on the wire without one", TIME, "mN"),
    Quantity("drive_work", "J", "W_drive", "work of the drive since the start, on hub and wire", TIME, "uJ"),
    Quantity("hub_kinetic_energy", "J", "E_hub", "kinetic energy of the force drive's hub", TIME, "uJ"),
    Quantity("hub_damping_loss", "J", "D_hub", "energy lost to the hub's damper since the start", TIME, "uJ"),
    Quantity(
        "hub_numerical_loss",
        "J",
        "D_hnum",
        "hub's energy lost to the time integration since the start",
        TIME,
        "uJ",
    ),
    Quantity("drive_speed", "m s-1", "v", "speed of the drive, positive into the vessel", TIME, "mm/s"),
    Quantity(
        "drive_position",
        "m",
        "s_drive",
        "place of the wire's proximal end along the catheter's axis, from the catheter's exit",
        TIME,
        "mm",
    ),
    Quantity("solver_steps", "1", "n_s", "solver steps taken since the start", TIME, "1", integer=True),
    Quantity("newton_iterations", "1", "n_i", "Newton iterations taken since the start", TIME, "1", integer=True),
    Quantity("smallest_step", "s", "h_min", "smallest solver step taken since the start", TIME, "ms"),
)
_FIELDS = (
    Quantity("node_x", "m", "x", "x of the wire's nodes, proximal end first, tip last", NODE, "mm"),
    Quantity("node_y", "m", "y", "y of the wire's nodes, proximal end first, tip last", NODE, "mm"),
    Quantity(
        "joint_angle",
        "rad",
        "theta",
        "angle between the segments at a joint, counter-clockwise; the first joint is the clamp",
        JOINT,
        "deg",
    ),
    Quantity(
        "joint_torque",
        "N m",
        "M",
        "bending moment of the joint's spring and damper on its distal segment",
        JOINT,
        "uN m",
    ),
    Quantity("contact_x", "m", "x_c", "x of the contact's point on the wire's surface", CONTACT, "mm"),
    Quantity("contact_y", "m", "y_c", "y of the contact's point on the wire's surface", CONTACT, "mm"),
    Quantity("contact_arc_length", "m", "s_c", "place of the contact along the wire, from the tip", CONTACT, "mm"),
    Quantity(
        "contact_normal_force",
        "N",
        "f_n",
        "normal force of the wire on the wall at the contact, never negative",
        CONTACT,
        "mN",
    ),
    Quantity(
        "contact_tangential_force",
        "N",
        "f_t",
        "tangential force of the wire on the wall, positive towards the wire's tip",
        CONTACT,
        "mN",
    ),
    Quantity(
        "contact_gap",
        "m",
        "g",
        "signed distance of the wire's surface to the wall, negative inside the wall",
        CONTACT,
        "um",
    ),
    Quantity("contact_kind", "1", "kind", "which features touch", CONTACT, "1", integer=True, flags=CONTACT_KINDS),
    Quantity("contact_owner", "1", "owner", "whose wall is touched", CONTACT, "1", integer=True, flags=CONTACT_OWNERS),
)
_PLACES = (
    Quantity("node_arc_length", "m", "s", "place of the nodes along the wire, from the tip", ("node",), "mm"),
    Quantity("joint_arc_length", "m", "s", "place of the joints along the wire, from the tip", ("joint",), "mm"),
    Quantity(
        "vessel_wall_x", "m", "x", "x of the vessel's walls; NaN between two polylines", ("vessel_wall_point",), "mm"
    ),
    Quantity(
        "vessel_wall_y", "m", "y", "y of the vessel's walls; NaN between two polylines", ("vessel_wall_point",), "mm"
    ),
    Quantity(
        "catheter_wall_x",
        "m",
        "x",
        "x of the catheter's walls; NaN between two polylines",
        ("catheter_wall_point",),
        "mm",
    ),
    Quantity(
        "catheter_wall_y",
        "m",
        "y",
        "y of the catheter's walls; NaN between two polylines",
        ("catheter_wall_point",),
        "mm",
    ),
)

QUANTITIES: Mapping[str, Quantity] = MappingProxyType(
    {q.name: q for q in _SERIES + _FURTHER_SCALARS + _FIELDS + _PLACES}
)
"""Every quantity by its name."""

SERIES_COLUMNS: tuple[str, ...] = tuple(q.name for q in _SERIES)
"""Columns of series.csv in their order, time first."""

SCALARS: tuple[str, ...] = tuple(q.name for q in _SERIES[1:] + _FURTHER_SCALARS)
"""Every scalar of an output instant but time itself."""

NODE_FIELDS: tuple[str, ...] = tuple(q.name for q in _FIELDS if q.dims == NODE)
JOINT_FIELDS: tuple[str, ...] = tuple(q.name for q in _FIELDS if q.dims == JOINT)
CONTACT_FIELDS: tuple[str, ...] = tuple(q.name for q in _FIELDS if q.dims == CONTACT)


def display_unit(name: str, largest: float = 0.0, too_long: float = _TOO_LONG_ON_AXIS) -> tuple[str, float]:
    """Unit in which to show the quantity `name`, and the factor from SI to it.

    `largest` is the largest magnitude (SI) that is to be shown: where its number would reach `too_long`, the next
    coarser unit is taken (20 000 mN become 20 N).
    """
    quantity = QUANTITIES[name]
    choices = _DISPLAY[quantity.unit]
    first = next(i for i, (unit, _) in enumerate(choices) if unit == quantity.display_unit)
    usable = [choice for choice in choices[first:] if not abs(largest) * choice[1] >= too_long]
    return usable[0] if usable else choices[-1]


def display(name: str, value: float, digits: int = 3) -> str:
    """One number of the quantity `name` (SI) as text in its display unit: `display("push_force", 0.0207)` is "20.7
    mN".
    """
    unit, factor = display_unit(name, value, _TOO_LONG_IN_TEXT)
    number = f"{value * factor + 0.0:.{digits}g}"  # no number reads as -0
    if "e+" in number:
        number = f"{value * factor:.0f}"
    return number if unit == "1" else f"{number} {plain(unit)}"


LIKE: Mapping[str, str] = MappingProxyType(
    {
        "m": "tip_x",
        "N": "push_force",
        "J": "insertion_work",
        "rad": "tip_angle",
        "s": "time",
        "m/s": "drive_speed",
        "m s-1": "drive_speed",
        "1": "contacts",
    }
)
"""A quantity of each unit, whose display unit serves for parameters and metrics that are no quantity by themselves."""


def number_text(name: str, value: float | None, unit: str) -> str:
    """A number in SI, of the quantity `name` or of any in `unit`, as people read it; a dash where there is none."""
    if value is None or not math.isfinite(value):
        return "-"
    like = name if name in QUANTITIES else LIKE.get(unit)
    return display(like, value) if like else f"{value:.4g} {unit}"


def value_text(value: object) -> str:
    """Any value as tables show it: six digits of a number, a dash where there is none."""
    return "-" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)


def plain(unit: str) -> str:
    """The unit as people write it: the micro sign instead of the `u` that files use, the degree sign for angles."""
    if unit == "deg":
        return "°"
    return "µ" + unit[1:] if unit.startswith("u") else unit
