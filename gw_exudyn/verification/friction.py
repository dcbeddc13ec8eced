"""Contact and Coulomb friction against closed forms: rod in a circular channel, capstan, stick and slip, signs."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.model import build
from gw_exudyn.model.contact import Contact
from gw_exudyn.result import Result
from gw_exudyn.simulation import Simulation, simulate
from gw_exudyn.verification.closed_forms import capstan, push_into_circle
from gw_exudyn.verification.evidence import Case, Chart, Curve, Evidence, Finding
from gw_exudyn.verification.scenes import DIAMETER, SPEED, corner_vessel, scene

Floats = NDArray[np.float64]

_GROUP = "friction"
_STIFFNESS, _RADIUS = 1e-6, 15e-3


def circular_channel() -> Finding:
    """Push force of a rod without friction in channels that leave it ever less room, and none at the limit.

    The force is the work of the drive over the passage of one segment, over its length: what a joint makes it rise and
    fall as it enters the bend is averaged out. Clearance must exceed the sagitta of a segment, 5 um, or the chain jams.
    """
    rows: list[Evidence] = []
    gaps = np.array([20e-6, 40e-6, 80e-6])
    forces = np.array([_in_channel(float(gap)) for gap in gaps])
    exact = push_into_circle(_STIFFNESS, _RADIUS)
    slope, limit = np.polyfit(gaps, forces, 1)
    for gap, force in zip(gaps, forces, strict=True):
        there = push_into_circle(_STIFFNESS, _RADIUS + float(gap))
        rows.append(
            Evidence(
                f"push force with {gap * 1e6:.0f} um of room on either side",
                "N",
                float(force),
                there,
                0.01 * there,
                "the rod lies on the outer wall where it is pressed, and crosses over for a part of the room",
                "EI/(2 (R + c)^2)",
            )
        )
    rows.append(
        Evidence(
            "push force, straight line to no room",
            "N",
            float(limit),
            exact,
            0.005 * exact,
            "the force ripples by 8 % as joints and facets pass; the mean is 0.2 % off, more with other facets",
            "EI/(2 R^2), the bending energy that a length takes in",
        )
    )
    line = np.array([0.0, 100e-6])
    curves = (
        Curve("EI/(2 (R + c)^2)", line * 1e6, _STIFFNESS / (2 * (_RADIUS + line) ** 2) * 1e3, "line"),
        Curve("fit", line * 1e6, (slope * line + limit) * 1e3, "line"),
        Curve("simulation", gaps * 1e6, forces * 1e3),
    )
    chart = Chart(
        "circular-channel",
        "Rod in a circular channel, R = 15 mm",
        "room on either side / um",
        "push force / mN",
        curves,
    )
    return Finding(tuple(rows), (chart,))


def _in_channel(gap: float) -> float:
    """N, mean over one segment's passage, 25 mm into a channel with `gap` (m) on either side of the wire.

    Four facets a segment, so that a passage is a whole number of them.
    """
    length, segments, travel, facets = 0.08, 80, 25e-3, 140
    passage, width = length / segments, DIAMETER + 2 * gap
    simulation = Simulation(
        scene(
            {"length": length, "bending_stiffness": _STIFFNESS, "segments": segments, "damping_time": 0.0},
            {"kind": "speed", "speed": SPEED, "distance": travel + passage},
            vessel={
                "kind": "arc",
                "radius": _RADIUS,
                "angle": facets * passage / 4 / (_RADIUS + gap),
                "diameter": width,
                "facets": facets,
                "lead_in": 2e-3,
                "lead_out": 5e-3,
            },
            catheter={"exit": [1e-3, 0.0], "bore": width},
            contact={"friction_coefficient": 0.0, "wall_damping": 0.0},
        )
    )
    return _mean_push(simulation, travel / SPEED, passage)


def _mean_push(simulation: Simulation, start: float, passage: float) -> float:
    """N, work of the drive over a travel of `passage` (m) from the time `start` (s), less what the integrator lost."""

    def work() -> float:
        outputs = simulation.outputs
        return float(outputs["insertion_work"]) - float(outputs["numerical_loss"])

    simulation.advance(start)
    before = work()
    simulation.advance(start + passage / SPEED)
    return (work() - before) / passage


def belt() -> Finding:
    """Capstan: a wire pulled back over the inner wall of a bend against a load at its tip.

    The load, 200 EI/R^2, is parallel to the far end of the bend, so that it keeps the tip off the walls. The angle is
    the one truly turned: from the straight stretch before the first contact to the tip.
    """
    rows, curves = [], []
    for friction in (0.1, 0.2, 0.4):
        found = []
        for degrees in (60, 90, 120):
            ratio, angle = _pulled_back(friction, degrees)
            found.append((math.degrees(angle), ratio))
            exact = capstan(friction, angle)
            rows.append(
                Evidence(
                    f"pull over load, friction {friction:g}, {math.degrees(angle):.2f} deg",
                    "1",
                    ratio,
                    exact,
                    0.005 * exact,
                    "a wire lifts off where a rope would not: EI/(2 T R^2) (1 + mu^2), 0.3 %; and its chain turns by 4 "
                    "deg a segment",
                    "exp(mu phi)",
                )
            )
        angles = np.linspace(0.0, 125.0, 60)
        curves.append(Curve(f"exp({friction:g} phi)", angles, np.exp(friction * np.radians(angles)), "line"))
        curves.append(Curve(f"friction {friction:g}", np.array(found)[:, 0], np.array(found)[:, 1]))
    chart = Chart(
        "capstan", "Pull-back over the inner wall of a bend", "angle turned / deg", "pull / load", tuple(curves)
    )
    return Finding(tuple(rows), (chart,))


def _pulled_back(friction: float, degrees: int) -> tuple[float, float]:
    """(pull over load, angle turned, rad), the pull as the mean over one segment's passage."""
    length, segments, width, lead, back = 90e-3, 90, 4e-3, 8e-3, 2e-3
    angle, inner = math.radians(degrees), _RADIUS - width / 2 + DIAMETER / 2
    load, passage, rise = 200 * _STIFFNESS / inner**2, length / segments, 4.0
    # Quick in, while the load is small; then the load rises; then slowly back.
    inserted, quick = 6e-3 + angle * inner + 5e-3, 0.1
    phases = [
        {"speed": quick, "distance": inserted},
        {"speed": 0.0, "duration": rise - inserted / quick},
        {"speed": -SPEED, "distance": back},
    ]
    simulation = Simulation(
        scene(
            {"length": length, "bending_stiffness": _STIFFNESS, "segments": segments, "damping_time": 2e-3},
            {"kind": "speed", "phases": phases},
            vessel={
                "kind": "arc",
                "radius": _RADIUS,
                "angle": angle,
                "diameter": width,
                "facets": degrees // 2,
                "lead_in": lead,
                "lead_out": 25e-3,
            },
            catheter={"exit": [2e-3, 1.4e-3], "bore": 0.5e-3, "friction_coefficient": 0.0},
            contact={"friction_coefficient": friction, "wall_stiffness": 1e5},
            tip={"force": [load * math.cos(angle), load * math.sin(angle)], "ramp": rise},
        )
    )
    pull = _mean_push(simulation, rise + (back - passage) / SPEED, passage)
    after = simulation.outputs
    return pull / load, float(after["tip_angle"]) - _direction_before_contact(
        after, simulation.model.wire.node_arc_length
    )


