"""Whether a run can be trusted: finite, in the lumen, not too deep in a wall, and with energies that add up."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import groupby

import numpy as np

from gw_exudyn.engine.stepper import Release, Stepper
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
    motion, wire = stepper.contact.motion, stepper.model.wire
    push = f"push force {stepper.instant.push:.4g} N"
    if not (np.isfinite(motion.q).all() and np.isfinite(stepper.instant.push)):
        return StatusReport(Status.NOT_FINITE, stepper.time)
    depth, place = stepper.contact.deepest()
    if depth > DEEPEST * wire.radius:
        return StatusReport(Status.TOO_DEEP, stepper.time, place, f"penetration {depth * 1e6:.4g} um, {push}")
    crossing = stepper.contact.crossing()
    if crossing is not None:
        body, wall = crossing
        return StatusReport(Status.OUTSIDE_LUMEN, stepper.time, f"segment {body} crosses wall {wall}", push)
    if not converged:
        return StatusReport(Status.NOT_CONVERGED, stepper.time, place, push)
    return None


def energy_report(stepper: Stepper) -> StatusReport | None:
    """ENERGY_OPEN where the energies of the run so far do not add up, else None."""
    energies = stepper.energies
    if energies.largest_work < ENERGY_FLOOR or abs(energies.error) <= OPEN_ENERGY * energies.largest_work:
        return None
    share = 100 * abs(energies.error) / energies.largest_work
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
