"""Norms of the difference of two courses: numbers that can be checked by hand."""

from __future__ import annotations

import numpy as np
import pytest

from gw_exudyn.comparison import Course, at, compare, course_of, differences, drawn_rows, nearest_distance
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
    """At one rate an empty cell is a gap, also at the ends."""
    time = np.arange(6.0)
    first = course(time=time, push_force=[0.0, 1.0, 2.0, 3.0, 4.0, 5.0])
    second = course(time=time, push_force=[0.5, np.nan, 2.0, 3.0, 4.0, np.nan])
    norms = compare(first, second)
    assert (norms["push_force_max"].value, norms["push_force_rms"].value) == (0.5, pytest.approx(np.sqrt(0.25 / 4)))


def test_a_path_has_no_way_across_its_gap():
    """A path against itself with the middle emptied: what is left lies on it, and the rest is not held against it."""
    time = np.linspace(0, 30, 301)
    x, y = 0.04 * np.sin(time / 6), 0.04 * np.cos(time / 6)
    away = (time > 11) & (time < 22)
    run = course(time=time, tip_x=x, tip_y=y)
    measured = course(time=time, tip_x=np.where(away, np.nan, x), tip_y=np.where(away, np.nan, y))
    norms = compare(run, measured)
    for name in ("tip_max", "tip_nearest_rms", "tip_nearest_max"):
        assert norms[name].value == pytest.approx(0, abs=1e-12), name
    # A point outside of the gap whose nearest would be half way over it has its nearest at an end.
    off = course(time=time, tip_x=np.where(time > 25, x[165], x), tip_y=np.where(time > 25, y[165], y))
    ends = np.array([[x[110], y[110]], [x[220], y[220]]])
    nearest = np.hypot(*(ends - [x[165], y[165]]).T).min()
    assert compare(off, measured)["tip_nearest_max"].value == pytest.approx(nearest, rel=1e-9)


def two_rates():
    """A camera at 15 and a load cell at 100 values a second, in one table, off the run's grid; run and table."""
    camera, cell = 0.013 + np.arange(0, 149) / 15, 0.004 + np.arange(0, 990) / 100
    time = np.union1d(camera, cell)
    seen = np.isin(time, camera)
    table = course(
        "both",
        time,
        tip_x=np.where(seen, 2e-3 * time, np.nan),
        tip_y=np.where(seen, 1e-3, np.nan),
        push_force=np.where(np.isin(time, cell), 0.01 * time, np.nan),
    )
    grid = np.arange(0, 10.05, 0.1)
    return course("run", grid, tip_x=2e-3 * grid, tip_y=np.zeros(len(grid)), push_force=0.01 * grid + 1e-3), table


def test_two_rates_in_one_table():
    """Each quantity is interpolated between its own values, whichever rows others have between them."""
    run, table = two_rates()
    norms = compare(run, table)
    assert norms["tip_rms"].value == pytest.approx(1e-3)
    assert norms["tip_nearest_max"].value == pytest.approx(1e-3)
    assert norms["push_force_rms"].value == pytest.approx(1e-3)


def test_a_line_through_one_of_two_rates_is_whole_but_for_its_gap():
    _, table = two_rates()
    force = table.values["push_force"]
    assert np.isfinite(force[drawn_rows(table.time, force)]).all()
    force[(table.time > 3) & (table.time < 6)] = np.nan
    assert not np.isfinite(force[drawn_rows(table.time, force)]).all()


def test_a_gap_at_one_of_two_rates_stays_one():
    run, table = two_rates()
    lost = (table.time > 3) & (table.time < 6)
    for name in ("tip_x", "tip_y"):
        table.values[name][lost] = np.nan
    known = np.isfinite(at(table, "tip_x", run.time))
    assert not known[(run.time > 3.05) & (run.time < 5.95)].any()
    assert known[(run.time > 0.1) & (run.time < 2.9) | (run.time > 6.1) & (run.time < 9.8)].all()
    assert np.isfinite(at(table, "push_force", run.time)[5:95]).all()


def test_times_far_apart_without_an_empty_cell_are_no_gap():
    """Values taken by hand, seldom and then often: there is nothing that says that any is missing."""
    seldom = course(time=(0.0, 5.0, 6.0, 7.0, 8.0), push_force=[0.0, 5.0, 6.0, 7.0, 8.0])
    assert at(seldom, "push_force", np.array([2.5])) == pytest.approx([2.5])


def test_no_common_time_or_quantity_is_told():
    with pytest.raises(ComparisonError, match="no time in common"):
        compare(course("a", push_force=[0, 1, 2]), course("b", time=(5.0, 6.0, 7.0), push_force=[0, 1, 2]))
    with pytest.raises(ComparisonError, match="no quantity in common"):
        compare(course("a", push_force=[0, 1, 2]), course("b", tip_force=[0, 1, 2]))


def test_distance_to_a_path_that_breaks():
    path = np.array([[0.0, 0.0], [1.0, 0.0], [np.nan, np.nan], [1.0, 1.0]])
    found = nearest_distance(np.array([[0.5, 0.2], [np.nan, 0.0], [1.2, 0.5]]), path)
    assert found == pytest.approx([0.2, np.nan, np.hypot(0.2, 0.5)], nan_ok=True)


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


def test_the_figure_draws_a_line_through_one_of_two_rates():
    from synthetic import made_up_result

    from gw_exudyn.plots import plot_comparison

    _, table = two_rates()
    (axes,) = [a for a in plot_comparison(made_up_result(), table).axes if a.get_ylabel().startswith("push force")]
    drawn = axes.lines[1].get_ydata()
    assert len(drawn) == np.isfinite(table.values["push_force"]).sum()
    assert np.isfinite(drawn).all()
