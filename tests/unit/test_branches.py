"""Vessels of branches: the united outline, its open ends and corners, and the names of the branches."""

from __future__ import annotations

import dataclasses
import itertools
import math
import re
from pathlib import Path

import numpy as np
import pytest
import shapely
from model_cases import RADIUS, scenario
from synthetic import made_up_result

from gw_exudyn.model.outline import Outline, build_outline
from gw_exudyn.model.walls import Tube, build_walls
from gw_exudyn.scenario import load_scenario, scenario_from_dict
from gw_exudyn.scenario.vessels.branch_course import FACET_TOLERANCE
from gw_exudyn.scenario.yaml_source import parse_yaml
from gw_exudyn.storage import read_run, write_run

MM = 1e-3
MAIN = {"name": "main", "points": [[0, 0], [0.04, 0]], "diameter": 6e-3}


def vessel(*branches: dict):
    return scenario(vessel={"kind": "branches", "branches": list(branches)}).vessel


def outline_of(*branches: dict) -> Outline:
    return build_outline(vessel(*branches))


def side(angle: float, diameter, at: float = 0.02, **more) -> dict:
    """A branch off main; angle in degrees."""
    course = {"parent": "main", "at": at, "angle": math.radians(angle), "length": 0.03}
    return {"name": "side", **course, "diameter": diameter, **more}


def turns(points: np.ndarray) -> np.ndarray:
    """deg, negative where a corner points into the lumen."""
    after = np.roll(points, -1, axis=0) - points
    before = np.roll(after, 1, axis=0)
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return np.degrees(np.arctan2(cross, (before * after).sum(axis=1)))


def edge_lengths(points: np.ndarray) -> np.ndarray:
    return np.hypot(*(np.roll(points, -1, axis=0) - points).T)


ANGLES = [s * a for a in (60, 90, 120) for s in (1, -1)]
DIAMETERS = list(itertools.product((2e-3, 4e-3, 8e-3), (2e-3, 4e-3, 8e-3)))


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("at", [0.02, 0.04])
@pytest.mark.parametrize("fillet", [0, 1e-3])
def test_any_diameters_at_any_bifurcation_give_a_clean_outline(angle, at, fillet):
    for wide, narrow in DIAMETERS:
        for taper in (1.0, 0.5):
            outline = outline_of(
                MAIN | {"diameter": wide, "fillet": fillet}, side(angle, [narrow, narrow * taper], at=at)
            )
            points, case = outline.points, (wide, narrow, taper)
            assert shapely.Polygon(points).is_valid, case
            # Inlet, outlet, and the side's end; at main's end the outlet is the side's.
            assert len(outline.open_edges) == (3 if at < 0.04 else 2), case
            widths = sorted(edge_lengths(points)[sorted(outline.open_edges)])
            ends = [wide, wide, narrow * taper] if at < 0.04 else [wide, narrow * taper]
            assert widths == pytest.approx(sorted(ends), rel=1e-6), case
            # No slivers: no spike, no wall far shorter than what a facet of the fillet is.
            # A wedge of wall as sharp as the branches' own angle; sharper at an end where widths do not fit together.
            fits = at < 0.04 or wide / 2 <= narrow * taper <= narrow <= wide
            assert np.abs(turns(points)).max() < (121 if fits else 155), case
            assert edge_lengths(points).min() > 5e-3 * min(wide, narrow * taper), case
            assert len(points) <= (10 if fillet == 0 else 36), case


def test_a_t_without_fillet_has_the_corners_of_the_crossing_walls():
    outline = outline_of(MAIN, side(90, 4e-3))
    corners = outline.points[turns(outline.points) < -1] / MM
    assert sorted(map(tuple, np.round(corners, 6))) == [(18.0, 3.0), (22.0, 3.0)]


def test_the_corner_of_a_slanting_branch_lies_where_the_walls_cross():
    # The side's downstream wall: 2 mm off an axis at 60 degrees through (20, 0), at y = 3 mm.
    outline = outline_of(MAIN, side(60, 4e-3))
    corners = outline.points[turns(outline.points) < -1] / MM
    expected = [20 + 3 / math.tan(math.radians(60)) + s * 2 / math.sin(math.radians(60)) for s in (-1, 1)]
    assert sorted(corners[:, 0]) == pytest.approx(expected, abs=1e-6)


