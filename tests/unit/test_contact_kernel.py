"""The compiled contact: its tangent against differences of its force, continuity, and the count of unstable directions.

Coordinates are scaled to lengths (angles times half a segment), so that all entries of a block are N/m.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from model_cases import LAW, RADIUS, at_rest, bare_walls, chain, force_at, plain_wire

from gw_exudyn.model.contact import Contact, _arrays

HALF = 1e-3
SCALE = np.array([1.0, 1.0, 1 / HALF])
"""One unit of each coordinate that moves a segment's end by one metre."""

NUDGE = 2e-10
"""m. Differences over twice of it.

Truncation (NUDGE / slip at Coulomb's limit)^2 ~ 3e-7, rounding 1e-18 m / NUDGE ~ 1e-8.
"""

TOLERANCE = 1e-6
MU = 0.4
RNG = np.random.default_rng(0)
FACTORS = np.array([0.5, 2.0, 0.3, 1.5, 0.8])
RATES = RNG.normal(size=(4, 3)) * [1e-3, 1e-3, 1.0]


def blocks(contact, q, v, position, velocity):
    """(n, 3, 3), N/m or N s/m: the kernel's tangent."""
    contact.motion.set(q, v)
    contact.evaluate(position, velocity)
    return contact.tangent.reshape(-1, 3, 3) * SCALE[:, None] * SCALE


def differences(contact, q, v, *, of_rate):
    """(n, 3, 3): central differences of each body's force over its own coordinates, or over their rates."""
    found = np.zeros((len(q), 3, 3))
    nudge = 1e-6 if of_rate else NUDGE  # the force is linear in the rate
    for body in range(len(q)):
        for k in range(3):
            change = np.zeros_like(q)
            change[body, k] = nudge * SCALE[k]
            ahead, back = (
                force_at(contact, *((q, v + sign * change) if of_rate else (q + sign * change, v))) for sign in (1, -1)
            )
            found[body, :, k] = (ahead - back)[body] / (2 * nudge) * SCALE
    return found


def assert_tangent_is_exact(contact, q, v, touching):
    """Over the place at rest, and over the rate in motion; in motion the tangent leaves out how the rate of the gap
    changes with the place: damping * penetration * (1/s by turning, 6/s round the wire's end) beside the stiffness."""
    rest = np.zeros_like(q)
    for rate, of_rate, tolerance in ((rest, False, TOLERANCE), (v, True, TOLERANCE), (v, False, 1e-3)):
        expected = differences(contact, q, rate, of_rate=of_rate)
        found = blocks(contact, q, rate, float(not of_rate), float(of_rate))
        assert {int(b) for b in np.flatnonzero(abs(expected).max(axis=(1, 2)))} == touching
        assert abs(found - expected).max() < tolerance * abs(expected).max()
    both = blocks(contact, q, v, 1.0, 20.0)
    assert both == pytest.approx(blocks(contact, q, v, 1.0, 0.0) + 20 * blocks(contact, q, v, 0.0, 1.0))


def slid(contact, q, along, ratio):
    """Begin the step so far back along `along`, (n, 2), that at q the tangential spring has `ratio` times its limit."""
    force_at(contact, q, np.zeros_like(q))
    normal = max(contact.nodes.normal.max(initial=0.0), contact.corners.normal.max(initial=0.0))
    back = q.copy()
    back[:, :2] -= np.asarray(along) * ratio * MU * normal / LAW.tangential_stiffness
    contact.motion.set(back, np.zeros_like(q))
    contact.start_step()


# --- node discs on walls

WALL = ((2e-3, 0.0), (8e-3, 4.5e-3))
ALONG = np.array([0.8, 0.6])
INTO_LUMEN = np.array([-0.6, 0.8])
GAPS = {"onset": 0.4 * LAW.toe, "toe": -0.4 * LAW.toe, "deep": -3 * LAW.toe}
PLACES = {"middle": 3e-3, "fades in": 0.03e-3, "fades out": 7.5e-3 - 0.05e-3}


def disc_at(along, gap, angle):
    """One segment, (1, 3), whose distal end is `along` the wall and `gap` off it."""
    place = np.array(WALL[0]) + along * ALONG + (RADIUS + gap) * INTO_LUMEN
    centre = place - HALF * np.array([math.cos(angle), math.sin(angle)])
    return np.array([[*centre, angle]])


