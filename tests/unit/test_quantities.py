"""The table of quantities: complete, in order, and shown in units that people read."""

from __future__ import annotations

import math

import pytest

from gw_exudyn.quantities import (
    CONTACT_FIELDS,
    JOINT_FIELDS,
    NODE_FIELDS,
    QUANTITIES,
    SCALARS,
    SERIES_COLUMNS,
    display,
    display_unit,
    plain,
)

COLUMNS = (
    "time insertion_depth tip_x tip_y tip_angle push_force tip_force wall_force_x wall_force_y wall_force_normal "
    "wall_force_max contacts penetration_max insertion_work elastic_energy wall_energy kinetic_energy friction_loss "
    "damping_loss numerical_loss energy_error load_work support_force_x support_force_y nose_force nose_travel "
    "tip_hold_force_x tip_hold_force_y"
)


def test_the_columns_of_the_series_are_those_promised_in_that_order():
    assert list(SERIES_COLUMNS) == COLUMNS.split()


def test_every_scalar_of_the_series_is_a_scalar_of_a_sample():
    assert set(SERIES_COLUMNS) - {"time"} <= set(SCALARS)


@pytest.mark.parametrize("quantity", QUANTITIES.values(), ids=lambda quantity: quantity.name)
def test_each_quantity_is_fully_described(quantity):
    unit, factor = display_unit(quantity.name)
    assert unit == quantity.display_unit
    assert factor > 0
    assert quantity.symbol
    assert len(quantity.long_name.split()) > 2
    assert quantity.heading == f"{quantity.name} [{quantity.unit}]"
    assert all(meaning.isidentifier() for _, meaning in quantity.flags)


def test_fields_live_where_they_say():
    dims = {name: QUANTITIES[name].dims for name in NODE_FIELDS + JOINT_FIELDS + CONTACT_FIELDS}
    assert {dims[name] for name in NODE_FIELDS} == {("time", "node")}
    assert {dims[name] for name in JOINT_FIELDS} == {("time", "joint")}
    assert {dims[name] for name in CONTACT_FIELDS} == {("time", "contact")}
    assert len(CONTACT_FIELDS) == 8


@pytest.mark.parametrize(
    ("name", "largest", "unit", "factor"),
    [
        ("push_force", 0.02, "mN", 1e3),
        ("push_force", 9.0, "mN", 1e3),
        ("push_force", 20.0, "N", 1.0),
        ("insertion_work", 0.1, "mJ", 1e3),
        ("insertion_work", 1e9, "J", 1.0),
        ("tip_angle", 1.0, "deg", 180 / math.pi),
        ("push_force", math.nan, "mN", 1e3),
        ("push_force", math.inf, "N", 1.0),
    ],
)
def test_long_numbers_move_on_to_a_coarser_unit(name, largest, unit, factor):
    assert display_unit(name, largest) == (unit, pytest.approx(factor))


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("push_force", 0.0207, "20.7 mN"),
        ("push_force", -0.0207, "-20.7 mN"),
        ("push_force", -0.0, "0 mN"),
        ("push_force", 1.19, "1.19 N"),
        ("wall_force_max", 12345.0, "12345 N"),
        ("insertion_depth", 0.08, "80 mm"),
        ("penetration_max", 2e-6, "2 µm"),
        ("tip_angle", math.pi / 2, "90 °"),
        ("contacts", 7, "7"),
    ],
)
def test_a_number_is_shown_in_its_display_unit(name, value, text):
    assert display(name, value) == text


def test_units_are_written_as_people_write_them():
    assert [plain(unit) for unit in ("uJ", "deg", "mN", "um")] == ["µJ", "°", "mN", "µm"]