def test_a_fillet_is_a_round_of_its_radius():
    radius, at = 2e-3, np.array([22e-3, 3e-3])
    outline = outline_of(MAIN | {"fillet": radius}, side(90, 4e-3))
    middle = at + radius  # in the wedge of wall between main and side
    near = outline.points[np.hypot(*(outline.points - middle).T) < 1.2 * radius]
    assert len(near) >= 4
    assert np.hypot(*(near - middle).T) == pytest.approx(radius, rel=1e-3)
    for a, b in itertools.pairwise(near):
        # Chords inside the round by no more than the facets' tolerance.
        sagitta = radius - np.hypot(*((a + b) / 2 - middle))
        assert 0 <= sagitta <= 2 * FACET_TOLERANCE * 4e-3
    assert turns(outline.points).min() > -25


def test_a_fillet_of_the_side_wins_over_its_parents():
    sharp = outline_of(MAIN | {"fillet": 2e-3}, side(90, 4e-3, fillet=0))
    assert len(sharp.points) == len(outline_of(MAIN, side(90, 4e-3)).points)


def test_a_bend_radius_rounds_both_walls_about_one_centre():
    points = [[0, 0], [0.03, 0], [0.03, 0.03]]
    bend = outline_of({"name": "main", "points": points, "diameter": 4e-3, "bend_radius": 10e-3}).points
    middle = np.array([20e-3, 10e-3])
    in_bend = bend[(bend[:, 0] > 20.1e-3) & (bend[:, 1] < 9.9e-3)]
    far = np.hypot(*(in_bend - middle).T)
    # Corners of both walls stand off the centre line's chords, so they lie on circles up to the chords' tolerance.
    assert np.minimum(np.abs(far - 8e-3), np.abs(far - 12e-3)).max() < 2 * FACET_TOLERANCE * 4e-3
    assert np.abs(turns(bend)[turns(bend) < 0]).max() < 22.6


def test_diameters_may_step_and_taper_along_the_length():
    table = [[0, 4e-3], [0.01, 4e-3], [0.01, 2e-3], [0.03, 3e-3]]
    outline = outline_of(MAIN | {"diameter": table})
    lumen = shapely.Polygon(outline.points)

    def width(x: float) -> float:
        return lumen.intersection(shapely.LineString([(x, -1), (x, 1)])).length

    assert [width(x) for x in (5e-3, 9.9e-3, 10.1e-3, 20e-3, 35e-3)] == pytest.approx(
        [4e-3, 4e-3, 2.005e-3, 2.5e-3, 3e-3], abs=1e-5
    )


def test_dead_ends_are_walls():
    assert len(outline_of(MAIN | {"end": "dead"}, side(90, 4e-3, end="dead")).open_edges) == 1


def test_a_pair_of_branches_at_the_end_makes_a_carina():
    right = side(-60, 3e-3, at=0.04) | {"name": "right"}
    outline = outline_of(MAIN, side(60, 3e-3, at=0.04), right)
    assert len(outline.open_edges) == 3
    carina = outline.points[(turns(outline.points) < -30) & (np.abs(outline.points[:, 1]) < 1e-9)]
    # Both inner walls stand 1.5 mm off their axes at 60 degrees: they cross at 1.5 / sin 60 beyond the point.
    assert carina / MM == pytest.approx(np.array([[40 + 1.5 / math.sin(math.radians(60)), 0.0]]), abs=1e-3)


def test_branches_to_both_sides_just_before_the_end_leave_no_slit():
    # Wider than their parent and just before its end: beyond the end they have only each other.
    main = MAIN | {"points": [[0, 0], [0.0399, -0.0028]], "diameter": 3e-3}
    left, right = side(95, 5e-3, at=0.039948), side(-104, 6e-3, at=0.039948) | {"name": "right"}
    assert np.abs(turns(outline_of(main, left, right).points)).max() < 121


def test_parents_may_stand_after_their_children():
    assert len(outline_of(side(90, 4e-3), MAIN).open_edges) == 3


def test_every_way_of_adding_noise_of_a_nanometre_keeps_the_same_walls():
    # Side wall and parent's end cap on one line: what makes slivers in naive unions.
    for noise in (0, 1e-9, -1e-9, 1e-12):
        outline = outline_of(MAIN, side(90, 4e-3, at=0.038 + noise))
        assert len(outline.open_edges) == 3
        assert len(outline.points) == 7


