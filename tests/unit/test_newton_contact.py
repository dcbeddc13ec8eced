"""How Newton's iteration takes contacts: where it linearises their onset, and when it gives a step up."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from model_cases import LAW, RADIUS, at_rest, bare_walls, force_at, plain_wire
from scenes import scenario

from gw_exudyn.engine.stepper import Stepper
from gw_exudyn.model import build
from gw_exudyn.model.contact import Contact

FLOOR = bare_walls(((-10e-3, 0.0), (10e-3, 0.0)))


def disc_at(gap):
    """One segment, (1, 3), along the floor, its node's disc this far off it, m."""
    return np.array([[0.0, RADIUS + gap, 0.0]])


@pytest.fixture
def contact() -> Contact:
    return at_rest(plain_wire([2e-3]), FLOOR, disc_at(0.1e-3))


def stepped(contact: Contact, start: float, end: float) -> float:
    """N: the normal force that Newton is given at the gap `end` after a step from the gap `start`, both in m."""
    force_at(contact, disc_at(start))
    contact.step_on()
    contact.motion.set(disc_at(end), np.zeros((1, 3)))
    contact.evaluate(followed=True)
    return float(contact.nodes.normal[0])


def iterations(contact: Contact, *, followed: bool) -> tuple[int, float]:
    """Newton on a disc that a soft spring presses on the floor, from deep in: how many, and the penetration of the
    onset at the end, m."""
    force, soft, gap = 1e-6, 1e-2, -LAW.toe
    contact.motion.set(disc_at(gap), np.zeros((1, 3)))
    contact.evaluate()
    for count in range(1, 40):
        missing = contact.force[0, 1] - force - soft * (gap + LAW.toe)
        if abs(missing) < 1e-12:
            return count, LAW.toe - gap
        gap += missing / (soft - contact.tangent[4])
        contact.step_on()
        contact.motion.set(disc_at(gap), np.zeros((1, 3)))
        contact.evaluate(followed=followed)
    raise AssertionError("Newton found no balance")


def test_a_contact_that_should_only_just_touch_is_found_in_a_few_iterations(contact):
    (plain, expected), (few, found) = (iterations(contact, followed=followed) for followed in (False, True))
    assert found == pytest.approx(expected, rel=1e-6)
    assert plain >= 8
    assert few <= 5


@pytest.mark.parametrize("start", [0.5, 0.0, -1.5, -4.0])
@pytest.mark.parametrize("end", [0.9, 0.499, -0.5, -1.5, -6.0])
def test_what_newton_is_given_is_off_the_law_by_no_more_than_twice_what_is_off_balance(contact, start, end):
    start, end = start * LAW.toe, end * LAW.toe
    given = stepped(contact, start, end)
    pairs = contact.nodes
    foreseen = LAW.stiffness * (pairs.was_line[0] + pairs.was_slope[0] * (LAW.toe - end))
    law = float(force_at(contact, disc_at(end))[0, 1])
    assert -1e-15 <= law - given <= 2 * (given - foreseen) + 1e-15


def test_the_spring_is_taken_where_it_has_the_force_that_was_foreseen(contact):
    start, end = 0.2 * LAW.toe, 0.4 * LAW.toe
    stepped(contact, start, end)
    pairs, toe = contact.nodes, LAW.toe
    foreseen = pairs.was_line[0] + pairs.was_slope[0] * (toe - end)
    taken = 2 * toe * pairs.slope[0]
    assert taken**2 / (4 * toe) == pytest.approx(foreseen)
    assert contact.tangent[4] == pytest.approx(-LAW.stiffness * taken / (2 * toe))


def test_a_contact_that_was_open_is_taken_as_it_is(contact):
    end = -0.4 * LAW.toe
    given = stepped(contact, 3 * LAW.toe, end)
    assert given == force_at(contact, disc_at(end))[0, 1] > 0


def test_the_forces_of_a_step_are_those_of_the_law(monkeypatch):
    model = build(scenario())
    stepper, worst = Stepper(model), []
    accept = stepper.contact.accept

    def compare() -> None:
        given = stepper.contact.force.copy()
        stepper.contact.evaluate(velocity=0.0)
        worst.append(np.abs(stepper.contact.force - given)[:, :2].max())
        accept()

    monkeypatch.setattr(stepper.contact, "accept", compare)
    assert stepper.advance(13.0)
    largest = max(force for name, (force, _) in stepper.peaks.items() if name == "wall_force_max")
    assert largest > 1e-3
    assert max(worst) < 1e-5 * largest


def test_a_step_is_given_up_where_newton_has_gone_further_than_a_step_may():
    stepper, calls = Stepper(build(scenario())), []
    newton = stepper._newton
    residual = newton._before_residual

    def watched(mbs, time, iteration, outer) -> None:
        residual(mbs, time, iteration, outer)
        calls.append((iteration, newton._jumped()))

    newton._before_residual = watched
    assert stepper.advance(13.0)
    after = [following for (count, far), (following, _) in pairwise(calls) if count >= 3 and far]
    assert after
    assert set(after) == {0}


def test_contacts_on_the_way_do_not_send_the_wire_to_the_other_side():
    """Few stiff segments, pushed square against a wall: they buckle towards the open end, as the rest curvature bends
    them, not into the corner opposite."""
    stiff = {"model": "amplatz-super-stiff", "segments": 20}
    case = scenario(contact={"friction_coefficient": 0.1}, solver={"step": 0.05})
    stepper = Stepper(build(case.model_copy(update={"wire": type(case.wire).model_validate(stiff)})))
    assert stepper.advance(14.0)
    assert stepper.tip()[1] > 2e-3
