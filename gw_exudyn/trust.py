"""Whether a run can be trusted: finite, in the lumen, not too deep in a wall, and with energies that add up."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import groupby

import numpy as np

from gw_exudyn.engine.stepper import Release, Stepper
from gw_exudyn.model.contact import Deepest
from gw_exudyn.result import SnapEvent, Status, StatusReport

DEEPEST = 0.3
"""Largest trusted penetration over the wire's radius."""

OPEN_ENERGY = 0.01
"""Largest trusted energy error over the largest work."""

ENERGY_FLOOR = 1e-7
"""Works below this, J, are too small for the energy check: bending the tip of a soft guidewire by five degrees takes
as much."""

SNAP_SHARE = 0.02
"""A nominal step that loses more than this share of the largest work to dampers and integrator is a snap-through."""


def trust_report(stepper: Stepper, *, converged: bool) -> StatusReport | None:
    """What is wrong at the time reached, or None. converged : the solver found its way there."""
    wire, time = stepper.model.wire, stepper.time
    push = f"push force {stepper.instant.push:.4g} N"
    if not (np.isfinite(stepper.contact.motion.q).all() and np.isfinite(stepper.instant.push)):
        return StatusReport(Status.NOT_FINITE, time)
    deepest = stepper.deepest
    if stepper.loads.discs.depth > DEEPEST * wire.radius:
        sunk = f"penetration {stepper.loads.discs.depth * 1e6:.4g} um, {push}"
        return StatusReport(Status.TOO_DEEP, time, "at a support or the nose", sunk)
    if deepest.depth > DEEPEST * wire.radius:
        sunk = f"penetration {deepest.depth * 1e6:.4g} um, {push}"
        return StatusReport(Status.TOO_DEEP, time, _place(stepper, deepest), sunk)
    left = _left(stepper)
    if left is not None:
        return StatusReport(Status.OUTSIDE_LUMEN, time, left, push)
    if not converged:
        return StatusReport(Status.NOT_CONVERGED, time, _place(stepper, deepest), push)
    return None


def _place(stepper: Stepper, deepest: Deepest) -> str:
    """Where a penetration is, in words."""
    if deepest.body < 0:
        return ""
    model, walls = stepper.model, stepper.model.walls
    tube = walls.corner_tube if deepest.corner else walls.tube
    owner, what = ("catheter" if tube[deepest.target] else "vessel"), ("corner" if deepest.corner else "wall")
    middle = float(model.wire.node_arc_length[deepest.body] + model.wire.node_arc_length[deepest.body + 1]) / 2
    x, y = model.frame.points_out(stepper.contact.motion.q[deepest.body, :2]) * 1e3
    return f"{middle * 1e3:.4g} mm from the tip, near ({x:.4g}, {y:.4g}) mm, at a {what} of the {owner}"


def _left(stepper: Stepper) -> str | None:
    """Where the wire's axis has gone through a wall, in words, or None."""
    crossing = stepper.contact.crossing()
    if crossing is None:
        return None
    body, wall = crossing
    x, y = stepper.model.frame.points_out(stepper.contact.motion.q[body, :2]) * 1e3
    owner = "catheter" if stepper.model.walls.tube[wall] else "vessel"
    return f"segment {body} near ({x:.4g}, {y:.4g}) mm crosses wall {wall}, of the {owner}"


def energy_report(stepper: Stepper) -> StatusReport | None:
    """ENERGY_OPEN where the energies of the run so far do not add up, else None."""
    energies = stepper.energies
    if energies.largest_work < ENERGY_FLOOR or abs(stepper.energy_error) <= OPEN_ENERGY * energies.largest_work:
        return None
    share = 100 * abs(stepper.energy_error) / energies.largest_work
    return StatusReport(Status.ENERGY_OPEN, stepper.time, detail=f"{share:.3g} % of {energies.largest_work:.3g} J")


def snap_events(stepper: Stepper) -> list[SnapEvent]:
    """Snap-throughs of the run so far: nominal steps, or several in a row, in which the wire lost much to its dampers
    or to the integrator. Quasi-static motion loses next to nothing there."""
    least = max(SNAP_SHARE * stepper.energies.largest_work, ENERGY_FLOOR)
    step = stepper.model.scenario.solver.step
    events: list[SnapEvent] = []
    for time, energy in _by_nominal_step(stepper.releases, step):
        if energy <= least:
            continue
        if events and time - events[-1].time <= step * 1.001:
            events[-1] = SnapEvent(time, events[-1].released_energy + energy)
        else:
            events.append(SnapEvent(time, energy))
    return events


def _by_nominal_step(releases: Sequence[Release], step: float) -> Iterator[tuple[float, float]]:
    """(end of the nominal step, s; energy released in it, J), in order."""
    for index, group in groupby(releases, key=lambda release: math.ceil(release.time / step - 1e-6)):
        yield index * step, sum(release.energy for release in group)
