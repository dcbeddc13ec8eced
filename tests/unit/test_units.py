"""Quantities as text: what is read, to the last bit, and what is said when it cannot be."""

from __future__ import annotations

import math

import pytest

from gw_exudyn.errors import UnitError
from gw_exudyn.scenario.units import describe, format_quantity, parse_number, parse_quantity, parse_unit, units_that_fit


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("0.36 mm", "m", 0.00036),
        ("0.36mm", "m", 0.00036),
        (" 0.36  mm ", "m", 0.00036),
        ("0.014 in", "m", 0.0003556),
        ("1 in", "m", 0.0254),
        ("3 Fr", "m", 0.001),
        ("5 µm", "m", 5e-6),
        ("5 μm", "m", 5e-6),
        ("5 um", "m", 5e-6),
        ("1.0 N*mm^2", "N*m^2", 1e-6),
        ("1.0 N·mm²", "N*m^2", 1e-6),
        ("1.0 N mm**2", "N*m^2", 1e-6),
        ("0.01 N*cm^2", "N*m^2", 1e-6),
        ("1 GPa*mm^4", "N*m^2", 1e-3),
        ("6450 kg/m^3", "kg/m^3", 6450.0),
        ("6.45 g/cm^3", "kg/m^3", 6450.0),
        ("20 ms", "s", 0.02),
        ("2 min", "s", 120.0),
        ("2 mm/s", "m/s", 0.002),
        ("-2 mm/s", "m/s", -0.002),
        ("45 deg", "rad", math.pi / 4),
        ("180°", "rad", math.pi),
        ("0.01 1/m", "1/m", 0.01),
        ("1e-3 1/mm", "1/m", 1.0),
        ("2000 N/m", "N/m", 2000.0),
        ("2 N/mm", "N/m", 2000.0),
        ("5 N*s/m", "N*s/m", 5.0),
        ("1 m/s/s", "m/s^2", 1.0),
        ("0.7 gf", "N", 0.006864655),
        ("+.5 N", "N", 0.5),
        ("1.5E+2 mN", "N", 0.15),
    ],
)
def test_a_quantity_is_read_to_the_last_bit(text: str, unit: str, value: float) -> None:
    """Equality, not closeness: factors are exact fractions, so the result is the double nearest to the true value."""
    assert parse_quantity(text, unit) == value


def test_a_further_dimension_is_taken_if_allowed() -> None:
    assert parse_quantity("1 rad/m", "1/m", "rad/m") == 1.0
    with pytest.raises(UnitError, match="is a curvature, not a curvature"):
        parse_quantity("1 rad/m", "1/m")


@pytest.mark.parametrize(
    ("text", "unit", "sentence"),
    [
        ("7 N", "N*m^2", "'7 N' is a force, not a bending stiffness; units that fit: N*m^2, N*cm^2, N*mm^2"),
        ("45 deg", "m", "'45 deg' is an angle, not a length; units that fit: m, cm, mm, um, in, Fr"),
        ("3 kg*m", "m", "'3 kg*m' is a quantity in m*kg, not a length; units that fit: m, cm, mm, um, in, Fr"),
        ("3 m/m", "m", "'3 m/m' is a quantity in no unit, not a length; units that fit: m, cm, mm, um, in, Fr"),
        ("0.36", "m", "'0.36' has no unit; write 0.36 without quotes if it is in SI (m), or give a unit: m, cm, mm, "
                      "um, in, Fr"),
        ("0,36 mm", "m", "'0,36 mm' has a decimal comma; write a decimal point: '0.36 mm'"),
        ("1_000 mm", "m", "'1_000 mm' has an underscore in its number; write '1000 mm'"),
        ("mm", "m", "'mm' does not begin with a number; write it as '2.5 m'"),
        ("", "m", "'' does not begin with a number; write it as '2.5 m'"),
        ("nan mm", "m", "'nan mm' does not begin with a number; write it as '2.5 m'"),
        ("1:30 min", "s", "':30 min' is no unit: ':30 min' is not understood; "
         "write products as 'N*s', quotients as 'mm/s', powers as 'mm^2'"),
        ("1 milimeter", "m", "unknown unit 'milimeter'; known are such as mm, in, Fr, N, s, deg"),
        ("1 millimeter", "m", "unknown unit 'millimeter'; did you mean 'mm'?"),
        ("1 MM", "m", "unknown unit 'MM'; did you mean 'mm'?"),
        ("1 inch", "m", "unknown unit 'inch'; did you mean 'in'?"),
        ("1 degs", "rad", "unknown unit 'degs'; did you mean 'deg'?"),
        ("1 N*mm2", "N*m^2", "'N*mm2' is no unit: write a power as 'mm^2'"),
        ("1 N*", "N", "'N*' is no unit: it ends early; write products as 'N*s', quotients as 'mm/s', powers as 'mm^2'"),
        ("1 m^99", "m", "'m^99' is no unit: the power of 'm' is beyond 9"),
        ("1e999999999 m", "m", "'1e999999999 m' has an exponent beyond 999"),
        ("1e-999999999 m", "m", "'1e-999999999 m' has an exponent beyond 999"),
        ("1e999 m", "m", "'1e999 m' is too large a number"),
    ],
)  # fmt: skip
def test_what_is_no_such_quantity_is_told_in_a_sentence(text: str, unit: str, sentence: str) -> None:
    with pytest.raises(UnitError) as caught:
        parse_quantity(text, unit)
    assert str(caught.value) == sentence


def test_long_text_is_refused_without_reading_it() -> None:
    with pytest.raises(UnitError, match="longer than 100 characters"):
        parse_quantity("1 " + "m*" * 1000 + "m", "m")
    with pytest.raises(UnitError, match="longer than 100 characters"):
        parse_unit("m" * 1000)


def test_a_bare_number_is_exact() -> None:
    assert parse_number(" 0.1 ") * 10 == 1
    for text in ("", "nan", "1_0", "0,5", "1 m", "٣"):
        with pytest.raises(UnitError):
            parse_number(text)


def test_units_and_their_kind_can_be_told() -> None:
    assert units_that_fit("N/m") == ("N/m", "N/mm", "mN/mm")
    assert units_that_fit("kg^2") == ("kg^2",)
    assert describe(parse_unit("J").dimension) == "an energy or a torque"
    assert format_quantity(0.00036, "mm") == "0.36 mm"
    assert format_quantity(math.pi / 4, "deg") == "45 deg"