@pytest.mark.parametrize("ratio", [0.0, 0.5, -1.0, 3.0], ids=["rest", "sticks", "gives way", "slides"])
@pytest.mark.parametrize("sharp", [0, 3], ids=["blunt", "sharp"])
@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("gap", GAPS)
def test_the_tangent_of_a_disc_on_a_wall(gap, place, sharp, ratio):
    passing = 4 * max(0.0, -GAPS[gap]) if sharp else 0.0  # a deeper disc is let go sooner beside a sharp end
    further = {"middle": 0.0, "fades in": passing, "fades out": -passing}[place]
    q = disc_at(PLACES[place] + further, GAPS[gap], 0.3)
    contact = at_rest(plain_wire([2 * HALF]), bare_walls(WALL, friction=MU, sharp=sharp), q + [0, 1e-3, 0])
    slid(contact, q, [ALONG], ratio)
    assert_tangent_is_exact(contact, q, RATES[:1], {0})


def test_the_tangent_in_a_pocket_where_two_walls_hold_one_disc():
    corner = np.array([4e-3, 0.0])
    q = np.array([[*(corner + [-RADIUS, RADIUS] + [3e-6, -4e-6]), 0.4]])
    q[0, :2] -= HALF * np.array([math.cos(0.4), math.sin(0.4)])
    walls = bare_walls(((0, 0), tuple(corner)), (tuple(corner), (4e-3, 4e-3)), friction=MU)
    contact = at_rest(plain_wire([2 * HALF]), walls, q - [1e-5, -1e-5, 0])
    slid(contact, q, [[1.0, 0.0]], 0.5)
    assert_tangent_is_exact(contact, q, RATES[:1], {0})
    assert (contact.nodes.normal > 0).sum() == 2


# --- corners on the wire

KINK = 0.4
HELD = RADIUS - 0.5 * LAW.toe
"""Distance of the corner from the wire's axis."""
BLEND = float(_arrays(plain_wire(np.full(4, 2 * HALF)), bare_walls(corners=[(0, 0)]))["joint_blend"][1])
"""Half width, m, of the hand-over between two segments."""
CORNERS = {
    # kink of the joint distal to segment 1; (x, y) of the corner seen from that segment; segments that it touches
    "beside": (0.0, (0.3 * HALF, HELD), {1}),
    "beside, right": (0.0, (-0.4 * HALF, -HELD), {1}),
    "hand-over at a straight joint": (0.0, (HALF + 0.3 * BLEND, HELD), {1, 2}),
    "hand-over in a bend round the corner": (KINK, (HALF - HELD * math.tan(KINK / 2) - 0.2 * BLEND, HELD), {1, 2}),
    "round end on the bisector": (-KINK, (HALF + HELD * math.sin(KINK / 2), HELD * math.cos(KINK / 2)), {1, 2}),
    "round end off the bisector": (
        -KINK,
        (HALF + HELD * math.sin(KINK / 2 - 0.3 * BLEND / HELD), HELD * math.cos(KINK / 2 - 0.3 * BLEND / HELD)),
        {1, 2},
    ),
    "round end, right": (KINK, (HALF + HELD * math.sin(KINK / 2 + 0.02), -HELD * math.cos(KINK / 2 + 0.02)), {1, 2}),
}


def wire_at(kink, corner, overall=0.3):
    """(q, corner): a chain of four segments, kinked after segment 1, and in the plane the corner seen from there."""
    wire = plain_wire(np.full(4, 2 * HALF))
    q = chain(wire, (1e-3, 2e-3), overall + np.array([-0.1, 0.0, kink, kink + 0.1]))
    return wire, q, in_plane(q[1], corner)


def in_plane(segment, place):
    c, s = math.cos(segment[2]), math.sin(segment[2])
    return segment[:2] + [c * place[0] - s * place[1], s * place[0] + c * place[1]]


def directions(q):
    return np.column_stack([np.cos(q[:, 2]), np.sin(q[:, 2])])


@pytest.mark.parametrize("ratio", [0.0, 0.5, -1.0, 3.0], ids=["rest", "sticks", "gives way", "slides"])
@pytest.mark.parametrize("case", CORNERS)
def test_the_tangent_of_a_corner_on_the_wire(case, ratio):
    kink, seen, touching = CORNERS[case]
    wire, q, corner = wire_at(kink, seen)
    contact = at_rest(wire, bare_walls(corners=[corner], friction=MU), q)
    slid(contact, q, directions(q), ratio)
    assert_tangent_is_exact(contact, q, RATES, touching)


@pytest.mark.parametrize("ratio", [0.2, 0.9, -1.0, 5.0])
@pytest.mark.parametrize("case", CORNERS)
def test_the_tangent_of_a_corner_where_the_wires_friction_changes(case, ratio):
    kink, seen, touching = CORNERS[case]
    wire, q, corner = wire_at(kink, seen)
    contact = at_rest(replace(wire, friction_factor=FACTORS), bare_walls(corners=[corner], friction=MU), q)
    slid(contact, q, directions(q), ratio)
    assert_tangent_is_exact(contact, q, RATES, touching)


