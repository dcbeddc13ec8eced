"""The numbers of the contact law: the user's, or chosen from what the wire will meet."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.model.contact import ContactLaw
from gw_exudyn.model.outline import Outline
from gw_exudyn.model.wire import mean_stiffness

if TYPE_CHECKING:
    from gw_exudyn.scenario import Scenario, WireSpec

Floats = NDArray[np.float64]

TOE = 0.04
"""Half width of the contact's quadratic onset over the wire's radius, where there is room for it."""

SINKING = 0.02
"""Penetration over the wire's radius that an automatic wall stiffness gives at the estimated peak force."""

DAMPING_TIME = 5e-5
"""Automatic wall damping over wall stiffness, s, at the penetration SINKING: small beside any step."""

JUST_AHEAD = 1e-6
"""How far past the exit, m, the lumen is looked at."""


@dataclass(frozen=True)
class Surroundings:
    """What the wire meets first. width : m, of the lumen across the catheter's axis just past the exit. ahead : m, from
    the exit along the axis to the first wall; infinite where there is none."""

    width: float
    ahead: float


def surroundings(outline: Outline, bore: float) -> Surroundings:
    """Of an outline in the catheter's frame; without a vessel the bore, m, is the only width there is."""
    if not len(outline.points):
        return Surroundings(bore, math.inf)
    a, b = outline.points, np.roll(outline.points, -1, axis=0)
    across = _crossings(a[:, ::-1] - [0.0, JUST_AHEAD], b[:, ::-1] - [0.0, JUST_AHEAD])
    above, below = across[across > 0], across[across <= 0]
    width = float(above.min() - below.max()) if len(above) and len(below) else 0.0
    walls = np.array([i not in outline.open_edges for i in range(len(a))])
    along = _crossings(a[walls], b[walls])
    in_front = along[along > JUST_AHEAD]
    return Surroundings(width, float(in_front.min()) if len(in_front) else math.inf)


def _crossings(a: Floats, b: Floats) -> Floats:
    """First coordinates at which the edges from a to b, (m, 2), cross the line where the second one is zero."""
    crosses = (a[:, 1] > 0) != (b[:, 1] > 0)
    rise = np.where(crosses, b[:, 1] - a[:, 1], 1.0)
    found: Floats = (a[:, 0] - a[:, 1] / rise * (b[:, 0] - a[:, 0]))[crosses]
    return found


def contact_law(scenario: Scenario, around: Surroundings) -> ContactLaw:
    """The contact's numbers: the user's where given, else such that the wire sinks in by SINKING of its radius.

    In a snug bore or lumen the onset is a quarter of the clearance at most: the wire would else be squeezed there.
    """
    radius, contact = scenario.wire.diameter / 2, scenario.contact
    stiffness = value_or(contact.wall_stiffness, automatic_stiffness(scenario, around))
    damping = value_or(contact.wall_damping, DAMPING_TIME * stiffness)
    return ContactLaw(
        stiffness=stiffness,
        tangential_stiffness=value_or(contact.tangential_stiffness, stiffness),
        damping=damping / (SINKING * radius),
        toe=min(TOE * radius, clearance(scenario, around) / 4),
    )


def clearance(scenario: Scenario, around: Surroundings) -> float:
    """Gap, m, on either side of the wire where it lies in the middle of the bore, or of the lumen at the exit."""
    narrowest = min(bore_or_more(scenario), max(around.width, scenario.wire.diameter * 1.001))
    return (narrowest - scenario.wire.diameter) / 2


def automatic_stiffness(scenario: Scenario, around: Surroundings) -> float:
    """Wall stiffness, N/m, at which the estimated peak force sinks the wire in by SINKING of its radius."""
    return estimated_force(scenario, around) / (SINKING * scenario.wire.diameter / 2)


def estimated_force(scenario: Scenario, around: Surroundings) -> float:
    """Force, N: the largest of what the wire's distal part meets in a bend, head-on, and straightened in the catheter.

    In a bend as tight as the lumen is wide: EI / (2 R^2), the push force of a rod in a circular channel. Head-on: the
    buckling load of a column, clamped and pinned, up to the wall ahead and some way into the catheter. Straightened:
    the three-point bending of a rest curvature over the chord whose sagitta is the clearance.
    """
    wire, bore = scenario.wire, bore_or_more(scenario)
    width = max(around.width, 2 * wire.diameter)
    stiffness = mean_stiffness(wire.effective_stiffness, 5 * width)
    bend = stiffness / (2 * width**2)
    head_on = 0.0 if math.isinf(around.ahead) else 20.2 * stiffness / (around.ahead + 10 * bore) ** 2
    curvature = _rest_curvature(wire)
    chord = math.sqrt(8 * (bore - wire.diameter) / curvature) if curvature > 0 else math.inf
    return max(bend, head_on, 4 * stiffness * curvature / chord)


def _rest_curvature(wire: WireSpec) -> float:
    """Curvature, 1/m, without load, of an arc-shaped tip; a kink counts as an arc over ten diameters."""
    tip = wire.tip_shape
    if tip.kind == "straight" or not tip.length or not tip.angle:
        return 0.0
    return abs(tip.angle) / (tip.length if tip.kind == "arc" else 10 * wire.diameter)


def law_warnings(scenario: Scenario, around: Surroundings) -> list[str]:
    """What a person should know of the law before the run."""
    return [*_too_soft(scenario, around), *_snug(scenario, around)]


def _too_soft(scenario: Scenario, around: Surroundings) -> list[str]:
    automatic, given = automatic_stiffness(scenario, around), scenario.contact.wall_stiffness
    if given is None or given >= automatic / 5:
        return []
    sinks = estimated_force(scenario, around) / given / (scenario.wire.diameter / 2)
    return [
        f"contact.wall_stiffness: {given:.6g} N/m lets the wire sink into the walls by about "
        f"{100 * sinks:.0f} % of its radius; auto would take {automatic:.3g} N/m"
    ]


def _snug(scenario: Scenario, around: Surroundings) -> list[str]:
    gap = clearance(scenario, around)
    if gap >= TOE * scenario.wire.diameter / 2:
        return []
    return [
        f"the wire has {gap * 1e6:.3g} um on either side in the catheter or the lumen: a fit this snug leaves its rest "
        "curvature no room and makes steps slow; give catheter.bore or the vessel a little more"
    ]


def bore_or_more(scenario: Scenario) -> float:
    """The catheter's bore, m; ten diameters of the wire where there is none."""
    return scenario.catheter.bore or 10 * scenario.wire.diameter


def value_or(value: float | None, otherwise: float) -> float:
    """The user's value where there is one."""
    return otherwise if value is None else value
