"""Names, units and meanings of the metrics that a scenario's runs have, without a run."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import Any

import numpy as np

from gw_exudyn.metrics import Metric, metrics
from gw_exudyn.quantities import CONTACT_FIELDS, JOINT_FIELDS, NODE_FIELDS, SCALARS
from gw_exudyn.result import Result, Status, StatusReport
from gw_exudyn.scenario import Scenario


@lru_cache(maxsize=16)
def metric_table(scenario: Scenario) -> Mapping[str, Metric]:
    """The metrics of a run of the scenario in which nothing happens, in the order in which a run tells them.

    Their values mean nothing, their units and meanings all. Which there are depends on the scenario: those of a target
    and of branches need both.
    """
    sample: dict[str, Any] = {"time": 0.0, **dict.fromkeys(SCALARS, 0.0)}
    sample |= {name: np.zeros(2) for name in NODE_FIELDS}
    sample |= {name: np.zeros(1) for name in JOINT_FIELDS}
    sample |= {name: np.zeros(0) for name in CONTACT_FIELDS}
    still = Result.from_samples(
        [sample],
        scenario=scenario,
        status=StatusReport(Status.COMPLETED),
        node_arc_length=[1.0, 0.0],
        joint_arc_length=[1.0],
    )
    return MappingProxyType(metrics(still))
