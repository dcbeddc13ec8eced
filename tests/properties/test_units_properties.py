"""Properties of the unit language, over generated quantities and over any text at all."""

from __future__ import annotations

import math
from fractions import Fraction

from hypothesis import example, given
from hypothesis import strategies as st

from gw_exudyn.errors import UnitError
from gw_exudyn.scenario.units import parse_number, parse_quantity, parse_unit

SYMBOLS = st.sampled_from(
    ["m", "mm", "um", "cm", "in", "Fr", "kg", "g", "s", "ms", "min", "N", "mN", "gf", "Pa", "GPa", "J", "Hz"]
)
POWERS = st.sampled_from(["", "^2", "^3", "^-1", "^-2", "²", "³", "**2"])
TERMS = st.builds("{}{}".format, SYMBOLS, POWERS)
UNITS = st.builds(
    lambda first, rest: first + "".join(operator + term for operator, term in rest),
    TERMS,
    st.lists(st.tuples(st.sampled_from(["*", "/", " ", "·", " * "]), TERMS), max_size=3),
)
FLOATS = st.floats(min_value=-1e50, max_value=1e50, allow_nan=False, allow_infinity=False)


@given(FLOATS)
def test_a_float_in_si_comes_back_as_it_was(value: float) -> None:
    """The shortest text of a double, read exactly and rounded once, is that double."""
    assert parse_quantity(f"{value!r} m", "m") == value
    assert float(parse_number(repr(value))) == value


@given(FLOATS, UNITS)
def test_a_quantity_is_its_number_times_its_unit_rounded_once(value: float, unit: str) -> None:
    found = parse_unit(unit)
    si = _si_text(found.dimension)
    assert parse_quantity(f"{value!r} {unit}", si) == float(Fraction(repr(value)) * found.factor)


@given(UNITS, UNITS)
def test_a_product_of_units_multiplies_factors_and_adds_dimensions(first: str, second: str) -> None:
    one, two, product = parse_unit(first), parse_unit(second), parse_unit(f"{first}*{second}")
    assert product.factor == one.factor * two.factor
    assert product.dimension == tuple(a + b for a, b in zip(one.dimension, two.dimension, strict=True))


@given(TERMS)
def test_a_unit_over_itself_has_none(term: str) -> None:
    found = parse_unit(f"{term}/{term}")
    assert found.factor == 1
    assert found.dimension == (0, 0, 0, 0)


@given(FLOATS.filter(lambda value: abs(value) > 1e-300), st.floats(min_value=-720, max_value=720))
def test_scaling_by_a_prefix_keeps_the_value(value: float, angle: float) -> None:
    """To one rounding of each side: 2^-52 relative."""
    assert math.isclose(
        parse_quantity(f"{value!r} mm", "m"), parse_quantity(f"{value!r} um", "m") * 1000, rel_tol=1e-15
    )
    assert math.isclose(parse_quantity(f"{angle!r} deg", "rad"), math.radians(angle), rel_tol=1e-15, abs_tol=0.0)


@given(st.text(max_size=120), UNITS)
@example("1e9999999 m", "m")
@example("1 m^99999999", "m")
@example("1 " + "/".join("m" * 60), "m")
@example("٣ mm", "m")
@example("1 m\n", "m")
def test_any_text_is_read_or_refused_in_a_sentence(text: str, unit: str) -> None:
    for attempt in (text, f"1 {text}", f"{text} mm"):
        try:
            value = parse_quantity(attempt, unit)
        except UnitError as error:
            sentence = str(error)
        else:
            sentence = f"{value} is read"
            assert math.isfinite(value)
        assert sentence.isprintable()  # what a hostile text holds never reaches the terminal as it is


def _si_text(dimension: tuple[int, int, int, int]) -> str:
    """The SI unit of a dimension; of no dimension, one that cancels."""
    names = zip(("m", "kg", "s", "rad"), dimension, strict=True)
    return "*".join(term for name, power in names for term in _powers(name, power)) or "m/m"


def _powers(name: str, power: int) -> list[str]:
    """A power as a product of powers that are not beyond 9, the highest that a unit may have."""
    step = 9 if power > 0 else -9
    return [f"{name}^{step}"] * (abs(power) // 9) + ([f"{name}^{power % step}"] if power % step else [])
