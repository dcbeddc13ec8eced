"""Quantities as text, `0.36 mm`, `1.0 N*mm^2`, `0.01 1/m`, turned into SI numbers with their dimension checked.

A quantity is a number, a space, a unit. A unit is a product and quotient of symbols with whole powers, read from left
to right: `N*s/m`, `kg/m^3`, `1/mm`. `·` and a space may stand for `*`, `²` and `³` for `^2` and `^3`. Factors are
exact fractions, so that `0.36 mm` is the very double that `0.00036` is, and `1 in` equals `25.4 mm`.
"""

from __future__ import annotations

import difflib
import math
import re
from dataclasses import dataclass
from fractions import Fraction

from gw_exudyn.errors import UnitError

Dimension = tuple[int, int, int, int]
"""Exponents of (length, mass, time, angle). Angle is kept apart so that `45 deg` is not taken for a friction
coefficient.
"""

_LONGEST = 100  # characters of a quantity; longer text is no quantity
_HIGHEST_POWER = 9

NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")
"""A decimal number. At most three digits of exponent, because an exact fraction of `1e-999999999` would not fit in
memory.
"""

_SYMBOL = re.compile(r"[A-Za-zµμ]+|[°\"]")
_POWER = re.compile(r"(?:\^|\*\*)\s*([+-]?[0-9]+)|([²³])")


@dataclass(frozen=True)
class Unit:
    """A unit: `factor` times the value in it is the value in SI; `dimension` are the exponents of m, kg, s, rad."""

    text: str
    factor: Fraction
    dimension: Dimension


@dataclass(frozen=True)
class _Kind:
    name: str
    si: str
    usual: tuple[str, ...]


# The kinds of quantity that an error can name, each with the units it offers.
_KINDS = (
    _Kind("a length", "m", ("m", "cm", "mm", "um", "in", "Fr")),
    _Kind("a time", "s", ("s", "ms", "us", "min")),
    _Kind("an angle", "rad", ("rad", "deg")),
    _Kind("a mass", "kg", ("kg", "g", "mg")),
    _Kind("a force", "N", ("N", "mN", "gf")),
    _Kind("a speed", "m/s", ("m/s", "mm/s", "cm/s", "mm/min")),
    _Kind("an acceleration", "m/s^2", ("m/s^2", "mm/s^2")),
    _Kind("a curvature", "1/m", ("1/m", "1/mm", "1/cm")),
    _Kind("a curvature", "rad/m", ("rad/m", "deg/mm")),
    _Kind("an area", "m^2", ("m^2", "mm^2")),
    _Kind("a second moment of area", "m^4", ("m^4", "mm^4")),
    _Kind("a bending stiffness", "N*m^2", ("N*m^2", "N*cm^2", "N*mm^2")),
    _Kind("a density", "kg/m^3", ("kg/m^3", "g/cm^3")),
    _Kind("a stiffness", "N/m", ("N/m", "N/mm", "mN/mm")),
    _Kind("a damping", "N*s/m", ("N*s/m", "N*s/mm")),
    _Kind("an energy or a torque", "N*m", ("N*m", "N*mm", "J", "mJ")),
    _Kind("a torsional stiffness", "N*m/rad", ("N*m/rad", "N*mm/deg")),
    _Kind("a pressure or a modulus", "Pa", ("Pa", "MPa", "GPa")),
    _Kind("a frequency", "Hz", ("Hz", "1/s")),
)

# What people write for a symbol that we do know.
_SPELLINGS = {
    "metre": "m", "metres": "m", "meter": "m", "meters": "m", "millimetre": "mm", "millimetres": "mm",
    "millimeter": "mm", "millimeters": "mm", "micron": "um", "microns": "um", "inch": "in", "inches": "in",
    '"': "in", "french": "Fr", "f": "Fr", "fr": "Fr", "sec": "s", "second": "s", "seconds": "s", "msec": "ms",
    "degree": "deg", "degrees": "deg", "radian": "rad", "radians": "rad", "newton": "N", "newtons": "N", "pascal": "Pa",
    "minute": "min", "minutes": "min", "hour": "h", "hours": "h", "psi": "Pa", "kgf": "gf", "lbf": "N",
}  # fmt: skip

_PREFIXES = {
    "n": Fraction(1, 10**9),
    "u": Fraction(1, 10**6),
    "µ": Fraction(1, 10**6),  # micro sign
    "μ": Fraction(1, 10**6),  # Greek small mu, which looks the same
    "m": Fraction(1, 10**3),
    "c": Fraction(1, 10**2),
    "k": Fraction(10**3),
    "M": Fraction(10**6),
    "G": Fraction(10**9),
}


