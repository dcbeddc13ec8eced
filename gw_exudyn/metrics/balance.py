"""Energies, and how the solver got on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.metrics.metric import Metric, final, peak_of
from gw_exudyn.quantities import QUANTITIES

if TYPE_CHECKING:
    from gw_exudyn.result import Result

LEAST_WORK = 1e-7
"""Largest work, J, below which an energy error is not measured on it; the floor of the trust check."""


def energy(result: Result) -> dict[str, Metric]:
    """Work, losses, and what the balance leaves over."""
    error, _ = peak_of(np.abs(result.values("energy_error")), result.time)
    work, _ = peak_of(np.abs(result.values("insertion_work") + result.values("load_work")), result.time)
    released = [snap.released_energy for snap in result.snaps]
    unit = QUANTITIES["energy_error"].unit
    return {
        "insertion_work": final(result, "insertion_work"),
        "friction_loss": final(result, "friction_loss"),
        "energy_error_max": Metric(error, unit, "largest magnitude of what the energy balance leaves over"),
        "energy_error_relative": Metric(
            error / work if work >= LEAST_WORK else float("nan"),
            "1",
            f"the same over the largest work; none where that is below {LEAST_WORK:g} J",
        ),
        "snaps": Metric(float(len(released)), "1", "number of snap-through events"),
        "snap_energy_max": Metric(max(released, default=0.0), unit, "largest energy released by a snap-through"),
    }


def solution(result: Result) -> dict[str, Metric]:
    """Cost and steps of the solution."""
    steps, iterations = result.values("solver_steps")[-1], result.values("newton_iterations")[-1]
    per_step = float(iterations / steps) if steps > 0 else float("nan")
    return {
        "duration": Metric(float(result.time[-1]), QUANTITIES["time"].unit, "time that the run reached"),
        "solver_steps": final(result, "solver_steps"),
        "newton_iterations_per_step": Metric(per_step, "1", "Newton iterations per solver step"),
        "smallest_step": final(result, "smallest_step"),
    }