@pytest.mark.parametrize("ratio", [0.0, 0.5, 3.0], ids=["rest", "sticks", "slides"])
@pytest.mark.parametrize("angle", [0.0, 0.5, -1.2])
def test_the_tangent_of_a_corner_ahead_of_the_tip(angle, ratio):
    wire, q, _ = wire_at(0.2, (0, 0))
    corner = in_plane(q[3], (HALF + HELD * math.cos(angle), HELD * math.sin(angle)))
    contact = at_rest(wire, bare_walls(corners=[corner], friction=MU), q)
    assert contact.memory.side == 0
    slid(contact, q, directions(q), ratio)
    assert_tangent_is_exact(contact, q, RATES, {3})


# --- continuity


def largest_change(kink, side, count):
    """Largest relative change of the total force and moment while a corner slides past a joint in `count` steps, at a
    constant distance from the wire's axis."""
    wire, q, _ = wire_at(kink, (0, 0))
    joint = in_plane(q[1], (HALF, 0.0))
    totals = []
    for corner in sliding_past(q, side, count):
        contact = at_rest(wire, bare_walls(corners=[corner]), q)
        force = force_at(contact, q)
        arm = q[:, :2] - joint
        moment = force[:, 2] + arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]
        totals.append([*force[:, :2].sum(axis=0), moment.sum() / HALF])
    found = np.array(totals)
    return np.linalg.norm(np.diff(found, axis=0), axis=1).max() / np.linalg.norm(found[0]), found


def sliding_past(q, side, count):
    """Points at distance HELD from the axis of segments 1 and 2: beside the one, round the joint or through the notch,
    beside the other."""
    kink = q[2, 2] - q[1, 2]
    notch = HELD * math.tan(max(0.0, side * kink / 2))
    round_end = max(0.0, -side * kink / 2) * HELD  # half the way round the joint
    for way in np.linspace(-1, 1, count) * (round_end + 4 * BLEND):
        beside = abs(way) - round_end
        if beside >= 0:
            segment, sign = (q[1], 1) if way < 0 else (q[2], -1)
            yield in_plane(segment, (sign * (HALF - notch - beside), side * HELD))
        else:
            turned = q[1, 2] + kink / 2 - side * way / HELD
            yield in_plane(q[1], (HALF, 0.0)) + side * HELD * np.array([-math.sin(turned), math.cos(turned)])


@pytest.mark.parametrize("side", [1, -1])
def test_past_a_straight_joint_the_force_hardly_changes(side):
    """Beyond its end a segment is round, and x^2 / (2 r) further away at x in the hand-over: 0.6 % of the force here
    with a hand-over of a tenth of the radius, 13 % with half of it. The weights alone would change nothing."""
    _, totals = largest_change(0.0, side, 201)
    assert abs(totals[:, :2] - totals[0, :2]).max() < 0.02 * np.linalg.norm(totals[0, :2])


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("kink", [0.4, -0.4, 0.05])
def test_past_a_kinked_joint_the_force_is_continuous(kink, side):
    """Steps a quarter as long change the force a quarter as much; a jump would stay."""
    coarse, fine = largest_change(kink, side, 201)[0], largest_change(kink, side, 801)[0]
    assert fine < 0.3 * coarse


def test_round_a_joint_the_force_keeps_its_size():
    """On the convex side the weights of the neighbours sum to one at equal distance, so the force only turns."""
    _, totals = largest_change(-KINK, 1, 201)
    round_end = KINK / 2 * HELD
    within = abs(np.linspace(-1, 1, 201)) * (round_end + 4 * BLEND) < round_end
    assert np.hypot(*totals[within, :2].T) == pytest.approx(np.hypot(*totals[0, :2]), rel=1e-9)


def test_a_disc_that_slides_off_a_sharp_end_is_let_go_smoothly():
    def forces(count):
        contact = at_rest(plain_wire([2 * HALF]), bare_walls(WALL, sharp=3), disc_at(7.3e-3, -1e-6, 0.3))
        return [force_at(contact, disc_at(a, -1e-6, 0.3))[0, 1] for a in np.linspace(7.3e-3, 7.6e-3, count)]

    coarse, fine = forces(201), forces(801)
    assert coarse[0] > 0
    assert coarse[-1] == 0
    assert max(abs(np.diff(fine))) < 0.3 * max(abs(np.diff(coarse)))


# --- the law