def _symbols() -> dict[str, tuple[Fraction, Dimension]]:
    """Every symbol of the unit language with its exact factor to SI and its dimension."""
    length, mass, time, angle = (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)
    one = Fraction(1)
    prefixed: list[tuple[str, str, Fraction, Dimension]] = [
        ("m", "nuµμmck", one, length),
        ("g", "uµμmk", Fraction(1, 1000), mass),
        ("s", "nuµμm", one, time),
        ("rad", "mu", one, angle),
        ("N", "nuµμmckM", one, (1, 1, -2, 0)),
        ("Pa", "kMG", one, (-1, 1, -2, 0)),
        ("J", "nuµμmk", one, (2, 1, -2, 0)),
        ("Hz", "kM", one, (0, 0, -1, 0)),
    ]
    symbols = {
        "in": (Fraction(254, 10000), length),
        "Fr": (Fraction(1, 3000), length),
        "deg": (Fraction(math.pi) / 180, angle),
        "°": (Fraction(math.pi) / 180, angle),
        "min": (Fraction(60), time),
        "h": (Fraction(3600), time),
        "gf": (Fraction(980665, 10**8), (1, 1, -2, 0)),
    }
    for symbol, prefixes, factor, dimension in prefixed:
        symbols[symbol] = (factor, dimension)
        for prefix in prefixes:
            symbols[prefix + symbol] = (factor * _PREFIXES[prefix], dimension)
    return symbols


_SYMBOLS = _symbols()


def parse_unit(text: str) -> Unit:
    """Read a unit such as `N*mm^2`.

    Raises
    ------
    UnitError
        naming the symbol that is not known and the nearest one that is.
    """
    if len(text) > _LONGEST:
        raise UnitError(f"{text[:20]!r}... is no unit: it is longer than {_LONGEST} characters")
    factor, exponents, at, sign = Fraction(1), [0, 0, 0, 0], 0, 1
    body = text.strip()
    if body.startswith("1/"):
        at, sign = 2, -1
    while True:
        at = _skip_space(body, at)
        symbol_factor, symbol_dimension, power, at = _term(body, at, text)
        factor *= symbol_factor ** (sign * power)
        exponents = [e + sign * power * d for e, d in zip(exponents, symbol_dimension, strict=True)]
        after = _skip_space(body, at)
        if after == len(body):
            break
        if body[after] in "*·/⋅":
            sign = -1 if body[after] == "/" else 1
            at = after + 1
        elif after > at:
            sign, at = 1, after  # a space multiplies
        else:
            raise UnitError(f"{text!r} is no unit: {body[after:]!r} is not understood; {_HOW}")
    return Unit(body, factor, (exponents[0], exponents[1], exponents[2], exponents[3]))


_HOW = "write products as 'N*s', quotients as 'mm/s', powers as 'mm^2'"


def _skip_space(text: str, at: int) -> int:
    while at < len(text) and text[at].isspace():
        at += 1
    return at


def _term(body: str, at: int, text: str) -> tuple[Fraction, Dimension, int, int]:
    """One symbol with its power, from position `at`: its factor, dimension and power, and where it ends."""
    match = _SYMBOL.match(body, at)
    if match is None:
        rest = body[at:]
        raise UnitError(
            f"{text!r} is no unit: " + (f"{rest!r} is not understood; {_HOW}" if rest else f"it ends early; {_HOW}")
        )
    symbol, at = match.group(), match.end()
    if symbol not in _SYMBOLS:
        raise UnitError(_unknown(symbol))
    if body[at : at + 1] in tuple("0123456789"):
        raise UnitError(f"{text!r} is no unit: write a power as '{symbol}^{body[at]}'")
    power = 1
    raised = _POWER.match(body, at)
    if raised is not None:
        at = raised.end()
        power = int(raised.group(1)[:5]) if raised.group(1) else {"²": 2, "³": 3}[raised.group(2)]
        if abs(power) > _HIGHEST_POWER:
            raise UnitError(f"{text!r} is no unit: the power of {symbol!r} is beyond {_HIGHEST_POWER}")
    return *_SYMBOLS[symbol], power, at


def _unknown(symbol: str) -> str:
    known = _SPELLINGS.get(symbol.lower())
    near = [known] if known else _nearest_symbols(symbol)
    hint = (
        f"; did you mean {' or '.join(repr(name) for name in near)}?"
        if near
        else "; known are such as mm, in, Fr, N, s, deg"
    )
    return f"unknown unit {symbol!r}{hint}"


