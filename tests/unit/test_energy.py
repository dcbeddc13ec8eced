"""Energies: each term where it is known by hand, and all of them together on steps of any kind."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from model_cases import LAW, RADIUS, at_rest, bare_walls, chain, plain_wire, scenario

from gw_exudyn.model.energy import Energies, advanced, joint_moments, relative_angles, snapshot
from gw_exudyn.model.kernel import Motion
from gw_exudyn.model.wire import build_wire

MU = 0.4
STEP = 0.05
FLOOR = ((0.0, 0.0), (60e-3, 0.0))


def motion_of(q, v=None):
    motion = Motion(len(q))
    motion.set(q, np.zeros_like(q) if v is None else v)
    return motion


def taken(contact, q, *, push=0.0, travel=0.0, before=None, acceleration=None):
    """The energies after a step from the contact's present place to q, at a steady rate; the contact goes on there."""
    wire, start_q = contact.wire, contact.motion.q.copy()
    contact.motion.set(start_q, np.zeros_like(q))
    old = snapshot(wire, contact.motion, push, 0.0)
    contact.start_step()
    contact.evaluate()
    start = contact.summary().energy
    contact.motion.set(q, (q - start_q) / STEP)
    contact.evaluate()
    if acceleration is None:
        acceleration = np.zeros_like(q)
    new = snapshot(wire, contact.motion, push, travel)
    after = advanced(before or Energies(), contact, start, old, new, acceleration, STEP)
    contact.accept()
    return after


# --- stored


@pytest.mark.parametrize("segments", [1, 10, 400])
def test_a_wire_bent_to_a_circle_stores_half_ei_curvature_squared(segments):
    """Over its length but for the distal half segment, which no joint stands for."""
    stiffness, curvature = 2e-6, 8.0
    wire = build_wire(scenario(wire={"segments": segments, "bending_stiffness": stiffness}).wire)
    angles = curvature * (wire.length - (wire.node_arc_length[:-1] + wire.node_arc_length[1:]) / 2)
    stored = snapshot(wire, motion_of(chain(wire, (0, 0), angles)), 0.0, 0.0).elastic
    assert stored == pytest.approx(0.5 * stiffness * curvature**2 * (wire.length - wire.lengths[-1] / 2))


def test_a_wire_at_its_rest_shape_stores_nothing_and_pulls_nowhere():
    wire = build_wire(scenario(wire={"tip_shape": {"kind": "arc", "length": 0.03, "angle": 1.0}}).wire)
    motion = motion_of(chain(wire, (0, 0), np.cumsum(wire.rest_angle)))
    assert snapshot(wire, motion, 0.0, 0.0).elastic == pytest.approx(0.0, abs=1e-20)
    assert joint_moments(wire, motion) == pytest.approx(np.zeros(10), abs=1e-15)


def test_joints_resist_bend_and_its_rate():
    wire = plain_wire([2e-3, 2e-3], stiffness=1e-3)
    q, v = chain(wire, (0, 0), [0.1, 0.4]), np.array([[0, 0, 1.0], [0, 0, -1.0]])
    assert joint_moments(wire, motion_of(q, v)) == pytest.approx([1e-3 * 0.1 + 2e-5 * 1.0, 1e-3 * 0.3 - 2e-5 * 2.0])
    assert relative_angles(np.array([0.1, 0.4])) == pytest.approx([0.1, 0.3])


def test_kinetic_energy_of_a_wire_that_flies_and_of_one_that_swings():
    wire = plain_wire(np.full(20, 1e-3))
    q, mass, length = chain(wire, (0, 0), 0.0), wire.mass.sum(), 20e-3
    fly = np.tile([0.3, -0.4, 0.0], (20, 1))
    swing = np.column_stack([np.zeros(20), 2.0 * q[:, 0], np.full(20, 2.0)])
    assert snapshot(wire, motion_of(q, fly), 0.0, 0.0).kinetic == pytest.approx(0.5 * mass * 0.25)
    assert snapshot(wire, motion_of(q, swing), 0.0, 0.0).kinetic == pytest.approx(0.5 * mass * length**2 / 3 * 4.0)


# --- lost


def test_dragging_costs_the_friction_force_times_the_way_it_slid():
    wire, depth = plain_wire(np.full(3, 2e-3)), 2 * LAW.toe
    q = chain(wire, (1e-3, RADIUS - depth), 0.0)
    contact = at_rest(wire, bare_walls(FLOOR, friction=MU), q)
    limit = MU * LAW.stiffness * depth
    after = Energies()
    for step in range(1, 11):
        after = taken(contact, q + [step * 1e-5, 0, 0], before=after)
    stretch = 1.1 * limit / LAW.tangential_stiffness  # of the tangential spring when it slides
    assert after.friction_loss == pytest.approx(3 * limit * (1e-4 - stretch))
    pressed = LAW.stiffness * (LAW.toe**2 * 2 / 3 + depth * depth / 2 - LAW.toe**2 / 2)
    # The spring's own energy: linear to 0.9 of the limit, then softening: the mean force there is 29/30 of the limit.
    dragged = limit**2 / LAW.tangential_stiffness * (0.9**2 / 2 + 0.2 * 29 / 30)
    assert after.wall == pytest.approx(3 * (pressed + dragged))
    assert after.damping_loss == pytest.approx(0.0, abs=1e-18)


