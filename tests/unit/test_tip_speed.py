"""The controller of the tip's speed, on its own: what it decides from what it sees."""

from __future__ import annotations

import math

import pytest

from gw_exudyn.model.course import Course
from gw_exudyn.model.tip_speed import TipSpeed

STEP = 0.05
MOST = 10e-3


def drive(wanted: float = 2e-3, limit: float = math.inf) -> TipSpeed:
    return TipSpeed(Course.of([0.0, 100.0], [wanted, wanted]), MOST, limit)


def run(start: TipSpeed, steps: int, gain: float, stiffness: float = 0.0) -> TipSpeed:
    """A tip that moves by `gain` times the hub's travel against a spring (N/m)."""
    controlled, tip = start, 0.0
    for i in range(steps):
        time, before = i * STEP, controlled.position_at(i * STEP)
        controlled = controlled.decided(time, (tip, 0.0), stiffness * before, STEP)
        tip += gain * (controlled.position_at(time + STEP) - before)
    return controlled


@pytest.mark.parametrize("gain", [0.3, 1.0, 3.0])
def test_the_tip_reaches_its_speed_whatever_it_makes_of_the_hubs(gain: float) -> None:
    assert run(drive(), 200, gain).leg.speed * gain == pytest.approx(2e-3, rel=1e-6)


def test_it_begins_with_the_wanted_speed() -> None:
    assert drive().decided(0.0, (0.0, 0.0), 0.0, STEP).leg.speed == 2e-3


def test_a_tip_that_stays_drives_the_hub_to_its_largest_speed_and_no_further() -> None:
    assert run(drive(), 400, 0.0).leg.speed == MOST


def test_a_tip_that_rushes_stops_the_hub_and_never_pulls_it_back() -> None:
    started = drive().decided(0.0, (0.0, 0.0), 0.0, STEP)
    assert started.decided(STEP, (5e-3, 0.0), 0.0, STEP).leg.speed == 0.0


def test_way_lost_is_not_made_up_in_a_rush() -> None:
    """After a tip that stuck goes on, its speed settles to the wanted one, not above it."""
    stuck = run(drive(), 40, 0.0)
    tip, controlled, speeds = 0.0, stuck, []
    for i in range(40, 120):
        before = controlled.position_at(i * STEP)
        controlled = controlled.decided(i * STEP, (tip, 0.0), 0.0, STEP)
        tip += controlled.position_at((i + 1) * STEP) - before
        speeds.append(controlled.leg.speed)
    assert speeds[-1] == pytest.approx(2e-3, rel=1e-6)
    assert min(speeds) > 1.9e-3


def test_the_push_force_comes_up_to_its_limit_and_stays_below() -> None:
    held = run(drive(limit=1.0), 1000, 0.0, stiffness=200.0)
    assert 0.99 < 200.0 * held.position_at(1000 * STEP) <= 1.0


def test_a_change_of_the_wanted_speed_acts_at_once() -> None:
    settled = run(drive(), 100, 1.0)
    tip = settled.position_at(100 * STEP)
    changed = settled.taken_over_at(100 * STEP, 5e-3).decided(100 * STEP, (tip, 0.0), 0.0, STEP)
    assert changed.leg.speed == pytest.approx(5e-3, rel=1e-3)


def test_deciding_twice_at_one_time_changes_nothing() -> None:
    once = run(drive(), 30, 0.7)
    again = once.decided(once.leg.since, (once.leg.x, once.leg.y), once.leg.push, STEP)
    assert again == once
