"""From a scenario to the model that the engine assembles."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.model.checks import check
from gw_exudyn.model.contact import ContactLaw
from gw_exudyn.model.drive import Drive, build_drive
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
from gw_exudyn.model.walls import Tube, Walls, build_walls, corners_into, tube_polylines, vessel_polylines
from gw_exudyn.model.wire import DEFAULT_IMPERFECTION, Wire, build_wire

if TYPE_CHECKING:
    from gw_exudyn.scenario import Scenario

Floats = NDArray[np.float64]


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
    drive: Drive
    outline: Outline
    tube: Tube
    loads: LoadSet
    around: Surroundings
    warnings: tuple[str, ...]

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
            "wire.bending_stiffness_least": min(min(p.value, p.value_end) for p in scenario.wire.bending_stiffness),
            "wire.bending_stiffness_largest": max(max(p.value, p.value_end) for p in scenario.wire.bending_stiffness),
            "wire.imperfection": value_or(scenario.wire.imperfection, DEFAULT_IMPERFECTION),
            "wire.mass": float(self.wire.mass.sum()),
            "vessel.walls": int(np.count_nonzero(~self.walls.tube)),
            "vessel.corners": corners_into(self.outline),
            "vessel.width_at_exit": self.around.width,
            "catheter.bore": scenario.catheter.bore,
            "contact.wall_stiffness": self.law.stiffness,
            "contact.wall_damping": self.law.damping * SINKING * self.wire.radius,
            "contact.tangential_stiffness": self.law.tangential_stiffness,
            "contact.onset": self.law.toe,
            "drive.duration": scenario.drive.duration,
            "drive.furthest": self.drive.extremes()[1],
            "solver.steps": int(np.ceil(scenario.drive.duration / scenario.solver.step)),
            "warnings": list(self.warnings),
        }


def build(scenario: Scenario) -> Model:
    """The model of a scenario. Raises ScenarioError for what cannot start (see checks)."""
    frame = Frame(scenario.catheter.exit, scenario.catheter.direction)
    wire, drive = _held(build_wire(scenario.wire), scenario.drive.hold), build_drive(scenario.drive)
    plane = build_outline(scenario.vessel)
    outline = Outline(frame.points_in(plane.points), plane.open_edges)
    pulled_back, bore = max(0.0, -drive.extremes()[0]), scenario.catheter.bore
    tube = Tube(bore or scenario.wire.diameter, 2 * wire.length + pulled_back, walled=bore is not None)
    loads = build_loads(scenario, wire, frame)
    check(scenario, outline, tube, drive, loads.discs)
    around = surroundings(outline, bore_or_more(scenario))
    law = contact_law(scenario, around)
    contact = scenario.contact
    walls = build_walls(
        outline,
        tube,
        wire.radius,
        contact.friction_coefficient,
        value_or(scenario.catheter.friction_coefficient, contact.friction_coefficient),
        seam_reach=6 * wire.radius,
    )
    warnings = (*law_warnings(scenario, around), *_too_coarse(scenario, wire))
    return Model(scenario, frame, wire, walls, law, drive, outline, tube, loads, around, warnings)


def _held(wire: Wire, hold: str) -> Wire:
    """The wire as the drive holds it: without the first joint's spring where its end may turn."""
    if hold == "clamped":
        return wire
    stiffness, damping, rest = wire.joint_stiffness.copy(), wire.joint_damping.copy(), wire.rest_angle.copy()
    stiffness[0] = damping[0] = rest[0] = 0.0
    return replace(wire, joint_stiffness=stiffness, joint_damping=damping, rest_angle=rest)


def _too_coarse(scenario: Scenario, wire: Wire) -> list[str]:
    shape, last = scenario.wire.tip_shape.length, float(wire.lengths[-1])
    if shape is None or shape >= last * (1 - 1e-9):
        return []
    return [
        f"wire.tip_shape: {shape * 1e3:.6g} mm is shorter than the last segment, {last * 1e3:.6g} mm, and is lost in "
        "part or whole; take more wire.segments, or a wire.grading above 1"
    ]