gaps = st.floats(-0.2e-3, 2 * LAW.toe)
speeds = st.floats(-1.0, 1.0)
ON_WALL = at_rest(plain_wire([2 * HALF]), bare_walls(WALL, friction=MU), disc_at(3e-3, 1e-4, 0.3))


@given(gaps, speeds, st.floats(-1e-4, 1e-4), st.floats(-1e-4, 1e-4))
def test_the_wall_never_pulls_and_friction_never_exceeds_coulombs_limit(gap, speed, kept, slip):
    """Whatever the speed, the slip of this step, and what the spring kept from the last. Rounding: 1e-12."""
    ON_WALL.motion.set(disc_at(3e-3 - slip, gap, 0.3), np.zeros((1, 3)))
    ON_WALL.start_step()
    if ON_WALL.nodes.count:
        ON_WALL.nodes.start[:] = kept
    force = force_at(ON_WALL, disc_at(3e-3, gap, 0.3), np.array([[*(speed * INTO_LUMEN), 0.0]]))[0]
    normal, tangential = force[:2] @ INTO_LUMEN, force[:2] @ ALONG
    assert normal >= 0
    assert abs(tangential) <= MU * normal * (1 + 1e-12) + 1e-15
    assert tangential * (kept + slip) <= 1e-15


@pytest.mark.parametrize(("gap", "depth"), [(1.0, 0.0), (0.0, 0.25), (-1.0, 1.0), (-5.0, 5.0)])
def test_the_normal_force_is_stiffness_times_penetration_after_a_smooth_onset(gap, depth):
    """In units of the onset's half width; in the onset the force is quadratic: (1 - gap)^2 / 4."""
    q = disc_at(3e-3, gap * LAW.toe, 0.3)
    force = force_at(at_rest(plain_wire([2 * HALF]), bare_walls(WALL), q), q)[0]
    assert force[:2] @ INTO_LUMEN == pytest.approx(LAW.stiffness * depth * LAW.toe, abs=1e-15)


def test_the_damper_resists_approach_in_proportion_to_penetration():
    q, approach = disc_at(3e-3, -2 * LAW.toe, 0.3), np.array([[*(-1e-3 * INTO_LUMEN), 0.0]])
    contact = at_rest(plain_wire([2 * HALF]), bare_walls(WALL), q)
    more = (force_at(contact, q, approach) - force_at(contact, q))[0, :2] @ INTO_LUMEN
    assert more == pytest.approx(LAW.damping * 2 * LAW.toe * 1e-3)


def test_the_force_is_minus_the_gradient_of_the_stored_energy():
    """Without friction and away from fades, for a disc and for a corner beside a segment and round a joint."""
    wire, q, corner = wire_at(*CORNERS["beside"][:2])
    wall_place = q[3, :2] + HALF * directions(q)[3] - (RADIUS - LAW.toe / 3) * np.array([0.0, 1.0])
    walls = bare_walls((tuple(wall_place - [3e-3, 0]), tuple(wall_place + [3e-3, 0])), corners=[corner])
    contact = at_rest(wire, walls, q)
    force = force_at(contact, q)
    for body, k in np.ndindex(q.shape):
        stored = []
        for sign in (1, -1):
            moved = q.copy()
            moved[body, k] += sign * NUDGE * SCALE[k]
            force_at(contact, moved)
            stored.append(contact.nodes.energy.sum() + contact.corners.energy.sum())
        slope = (stored[0] - stored[1]) / (2 * NUDGE)
        assert force[body, k] * SCALE[k] == pytest.approx(-slope, rel=1e-5, abs=1e-9)


# --- unstable directions


def hessian(contact: Contact, wire, base, angles):
    """(n, n), N m: second differences of joint energy plus wall energy over the angles, the proximal end held."""

    def potential(a):
        force_at(contact, chain(wire, base, a))
        bend = np.diff(a, prepend=0.0)
        return 0.5 * wire.joint_stiffness @ bend**2 + contact.nodes.energy.sum() + contact.corners.energy.sum()

    count, nudge = len(angles), 2e-6
    unit = nudge * np.eye(count)
    found = np.zeros((count, count))
    for i in range(count):
        for j in range(i + 1):
            corners = [potential(angles + s * unit[i] + t * unit[j]) * s * t for s in (1, -1) for t in (1, -1)]
            found[i, j] = found[j, i] = sum(corners) / (4 * nudge**2)
    return found


