"""Numbers of results as people read them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from gw_exudyn.quantities import QUANTITIES, display

if TYPE_CHECKING:
    from gw_exudyn.metrics import Metric

# A quantity of each unit, whose display unit serves for metrics that are no quantity by themselves.
_LIKE = {"m": "tip_x", "N": "push_force", "J": "insertion_work", "rad": "tip_angle", "s": "time", "1": "contacts"}


def metric_text(name: str, metric: Metric) -> str:
    """A metric in its display unit: `20.7 mN`; a coded one by its label."""
    return metric.label or number_text(name, metric.value, metric.unit)


def number_text(name: str, value: float | None, unit: str) -> str:
    """A number in SI in the unit in which people read it; a dash where there is none."""
    if value is None or not math.isfinite(value):
        return "-"
    like = name if name in QUANTITIES else _LIKE.get(unit)
    return display(like, value) if like else f"{value:.4g} {unit}"
