"""Small made-up results: smooth, plausible, and quick to make. Not physics; for tests of what comes after a run."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from gw_exudyn.quantities import CONTACT_FIELDS, JOINT_FIELDS, NODE_FIELDS, SCALARS
from gw_exudyn.result import Result, SnapEvent, Status, StatusReport
from gw_exudyn.scenario.stop import StopSpec
from gw_exudyn.scenario.vessels.regions import Lumen

FROM_TIP = 0.15 * (1 - np.arange(11) / 10)
LEAD, RADIUS, LIMB, HALF_WIDTH = 0.030, 0.012, 0.060, 0.003


@dataclass(frozen=True)
class StandInWire:
    diameter: float = 0.36e-3
    model: str | None = "universal-ii"


class StandInVessel(Lumen):
    """No branches by name."""

    def _whole(self) -> list[tuple[float, float]]:
        outer, inner = corner_walls()
        return [*map(tuple, outer), *map(tuple, inner)]


@dataclass(frozen=True)
class StandInScenario:
    """What results need to know of a scenario."""

    name: str = "corner90-universal"
    wire: StandInWire = field(default_factory=StandInWire)
    supports: tuple[Any, ...] = ()
    nose: Any = None
    vessel: Lumen = field(default_factory=StandInVessel)
    stop: StopSpec = field(default_factory=StopSpec)

    def to_dict(self) -> dict[str, Any]:
        return {"name": self.name, "wire": {"diameter": self.wire.diameter, "model": self.wire.model}}

    @classmethod
    def from_dict(cls, content: dict[str, Any]) -> StandInScenario:
        return cls(content["name"], StandInWire(**content["wire"]))


def route(place: np.ndarray) -> np.ndarray:
    """(k, 2) points of the made-up wire's course at distances from the catheter's exit: straight, a quarter circle to
    the left, straight up.
    """
    place = np.asarray(place, dtype=float)
    start = LEAD + HALF_WIDTH - RADIUS
    arc = RADIUS * np.pi / 2
    turned = np.clip((place - start) / RADIUS, 0, np.pi / 2)
    on = np.clip(place - start - arc, 0, None)
    sag = -(HALF_WIDTH - 0.2e-3) * np.sin(np.clip(place / start, 0, 1) * np.pi / 2) ** 2
    x = np.minimum(place, start) + RADIUS * np.sin(turned)
    y = sag + RADIUS * (1 - np.cos(turned)) + on
    return np.column_stack([x, y])


def corner_walls() -> tuple[np.ndarray, np.ndarray]:
    """Lower-right and upper-left wall of a vessel 6 mm wide that turns left by 90 degrees."""
    w, far, up = HALF_WIDTH, LEAD + HALF_WIDTH, LIMB
    outer = np.array([[0.0, -w], [far, -w], [far, up]])
    inner = np.array([[far - 2 * w, up], [far - 2 * w, w], [0.0, w]])
    return outer, inner


def catheter_walls(bore: float = 1.2e-3, length: float = 0.15) -> tuple[np.ndarray, np.ndarray]:
    return np.array([[-length, -bore / 2], [0, -bore / 2]]), np.array([[0, bore / 2], [-length, bore / 2]])


def sample(time: float, depth: float, scale: float, nodes_from_tip: np.ndarray, rate: float = 2e-3) -> dict[str, Any]:
    """One output instant with the wire inserted to `depth` and forces in proportion to `scale`."""
    place = depth - nodes_from_tip
    points = np.where(place[:, None] < 0, np.column_stack([place, 0 * place]), route(place))
    direction = np.unwrap(np.arctan2(*np.diff(points, axis=0).T[::-1]))
    values: dict[str, Any] = dict.fromkeys(SCALARS, 0.0)
    contacts = _contacts(depth, scale, nodes_from_tip, points)
    vessel = contacts["contact_owner"] == 0
    normal = contacts["contact_normal_force"]
    values.update(
        time=time,
        insertion_depth=depth,
        tip_x=points[-1, 0],
        tip_y=points[-1, 1],
        tip_angle=direction[-1],
        push_force=scale * (0.15 + 12 * depth + 0.5 * np.sin(400 * depth) * (depth > 0.03)),
        tip_force=scale * 0.4 * (depth > 0.03),
        wall_force_x=normal[vessel].sum() * 0.6,
        wall_force_y=-normal[vessel].sum() * 0.5,
        wall_force_normal=normal[vessel].sum(),
        wall_force_max=normal[vessel].max(initial=0.0) * np.hypot(1, 0.3),
        contacts=int(vessel.sum()),
        penetration_max=2e-6,
        insertion_work=scale * 10 * depth**2,
        elastic_energy=scale * 5 * depth**2,
        wall_energy=scale * 0.3 * depth**2,
        friction_loss=scale * 4 * depth**2,
        damping_loss=scale * 0.4 * depth**2,
        numerical_loss=scale * 0.27 * depth**2,
        energy_error=scale * 0.03 * depth**2,
        catheter_force_normal=scale * 6 * depth,
        drive_speed=rate,
        drive_position=depth - 0.15,
        solver_steps=round(time / 0.05),
        newton_iterations=4 * round(time / 0.05),
        smallest_step=0.05,
    )
    values.update(dict(zip(NODE_FIELDS, points.T, strict=True)))
    angles = np.diff(direction, prepend=0.0)
    values.update(dict(zip(JOINT_FIELDS, (angles, 1e-4 * angles), strict=True)))
    return values | contacts


def _contacts(depth: float, scale: float, from_tip: np.ndarray, points: np.ndarray) -> dict[str, np.ndarray]:
    """Nodes on the outer wall once the tip is in the corner, one corner of the inner wall, one lip of the catheter."""
    radius = 0.18e-3
    rows: list[tuple[float, ...]] = []
    if depth > 0.02:
        for index in np.flatnonzero((depth - from_tip > 0.012) & (depth - from_tip < 0.020))[::2]:
            x, y = points[index]
            rows.append((x, y - radius, from_tip[index], scale * 0.15, scale * 0.05, -1e-6, 0, 0))
    if depth > 0.035:
        for index in np.flatnonzero(depth - from_tip > 0.042)[::3]:
            x, y = points[index]
            rows.append((x + radius, y, from_tip[index], scale * (0.3 + 4 * (depth - 0.035)), scale * 0.1, -2e-6, 0, 0))
    if depth > 0.03:
        x, y = points[-1]
        rows.append((x + radius, y, 0.0, scale * (0.5 + 8 * depth), scale * 0.3, -2e-6, 0, 0))
        s = depth - 0.001
        rows.append((0.001, 0.6e-3, s, scale * 0.8, scale * 0.1, -1e-6, 1, 1))
    table = np.array(rows).reshape(-1, len(CONTACT_FIELDS))
    return dict(zip(CONTACT_FIELDS, table.T, strict=True))


def made_up_result(
    name: str = "corner90-universal",
    *,
    segments: int = 60,
    scale: float = 0.02,
    instants: int = 41,
    deepest: float = 0.08,
    pull_back: bool = False,
    wire: StandInWire | None = None,
    status: StatusReport | None = None,
    snaps: tuple[SnapEvent, ...] = (SnapEvent(17.3, 2.1e-6),),
    peaks: dict[str, tuple[float, float]] | None = None,
) -> Result:
    """A run that pushes at 2 mm/s to `deepest` (and back with `pull_back`); contact forces are a few times `scale`
    (N).
    """
    from_tip = 0.15 * (1 - np.arange(segments + 1) / segments)
    depths = np.linspace(0, deepest, instants)
    if pull_back:
        depths = np.concatenate([depths, depths[-2::-1]])
    times = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(depths)))]) / 2e-3
    return Result.from_samples(
        [sample(time, depth, scale, from_tip) for time, depth in zip(times, depths, strict=True)],
        scenario=StandInScenario(name, wire or StandInWire()),
        status=status or StatusReport(Status.COMPLETED, float(times[-1])),
        node_arc_length=from_tip,
        joint_arc_length=from_tip[:-1],
        snaps=snaps,
        vessel_outline=corner_walls(),
        catheter_outline=catheter_walls(),
        provenance={"note": "made up"},
        wall_time=1.25,
        counters={"steps": 800, "newton_iterations": 3200},
        peaks=peaks or {},
    )
