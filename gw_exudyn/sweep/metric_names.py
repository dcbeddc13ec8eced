"""Names, units and meanings of the metrics that every run has, without a run."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

import numpy as np

from gw_exudyn.metrics import Metric, metrics
from gw_exudyn.quantities import CONTACT_FIELDS, JOINT_FIELDS, NODE_FIELDS, SCALARS
from gw_exudyn.result import Result, Status, StatusReport
from gw_exudyn.scenario import scenario_from_dict

_SOME_SCENARIO = {
    "wire": {"model": "universal-ii"},
    "vessel": {"kind": "straight", "length": "100 mm", "diameter": "4 mm"},
    "catheter": {"bore": "1.2 mm"},
    "drive": {"kind": "speed", "speed": "1 mm/s", "distance": "1 mm"},
}


@cache  # the metrics of a program do not change
def metric_table() -> Mapping[str, Metric]:
    """The metrics of a run in which nothing happens: their values mean nothing, their units and meanings all."""
    sample: dict[str, Any] = {"time": 0.0, **dict.fromkeys(SCALARS, 0.0)}
    sample |= {name: np.zeros(2) for name in NODE_FIELDS}
    sample |= {name: np.zeros(1) for name in JOINT_FIELDS}
    sample |= {name: np.zeros(0) for name in CONTACT_FIELDS}
    still = Result.from_samples(
        [sample],
        scenario=scenario_from_dict(_SOME_SCENARIO),
        status=StatusReport(Status.COMPLETED),
        node_arc_length=[1.0, 0.0],
        joint_arc_length=[1.0],
    )
    return MappingProxyType(metrics(still))


def metric_names() -> tuple[str, ...]:
    """The names, in the order in which a run tells them."""
    return tuple(metric_table())
