"""Norms of the difference of two courses: numbers that can be checked by hand."""

from __future__ import annotations

import numpy as np
import pytest

from gw_exudyn.comparison import Course, compare, course_of, differences, nearest_distance
from gw_exudyn.errors import ComparisonError


def course(name="run", time=(0.0, 1.0, 2.0), **values):
    return Course(name, np.array(time), {key: np.array(row, dtype=float) for key, row in values.items()})


def test_the_path_at_equal_times_and_at_the_nearest_point():
    """The second goes the same way, a second late: apart at equal times, not apart as a path."""
    first = course(tip_x=[0, 3e-3, 6e-3], tip_y=[0, 0, 0])
    second = course(tip_x=[0, 0, 3e-3], tip_y=[0, 0, 0])
    norms = {name: norm.value for name, norm in compare(first, second).items()}
    assert norms["tip_rms"] == pytest.approx(np.sqrt((9 + 9) / 3) * 1e-3)
    assert (norms["tip_max"], norms["tip_final"]) == (pytest.approx(3e-3), pytest.approx(3e-3))
    assert norms["tip_nearest_rms"] == pytest.approx(np.sqrt(9 / 3) * 1e-3)  # its last point lies beyond the other path
    assert compare(second, first)["tip_nearest_max"].value == pytest.approx(0)


def test_a_course_with_itself_is_not_apart():
    same = course(tip_x=[0, 1e-3, 2e-3], tip_y=[0, 1e-3, 0], push_force=[0.0, 0.1, 0.3])
    assert all(norm.value == 0 for norm in compare(same, same).values())


def test_other_instants_are_interpolated_and_only_the_common_time_counts():
    first = course(time=(0.0, 1.0, 2.0), push_force=[0.0, 1.0, 2.0])
    second = course(time=(0.5, 1.5), push_force=[0.6, 1.6])
    assert compare(first, second)["push_force_max"].value == pytest.approx(0.1)


def test_gaps_are_left_out():
    first = course(push_force=[0.0, 1.0, 2.0])
    second = course(push_force=[0.5, np.nan, 2.0])
    norms = compare(first, second)
    assert (norms["push_force_max"].value, norms["push_force_rms"].value) == (0.5, pytest.approx(np.sqrt(0.125)))


def test_no_common_time_or_quantity_is_told():
    with pytest.raises(ComparisonError, match="no time in common"):
        compare(course("a", push_force=[0, 1, 2]), course("b", time=(5.0, 6.0, 7.0), push_force=[0, 1, 2]))
    with pytest.raises(ComparisonError, match="no quantity in common"):
        compare(course("a", push_force=[0, 1, 2]), course("b", tip_force=[0, 1, 2]))


def test_distance_to_a_path_leaves_gaps():
    path = np.array([[0.0, 0.0], [1.0, 0.0], [np.nan, np.nan], [1.0, 1.0]])
    found = nearest_distance(np.array([[0.5, 0.2], [np.nan, 0.0], [1.2, 0.5]]), path)
    assert found == pytest.approx([0.2, np.nan, 0.2], nan_ok=True)


def test_what_differs_between_scenarios():
    first = {"name": "a", "wire": {"segments": 20, "shape": [[0, 1], [2, 3]]}, "tip": {}}
    second = {"name": "b", "wire": {"segments": 40, "shape": [[0, 1], [2, 4]], "model": "x"}, "tip": {}}
    assert [(d.path, d.first, d.second) for d in differences(first, second)] == [
        ("wire.segments", 20, 40),
        ("wire.shape.1.1", 3, 4),
        ("wire.model", None, "x"),
    ]


def test_a_result_has_a_course():
    from synthetic import made_up_result

    result = made_up_result()
    assert compare(course_of(result), course_of(result))["tip_rms"].value == 0
