"""From a vessel to walls: outlines with the lumen on their left, corners, and what the catheter's exit cuts out."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
from model_cases import RADIUS, scenario

from gw_exudyn.model.build import build
from gw_exudyn.model.checks import contains
from gw_exudyn.model.law import surroundings
from gw_exudyn.model.outline import Outline, build_outline
from gw_exudyn.model.walls import Tube, Walls, build_walls, tube_polylines, vessel_polylines

MM = 1e-3
BORE = 1.2
TUBE = Tube(BORE * MM, 0.1)
SEAM = 6 * RADIUS


def channel(**changes) -> Outline:
    return build_outline(scenario(vessel={"kind": "straight", "length": 0.1, "diameter": 4e-3} | changes).vessel)


def arc(angle: float, **changes) -> Outline:
    vessel = {"kind": "arc", "radius": 0.015, "angle": angle, "diameter": 4e-3, "facets": 12, "lead_in": 0.01}
    return build_outline(scenario(vessel=vessel | changes).vessel)


def polygon(*points: tuple[float, float], open_edges: tuple[int, ...] = ()) -> Outline:
    """From points in mm."""
    rows = [[x * MM, y * MM] for x, y in points]
    return build_outline(scenario(vessel={"kind": "polygon", "points": rows, "open_edges": list(open_edges)}).vessel)


def walls_of(outline: Outline, tube: Tube = TUBE) -> Walls:
    return build_walls(outline, tube, RADIUS, 0.4, 0.1, SEAM)


def area(points) -> float:
    x, y = points.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def vessel_segments(walls: Walls) -> set[tuple[tuple[float, float], tuple[float, float]]]:
    """Start and end of the vessel's walls, mm."""
    ends = walls.start + walls.length[:, None] * walls.tangent
    rows = np.column_stack([walls.start, ends])[~walls.tube] / MM
    return {((a, b), (c, d)) for a, b, c, d in np.round(rows, 5) + 0.0}


def corners_in_mm(walls: Walls, but: Sequence[tuple[float, float]] = ()) -> list[tuple[float, float]]:
    """The corners, sorted; without those of `but` (the walls' ends at open ends), each of which must be there."""
    found = sorted((float(x), float(y)) for x, y in np.round(walls.corner / MM, 5) + 0.0)
    assert set(but) <= set(found)
    return [corner for corner in found if corner not in but]


LIPS = [(0.0, -BORE / 2), (0.0, BORE / 2)]
L_BEND = [(0, -2), (24, -2), (24, 40), (20, 40), (20, 2), (0, 2)]
"""A channel of 4 mm that turns left by 90 degrees; inlet and outlet are the edges 5 and 2."""


# --- outlines


def test_a_straight_channel_with_an_open_and_a_dead_end():
    outline = channel()
    assert outline.points / MM == pytest.approx(np.array([(0, -2), (100, -2), (100, 2), (0, 2)]))
    assert outline.open_edges == {1, 3}
    assert channel(end="dead").open_edges == {3}


@pytest.mark.parametrize("angle", [1.2, -1.2, 2.5])
def test_an_arc_goes_where_its_centreline_goes(angle):
    outline = arc(angle, lead_out=0.02)
    assert area(outline.points) > 0
    turned = np.array([math.cos(angle), math.sin(angle)])
    side = math.copysign(1.0, angle)
    end = [0.01 + 0.015 * math.sin(abs(angle)), side * 0.015 * (1 - math.cos(angle))] + 0.02 * turned
    exits = [e for e in outline.open_edges if e != len(outline.points) - 1]
    a, b = outline.points[exits[0]], outline.points[exits[0] + 1]
    assert (a + b) / 2 == pytest.approx(end)
    assert np.hypot(*(b - a)) == pytest.approx(4e-3)
    assert (b - a) @ turned == pytest.approx(0, abs=1e-15)


def test_the_corners_of_an_arc_lie_on_its_circles():
    points = arc(1.2).points
    centre = np.array([0.01, 0.015])
    curved = points[(points[:, 0] > 0.0101)]
    distance = np.hypot(*(curved - centre).T)
    assert np.minimum(abs(distance - 0.013), abs(distance - 0.017)) == pytest.approx(0, abs=1e-12)
    assert len(curved) == 24  # 12 of each side; where the arc begins x is 10 mm


