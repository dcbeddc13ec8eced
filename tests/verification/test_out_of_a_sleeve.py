"""A wire let out of a sleeve against closed forms: a cantilever of its free length, a rod fed into a round channel."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gw_exudyn.result import Result, Status
from gw_exudyn.scenario import scenario_from_dict
from gw_exudyn.simulation import simulate

EI, DIAMETER = 1e-5, 0.36e-3
RADIUS = 20e-3


def run(**sections: Any) -> Result:
    wire = {"diameter": DIAMETER, "bending_stiffness": EI, "density": 6000.0, "imperfection": 0.0}
    content = {"catheter": {"bore": "sleeve"}, "stop": {"tip_stall": "off"}} | sections
    result = simulate(scenario_from_dict(content | {"wire": wire | sections["wire"]}))
    assert result.status.status is Status.COMPLETED, result.status.sentence()
    return result


@pytest.mark.parametrize("segments", [10, 40])
@pytest.mark.parametrize("free", [0.0500, 0.0523, 0.0548, 0.0571])
def test_a_cantilever_out_of_a_sleeve_bends_like_its_free_length(segments: int, free: float) -> None:
    """delta = F L^3 / (3 EI) of the length outside, whole segments or not, within 0.6 / n^2 of the n segments outside.

    A chain clamped between two segments is off by 1 / (2 n^2), as one clamped at a segment's end.
    """
    force = 1e-5
    result = run(
        wire={"length": 0.1, "segments": segments},
        vessel={"kind": "none"},
        drive={"kind": "speed", "speed": 0.0, "duration": 2.0, "start": free},
        tip={"force": [0.0, force], "ramp": 1.0},
        solver={"tolerance": 1e-10, "absolute_tolerance": 1e-14},
    )
    outside = segments * free / 0.1
    closed = force * free**3 / (3 * EI)
    assert float(result.values("tip_y")[-1]) == pytest.approx(closed, rel=0.6 / outside**2)
    assert np.abs(result.values("energy_error")).max() < 1e-6 * result.values("load_work")[-1]


def fed(clearance: float) -> tuple[float, float]:
    """Mean push force over a segment's passage, N, once the tip is far in; and of it what damping and integration
    take."""
    segments, length, begin, passages = 24, 0.06, 0.025, 3
    result = run(
        wire={"length": length, "segments": segments},
        vessel={"kind": "arc", "radius": RADIUS, "angle": 2.2, "diameter": DIAMETER + 2 * clearance, "facets": 90},
        contact={"friction_coefficient": 0.0},
        drive={"kind": "speed", "speed": 2e-3, "distance": begin + passages * length / segments},
        output={"interval": 0.05},
    )
    travel = result.values("drive_position") - result.values("drive_position")[0]
    lost = result.values("damping_loss") + result.values("numerical_loss")
    work, loss = (
        float(np.diff(np.interp([begin, travel[-1]], travel, sums))[0]) / (travel[-1] - begin)
        for sums in (result.values("insertion_work"), lost)
    )
    error = np.abs(result.values("energy_error")).max()
    assert error < 1e-5 * result.values("insertion_work")[-1]
    return work, loss


def test_a_rod_fed_into_a_circular_channel_needs_its_bending_energy_per_length() -> None:
    """Mean push force EI / (2 R^2) at no clearance [the bending energy of what goes in]; it lies along the outer wall,
    so with a clearance c it is EI / (2 (R + c)^2). The clearance is above the sagitta of a segment, 0.04 mm."""
    ideal = EI / (2 * RADIUS**2)
    clearances = np.array([0.06e-3, 0.12e-3])
    found = np.array([fed(float(c)) for c in clearances])
    kept = found[:, 0] - found[:, 1]
    assert kept == pytest.approx(EI / (2 * (RADIUS + clearances) ** 2), rel=0.01)
    at_none = kept[0] - clearances[0] * (kept[1] - kept[0]) / (clearances[1] - clearances[0])
    assert at_none == pytest.approx(ideal, rel=0.01)
    # What damping and steps of finite length take comes on top, and is told as such.
    assert (np.abs(found[:, 1]) < 0.08 * ideal).all()
