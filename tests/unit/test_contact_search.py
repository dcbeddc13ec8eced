"""The search for pairs among thousands of walls: nothing is overlooked, and many facets are as stiff as few."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest
from model_cases import LAW, RADIUS, at_rest, bare_walls, chain, force_at, plain_wire

from gw_exudyn.model.contact import Contact
from gw_exudyn.model.outline import Outline, build_outline
from gw_exudyn.model.walls import Tube, Walls, build_walls
from gw_exudyn.scenario import scenario_from_dict

MM = 1e-3
BEND = 15 * MM


def arc_walls(facets: int, friction: float = 0.2) -> Walls:
    """A quarter bend of 15 mm in a lumen of 4 mm, after a catheter of 1.2 mm that ends at the origin."""
    vessel = {"kind": "arc", "radius": BEND, "angle": 1.5, "diameter": 4 * MM, "facets": facets, "lead_in": 10 * MM}
    content = {
        "wire": {"model": "universal-ii"},
        "vessel": vessel,
        "catheter": {"bore": 1.2 * MM},
        "drive": {"kind": "speed", "speed": 2e-3, "distance": 0.01},
    }
    outline: Outline = build_outline(scenario_from_dict(content).vessel)
    return build_walls(outline, Tube(1.2 * MM, 0.2), RADIUS, friction, friction, 6 * RADIUS)


def shuffled(walls: Walls, rng: np.random.Generator) -> tuple[Walls, np.ndarray, np.ndarray]:
    """The same walls in an order in which no neighbours lie together, so that no search can leave out a run of them;
    and where each of the new ones was."""
    order, corner_order = rng.permutation(len(walls.length)), rng.permutation(len(walls.corner))
    parts = {f.name: getattr(walls, f.name) for f in fields(walls)}
    mixed = {name: part[corner_order if name.startswith("corner") else order] for name, part in parts.items()}
    return Walls(**mixed), order, corner_order


def wandering(rng: np.random.Generator, segments: int = 60):
    """A wire that leaves the catheter and winds about the bend."""
    wire = plain_wire(np.full(segments, 28 * MM / segments))
    angles = np.linspace(0.0, rng.uniform(0.5, 1.5), segments) + np.cumsum(rng.normal(0, 0.02, segments))
    return wire, chain(wire, (-5 * MM, rng.uniform(-0.3, 0.3) * MM), angles)


def found(contact: Contact, walls_were=None, corners_were=None):
    """The pairs as sets of (body, target), targets as they were numbered before."""
    nodes, corners = contact.nodes, contact.corners
    wall = nodes.target if walls_were is None else walls_were[nodes.target]
    corner = corners.target if corners_were is None else corners_were[corners.target]
    sides = corners.side.tolist()
    return set(zip(nodes.body, wall, strict=True)), set(zip(corners.body, corner, sides, strict=True))


@pytest.mark.parametrize("seed", range(4))
def test_the_order_of_the_walls_does_not_matter(seed):
    """Pairs, sides of corners, and the wall that is crossed; between 40 and 2000 walls."""
    rng = np.random.default_rng(seed)
    walls = arc_walls((12, 100, 400, 990)[seed])
    mixed, wall_was, corner_was = shuffled(walls, rng)
    crossings, pairs, sides = 0, 0, set()
    for _ in range(6):
        wire, q = wandering(rng)
        plain, other = at_rest(wire, walls, q), at_rest(wire, mixed, q)
        pairs += plain.nodes.count
        assert found(plain) == found(other, wall_was, corner_was)
        assert (plain.memory.side[corner_was] == other.memory.side).all()
        sides |= set(plain.memory.side)
        crossing, crossing_other = plain.crossing(), other.crossing()
        assert (crossing is None) == (crossing_other is None)
        if crossing is not None and crossing_other is not None:
            assert crossing[0] == crossing_other[0]
            crossings += 1
    assert crossings > 0
    assert pairs > 50
    assert sides == {-1, 0, 1}


def test_pairs_come_in_the_order_of_body_and_wall():
    wire, q = wandering(np.random.default_rng(7))
    contact = at_rest(wire, arc_walls(500), q)
    for pairs in (contact.nodes, contact.corners):
        keys = pairs.body.astype(int) * 10_000 + pairs.target
        assert (np.diff(keys) > 0).all()


@pytest.mark.parametrize("seed", range(3))
def test_forces_do_not_depend_on_the_way_to_a_place(seed):
    """A wire that strays in small moves has the forces, to the bit, of one whose pairs are all looked at there."""
    rng = np.random.default_rng(seed)
    wire, q = wandering(rng)
    contact = at_rest(wire, arc_walls(400), q)
    touched = set()
    for _ in range(60):
        q = q + rng.normal(0, 1, q.shape) * [0.1 * RADIUS, 0.1 * RADIUS, 1e-3]
        strayed = force_at(contact, q), contact.tangent.copy(), contact.summary()
        touched.add(int(np.count_nonzero(contact.nodes.normal * contact.nodes.weight)))
        contact.nodes.struct.near_count = -1
        assert (force_at(contact, q) == strayed[0]).all()
        assert (contact.tangent == strayed[1]).all()
        assert bytes(contact.summary()) == bytes(strayed[2])
    assert len(touched) > 1


@pytest.mark.parametrize("facets", [96, 400, 2000])
def test_a_bend_of_many_facets_is_as_stiff_as_one_wall(facets):
    """A disc pressed into the outer wall of a bend, at places along half a facet and more; the wall itself lies up to
    facet^2 / (8 R) inside its circle."""
    turn = 1.5 / facets
    angle = 0.6 + np.arange(1200) * turn / 800
    circle = BEND + 2 * MM
    corners = np.column_stack([np.sin(np.arange(facets + 1) * turn), -np.cos(np.arange(facets + 1) * turn)]) * circle
    outline = Outline(np.vstack([corners, [(0.0, 0.0)]]), frozenset({facets, facets + 1}))
    walls = build_walls(outline, Tube(1.2 * MM, 0.2), RADIUS, 0.0, 0.0, 0.0)
    half = 1e-4
    wire = plain_wire([2 * half])
    depth = 2 * LAW.toe
    pushed = []
    for a in angle:
        radial = np.array([np.sin(a), -np.cos(a)])
        facet = a / turn - np.floor(a / turn) - 0.5
        place = radial * (circle * np.cos(turn / 2) / np.cos(facet * turn) - RADIUS + depth)
        q = np.array([[*(place - [half, 0.0]), 0.0]])
        contact = at_rest(wire, walls, q)
        pushed.append(np.hypot(*force_at(contact, q)[0, :2]))
    assert np.array(pushed) == pytest.approx(LAW.stiffness * depth, rel=0.05)


def test_a_wall_in_two_straight_pieces_is_one_wall():
    """Where an edge is only divided, a disc is pushed as by one wall, wherever it lies."""
    outline = Outline(np.array([(5, -2), (15, -2), (30, -2), (30, 2), (5, 2)]) * MM, frozenset({4}))
    walls = build_walls(outline, Tube(1.2 * MM, 0.2), RADIUS, 0.0, 0.0, 0.0)
    wire, half = plain_wire([2e-4]), 1e-4
    for x in 15 * MM + np.linspace(-2, 2, 81) * RADIUS:
        q = np.array([[x - half, -2 * MM + RADIUS - 2 * LAW.toe, 0.0]])
        assert force_at(at_rest(wire, walls, q), q)[0] == pytest.approx(
            [0.0, 2 * LAW.stiffness * LAW.toe, 0.0], abs=1e-3
        )


def test_a_short_list_of_walls_needs_no_index():
    """No walls at all, and no corners."""
    wire = plain_wire([1 * MM, 1 * MM])
    contact = at_rest(wire, bare_walls(), chain(wire, (0, 0), 0.0))
    assert (contact.nodes.count, contact.corners.count, contact.crossing()) == (0, 0, None)