def test_walls_and_corners_of_a_tree_reach_the_contact():
    outline = outline_of(MAIN, side(60, [4e-3, 2e-3]))
    walls = build_walls(outline, Tube(1.2e-3, 0.1), RADIUS, 0.4, 0.1, 6 * RADIUS)
    ends = walls.start + walls.length[:, None] * walls.tangent
    ahead = walls.start + walls.length[:, None] / 2 * walls.tangent + 1e-5 * walls.normal
    lumen = shapely.Polygon(outline.points)
    assert shapely.contains_xy(lumen, *ahead[~walls.tube].T).all()
    for edge in outline.open_edges:
        a, b = outline.points[edge], outline.points[(edge + 1) % len(outline.points)]
        middle = (walls.start + ends) / 2
        assert np.hypot(*(middle - (a + b) / 2).T).min() > 1e-4


# --- names


def test_a_point_lies_in_the_branch_that_has_it():
    tree = vessel(MAIN | {"fillet": 2e-3}, side(90, 4e-3))
    assert tree.branch_names == ("main", "side")
    points = [[5e-3, 1e-3], [20e-3, 2.9e-3], [20e-3, 10e-3], [22.3e-3, 3.4e-3], [20e-3, -3.05e-3], [5e-3, 9e-3]]
    # In main; still in main; in side; in the rounded corner between them; just in main's wall; far outside.
    assert list(tree.branch_at(points))[:3] == ["main", "main", "side"]
    assert tree.branch_at(points)[3] in ("main", "side")
    assert list(tree.branch_at(points))[4:] == ["main", ""]
    assert tree.branch_at(np.full((2, 3, 2), np.nan)).shape == (2, 3)
    assert (tree.branch_at(np.full((2, 3, 2), np.nan)) == "").all()


def test_vessels_without_branches_have_one_name():
    one = scenario(vessel={"kind": "straight", "length": 0.1, "diameter": 4e-3}).vessel
    assert one.branch_names == ("lumen",)
    assert list(one.branch_at([[0.05, 0], [0.05, 3e-3]])) == ["lumen", ""]


def test_regions_have_outline_and_centre_line():
    regions = vessel(MAIN, side(90, 4e-3)).regions()
    assert list(regions) == ["main", "side"]
    assert regions["side"].centre_line / MM == pytest.approx(np.array([[20, 0], [20, 30]]))
    assert shapely.Polygon(regions["main"].outline).area == pytest.approx(40e-3 * 6e-3)


# --- overrides and the resolved scenario


def test_overrides_reach_branches_by_index_and_by_name():
    by_index = load_scenario("phantom-universal", ["vessel.branches.1.angle=70 deg"])
    by_name = load_scenario("phantom-universal", ["vessel.branches.left.angle=70 deg"])
    assert by_name == by_index
    assert by_name.vessel.branches[1].angle == pytest.approx(math.radians(70))
    row = load_scenario("phantom-universal", ["vessel.branches.target.diameter.1=2.5 mm"])
    assert row.vessel.branches[3].diameter == (3.5e-3, 2.5e-3)


def test_the_resolved_scenario_holds_the_shared_vessel_whole():
    loaded = load_scenario("phantom-amplatz")
    again = scenario_from_dict(loaded.to_dict())
    assert again == loaded
    assert loaded.vessel == load_scenario("phantom-universal").vessel
    assert loaded.vessel.branch_names == ("trunk", "left", "right", "target", "upper")


def test_a_run_that_was_stored_knows_its_branches(tmp_path):
    scenario = load_scenario("phantom-universal")
    result = dataclasses.replace(made_up_result(segments=10, instants=3), scenario=scenario)
    again = read_run(write_run(result, tmp_path / "run", command=["test"], figures=False))
    points = [[10e-3, 0], [26e-3, 10e-3], [60e-3, 20.5e-3], [0.5, 0.5]]
    assert list(again.scenario.vessel.branch_at(points)) == ["trunk", "left", "target", ""]


def test_the_example_in_the_docs_is_good():
    text = (Path(__file__).resolve().parents[2] / "docs" / "vessels.md").read_text(encoding="utf-8")
    block = re.search(r"```yaml\n(.*?)```", text, re.DOTALL)[1]
    found = scenario(vessel=parse_yaml(block, "vessels.md").data["vessel"]).vessel
    assert found.branch_names == ("main", "side")