def assert_count_is_that_of_the_hessian(contact, wire, base, angles):
    eigenvalues = np.linalg.eigvalsh(hessian(contact, wire, base, angles))
    assert abs(eigenvalues).min() > 1e-3 * abs(wire.joint_stiffness).max(), "too near to zero to be counted"
    force_at(contact, chain(wire, base, angles))
    expected = int((eigenvalues < 0).sum())
    assert contact._kernel.unstable(contact.motion, contact.nodes, contact.corners, wire.joint_stiffness) == expected
    assert contact.is_unstable(wire.joint_stiffness) == (expected > 0)
    return expected


def test_a_compressed_column_has_as_many_unstable_directions_as_it_passed_buckling_loads():
    """A straight wire pressed square against a wall, deeper and deeper: a clamped column with a free end that slides on
    the wall buckles at (2 k - 1)^2 pi^2 EI / (4 L^2)."""
    wire = plain_wire(np.full(8, 2 * HALF), stiffness=1e-4)
    base, length = (1e-3, 0.0), 8 * 2 * HALF
    first = math.pi**2 * 1e-4 * 2 * HALF / (4 * length**2)
    counts = []
    for load in (0.5, 3.0, 16.0, 32.0, 52.0):  # the chain's buckling loads are 1, 9, 23, 42, 62 times the first
        x = base[0] + length + RADIUS + gap_for(load * first)
        contact = at_rest(wire, bare_walls(((x, -5e-3), (x, 5e-3))), chain(wire, base, np.zeros(8)))
        counts.append(assert_count_is_that_of_the_hessian(contact, wire, base, np.zeros(8)))
    assert counts == [0, 1, 2, 3, 4]


def gap_for(force):
    """Gap, m, at which a contact at rest pushes with this force, N."""
    depth = force / LAW.stiffness
    return -depth if depth > LAW.toe else LAW.toe - math.sqrt(4 * LAW.toe * depth)


def on_walls(rng, q):
    """A wall under every other node, so that the wire is pressed by forces that differ in size and direction."""
    ends, pieces = q[:, :2] + HALF * directions(q), []
    for node in range(1, len(q), 2):
        along = rng.uniform(-math.pi, math.pi)
        t, n = np.array([math.cos(along), math.sin(along)]), np.array([-math.sin(along), math.cos(along)])
        foot = ends[node] - (RADIUS - rng.uniform(1, 12) * LAW.toe) * n
        pieces.append((tuple(foot - 0.3e-3 * t), tuple(foot + 0.3e-3 * t)))
    return bare_walls(*pieces)


def on_corners(rng, q):
    """Two corners beside segments of the distal half, pressed in on either side."""
    segments = len(q) - 1 - rng.permutation(3)[:2]
    sides, depths = rng.choice([-1, 1], 2), rng.uniform(1, 12, 2) * LAW.toe
    places = zip(segments, rng.uniform(-0.8, 0.8, 2) * HALF, sides * (RADIUS - depths), strict=True)
    return bare_walls(corners=[in_plane(q[i], (x, y)) for i, x, y in places])


@pytest.mark.parametrize("walls_for", [on_walls, on_corners])
def test_the_count_holds_for_bent_wires_in_any_place(walls_for):
    """No balance is needed for the count. Soft joints, so that what the forces' directions add decides it."""
    counts = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        wire = plain_wire(np.full(6, 2 * HALF), stiffness=10 ** rng.uniform(-6, -4.5))
        angles = np.cumsum(rng.normal(0, 0.2, 6))
        q = chain(wire, (1e-3, 0.0), angles)
        contact = at_rest(wire, walls_for(rng, q), q)
        eigenvalues = np.linalg.eigvalsh(hessian(contact, wire, (1e-3, 0.0), angles))
        if abs(eigenvalues).min() > 0.02 * wire.joint_stiffness[0]:
            counts.append(assert_count_is_that_of_the_hessian(contact, wire, (1e-3, 0.0), angles))
    assert len(counts) > 30
    assert {0, 1, 2} <= set(counts)


@pytest.mark.parametrize("angle", [0.0, 0.4])
def test_a_tip_pressed_head_on_against_a_corner_is_unstable(angle):
    """The disc would slip off the corner to either side, at a force far below the column's buckling load."""
    wire = plain_wire(np.full(5, 2 * HALF), stiffness=2e-4)
    angles = np.zeros(5)
    q = chain(wire, (1e-3, 0.0), angles)
    corner = in_plane(q[4], (HALF + (RADIUS - 2e-6) * math.cos(angle), (RADIUS - 2e-6) * math.sin(angle)))
    contact = at_rest(wire, bare_walls(corners=[corner]), q)
    assert assert_count_is_that_of_the_hessian(contact, wire, (1e-3, 0.0), angles) == (1 if angle == 0 else 0)