def test_a_left_and_a_right_arc_are_mirror_images():
    mirrored = arc(1.2).points * [1, -1]
    assert sorted(map(tuple, np.round(mirrored, 12))) == sorted(map(tuple, np.round(arc(-1.2).points, 12)))


def test_an_arc_without_a_lead_begins_at_the_inlet():
    outline = arc(1.2, lead_in=0.0)
    assert outline.points[0] / MM == pytest.approx([0, -2])
    assert len(outline.points) == 26
    assert outline.open_edges == {12, 25}


def test_a_clockwise_polygon_keeps_its_open_edge():
    there = polygon(*L_BEND, open_edges=(2,))
    back = polygon(*L_BEND[::-1], open_edges=(2,))  # from (20, 40) to (24, 40) too
    for outline in (there, back):
        assert area(outline.points) > 0
        (edge,) = outline.open_edges
        assert outline.points[edge] / MM == pytest.approx([24, 40])
        assert outline.points[(edge + 1) % 6] / MM == pytest.approx([20, 40])


def test_points_on_a_straight_line_are_dropped_but_for_the_ends_of_open_edges():
    outline = polygon((0, -2), (10, -2), (30, -2), (30, 2), (30, 3), (0, 3), (0, 1), open_edges=(3, 6))
    assert outline.points / MM == pytest.approx(np.array([(0, -2), (30, -2), (30, 2), (30, 3), (0, 3), (0, 1)]))
    assert outline.open_edges == {2, 5}


def test_open_edges_in_a_row_become_one():
    outline = polygon((0, -2), (30, -2), (30, 0), (30, 2), (0, 2), open_edges=(1, 2, 4))
    assert outline.points / MM == pytest.approx(np.array([(0, -2), (30, -2), (30, 2), (0, 2)]))
    assert outline.open_edges == {1, 3}


def test_a_slit_is_no_straight_line():
    """A septum without thickness: at its end the outline turns back."""
    points = [(0, -3), (30, -3), (30, 0), (10, 0), (30, 1e-6), (30, 3), (0, 3)]
    assert polygon(*points).points / MM == pytest.approx(np.array(points))


# --- walls


@pytest.mark.parametrize(
    "outline", [channel(), arc(1.2), arc(-2.5), polygon(*L_BEND)], ids=["straight", "left", "right", "L"]
)
def test_the_lumen_is_on_the_left_of_every_wall(outline):
    walls = walls_of(outline)
    middle = walls.start + walls.tangent * walls.length[:, None] / 2
    vessel = ~walls.tube
    assert all(contains(outline.points, p) for p in (middle + 1e-5 * walls.normal)[vessel])
    assert not any(contains(outline.points, p) for p in (middle - 1e-5 * walls.normal)[vessel])
    assert np.hypot(*walls.tangent.T) == pytest.approx(1.0)
    assert (abs((middle + 1e-5 * walls.normal)[walls.tube, 1]) < BORE / 2 * MM).all()


def test_the_inner_corner_of_a_bend_is_sharp_and_the_outer_one_a_pocket():
    outline = polygon(*L_BEND, open_edges=(2, 5))
    walls = walls_of(outline)
    assert corners_in_mm(walls, but=[(0.0, -2.0), (0.0, 2.0), (24.0, 40.0), (20.0, 40.0)]) == [*LIPS, (20.0, 2.0)]
    start = {tuple(np.round(p / MM, 6)): i for i, p in enumerate(walls.start)}
    beyond_corner, before_corner = start[20.0, 2.0], start[20.0, 40.0]
    assert walls.sharp[beyond_corner] == 3  # it also ends at an open end
    assert walls.sharp[before_corner] == 3  # it also begins at an open end
    before_pocket, beyond_pocket = start[0.0, -2.0], start[24.0, -2.0]
    assert walls.sharp[[before_pocket, beyond_pocket]] == pytest.approx([1, 2])  # open ends, not the pocket
    assert walls.hi[before_pocket] > walls.length[before_pocket]
    assert walls.lo[beyond_pocket] < 0
    # Sharp ends and open ends reach nowhere.
    assert walls.lo[[before_pocket, beyond_corner, before_corner]] == pytest.approx([0, 0, 0])
    assert walls.hi[[beyond_pocket, before_corner]] == pytest.approx(walls.length[[beyond_pocket, before_corner]])