def _direction_before_contact(outputs: Any, arc_length: Floats) -> float:
    """Rad, of the straight stretch between the catheter and the first contact with the vessel."""
    pressed = (np.asarray(outputs["contact_owner"]) == 0) & (np.asarray(outputs["contact_normal_force"]) > 1e-6)
    first = float(np.asarray(outputs["contact_arc_length"])[pressed].max())
    x, y = np.asarray(outputs["node_x"]), np.asarray(outputs["node_y"])
    free = np.flatnonzero((arc_length > first) & (x > 2e-3))
    return float(np.median(np.arctan2(np.diff(y[free]), np.diff(x[free]))))


def stick_and_slip() -> Finding:
    """A wire whose tip is pressed square on a wall with a force N, and is pulled along it by a load F at its tip.

    With F = mu N / 2 it must stay where it is; with F rising it must go when F reaches mu N.
    """
    friction, ramp = 0.4, 20.0
    normal = float(_on_a_wall(friction, 0.0, 1.0).values("wall_force_normal")[-1])
    held = _on_a_wall(friction, friction * normal / 2, ramp / 4, seconds=ramp / 4 + 10.0)
    creep = float(held.values("tip_y")[-1]) - float(np.interp(ramp / 4, held.time, held.values("tip_y")))
    rising = _on_a_wall(friction, 2 * friction * normal, ramp, interval=0.02)
    moved, load = rising.values("tip_y"), 2 * friction * normal * rising.time / ramp
    # Once it goes it runs: bent, the wire reaches less far, and presses less.
    first = int(np.argmax(moved > _SLIPPED))
    slipping, limit = float(load[first]), friction * float(rising.values("wall_force_normal")[first - 1])
    rows = (
        Evidence(
            "way in 10 s under mu N / 2",
            "m",
            abs(creep),
            10e-6,
            0.0,
            "a hundredth of a millimetre, which nobody sees; a spring that sticks does not creep at all",
            "Coulomb",
            "at_most",
        ),
        Evidence(
            "load at which it has slipped by 5 um",
            "N",
            slipping,
            limit,
            0.01 * limit,
            "the wire's own stiffness, 3 EI/L^3, takes 0.2 % at 5 um, and the load rises by 0.2 % between outputs",
            "mu N",
        ),
    )
    shown = moved < 4 * _SLIPPED
    curves = (
        Curve("rising load", load[shown] / limit, moved[shown] * 1e6),
        Curve("mu N", np.array([1.0, 1.0]), np.array([0.0, 4 * _SLIPPED]) * 1e6, "line"),
    )
    chart = Chart(
        "stick-and-slip", "Tip pressed on a wall, pulled along it", "load / mu N", "way of the tip / um", curves
    )
    return Finding(rows, (chart,))


