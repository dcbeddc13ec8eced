"""How hard the wire is pushed, and how hard it presses on the vessel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.metrics.metric import Metric, largest, with_time
from gw_exudyn.quantities import CONTACT_OWNERS, QUANTITIES

if TYPE_CHECKING:
    from gw_exudyn.result import Result

VESSEL = next(value for value, word in CONTACT_OWNERS if word == "vessel")


def forces(result: Result) -> dict[str, Metric]:
    """The largest forces, with their times, and where the largest wall force was."""
    resultant = np.hypot(result.values("wall_force_x"), result.values("wall_force_y"))
    cases = {
        "push_force_max": ("push_force", result.values("push_force"), "largest push force", ""),
        "pull_force_max": (
            "pull_force",
            -result.values("push_force"),
            "largest pull force",
            " (negative push force; zero or less: none)",
        ),
        "wall_force_max": (
            "wall_force_max",
            result.values("wall_force_max"),
            "largest force of a single contact with the vessel",
            "",
        ),
        "wall_force_resultant_max": ("", resultant, "largest resultant force on the vessel", ""),
        "tip_force_max": ("", result.values("tip_force"), "largest contact force on the tip", ""),
    }
    found: dict[str, Metric] = {}
    for name, (peak, values, meaning, remark) in cases.items():
        found |= with_time(result, name, peak, values, QUANTITIES["push_force"].unit, meaning, remark)
    return found | _place_of_largest_force(result)


def hardest_contact(result: Result) -> tuple[int, int] | None:
    """Output and contact (indices) at which the vessel was pressed hardest (of a peak between two outputs, the
    nearest); None where it never was.
    """
    force = np.hypot(result.values("contact_normal_force"), result.values("contact_tangential_force"))
    of_vessel = result.values("contact_owner") == VESSEL
    force = np.where(of_vessel & np.isfinite(force), force, -np.inf)
    instant, contact = (int(i) for i in np.unravel_index(int(np.argmax(force)), force.shape))
    return (instant, contact) if np.isfinite(force[instant, contact]) else None


def _place_of_largest_force(result: Result) -> dict[str, Metric]:
    where = hardest_contact(result)
    places = {"x": "contact_x", "y": "contact_y", "arc_length": "contact_arc_length"}
    return {
        f"wall_force_max_{name}": Metric(
            float("nan") if where is None else float(result.values(field)[where]),
            QUANTITIES[field].unit,
            f"{QUANTITIES[field].long_name}, of the largest force of a single contact, at the outputs",
        )
        for name, field in places.items()
    }


def contact(result: Result) -> dict[str, Metric]:
    """How many contacts, and how deep."""
    return {
        "contacts_max": largest(
            result, "contacts", "largest number of contacts with the vessel at once, at the outputs"
        ),
        **with_time(
            result,
            "penetration_max",
            "penetration_max",
            result.values("penetration_max"),
            QUANTITIES["penetration_max"].unit,
            "deepest penetration of the wire's surface into a wall",
        ),
    }
