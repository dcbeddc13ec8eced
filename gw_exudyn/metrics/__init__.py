"""Single numbers that sum up a run, each with its unit and meaning.

Those of a target are there where the scenario has one, those of branches where its vessel has branches by name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from gw_exudyn.metrics.balance import LEAST_WORK, energy, solution
from gw_exudyn.metrics.branches import branches
from gw_exudyn.metrics.forces import contact, forces
from gw_exudyn.metrics.metric import Metric
from gw_exudyn.metrics.motion import guidance, tip
from gw_exudyn.metrics.target import target

if TYPE_CHECKING:
    from gw_exudyn.result import Result

__all__ = ["LEAST_WORK", "Metric", "metrics"]


def metrics(result: Result) -> dict[str, Metric]:
    """Metrics of a run by name, in the order in which a table shows them."""
    return {
        **tip(result),
        **target(result),
        **guidance(result),
        **forces(result),
        **contact(result),
        **branches(result),
        **energy(result),
        **solution(result),
    }
