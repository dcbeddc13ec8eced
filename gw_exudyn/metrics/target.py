"""Whether the tip reached the scenario's target (`stop.target`), when, and at which depth."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.metrics.metric import Metric
from gw_exudyn.quantities import QUANTITIES

if TYPE_CHECKING:
    from gw_exudyn.result import Result


def target(result: Result) -> dict[str, Metric]:
    """The target's metrics; none where the scenario has no target."""
    wanted = result.scenario.stop.target
    if wanted is None:
        return {}
    tips = np.column_stack([result.values("tip_x"), result.values("tip_y")])
    reached = np.array(wanted.reached(result.scenario.vessel, tips))
    first = int(np.argmax(reached))
    times = {"time": result.time, "insertion_depth": result.values("insertion_depth")}
    return {
        "target_reached": Metric(
            float(reached.any()), "1", f"1 where the tip reached its target at an output, else 0; {wanted.words}"
        ),
        **{
            f"target_{name}": Metric(
                float(values[first]) if reached.any() else float("nan"),
                QUANTITIES[name].unit,
                f"{name.replace('_', ' ')} at the first output at which the tip had reached its target; none where it "
                "never did",
            )
            for name, values in times.items()
        },
    }
