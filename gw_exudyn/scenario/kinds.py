"""The quantities of a scenario with their plausible ranges, one table for all sections.

What lies outside is refused as a slip (a wire of 0.36 m diameter), not as bad physics; the ranges are wide on purpose.
"""

from __future__ import annotations

import math

from gw_exudyn.scenario.fields import Number, Quantity, Row, Table

FULL_TURN = 2 * math.pi

WIRE_DIAMETER = Quantity("m", 0.05e-3, 5e-3, "mm", optional=True)
WIRE_LENGTH = Quantity("m", 1e-3, 5.0, "mm", optional=True)
ARC_LENGTH = Quantity("m", 0.0, 5.0, "mm")
BENDING_STIFFNESS = Quantity("N*m^2", 1e-10, 1.0, "N*mm^2")
BENDING_STIFFNESS_OR_NONE = Quantity("N*m^2", 1e-10, 1.0, "N*mm^2", optional=True)
CORE_DIAMETER = Quantity("m", 0.01e-3, 5e-3, "mm")
FLOPPY_LENGTH = Quantity("m", 0.0, 5.0, "mm")
MODULUS = Quantity("Pa", 1e5, 1e12, "GPa")
STIFFNESS_FACTOR = Number(0.01, 100.0)
DENSITY = Quantity("kg/m^3", 500.0, 25000.0, "kg/m^3", optional=True)
DAMPING_TIME = Quantity("s", 0.0, 10.0, "s")
REST_CURVATURE = Quantity("1/m", -1000.0, 1000.0, "1/m", also=("rad/m",), auto=True)
TIP_LENGTH = Quantity("m", 1e-5, 1.0, "mm", optional=True)
TIP_ANGLE = Quantity("rad", -FULL_TURN, FULL_TURN, "deg", optional=True)

VESSEL_DIAMETER = Quantity("m", 0.1e-3, 100e-3, "mm")
VESSEL_LENGTH = Quantity("m", 1e-3, 5.0, "mm")
LEAD_LENGTH = Quantity("m", 0.0, 5.0, "mm")
ARC_RADIUS = Quantity("m", 0.1e-3, 5.0, "mm")
ANGLE = Quantity("rad", -FULL_TURN, FULL_TURN, "deg")
COORDINATE = Quantity("m", -10.0, 10.0, "mm")
POINT = Row(("x", "y"), (COORDINATE, COORDINATE))
BRANCH_LENGTH = Quantity("m", 1e-3, 5.0, "mm", optional=True)
BRANCH_ANGLE = Quantity("rad", -math.radians(150), math.radians(150), "deg", optional=True)
BRANCH_PLACE = Quantity("m", 0.0, 5.0, "mm", optional=True)
BEND_RADIUS = Quantity("m", 0.0, 5.0, "mm")
DRAWING_LENGTH = Quantity("m", 1e-3, 10.0, "mm", optional=True)
FILLET = Quantity("m", 0.0, 0.1, "mm", optional=True)
BORE = Quantity("m", 0.05e-3, 50e-3, "mm", optional=True)

MOMENT = Quantity("N*m", -1e3, 1e3, "N*mm")
DISC_RADIUS = Quantity("m", 1e-6, 1.0, "mm")
DISC_STIFFNESS = Quantity("N/m", 1e-3, 1e12, "N/m", auto=True)
NOSE_SPEED = Quantity("m/s", 1e-9, 1.0, "mm/s")
NOSE_TRAVEL = Quantity("m", 1e-9, 5.0, "mm")

FRICTION = Number(0.0, 2.0)
FRICTION_OR_NONE = Number(0.0, 2.0, optional=True)
PATCH_REACH = Quantity("m", 1e-6, 5.0, "mm")
WALL_STIFFNESS = Quantity("N/m", 1e-3, 1e9, "N/m", auto=True)
WALL_DAMPING = Quantity("N*s/m", 0.0, 1e6, "N*s/m", auto=True)

SPEED = Quantity("m/s", -1.0, 1.0, "mm/s")
SPEED_OR_NONE = Quantity("m/s", -1.0, 1.0, "mm/s", optional=True)
START = Quantity("m", 0.0, 5.0, "mm")
TRAVEL = Quantity("m", 1e-6, 5.0, "mm", optional=True)
DURATION = Quantity("s", 1e-3, 1e5, "s", optional=True)
RAMP = Quantity("s", 0.0, 1e5, "s", optional=True)
INSTANT = Quantity("s", 0.0, 1e5, "s")
SPEED_TABLE = Table(Row(("time", "speed"), (INSTANT, SPEED)), 2, 100_000, optional=True)

FORCE = Quantity("N", -100.0, 100.0, "mN")
FORCE_OR_NONE = Quantity("N", -100.0, 100.0, "mN", optional=True)
FORCE_LIMIT = Quantity("N", 1e-6, 1000.0, "N", optional=True)
FORCE_TABLE = Table(Row(("time", "force"), (INSTANT, FORCE)), 2, 100_000, optional=True)
STALL_TRAVEL = Quantity("m", 0.1e-3, 5.0, "mm", auto=True, off=True)
NEARNESS = Quantity("m", 1e-6, 0.1, "mm")
HUB_MASS = Quantity("kg", 1e-6, 10.0, "g")
HUB_DAMPING = Quantity("N*s/m", 1e-3, 1e6, "N*s/m")
HUB_SPEED = Quantity("m/s", 1e-6, 1.0, "mm/s")
TIP_SPEED = Quantity("m/s", 0.0, 1.0, "mm/s")
TIP_SPEED_OR_NONE = Quantity("m/s", 0.0, 1.0, "mm/s", optional=True)
TIP_SPEED_TABLE = Table(Row(("time", "speed"), (INSTANT, TIP_SPEED)), 2, 100_000, optional=True)

SOLVER_STEP = Quantity("s", 1e-4, 1.0, "s")
SMALLEST_STEP = Quantity("s", 1e-9, 1.0, "s")
TOLERANCE = Number(1e-12, 1e-3)
RESIDUAL = Quantity("N", 1e-15, 1e-3, "N")
OUTPUT_INTERVAL = Quantity("s", 1e-4, 1e5, "s")
