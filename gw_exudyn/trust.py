"""Whether a run can be trusted: finite, in the lumen, not too deep in a wall, and with energies that add up."""

from __future__ import annotations

import numpy as np

from gw_exudyn.engine.stepper import Stepper
from gw_exudyn.result import SnapEvent, Status, StatusReport

DEEPEST = 0.3
"""Largest trusted penetration over the wire's radius."""

OPEN_ENERGY = 0.01
"""Largest trusted energy error over the largest work."""

ENERGY_FLOOR = 1e-7
"""Works below this, J, are too small for the energy check: bending the tip of a soft guidewire by five degrees takes
as much."""

SNAP_SHARE = 0.02
"""A solver step that loses more than this share of the largest work to the integrator is a snap-through."""


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
    """Snap-throughs of the run so far: runs of solver steps that each lost much at once, with the energy they set
    free."""
    least = max(SNAP_SHARE * stepper.energies.largest_work, ENERGY_FLOOR)
    step = stepper.model.scenario.solver.step
    events: list[SnapEvent] = []
    for release in stepper.releases:
        if release.energy <= least:
            continue
        if events and release.time - events[-1].time <= step + 1e-9:
            events[-1] = SnapEvent(events[-1].time, events[-1].released_energy + release.energy)
        else:
            events.append(SnapEvent(release.time, release.energy))
    return events
