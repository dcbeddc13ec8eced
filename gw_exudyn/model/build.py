"""From a scenario to the model that the engine assembles."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.model.checks import check, travel_wanted
from gw_exudyn.model.contact import ContactLaw
from gw_exudyn.model.drive import AnyDrive, Drive, build_drive
from gw_exudyn.model.frame import Frame
from gw_exudyn.model.law import (
    SINKING,
    Surroundings,
    bore_or_more,
    contact_law,
    law_warnings,
    surroundings,
    value_or,
)
from gw_exudyn.model.loads import LoadSet, build_loads
from gw_exudyn.model.outline import Outline, build_outline
from gw_exudyn.model.patches import Patch
from gw_exudyn.model.walls import Tube, Walls, build_walls, corners_into, tube_polylines, vessel_polylines
from gw_exudyn.model.wire import DEFAULT_IMPERFECTION, Wire, build_wire

if TYPE_CHECKING:
    from gw_exudyn.scenario import Scenario

Floats = NDArray[np.float64]


_STALL_LUMENS, _LEAST_STALL = 1.25, 5e-3
"""Default travel in which a tip has stalled: in lumens at the catheter's exit, and at least so many m."""


@dataclass(frozen=True)
class Model:
    """What the engine needs, in the catheter's frame (see Frame). All SI.

    around : from which the wall stiffness is estimated. warnings : sentences for the user.
    """

    scenario: Scenario
    frame: Frame
    wire: Wire
    walls: Walls
    law: ContactLaw
    drive: AnyDrive
    outline: Outline
    tube: Tube
    loads: LoadSet
    around: Surroundings
    warnings: tuple[str, ...]

    @property
    def travel_range(self) -> tuple[float, float]:
        """Travel, m, between which the proximal end stays in the catheter, and the catheter's walls reach; a wire may
        be inserted whole, give or take a rounding error. Without a tube there is no end."""
        if not self.tube.walled:
            return -math.inf, math.inf
        return self.wire.length - self.tube.length, self.wire.length * (1 + 1e-12)

    @property
    def stall_travel(self) -> float:
        """Travel, m, of the proximal end in which a tip that stays where it is has stalled; infinite for never.

        In the vessels of benchmarks/cases.py (100 segments, friction 0.2 and 0.4) a tip sticks for up to 0.6 lumens of
        travel before it goes on; those that stuck for longer never came free. A tip that is held in its place does not
        stall.
        """
        held = self.loads.tip.held[0] > 0
        chosen = math.inf if held else max(_LEAST_STALL, _STALL_LUMENS * self.around.width)
        return value_or(self.scenario.stop.tip_stall, chosen)

    def vessel_outline(self) -> list[Floats]:
        """The vessel's walls for drawing, in the scenario's plane: (k, 2) polylines, m."""
        lines = vessel_polylines(self.outline, self.tube)
        return [
            self.frame.points_out(np.vstack([points, points[:1]]) if closed else points) for points, closed in lines
        ]

    def catheter_outline(self) -> list[Floats]:
        """The catheter's walls for drawing, in the scenario's plane: (2, 2) polylines, m, as long as the wire."""
        if self.scenario.catheter.bore is None:
            return []
        drawn = Tube(self.tube.bore, self.wire.length)
        return [self.frame.points_out(points) for points in tube_polylines(drawn)]

    def describe(self) -> dict[str, Any]:
        """Numbers that tell a person what will be run; SI, for `check` and `info`."""
        scenario = self.scenario
        return {
            "wire.diameter": scenario.wire.diameter,
            "wire.length": self.wire.length,
            "wire.segments": self.wire.segments,
            "wire.shortest_segment": float(self.wire.lengths.min()),
            "wire.longest_segment": float(self.wire.lengths.max()),
            "wire.bending_stiffness_least": min(min(p.value, p.value_end) for p in scenario.wire.effective_stiffness),
            "wire.bending_stiffness_largest": max(max(p.value, p.value_end) for p in scenario.wire.effective_stiffness),
            "wire.imperfection": value_or(scenario.wire.imperfection, DEFAULT_IMPERFECTION),
            "wire.mass": float(self.wire.mass.sum()),
            "vessel.walls": int(np.count_nonzero(~self.walls.tube)),
            "vessel.corners": corners_into(self.outline),
            "vessel.branches": list(scenario.vessel.branch_names),
            "vessel.out_of_plane": getattr(scenario.vessel, "out_of_plane", None),
            "vessel.width_at_exit": self.around.width,
            "catheter.bore": scenario.catheter.bore,
            "contact.wall_stiffness": self.law.stiffness,
            "contact.wall_damping": self.law.damping * SINKING * self.wire.radius,
            "contact.tangential_stiffness": self.law.tangential_stiffness,
            "contact.onset": self.law.toe,
            "drive.duration": scenario.drive.duration,
            "drive.kind": scenario.drive.kind,
            "stop.tip_stall": None if math.isinf(self.stall_travel) else self.stall_travel,
            "drive.furthest": travel_wanted(scenario, self.drive),
            "solver.steps": int(np.ceil(scenario.drive.duration / scenario.solver.step)),
            "warnings": list(self.warnings),
        }


