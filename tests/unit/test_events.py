"""The anchor by which a stalled tip is found, and the hub's books."""

from __future__ import annotations

import pytest

from gw_exudyn.events import Anchor, moved_anchor
from gw_exudyn.model.hub import HubEnergies, HubInstant, hub_advanced

LENGTH = 10e-3


def test_the_anchor_stays_while_the_tip_stays() -> None:
    anchor = Anchor(1e-3, 5e-3, 0.0)
    assert moved_anchor(anchor, LENGTH, 9e-3, (5.99e-3, 0.0)) is anchor


def test_the_anchor_goes_along_with_a_tip_that_moves_on() -> None:
    assert moved_anchor(Anchor(1e-3, 5e-3, 0.0), LENGTH, 9e-3, (5e-3, 1e-3)) == Anchor(9e-3, 5e-3, 1e-3)


def test_the_anchor_goes_back_with_a_wire_that_is_pulled_back() -> None:
    assert moved_anchor(Anchor(4e-3, 5e-3, 0.0), LENGTH, 3e-3, (5e-3, 0.0)) == Anchor(3e-3, 5e-3, 0.0)


def test_the_hubs_books_close_over_a_step_whose_forces_balance() -> None:
    """Hand-made instants: at each, force = push + damping x speed + mass x acceleration."""
    mass, damping, step = 0.01, 5.0, 0.05
    old = HubInstant(0.0, 1e-3, 0.2, 0.013, 0.013 - damping * 1e-3 - mass * 0.2)
    new = HubInstant(2e-4, 6e-3, -0.1, 0.050, 0.050 - damping * 6e-3 + mass * 0.1)
    before = HubEnergies(work=1e-5, kinetic=0.5 * mass * 1e-6, passed_on=1e-5 - 0.5 * mass * 1e-6)
    after = hub_advanced(before, mass, damping, old, new, step)
    assert after.error == pytest.approx(before.error, abs=1e-18)
    assert after.kinetic == pytest.approx(0.5 * mass * 36e-6)
    assert after.damping_loss == pytest.approx(damping * 4e-8 / step)
    assert after.work - before.work == pytest.approx(0.5 * (0.013 + 0.050) * 2e-4)


def test_a_hub_whose_forces_do_not_balance_shows_in_the_error() -> None:
    old, new = HubInstant(), HubInstant(2e-4, 6e-3, 0.0, 0.05, 0.05)
    after = hub_advanced(HubEnergies(), 0.01, 5.0, old, new, 0.05)
    assert after.error == pytest.approx(-5.0 * 6e-3 * 2e-4)
