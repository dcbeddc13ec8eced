"""Any rigid motion and mirror image of the whole scene leaves forces alone, up to the Newton tolerance."""

from __future__ import annotations

import math
from functools import cache

from hypothesis import given, settings
from hypothesis import strategies as st

from gw_exudyn.result import Result
from gw_exudyn.verification.insertions import WIRES, bend60, changed, run
from gw_exudyn.verification.invariance import NEWTON_TOLERANCE, Motion, differences, moved


def scene(wire: str):
    return changed(bend60(wire), wire={"segments": 40}, solver={"step": 0.1})


@cache
def unmoved(wire: str) -> Result:
    return run(scene(wire))


place = st.floats(-0.3, 0.3)


@settings(max_examples=8, deadline=None, derandomize=True)
@given(st.sampled_from(WIRES), st.floats(-math.pi, math.pi), place, place, st.booleans())
def test_forces_do_not_depend_on_the_frame(wire: str, turn: float, x: float, y: float, mirror: bool) -> None:
    motion = Motion(turn, (x, y), mirror)
    found = differences(unmoved(wire), run(moved(scene(wire), motion)), motion)
    place = found.pop("tip")
    for name, difference in found.items():
        # Ten times the Newton tolerance: both runs end their iterations where the residual is that small.
        assert difference <= 10 * NEWTON_TOLERANCE, name
    assert place <= 10 * NEWTON_TOLERANCE * 1e-3
