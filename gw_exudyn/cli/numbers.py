"""Metrics as people read them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gw_exudyn.quantities import number_text

if TYPE_CHECKING:
    from gw_exudyn.metrics import Metric


def metric_text(name: str, metric: Metric) -> str:
    """A metric in its display unit: `20.7 mN`; a coded one by its label."""
    return metric.label or number_text(name, metric.value, metric.unit)