def test_sticking_costs_nothing_and_gives_all_back():
    wire = plain_wire(np.full(3, 2e-3))
    q = chain(wire, (1e-3, RADIUS - 2 * LAW.toe), 0.0)
    contact = at_rest(wire, bare_walls(FLOOR, friction=MU), q)
    contact.evaluate()
    stored = contact.summary().energy
    slip = 0.8 * MU * LAW.stiffness * 2 * LAW.toe / LAW.tangential_stiffness
    there = taken(contact, q + [slip, 0, 0])
    assert there.wall == pytest.approx(stored + 3 * LAW.tangential_stiffness * slip**2 / 2)
    back = taken(contact, q, before=there)
    assert back.friction_loss == pytest.approx(0.0, abs=1e-20)
    assert back.wall == pytest.approx(stored)


def test_pressing_in_costs_the_dampers_force_times_the_way():
    wire, depth, way = plain_wire([2e-3]), 3 * LAW.toe, 1e-6
    contact = at_rest(wire, bare_walls(FLOOR), chain(wire, (1e-3, RADIUS - depth + way), 0.0))
    after = taken(contact, chain(wire, (1e-3, RADIUS - depth), 0.0))
    assert after.damping_loss == pytest.approx(LAW.damping * depth * way / STEP * way, rel=1e-6, abs=0)


def test_bending_costs_the_joints_dampers_their_share():
    wire = plain_wire(np.full(3, 2e-3), stiffness=1e-3)
    contact = at_rest(wire, bare_walls(FLOOR), chain(wire, (1e-3, 5e-3), 0.0))
    after = taken(contact, chain(wire, (1e-3, 5e-3), [0.0, 0.1, 0.3]))
    assert after.damping_loss == pytest.approx(0.02 * 1e-3 * (0.1**2 + 0.2**2) / STEP, rel=1e-9, abs=0)
    assert after.elastic == pytest.approx(0.5 * 1e-3 * (0.1**2 + 0.2**2))


def test_the_drives_work_is_its_mean_force_times_the_way():
    wire = plain_wire([2e-3])
    contact = at_rest(wire, bare_walls(FLOOR), chain(wire, (1e-3, 5e-3), 0.0))
    after = taken(contact, chain(wire, (1.2e-3, 5e-3), 0.0), push=0.5, travel=2e-4)
    assert after.insertion_work == pytest.approx(0.5 * 2e-4)
    assert after.largest_work >= after.insertion_work


# --- together


def tumbling(seed):
    """A wire pressed onto a floor and against two corners, and 25 random small moves of all its joints."""
    rng = np.random.default_rng(seed)
    wire = replace(plain_wire(np.full(6, 2e-3)), rest_angle=rng.normal(0, 0.02, 6))
    angles = rng.normal(0, 2e-3, 6)
    corners = [(4.2e-3, 2 * RADIUS - 8e-6), (9.1e-3, 2 * RADIUS - 8e-6)]
    base = np.array([1e-3, RADIUS - 4e-6])
    contact = at_rest(wire, bare_walls(FLOOR, corners=corners, friction=MU), chain(wire, base, angles))
    travel = 0.0
    for _ in range(25):
        angles = angles + rng.normal(0, 1e-3, 6)
        travel = rng.normal(0, 1e-5)
        base = base + [travel, 0.0]
        yield contact, chain(wire, base, angles), travel


@pytest.mark.parametrize("seed", range(5))
def test_losses_are_never_negative(seed):
    friction = damping = 0.0
    for contact, q, _ in tumbling(seed):
        after = taken(contact, q)
        assert after.friction_loss >= 0.0
        assert after.damping_loss >= 0.0
        friction, damping = friction + after.friction_loss, damping + after.damping_loss
    assert friction > 0
    assert damping > 0


@pytest.mark.parametrize("seed", range(5))
def test_the_books_close_where_the_forces_balance(seed):
    """Any move of a chain, and accelerations that balance its forces at the step's end: then what the drive puts in is
    stored or lost. Rounding: 1e-9 of the work."""
    for contact, q, travel in tumbling(seed):
        wire, start_q = contact.wire, contact.motion.q.copy()
        old = snapshot(wire, contact.motion, 0.3, 0.0)
        contact.start_step()
        contact.evaluate()
        start = contact.summary().energy
        contact.motion.set(q, (q - start_q) / STEP)
        contact.evaluate()
        acceleration, push = balanced(contact, np.random.default_rng(seed).normal(0, 1e-2, (6, 2)))
        new = snapshot(wire, contact.motion, push, travel)
        before = Energies(elastic=old.elastic, wall=start, kinetic=old.kinetic)
        before = replace(before, start=before.elastic + before.wall + before.kinetic)
        after = advanced(before, contact, start, old, new, acceleration, STEP)
        contact.accept()
        assert abs(after.error) < 1e-9 * (abs(after.insertion_work) + after.elastic)
        assert abs(after.insertion_work) > 1e-8
        assert after.elastic + after.wall > 1e-9


def balanced(contact, linear):
    """(n, 3) accelerations and the push force on the proximal end, N, for given accelerations of the centres: forces in
    the joints from the tip backwards, then the moments about each centre [Newton and Euler]."""
    wire, force = contact.wire, contact.force
    needed = wire.mass[:, None] * linear - force[:, :2]
    joint = np.vstack([np.cumsum(needed[::-1], axis=0)[::-1], np.zeros(2)])
    moment = np.append(joint_moments(wire, contact.motion), 0.0)
    turning = np.zeros(len(linear))
    for i, angle in enumerate(contact.motion.q[:, 2]):
        arm = wire.lengths[i] / 2 * np.array([math.cos(angle), math.sin(angle)])
        levers = -_cross(arm, joint[i]) - _cross(arm, joint[i + 1])
        turning[i] = (force[i, 2] + levers - moment[i] + moment[i + 1]) / wire.inertia[i]
    return np.column_stack([linear, turning]), float(joint[0, 0])


def _cross(a, b):
    return a[0] * b[1] - a[1] * b[0]