_SLIPPED, _FREE = 5e-6, 20e-3
"""m: way by which it has slipped; free length of the wire."""


def _on_a_wall(
    friction: float, load: float, ramp: float, seconds: float | None = None, interval: float = 0.5
) -> Result:
    """The tip is pressed on a wall at a right angle, in a tenth of a second; `load` (N) along it rises over `ramp`."""
    press, seconds = 0.1, seconds or ramp  # 2 um on, to 2 mN: a third of what would buckle a wire with a free tip
    phases = [{"speed": 2e-5, "duration": press}, {"speed": 0.0, "duration": seconds - press}]
    return simulate(
        scene(
            {"length": 0.04, "bending_stiffness": _STIFFNESS, "segments": 40},
            {"kind": "speed", "phases": phases, "start": _FREE - DIAMETER / 2 - 4e-6},
            vessel={"kind": "straight", "length": _FREE + 2e-3, "diameter": 8e-3, "end": "dead"},
            catheter={"exit": [2e-3, 0.0], "bore": 0.5e-3, "friction_coefficient": 0.0},
            contact={"friction_coefficient": friction, "wall_stiffness": 2000.0},
            tip={"force": [0.0, load], "ramp": ramp},
            output={"interval": interval},
        )
    )


def signs() -> Finding:
    """In, hold and out round a corner: what a wall and its friction may never do, at any instant.

    A normal force below zero would be a wall that pulls; a friction loss that falls would be friction that drives.
    """
    width = 4e-3
    phases = [
        {"speed": SPEED, "distance": 25e-3},
        {"speed": 0.0, "duration": 1.0},
        {"speed": -SPEED, "distance": 20e-3},
    ]
    result = simulate(
        scene(
            {"length": 0.08, "bending_stiffness": _STIFFNESS, "segments": 60},
            {"kind": "speed", "phases": phases},
            vessel=corner_vessel(width),
            catheter={"exit": [-5e-3, 0.0], "bore": width},
            contact={"friction_coefficient": 0.4},
            output={"interval": 0.05},
        )
    )
    pressing = result.dataset["contact_normal_force"].values
    tangential = np.abs(result.dataset["contact_tangential_force"].values)
    loss, error = result.values("friction_loss"), result.values("energy_error")
    work = float(np.abs(result.values("insertion_work")).max())
    over = float(np.nanmax(tangential - 0.4 * pressing))
    strongest = float(np.nanmax(tangential[pressing > 1e-4] / pressing[pressing > 1e-4]))
    rows = (
        Evidence(
            "least normal force, drawn off a wall at up to 1 m/s",
            "N",
            _drawn_off(),
            0.0,
            0.0,
            "exact",
            "a wall does not pull",
            "at_least",
        ),
        Evidence(
            "largest tangential force above mu times normal", "N", over, 1e-12, 0.0, "rounding", "Coulomb", "at_most"
        ),
        Evidence("tangential over normal force of what slides", "1", strongest, 0.4, 1e-9, "rounding", "Coulomb"),
        Evidence(
            "least rise of the friction loss between outputs",
            "J",
            float(np.diff(loss).min()),
            -1e-15,
            0.0,
            "rounding of a sum of 1e-4 J",
            "friction takes energy",
            "at_least",
        ),
        Evidence(
            "largest error of the energy balance",
            "J",
            float(np.abs(error).max()),
            0.001 * work,
            0.0,
            "a thousandth of the largest work",
            "first law",
            "at_most",
        ),
    )
    time = result.time
    curves = tuple(
        Curve(name.replace("_", " "), time, result.values(name) * 1e6, "line")
        for name in ("insertion_work", "elastic_energy", "friction_loss", "energy_error")
    )
    return Finding(rows, (Chart("signs", "In, hold, and out round a corner", "time / s", "energy / uJ", curves),))


