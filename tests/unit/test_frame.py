"""The catheter's frame: signs, and there and back."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gw_exudyn.model.frame import Frame

UP = Frame((1.0, 2.0), math.pi / 2)
"""At (1, 2), pointing up: its x is the plane's y, its y the plane's -x."""


@pytest.mark.parametrize(("plane", "local"), [((1, 2), (0, 0)), ((1, 5), (3, 0)), ((-1, 2), (0, 2)), ((4, 6), (4, -3))])
def test_ahead_is_x_and_left_is_y(plane, local):
    assert UP.points_in(plane) == pytest.approx(np.array(local, dtype=float), abs=1e-15)
    assert UP.points_out(local) == pytest.approx(np.array(plane, dtype=float), abs=1e-15)


def test_vectors_turn_but_do_not_move():
    assert UP.vectors_out([[2.0, 0.0], [0.0, 3.0]]) == pytest.approx(np.array([[0.0, 2.0], [-3.0, 0.0]]), abs=1e-15)


coordinate = st.floats(-1.0, 1.0)
point = st.tuples(coordinate, coordinate)


@given(point, st.floats(-7.0, 7.0), st.lists(point, min_size=1, max_size=5))
def test_there_and_back(origin, angle, points):
    frame, given_points = Frame(origin, angle), np.array(points)
    local = frame.points_in(given_points)
    assert frame.points_out(local) == pytest.approx(given_points, abs=1e-14)
    assert np.hypot(*local.T) == pytest.approx(np.hypot(*(given_points - origin).T), abs=1e-14)
    moved = frame.points_out(local + [0.3, -0.2]) - given_points
    assert moved == pytest.approx(np.tile(frame.vectors_out([0.3, -0.2]), (len(points), 1)), abs=1e-14)
