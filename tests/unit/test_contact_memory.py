"""What contact keeps from step to step: the slip that sticks, the side of a corner; and which pairs it looks at."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from model_cases import LAW, RADIUS, at_rest, bare_walls, chain, force_at, plain_wire, settle

from gw_exudyn.model.contact import first_in_vessel
from gw_exudyn.model.outline import Outline
from gw_exudyn.model.walls import Tube, build_walls

MM = 1e-3
MU = 0.4
DEPTH = 5e-6
NORMAL = LAW.stiffness * (LAW.toe + DEPTH) ** 2 / (4 * LAW.toe)
"""N. The depth is within the quadratic onset."""
LIMIT = MU * NORMAL
FLOOR = ((0.0, 0.0), (60 * MM, 0.0))


def lying(segments=3, x=1 * MM, depth=DEPTH):
    """A straight wire on the floor, pressed in by `depth` at every node."""
    wire = plain_wire(np.full(segments, 2 * MM))
    return wire, chain(wire, (x, RADIUS - depth), 0.0)


def shifted(q, dx, dy=0.0):
    return q + [dx, dy, 0.0]


def drag(contact, q):
    """Friction forces, N, on the nodes at a place."""
    return force_at(contact, q)[:, 0]


# --- friction


def test_a_stuck_wire_is_held_by_the_tangential_spring():
    wire, q = lying()
    contact = at_rest(wire, bare_walls(FLOOR, friction=MU), q)
    slip = 0.5 * LIMIT / LAW.tangential_stiffness
    assert drag(contact, shifted(q, slip)) == pytest.approx(np.full(3, -0.5 * LIMIT))
    assert drag(contact, shifted(q, -slip)) == pytest.approx(np.full(3, 0.5 * LIMIT))


def test_what_sticks_does_not_creep():
    """A thousand steps in which nothing moves: the same force to the last digit."""
    wire, q = lying()
    contact = at_rest(wire, bare_walls(FLOOR, friction=MU), q)
    moved = shifted(q, 0.8 * LIMIT / LAW.tangential_stiffness)
    first = force_at(contact, moved)
    for _ in range(1000):
        settle(contact)
    assert (force_at(contact, moved) == first).all()


def test_a_step_cut_into_pieces_sticks_alike():
    wire, q = lying()
    slip = 0.8 * LIMIT / LAW.tangential_stiffness
    contact = at_rest(wire, bare_walls(FLOOR, friction=MU), q)
    for part in (0.2, 0.3, 0.9, 1.0):
        force_at(contact, shifted(q, part * slip))
        settle(contact)
    assert drag(contact, shifted(q, slip)) == pytest.approx(np.full(3, -0.8 * LIMIT))


def test_sliding_meets_coulombs_limit_and_turning_back_first_unloads_the_spring():
    wire, q = lying()
    contact = at_rest(wire, bare_walls(FLOOR, friction=MU), q)
    assert drag(contact, shifted(q, 0.05 * MM)) == pytest.approx(np.full(3, -LIMIT))
    settle(contact)
    unload = LIMIT / LAW.tangential_stiffness
    # Past 1.1 of the limit's slip it slides, so the spring holds 1.1 of it; it softens from 0.9 on.
    assert drag(contact, shifted(q, 0.05 * MM - 0.6 * unload)) == pytest.approx(np.full(3, -0.5 * LIMIT))
    assert drag(contact, shifted(q, 0.05 * MM - 1.6 * unload)) == pytest.approx(np.full(3, 0.5 * LIMIT))
    assert drag(contact, shifted(q, -0.05 * MM)) == pytest.approx(np.full(3, LIMIT))


def test_the_spring_gives_way_between_nine_and_eleven_tenths_of_the_limit():
    wire, q = lying()
    contact = at_rest(wire, bare_walls(FLOOR, friction=MU), q)
    shares = [-drag(contact, shifted(q, r * LIMIT / LAW.tangential_stiffness))[0] / LIMIT for r in (0.9, 1.0, 1.1, 2.0)]
    assert shares == pytest.approx([0.9, 0.975, 1.0, 1.0])


def test_a_lighter_press_lets_go_what_it_cannot_hold():
    wire, q = lying()
    contact = at_rest(wire, bare_walls(FLOOR, friction=MU), q)
    stuck = shifted(q, 0.8 * LIMIT / LAW.tangential_stiffness)
    force_at(contact, stuck)
    settle(contact)
    force = force_at(contact, shifted(stuck, 0.0, 4e-6))
    assert (force[:, 1] > 0).all()
    assert force[:, 0] == pytest.approx(-MU * force[:, 1])
    force_at(contact, shifted(stuck, 0.0, 1e-4))  # lifted off
    settle(contact)
    assert drag(contact, stuck) == pytest.approx(np.zeros(3), abs=1e-12)  # it comes back without a memory


def test_slip_is_recalled_for_the_node_that_had_it():
    """Three nodes with three slips; then the first is lifted so far that its pair leaves the list."""
    wire, q = lying()
    contact = at_rest(wire, bare_walls(FLOOR, friction=MU), q)
    slips = np.array([0.2, 0.4, 0.6]) * LIMIT / LAW.tangential_stiffness
    moved = q + np.column_stack([slips, np.zeros((3, 2))])
    force_at(contact, moved)
    contact.accept()
    moved[0, 1] += 10 * contact.reach
    contact.motion.set(moved, np.zeros_like(moved))
    contact.start_step()
    assert contact.nodes.body.tolist() == [1, 2]
    assert drag(contact, moved)[1:] == pytest.approx([-0.4 * LIMIT, -0.6 * LIMIT])


def test_a_node_that_is_new_to_a_wall_has_slipped_nowhere():
    wire, q = lying()
    lifted = q + np.array([[0, 0, 0], [0, 5e-5, 0], [0, 0, 0]])
    contact = at_rest(wire, bare_walls(FLOOR, friction=MU), lifted)
    slip = 0.5 * LIMIT / LAW.tangential_stiffness
    force_at(contact, shifted(lifted, slip))
    settle(contact)
    assert drag(contact, shifted(q, slip)) == pytest.approx([-0.5 * LIMIT, 0.0, -0.5 * LIMIT])


def test_the_memory_is_all_that_crosses_steps():
    wire, q = lying()
    walls = bare_walls(FLOOR, corners=[(3.5 * MM, 2 * RADIUS - 2 * DEPTH)], friction=MU)
    contact, other = at_rest(wire, walls, q), at_rest(wire, walls, shifted(q, 3 * MM))
    moved = shifted(q, 0.7 * LIMIT / LAW.tangential_stiffness)
    force_at(contact, moved)
    settle(contact)
    other.memory = contact.memory
    other.motion.set(moved, np.zeros_like(moved))
    other.start_step()
    ahead = shifted(moved, 1e-7, 1e-7)
    assert (force_at(other, ahead) == force_at(contact, ahead)).all()
    assert other.memory.side == [1.0]


@pytest.mark.parametrize("to_joint", [0.5 * MM, 0.0])
def test_a_corner_drags_a_wire_past_it_at_coulombs_limit(to_joint):
    """The corner on top presses the wire down. Wherever it is on a segment or at a joint, sliding friction of the whole
    wire there is the limit of the whole normal force."""
    wire, q = lying(4)
    corner = (q[1, 0] + 1 * MM - to_joint, q[1, 1] + RADIUS - DEPTH)
    contact = at_rest(wire, bare_walls(corners=[corner], friction=MU), shifted(q, -0.05 * MM))
    force = force_at(contact, q)
    assert force[:, 0].sum() == pytest.approx(-MU * (contact.corners.weight * contact.corners.normal).sum())


def test_a_wire_stuck_at_a_corner_on_a_joint_does_not_creep():
    wire, q = lying(4)
    corner = (q[1, 0] + 0.995 * MM, q[1, 1] + RADIUS - DEPTH)
    contact = at_rest(wire, bare_walls(corners=[corner], friction=MU), q)
    moved = shifted(q, 0.5 * LIMIT / LAW.tangential_stiffness)
    first = force_at(contact, moved)
    assert (contact.corners.weight[contact.corners.normal > 0] < 0.9).all()  # shared by two segments
    assert first[:, 0].sum() < 0
    for _ in range(100):
        settle(contact)
    assert force_at(contact, moved) == pytest.approx(first, rel=1e-12)


@pytest.mark.parametrize("parts", [(1.0,), (0.3, 0.6, 1.0)], ids=["one step", "three steps"])
def test_a_tip_stuck_head_on_on_a_corner_is_held_from_the_side(parts):
    """The tip's disc sticks to the corner; moved sideways by 2 um it is pulled back by the tangential spring, also when
    the corner comes to the other side of the wire's axis on the way, and however the way is cut into steps. The normal
    turns with the disc: its share is -normal * (offset / radius)."""
    wire = plain_wire(np.full(3, 2 * MM))
    q = chain(wire, (1 * MM, 0.0), 0.0)
    deep, way = 10e-6, 2e-6
    contact = at_rest(wire, bare_walls(corners=[(7 * MM + RADIUS - deep, way / 2)], friction=MU), q)
    for part in parts:
        moved = q + np.array([[0, 0, 0], [0, 0, 0], [0, part * way, 0]])
        force = force_at(contact, moved)[-1]
        settle(contact)
    normal = LAW.stiffness * deep
    sideways = -LAW.tangential_stiffness * way + normal * (way / 2) / (RADIUS - deep)
    assert force[1] == pytest.approx(sideways, rel=0.02)  # of the disc's turn: offset / radius


# --- the side on which a corner is passed


def passing(offset):
    """A wire along x, its tip 1 mm before a corner that lies `offset` to the left of its axis."""
    wire = plain_wire(np.full(5, 2 * MM))
    q = chain(wire, (1 * MM, 0.0), 0.0)
    return wire, q, at_rest(wire, bare_walls(corners=[(12 * MM, offset)]), q)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_side_is_decided_when_the_tip_passes_kept_and_undone_on_pull_back(side):
    _, q, contact = passing(side * 2 * RADIUS)
    seen = []
    for travel in (0.5, 0.99, 1.01, 3.0, 5.0, 1.01, 0.99, 0.0):
        contact.motion.set(shifted(q, travel * MM), np.zeros_like(q))
        settle(contact)
        seen.append(float(contact.memory.side[0]))
    assert seen == [0, 0, side, side, side, side, 0, 0]


def test_the_other_side_may_be_taken_at_the_next_try():
    _, q, contact = passing(RADIUS)
    for travel, height, side in ((3.0, 0.0, 1), (0.0, 0.0, 0), (0.0, 2 * RADIUS, 0), (3.0, 2 * RADIUS, -1)):
        contact.motion.set(shifted(q, travel * MM, height), np.zeros_like(q))
        settle(contact)
        assert contact.memory.side == side


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("way", [0.5e-6, -0.5e-6], ids=["passed", "pulled back"])
def test_deciding_a_side_changes_no_force(side, way):
    """A tip that sticks to a corner beside its end moves past it, or back: 0.25 um either way."""
    wire = plain_wire(np.full(3, 2 * MM))
    q = chain(wire, (1 * MM, 0.0), 0.0)
    corner = (7 * MM + way / 2, side * (RADIUS - 10e-6))
    contact = at_rest(wire, bare_walls(corners=[corner], friction=MU), q)
    before = float(contact.memory.side[0])
    force = force_at(contact, shifted(q, way))
    assert force[-1, 0] == pytest.approx(-LAW.tangential_stiffness * way, rel=0.1)  # and a little of the normal force
    settle(contact)
    assert {before, float(contact.memory.side[0])} == {0.0, side}
    assert force_at(contact, shifted(q, way)) == pytest.approx(force, rel=1e-9)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_wire_that_a_trial_carries_across_a_corner_is_pushed_back_to_its_side(side):
    """An unsigned distance would push it on: the axis is beyond the corner by half a radius."""
    _, q, contact = passing(side * 1.1 * RADIUS)
    contact.motion.set(shifted(q, 3 * MM), np.zeros_like(q))
    settle(contact)
    force = force_at(contact, shifted(q, 3 * MM, side * 1.6 * RADIUS))
    assert side * force[:, 1].sum() < -LAW.stiffness * 1.4 * RADIUS
    assert contact.deepest().depth == pytest.approx(1.5 * RADIUS)
    assert contact.deepest()[1:] == (4, 0, True)


def test_before_it_is_passed_a_corner_pushes_the_tip_away_on_either_side():
    for offset in (0.5 * RADIUS, -0.5 * RADIUS):
        _, q, contact = passing(offset)
        force = force_at(contact, shifted(q, 0.95 * MM))[-1]
        assert force[0] < 0
        assert math.copysign(1.0, force[1]) == -math.copysign(1.0, offset)


# --- septum


SEPTUM = np.array([(0, -3), (30, -3), (30, -0.05), (10, -0.05), (10, 0.05), (30, 0.05), (30, 3), (0, 3)]) * MM
WEDGE = np.array([(0, -3), (30, -3), (30, -1), (10, 0), (30, 1), (30, 3), (0, 3)]) * MM


def forked(points):
    open_edges = frozenset({1, len(points) - 3, len(points) - 1})
    return build_walls(Outline(points, open_edges), Tube(1.2 * MM, 0.1), RADIUS, MU, MU, 6 * RADIUS)


def beside_septum(height, tip=15 * MM):
    wire = plain_wire(np.full(7, 2 * MM))
    return wire, chain(wire, (tip - 14 * MM, height), 0.0)


@pytest.mark.parametrize("side", [1, -1])
def test_across_a_thin_septum_nothing_is_met(side):
    """A septum of 0.1 mm, thinner than the wire's radius; the wire lies on one face of it and is pressed in by a fifth
    of its radius. Only that face pushes, away from the septum."""
    wire, q = beside_septum(side * (0.05 * MM + 0.8 * RADIUS))
    walls = forked(SEPTUM)
    contact = at_rest(wire, walls, q)
    force = force_at(contact, q)
    pushing = contact.nodes.target[(contact.nodes.normal > 0) & (contact.nodes.weight > 0)]
    assert set(walls.normal[pushing, 1]) == {float(side)}
    assert (side * force[:, 1] >= 0).all()
    assert side * force[-1, 1] == pytest.approx(LAW.stiffness * 0.2 * RADIUS)
    assert contact.crossing() is None


@pytest.mark.parametrize("points", [SEPTUM, WEDGE], ids=["septum", "wedge"])
@pytest.mark.parametrize("side", [1, -1])
def test_a_node_that_passes_a_carina_is_not_caught_by_its_far_wall(points, side):
    """From 0.2 mm before the carina to 0.5 mm past it within one step, clear of all walls by 0.03 mm."""
    wire, q = beside_septum(side * (0.08 * MM + RADIUS), tip=9.8 * MM)
    contact = at_rest(wire, forked(points), q)
    for travel in np.linspace(0.0, 0.7 * MM, 29):
        assert force_at(contact, shifted(q, travel)) == pytest.approx(np.zeros((7, 3)), abs=1e-15)
    for travel in np.linspace(0.7 * MM, 0.0, 8):  # and back, in steps
        contact.motion.set(shifted(q, travel), np.zeros_like(q))
        settle(contact)
        assert force_at(contact, shifted(q, travel)) == pytest.approx(np.zeros((7, 3)), abs=1e-15)


# --- what is looked at


def test_a_node_from_outside_a_wall_is_not_held_by_it():
    wire, q = lying()
    contact = at_rest(wire, bare_walls(FLOOR), shifted(q, 0.0, -1.5 * RADIUS))
    assert contact.nodes.count == 0


def test_behind_the_exit_the_catheter_counts_and_before_it_the_vessel():
    wire = plain_wire(np.full(6, 2 * MM))
    q = chain(wire, (-7 * MM, 0.0), 0.0)
    points = np.array([(-5, -2), (30, -2), (30, 2), (-5, 2)]) * MM
    walls = build_walls(Outline(points, frozenset({1})), Tube(1.2 * MM, 0.1), RADIUS, MU, MU, 0)
    contact = at_rest(wire, walls, q)
    assert first_in_vessel(contact.motion, wire, 0.6 * MM) == 3
    contact.reach = 5 * MM
    contact.start_step()
    tube = walls.tube[contact.nodes.target]
    assert (tube == (contact.nodes.body < 3)).all()
    assert set(contact.nodes.body[tube]) == {0, 1, 2}
    assert set(contact.nodes.body[~tube]) == {3, 4, 5}
    behind = at_rest(wire, walls, shifted(q, -10 * MM)).motion
    assert first_in_vessel(behind, wire, 0.6 * MM) == 6
    # A tip that hooks back beside the catheter is not in it.
    behind.q[-1, 1] = 1 * MM
    assert first_in_vessel(behind, wire, 0.6 * MM) == 5


def test_a_segment_in_the_catheter_meets_no_corner_of_the_vessel():
    wire = plain_wire(np.full(6, 2 * MM))
    q = chain(wire, (-7 * MM, 0.0), 0.0)
    for x, tube, expected in ((-3.5, False, 0), (-3.5, True, 1), (3.5, False, 1), (3.5, True, 1)):
        walls = bare_walls(corners=[(x * MM, RADIUS - 1e-6)], tube=tube)
        contact = at_rest(wire, walls, q)
        force_at(contact, q)
        assert (contact.corners.normal > 0).sum() == expected


def test_lists_grow_as_needed_and_lose_nothing():
    wire = plain_wire(np.full(900, 0.05 * MM))
    q = chain(wire, (1 * MM, RADIUS - DEPTH), 0.0)
    corners = np.column_stack([np.linspace(2 * MM, 40 * MM, 400), np.full(400, 2 * RADIUS - 2 * DEPTH)])
    contact = at_rest(wire, bare_walls(FLOOR, corners=corners), q)
    assert contact.nodes.count == 900
    assert contact.corners.count > 4 * 256
    alone = [at_rest(wire, bare_walls(corners=[corner]), q) for corner in corners]
    pressed = sum(force_at(one, q)[:, 1].sum() for one in alone)
    assert pressed < 0
    assert force_at(contact, q)[:, 1].sum() == pytest.approx(900 * NORMAL + pressed, rel=1e-9)


# --- leaving the lumen


def box(*open_edges):
    points = np.array([(-1, -2), (20, -2), (20, 2), (-1, 2)]) * MM
    return build_walls(Outline(points, frozenset(open_edges)), Tube(1.2 * MM, 0.1), RADIUS, MU, MU, 0)


def crossing(walls, base, angle):
    wire = plain_wire(np.full(6, 2 * MM))
    found = at_rest(wire, walls, chain(wire, base, angle)).crossing()
    return None if found is None else (found[0], tuple(np.round(walls.normal[found[1]], 9) + 0.0))


def test_a_wire_in_the_lumen_crosses_nothing():
    assert crossing(box(), (-5 * MM, 0.0), 0.0) is None


def test_a_tunnelled_wire_is_found_with_its_first_segment_outside():
    """It starts at (0.2, 0) mm and rises at 0.4 rad: y passes 2 mm after 5.14 mm of wire, in the third segment."""
    assert crossing(box(), (0.2 * MM, 0.0), 0.4) == (2, (0.0, -1.0))
    assert crossing(box(), (0.2 * MM, 0.0), -0.4) == (2, (0.0, 1.0))


def test_leaving_through_an_open_end_is_no_crossing():
    assert crossing(box(), (12.5 * MM, 0.0), 0.0) == (3, (-1.0, 0.0))
    assert crossing(box(1), (12.5 * MM, 0.0), 0.0) is None


def test_a_wire_that_goes_through_its_catheters_wall_is_found_too():
    assert crossing(box(1), (-5 * MM, 0.0), 0.1) is None
    walls = box()
    assert crossing(replace(walls, tube=np.ones_like(walls.tube)), (0.2 * MM, 0.0), 0.4) is not None