def test_a_septum_ends_in_two_corners():
    outline = polygon((0, -3), (30, -3), (30, -0.1), (10, -0.1), (10, 0.1), (30, 0.1), (30, 3), (0, 3))
    assert corners_in_mm(walls_of(outline)) == [*LIPS, (10.0, -0.1), (10.0, 0.1)]


@pytest.mark.parametrize("degrees", [6, 30, 60, 90, 120, 150, 179])
def test_a_wall_reaches_on_past_a_pocket_but_not_far_behind_its_neighbour(degrees):
    """A pocket that turns by so much. Behind the neighbour: half a radius at most; along itself: 0.3 mm at most."""
    turn = math.radians(degrees)
    far = (10 + 10 * math.cos(turn), 20 + 10 * math.sin(turn))
    walls = walls_of(Outline(np.array([(0, 20), (10, 20), far, (-20, 60)]) * MM, frozenset()))
    start = [tuple(p) for p in np.round(walls.start / MM, 9)]
    before, beyond = start.index((0.0, 20.0)), start.index((10.0, 20.0))
    for reach in (walls.hi[before] - walls.length[before], -walls.lo[beyond]):
        assert 0 < reach <= 0.3e-3
        assert reach * math.sin(turn) <= RADIUS / 2 * (1 + 1e-9)
        assert reach == pytest.approx(0.3e-3) or reach * math.sin(min(turn, math.pi / 2)) == pytest.approx(RADIUS / 2)


def test_the_zones_in_which_walls_fade_never_overlap():
    """Walls down to a twentieth of the wire's radius."""
    for facets in (2, 24, 1000, 3000):
        walls = walls_of(arc(1.2, facets=facets))
        assert (walls.lo + walls.fade_lo <= walls.hi - walls.fade_hi).all()
        assert (walls.fade_lo > 0).all()
        assert (walls.fade_hi > 0).all()


def test_friction_is_the_catheters_in_the_catheter_and_at_its_lips():
    walls = walls_of(polygon(*L_BEND, open_edges=(2, 5)))
    assert set(walls.friction[walls.tube]) == {0.1}
    assert set(walls.friction[~walls.tube]) == {0.4}
    of_corner = dict(zip(map(tuple, np.round(walls.corner / MM, 6)), walls.corner_friction, strict=True))
    assert {of_corner.pop(lip) for lip in LIPS} == {0.1}
    assert set(of_corner.values()) == {0.4}
    assert walls.corner_tube.sum() == 2


# --- the catheter's exit


def test_open_ends_are_no_walls():
    assert vessel_segments(walls_of(channel())) == {((0.0, -2.0), (100.0, -2.0)), ((100.0, 2.0), (0.0, 2.0))}


def test_the_mouth_is_cut_from_a_wall_across_the_exit():
    walls = walls_of(polygon((0, -2), (30, -2), (30, 2), (0, 2)))
    assert {((0.0, 2.0), (0.0, 0.6)), ((0.0, -0.6), (0.0, -2.0))} < vessel_segments(walls)
    assert corners_in_mm(walls) == LIPS
    # The cut ends are edges over which the lips take over.
    ends = {tuple(np.round(p / MM, 5) + 0.0): s for p, s in zip(walls.start, walls.sharp, strict=True)}
    assert ends[0.0, -0.6] == 1
    assert ends[0.0, 2.0] == 2


