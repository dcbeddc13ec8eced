"""The drive: travel is the integral of the speed, whatever the table, and whoever takes over."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from model_cases import scenario

from gw_exudyn.model.drive import Drive, build_drive
from gw_exudyn.scenario import SpeedDrive


def drive(*rows: tuple[float, float]) -> Drive:
    return table({"kind": "speed", "table": [list(row) for row in rows]})


def table(spec) -> Drive:
    return build_drive(scenario(drive=spec).drive)


PHASES = table(
    {
        "kind": "speed",
        "phases": [
            {"speed": 2e-3, "duration": 10.0, "ramp": 1.0},
            {"speed": 0.0, "duration": 4.0, "ramp": 1.0},
            {"speed": -4e-3, "duration": 5.0},
        ],
    }
)
"""Up to 2 mm/s within 1 s, on until 10 s, stopped by 11 s, held until 14 s; then 4 mm/s back until 19 s."""


@pytest.mark.parametrize(
    ("time", "speed", "travel"),
    [
        (0.0, 0.0, 0.0),
        (0.5, 1e-3, 0.25e-3),
        (1.0, 2e-3, 1e-3),
        (10.0, 2e-3, 19e-3),
        (10.5, 1e-3, 19.75e-3),
        (11.0, 0.0, 20e-3),
        (13.0, 0.0, 20e-3),
        (14.0, -4e-3, 20e-3),  # at a step the later speed
        (19.0, -4e-3, 0.0),
        (20.0, -4e-3, -4e-3),  # past the end the last speed is held
    ],
)
def test_ramp_hold_and_pull_back(time, speed, travel):
    assert PHASES.speed_at(time) == pytest.approx(speed, abs=1e-15)
    assert PHASES.position_at(time) == pytest.approx(travel, abs=1e-15)


def test_a_constant_speed_starts_at_once():
    constant = table({"kind": "speed", "speed": 2e-3, "distance": 0.06})
    assert (constant.speed_at(0.0), constant.position_at(0.0)) == (2e-3, 0.0)
    assert constant.position_at(30.0) == pytest.approx(0.06)


def test_the_fastest_speed_between_two_times_counts_both_ways_and_in_between():
    end = float(PHASES.course.time[-1])
    assert PHASES.fastest(0.0, end) == 4e-3
    peak = drive((0, 0), (1, -5e-3), (2, 0))
    assert peak.fastest(0.0, 2.0) == 5e-3
    assert peak.fastest(0.0, 0.5) == pytest.approx(2.5e-3)
    assert peak.taken_over_at(0.5, 1e-3).fastest(0.5, 2.0) == 1e-3


def test_extremes_of_there_and_back():
    assert PHASES.extremes() == pytest.approx((0.0, 20e-3))
    assert drive((0, -1e-3), (3, -1e-3), (3, 1e-3), (5, 1e-3)).extremes() == pytest.approx((-3e-3, 0.0))


def test_a_turning_point_inside_a_ramp_is_an_extreme():
    """From 3 to -1 mm/s within 4 s: it turns after 3 s, 4.5 mm on; at the ramp's end it is back at 4 mm."""
    turning = drive((0, 3e-3), (4, -1e-3))
    assert turning.position_at(4.0) == pytest.approx(4e-3)
    assert turning.extremes() == pytest.approx((0.0, 4.5e-3))
    assert drive((0, -3e-3), (4, 1e-3)).extremes() == pytest.approx((-4.5e-3, 0.0))


def test_taken_over_from_outside_the_travel_does_not_jump():
    taken = PHASES.taken_over_at(10.5, -1e-3)
    assert taken.position_at(10.5) == PHASES.position_at(10.5)
    assert taken.position_at(10.4) == PHASES.position_at(10.4)
    assert taken.speed_at(10.5) == -1e-3
    assert taken.speed_at(10.4) == PHASES.speed_at(10.4)
    assert taken.position_at(12.5) == pytest.approx(PHASES.position_at(10.5) - 2e-3)


def test_taken_over_again_and_again():
    taken = PHASES.taken_over_at(2.0, 1e-3).taken_over_at(3.0, 5e-3).taken_over_at(4.0, 0.0)
    assert taken.position_at(9.0) == pytest.approx(PHASES.position_at(2.0) + 1e-3 + 5e-3)


def test_taken_over_past_the_end_goes_on_from_there():
    assert PHASES.taken_over_at(21.0, 1e-3).position_at(22.0) == pytest.approx(-8e-3 + 1e-3)


steps = st.lists(st.tuples(st.floats(0.0, 5.0), st.floats(-0.1, 0.1)), min_size=1, max_size=6)


@given(steps, st.floats(-0.1, 0.1))
def test_travel_is_the_integral_of_the_speed_and_stays_within_the_extremes(steps, first):
    """Over half a piece a linear speed covers its mean, exactly but for rounding (1e-12 m)."""
    times = [float(t) for t in np.cumsum([0.0, *(lasts for lasts, _ in steps)])]
    speeds = [first, *(speed for _, speed in steps)]
    made = build_drive(SpeedDrive(time=tuple(times), speed=tuple(speeds)))
    low, high = made.extremes()
    for (start, before), (end, after) in pairwise(zip(times, speeds, strict=True)):
        middle, mean = (start + end) / 2, (3 * before + after) / 4
        if middle < end:
            covered = made.position_at(middle) - made.position_at(start)
            assert covered == pytest.approx(mean * (middle - start), abs=1e-12)
        assert low - 1e-12 <= made.position_at(middle) <= high + 1e-12
