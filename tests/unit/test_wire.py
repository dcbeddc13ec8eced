"""The chain of segments: lengths, joints by integrated compliance, rest angles, mass."""

from __future__ import annotations

import math

import numpy as np
import pytest
from model_cases import scenario

from gw_exudyn.model.build import build
from gw_exudyn.model.wire import Wire, build_wire, mean_stiffness, segment_lengths

LENGTH = 0.1
EXACT = 1e-12
"""Rounding of sums of a few thousand doubles, relative."""


def wire(**changes) -> Wire:
    return build_wire(scenario(wire={"length": LENGTH} | changes).wire)


def pieces(*rows):
    return [{"from": low, "to": high, "value": value} for low, high, value in rows]


@pytest.mark.parametrize("segments", [1, 2, 7, 5000])
@pytest.mark.parametrize("grading", [1.0, 4.0, 0.25])
def test_the_segments_make_up_the_wire_and_shrink_by_one_ratio(segments, grading):
    lengths = segment_lengths(LENGTH, segments, grading)
    assert lengths.sum() == pytest.approx(LENGTH, rel=EXACT)
    assert (lengths > 0).all()
    if segments > 1:
        assert lengths[0] / lengths[-1] == pytest.approx(grading)
        assert lengths[1:] / lengths[:-1] == pytest.approx(np.full(segments - 1, grading ** (-1 / (segments - 1))))


@pytest.mark.parametrize("segments", [1, 3, 5000])
def test_arc_length_counts_from_the_tip(segments):
    built = wire(segments=segments, grading=2.0)
    assert built.node_arc_length[-1] == 0.0
    assert built.length == built.node_arc_length[0] == pytest.approx(LENGTH, rel=EXACT)
    assert -np.diff(built.node_arc_length) == pytest.approx(built.lengths, rel=1e-9)
    assert built.joint_arc_length == pytest.approx(built.node_arc_length[:-1])
    assert built.segments == segments


def test_a_uniform_wire_has_joints_of_stiffness_over_length_and_twice_that_at_the_clamp():
    built = wire(segments=8, bending_stiffness=3e-6)
    expected = np.full(8, 3e-6 / (LENGTH / 8))
    expected[0] *= 2
    assert built.joint_stiffness == pytest.approx(expected, rel=EXACT)


def test_a_wire_of_one_segment_bends_in_the_clamp_only():
    built = wire(segments=1, bending_stiffness=3e-6, imperfection=2.0)
    assert built.joint_stiffness == pytest.approx([2 * 3e-6 / LENGTH])
    assert built.rest_angle == pytest.approx([2.0 * LENGTH / 2])


def test_between_unequal_segments_a_joint_stands_for_half_of_each():
    built = wire(segments=2, grading=3.0, bending_stiffness=3e-6)
    proximal, distal = 0.75 * LENGTH, 0.25 * LENGTH
    assert built.joint_stiffness == pytest.approx([3e-6 / (proximal / 2), 3e-6 / ((proximal + distal) / 2)])


def test_where_stiffness_steps_inside_a_joint_its_halves_act_in_series():
    """Ten segments; joint 5 stands for 45 to 55 mm from the tip. A step at 48 mm leaves 3 mm soft and 7 mm stiff."""
    soft, stiff = 1e-6, 7e-6
    built = wire(segments=10, bending_stiffness=pieces((0, 0.048, soft), (0.048, LENGTH, stiff)))
    assert built.joint_stiffness[5] == pytest.approx(1 / (0.003 / soft + 0.007 / stiff), rel=1e-9)
    assert built.joint_stiffness[4] == pytest.approx(stiff / 0.01)  # the proximal neighbour is stiff, the distal soft
    assert built.joint_stiffness[6] == pytest.approx(soft / 0.01)


def test_linear_stiffness_is_integrated_exactly():
    """EI(s) = a + b s has the compliance ln(EI(s2)/EI(s1)) / b."""
    tip, end = 1e-6, 9e-6
    built = wire(segments=5, bending_stiffness=pieces((0, LENGTH, [tip, end])))
    slope = (end - tip) / LENGTH
    middles = np.array([0.09, 0.07, 0.05, 0.03, 0.01])
    far, near = np.array([LENGTH, *middles[:-1]]), middles
    compliance = np.log((tip + slope * far) / (tip + slope * near)) / slope
    assert built.joint_stiffness == pytest.approx(1 / compliance, rel=1e-9)


def test_a_hair_of_slope_changes_nothing():
    """The logarithm loses no digits: from a slope of 1e-15 on to one of 1e-3, compliance goes smoothly."""
    flat = wire(segments=5, bending_stiffness=1e-6).joint_stiffness
    for change in (1e-15, 1e-11, 1e-9, 2e-9, 1e-6, 1e-3):
        bent = wire(segments=5, bending_stiffness=pieces((0, LENGTH, [1e-6, 1e-6 * (1 + change)]))).joint_stiffness
        assert bent == pytest.approx(flat, rel=1.01 * change + EXACT)