def test_a_bore_as_wide_as_the_lumen_has_no_lips_and_the_walls_overlap_at_the_seam():
    walls = walls_of(channel(diameter=BORE * MM, end="dead"))
    assert corners_in_mm(walls) == []
    assert (walls.sharp == 0).all()
    for wall in range(len(walls.length)):
        leaves_exit = abs(walls.start[wall, 0]) < 1e-12
        reach = -walls.lo[wall] if leaves_exit else walls.hi[wall] - walls.length[wall]
        touches_exit = leaves_exit or abs((walls.start + walls.tangent * walls.length[:, None])[wall, 0]) < 1e-12
        if touches_exit:
            assert reach == pytest.approx(SEAM)


def test_a_bore_flush_on_one_side_has_one_lip():
    walls = walls_of(polygon((0, -0.6), (30, -0.6), (30, 3), (0, 3), open_edges=(3,)))
    assert corners_in_mm(walls, but=[(0.0, 3.0)]) == [(0.0, 0.6)]


def test_a_catheter_that_protrudes_keeps_the_lumen_beside_it():
    """The exit is 5 mm inside: the wall behind is cut, the walls beside are whole, and the lips are corners."""
    outline = polygon((-5, -2), (30, -2), (30, 2), (-5, 2))
    walls = walls_of(outline)
    assert {((-5.0, -2.0), (30.0, -2.0)), ((-5.0, 2.0), (-5.0, 0.6)), ((-5.0, -0.6), (-5.0, -2.0))} < vessel_segments(
        walls
    )
    # Where the catheter comes through the wall behind, it leaves two ends.
    assert corners_in_mm(walls, but=[(-5.0, -0.6), (-5.0, 0.6)]) == LIPS


def test_a_closed_vessel_around_the_exit_stays_closed():
    """A catheter too short to reach the wall cuts nothing."""
    outline = polygon((-5, -2), (30, -2), (30, 2), (-5, 2))
    ((points, closed),) = vessel_polylines(outline, Tube(BORE * MM, 1e-3))
    assert closed
    assert len(points) == 4


def test_a_catheter_at_an_angle_sees_the_same_walls():
    """The cornered channel turned and shifted with its catheter: the walls in the catheter's frame do not change."""
    angle, shift = 0.7, np.array([0.02, -0.03])
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    there = (np.array(L_BEND) * MM) @ turn.T + shift

    def built(points, **catheter):
        vessel = {"kind": "polygon", "points": [list(map(float, p)) for p in points], "open_edges": [2]}
        return build(scenario(vessel=vessel, catheter={"bore": BORE * MM} | catheter))

    plain = built(np.array(L_BEND) * MM)
    turned = built(there, exit=[float(x) for x in shift], direction=angle)
    assert turned.walls.start == pytest.approx(plain.walls.start, abs=1e-8)
    assert turned.walls.tangent == pytest.approx(plain.walls.tangent, abs=1e-6)
    assert (turned.walls.sharp == plain.walls.sharp).all()
    assert turned.walls.corner == pytest.approx(plain.walls.corner, abs=1e-8)
    assert turned.around.width == pytest.approx(plain.around.width)
    assert turned.around.ahead == pytest.approx(plain.around.ahead)
    drawn = np.vstack(turned.vessel_outline())
    assert min(np.hypot(*(drawn - there[4]).T)) < 1e-12


def test_a_flush_bore_at_an_angle_stays_flush():
    angle = 0.7
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    box = (np.array([(0, -0.6), (30, -0.6), (30, 0.6), (0, 0.6)]) * MM) @ turn.T
    vessel = {"kind": "polygon", "points": [list(map(float, p)) for p in box], "open_edges": [3]}
    model = build(scenario(vessel=vessel, catheter={"bore": BORE * MM, "direction": angle}))
    assert len(model.walls.corner) == 0


def test_the_lumens_width_is_taken_just_past_the_exit():
    assert surroundings(channel(), BORE * MM).width == pytest.approx(4e-3)
    assert surroundings(polygon((-5, -1), (30, -3), (30, 2), (-5, 2)), BORE * MM).width == pytest.approx(
        2e-3 + 9e-3 / 7, rel=1e-4
    )


def test_the_catheter_is_drawn_behind_its_exit():
    for line in tube_polylines(TUBE):
        assert line[:, 0].max() == 0.0
        assert line[:, 0].min() == -0.1