def _nearest_symbols(symbol: str) -> list[str]:
    same_letters = [known for known in _SYMBOLS if known.lower() == symbol.lower()]
    return same_letters[:2] or difflib.get_close_matches(symbol, _SYMBOLS, n=2, cutoff=0.6)


def parse_quantity(text: str, unit: str, *also: str) -> float:
    """Read a quantity with its unit and return it in SI.

    Parameters
    ----------
    text : number, space, unit; for instance `0.014 in`.
    unit : an SI unit with the dimension that is needed, for instance `m`.
    also : further units whose dimension is taken too (`rad/m` beside `1/m`).

    Returns
    -------
    float, in SI, rounded once.

    Raises
    ------
    UnitError
        when the text is no quantity or its dimension differs; the message names the units that fit.
    """
    body = text.strip()
    if len(body) > _LONGEST:
        raise UnitError(f"{body[:20]!r}... is no quantity: it is longer than {_LONGEST} characters")
    match = NUMBER.match(body)
    if match is None or (match.end() < len(body) and body[match.end()] in ".,_0123456789"):
        raise UnitError(_no_number(body, unit))
    written = body[match.end() :].strip()
    if not written:
        fit = ", ".join(units_that_fit(unit))
        raise UnitError(
            f"{text!r} has no unit; write {body} without quotes if it is in SI ({unit}), or give a unit: {fit}"
        )
    found = parse_unit(written)
    if found.dimension not in {parse_unit(fit).dimension for fit in (unit, *also)}:
        raise UnitError(
            f"{text!r} is {describe(found.dimension)}, not {describe(parse_unit(unit).dimension)}; {_offer(unit)}"
        )
    return _finite(Fraction(match.group()) * found.factor, text)


def parse_number(text: str) -> Fraction:
    """Read a bare decimal number exactly; UnitError for anything else (`nan`, `1_000`, `0,5`)."""
    body = text.strip()
    if len(body) > _LONGEST or NUMBER.fullmatch(body) is None:
        raise UnitError(_no_number(body[:_LONGEST], ""))
    return Fraction(body)


def in_si(number: Fraction, unit: Unit) -> float:
    """The exact `number` in `unit`, in SI, rounded once."""
    return _finite(number * unit.factor, f"{float(number):g} {unit.text}")


def _finite(value: Fraction, text: str) -> float:
    try:
        return float(value)
    except OverflowError:
        raise UnitError(f"{text!r} is too large a number") from None


def _no_number(body: str, unit: str) -> str:
    example = f"as '2.5 {unit}'" if unit else "as 2.5 or 1e-3"
    if re.match(r"[+-]?[0-9]+,[0-9]", body):
        return f"{body!r} has a decimal comma; write a decimal point: {body.replace(',', '.', 1)!r}"
    if re.match(r"[+-]?[0-9.]+[eE][+-]?[0-9]{4}", body):
        return f"{body!r} has an exponent beyond 999"
    if re.match(r"[+-]?[0-9]+_", body):
        return f"{body!r} has an underscore in its number; write {body.replace('_', '')!r}"
    return (
        f"{body!r} does not begin with a number; write it {example}"
        if unit
        else f"{body!r} is no number; write it {example}"
    )


def _offer(unit: str) -> str:
    return f"units that fit: {', '.join(units_that_fit(unit))}"


def units_that_fit(unit: str) -> tuple[str, ...]:
    """Usual units of the dimension of `unit`, for messages and help."""
    dimension = parse_unit(unit).dimension
    for kind in _KINDS:
        if parse_unit(kind.si).dimension == dimension:
            return kind.usual
    return (unit,)


def describe(dimension: Dimension) -> str:
    """What kind of quantity has this dimension: `a length`, `a bending stiffness`, or its SI unit if it has no name."""
    for kind in _KINDS:
        if parse_unit(kind.si).dimension == dimension:
            return kind.name
    powers = zip(("m", "kg", "s", "rad"), dimension, strict=True)
    return "a quantity in " + (
        "*".join(f"{name}^{power}" if power != 1 else name for name, power in powers if power) or "no unit"
    )


def format_quantity(value: float, unit: str) -> str:
    """The SI `value` as text in `unit`, six digits: `0.36 mm`."""
    return f"{value / float(parse_unit(unit).factor):.6g} {unit}"