def _drawn_off() -> float:
    """N, least normal force of a wire that lies in a wall and leaves it; its damper alone would pull from 0.07 m/s on.

    Straight from the contact law of the model: the outputs of a run name contacts that press, and no others.
    """
    model = build(
        scene(
            {"length": 0.04, "bending_stiffness": _STIFFNESS, "segments": 20},
            {"kind": "speed", "speed": 0.0, "duration": 1.0},
            vessel={"kind": "straight", "length": 0.05, "diameter": 4e-3},
            catheter={"exit": [0.0, 0.0], "bore": 1e-3},
            contact={"friction_coefficient": 0.4},
        )
    )
    contact = Contact(model.wire, model.walls, model.law)
    nodes = model.wire.node_arc_length
    place, rate = np.zeros((20, 3)), np.zeros((20, 3))
    place[:, 0] = 0.03 - (nodes[1:] + nodes[:-1]) / 2
    least, most = math.inf, 0.0
    for depth in np.linspace(-2.0, 20.0, 23) * 1e-6:
        for speed in (0.0, 0.01, 0.1, 1.0):
            place[:, 1], rate[:, 1] = -2e-3 + model.wire.radius - depth, speed
            contact.motion.set(place, rate)
            contact.start_step()
            contact.evaluate()
            least = min(least, float(contact.nodes.normal.min()))
            most = max(most, float(contact.nodes.normal.max()))
    return least if most > 0 else math.nan


CASES = (
    Case(_GROUP, "rod in a circular channel", circular_channel),
    Case(_GROUP, "capstan", belt),
    Case(_GROUP, "stick and slip", stick_and_slip),
    Case(_GROUP, "signs of normal force and friction", signs),
)