def test_the_mean_stiffness_is_that_of_the_distal_part():
    given = scenario(wire={"bending_stiffness": pieces((0, 0.02, 1e-6), (0.02, LENGTH, 4e-6))}).wire.bending_stiffness
    assert mean_stiffness(given, 0.02) == pytest.approx(1e-6)
    assert mean_stiffness(given, 0.04) == pytest.approx(0.04 / (0.02 / 1e-6 + 0.02 / 4e-6))
    assert mean_stiffness(given, 10.0) == pytest.approx(LENGTH / (0.02 / 1e-6 + 0.08 / 4e-6))


def test_damping_is_stiffness_times_its_time():
    built = wire(segments=4, damping_time=0.05)
    assert built.joint_damping == pytest.approx(0.05 * built.joint_stiffness)


@pytest.mark.parametrize("segments", [1, 10, 5000])
def test_mass_and_inertia_are_those_of_solid_rods(segments):
    built = wire(segments=segments, density=6000.0, diameter=0.4e-3, grading=2.0)
    area, mass = math.pi * 0.2e-3**2, built.mass
    assert mass.sum() == pytest.approx(6000.0 * area * LENGTH, rel=1e-9)
    assert mass == pytest.approx(6000.0 * area * built.lengths)
    assert built.inertia == pytest.approx(mass * (3 * 0.2e-3**2 + built.lengths**2) / 12, rel=1e-9, abs=0)
    assert built.radius == 0.2e-3


def test_the_rest_curvature_adds_up_to_the_middle_of_the_last_segment():
    built = wire(segments=20, imperfection=0.5)
    assert built.rest_angle.sum() == pytest.approx(0.5 * LENGTH * (1 - 0.5 / 20))
    assert built.rest_angle[0] == pytest.approx(0.5 * LENGTH / 40)
    assert built.rest_angle[1:] == pytest.approx(np.full(19, 0.5 * LENGTH / 20))


def test_a_wire_called_straight_has_a_small_imperfection_unless_it_is_given():
    assert 0 < wire(imperfection=None).rest_angle.sum() < 0.01
    assert (wire(imperfection=0.0).rest_angle == 0).all()
    assert wire(imperfection=-0.5).rest_angle == pytest.approx(-wire(imperfection=0.5).rest_angle)


@pytest.mark.parametrize("angle", [0.7, -0.7])
def test_a_curved_tip_turns_by_its_angle_within_its_length(angle):
    """Segments of 1 mm, an arc of the distal 10.2 mm: the last segment points where the arc does half a segment before
    its end, and nothing is bent further back."""
    shape = {"kind": "arc", "length": 0.0102, "angle": angle}
    built = wire(segments=100, tip_shape=shape)
    assert built.rest_angle.sum() == pytest.approx(angle * (1 - 0.0005 / 0.0102))
    assert built.rest_angle[-1] == pytest.approx(angle * 0.001 / 0.0102)
    assert (built.rest_angle[:90] == 0).all()
    assert built.rest_angle[90] == pytest.approx(angle * 0.0007 / 0.0102)  # of 9.5 to 10.5 mm, 0.7 mm are curved


@pytest.mark.parametrize("place", [0.0104, 0.0096])
def test_a_kink_sits_in_the_nearest_joint(place):
    built = wire(segments=100, tip_shape={"kind": "bend", "length": place, "angle": 0.6}, imperfection=0.5)
    kinked = built.rest_angle - 0.5 * 0.001
    kinked[0] += 0.5 * 0.0005
    assert kinked[90] == pytest.approx(0.6)  # joint 90 is 10 mm from the tip
    assert np.delete(kinked, 90) == pytest.approx(np.zeros(99), abs=1e-12)


@pytest.mark.parametrize("place", [LENGTH, 0.0999, 0.0995, 0.05, 0.0006, 0.00051])
def test_a_kink_beyond_half_the_last_segment_is_in_one_joint(place):
    built = wire(segments=100, tip_shape={"kind": "bend", "length": place, "angle": 0.6})
    assert sorted(built.rest_angle)[-2:] == pytest.approx([0.0, 0.6])


def test_a_kink_at_the_clamp_is_not_lost_by_rounding():
    for segments in range(2, 60):
        built = wire(segments=segments, tip_shape={"kind": "bend", "length": LENGTH, "angle": 0.6})
        assert built.rest_angle[0] == pytest.approx(0.6)


@pytest.mark.parametrize("kind", ["bend", "arc"])
def test_a_tip_shape_that_the_segments_cannot_show_is_warned_of(kind):
    shape = {"kind": kind, "length": 0.004, "angle": 0.6}
    (warning,) = build(scenario(wire={"segments": 20, "tip_shape": shape})).warnings
    assert warning.startswith("wire.tip_shape: 4 mm is shorter than the last segment, 5 mm")
    assert build(scenario(wire={"segments": 25, "tip_shape": shape})).warnings == ()