def build(scenario: Scenario) -> Model:
    """The model of a scenario. Raises ScenarioError for what cannot start (see checks)."""
    frame = Frame(scenario.catheter.exit, scenario.catheter.direction)
    wire, drive = _held(build_wire(scenario.wire), scenario.drive.hold), build_drive(scenario.drive)
    plane = build_outline(scenario.vessel)
    outline = Outline(frame.points_in(plane.points), plane.open_edges)
    pulled_back = max(0.0, -drive.extremes()[0]) if isinstance(drive, Drive) else 0.0
    bore = scenario.catheter.bore
    tube = Tube(bore or scenario.wire.diameter, 2 * wire.length + pulled_back, walled=bore is not None)
    loads = build_loads(scenario, wire, frame)
    check(scenario, outline, tube, drive, loads.discs)
    around = surroundings(outline, bore_or_more(scenario))
    law = contact_law(scenario, around)
    contact, patches = scenario.contact, _patches(scenario, frame)
    walls = build_walls(
        outline,
        tube,
        wire.radius,
        contact.friction_coefficient,
        value_or(scenario.catheter.friction_coefficient, contact.friction_coefficient),
        seam_reach=6 * wire.radius,
        patches=patches,
    )
    warnings = (
        *law_warnings(scenario, around),
        *_too_coarse(scenario, wire),
        *_shaft_alone(scenario),
        *_off_the_walls(patches, walls),
    )
    return Model(scenario, frame, wire, walls, law, drive, outline, tube, loads, around, warnings)


def _held(wire: Wire, hold: str) -> Wire:
    """The wire as the drive holds it: without the first joint's spring where its end may turn."""
    if hold == "clamped":
        return wire
    stiffness, damping, rest = wire.joint_stiffness.copy(), wire.joint_damping.copy(), wire.rest_angle.copy()
    stiffness[0] = damping[0] = rest[0] = 0.0
    return replace(wire, joint_stiffness=stiffness, joint_damping=damping, rest_angle=rest)


def _patches(scenario: Scenario, frame: Frame) -> list[Patch]:
    """The patches of a scenario, in the catheter's frame."""
    ends = [(patch, *frame.points_in(np.array([patch.start, patch.end]))) for patch in scenario.contact.patches]
    return [Patch(start, end, patch.within, patch.friction_coefficient) for patch, start, end in ends]


def _off_the_walls(patches: list[Patch], walls: Walls) -> list[str]:
    """Patches that hold no wall: a slip of the ruler."""
    vessel = ~walls.tube
    start, end = walls.start[vessel], (walls.start + walls.tangent * walls.length[:, None])[vessel]
    places = np.vstack([start, (start + end) / 2, end])
    return [
        f"contact.patches.{i}: no wall of the vessel lies within {patch.within * 1e3:.6g} mm of its line; "
        "it changes nothing"
        for i, patch in enumerate(patches)
        if len(places) and (patch.distance(places) > patch.within * (1 + 1e-9)).all()
    ]


def _too_coarse(scenario: Scenario, wire: Wire) -> list[str]:
    shape, last = scenario.wire.tip_shape.length, float(wire.lengths[-1])
    if shape is None or shape >= last * (1 - 1e-9):
        return []
    return [
        f"wire.tip_shape: {shape * 1e3:.6g} mm is shorter than the last segment, {last * 1e3:.6g} mm, and is lost in "
        "part or whole; take more wire.segments, or a wire.grading above 1"
    ]


def _shaft_alone(scenario: Scenario) -> list[str]:
    if not scenario.wire.shaft_alone:
        return []
    return [
        f"wire.model: {scenario.wire.model} is the shaft alone, and no tip of this wire is known: the distal part of "
        "the real wire is far softer; give it one by wire.floppy_tip"
    ]
