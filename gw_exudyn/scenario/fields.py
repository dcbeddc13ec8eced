"""The kinds of value that a scenario file may hold, on top of pydantic.

A kind reads one value (`Quantity` a length, `Whole` a count), says in a sentence what is wrong with it, and describes
itself for the JSON schema. Kinds stand in the `Annotated` of a field. Nothing is coerced: 3.7 is no count, `"3"` is
no number, `true` is neither.
"""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import core_schema

from gw_exudyn.errors import UnitError
from gw_exudyn.scenario.faults import Faults, wrong
from gw_exudyn.scenario.units import format_quantity, parse_quantity, parse_unit, units_that_fit
from gw_exudyn.scenario.words import did_you_mean, plural, shown

IN_SI = "in SI: "
"""What the JSON schema's description of a bare number begins with; its unit follows."""


class Kind:
    """Base of the kinds of value."""

    def read(self, value: Any) -> Any:
        """The value in SI, checked. Raises what `wrong` makes, or a ValidationError with several."""
        raise NotImplementedError

    def json(self) -> dict[str, Any]:
        """JSON schema of the value as a file may hold it."""
        raise NotImplementedError

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        """Pydantic's hook: validate by `read` alone."""
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Pydantic's hook: describe by `json`."""
        return self.json()


@dataclass(frozen=True)
class Quantity(Kind):
    """A physical quantity: a bare SI number or text with a unit.

    unit : its SI unit. low, high : the plausible, in SI, both allowed. usual : the unit in which limits are told.
    also : other SI units whose dimension is taken. auto : the word `auto` stands for None. optional : so does nothing
        at all. off : the word `off` stands for infinite. zero : a word that stands for 0, which no number may.
    """

    unit: str
    low: float
    high: float
    usual: str
    also: tuple[str, ...] = ()
    auto: bool = False
    optional: bool = False
    off: bool = False
    zero: str = ""

    @property
    def words(self) -> dict[str, float | None]:
        """The words that may stand for a value, and the value of each."""
        words: dict[str, float | None] = {"auto": None} if self.auto else {}
        return words | ({"off": math.inf} if self.off else {}) | ({self.zero: 0.0} if self.zero else {})

    def word_for(self, value: float | None) -> str:
        """The word that stands for a value; empty where none does."""
        return next((word for word, meaning in self.words.items() if meaning == value), "")

    def read(self, value: Any) -> float | None:
        """The value in SI."""
        if value is None and (self.optional or self.auto):
            return None
        if isinstance(value, str) and value in self.words:
            return self.words[value]
        if isinstance(value, str):
            number = self._from_text(value)
        elif is_number(value):
            number = as_float(value)
        else:
            raise wrong(f"{shown(value)} is no quantity; write {self._example()}")
        if not self.low <= number <= self.high:
            raise wrong(self._implausible(value, number))
        return number

    def _from_text(self, text: str) -> float:
        try:
            return parse_quantity(text, self.unit, *self.also)
        except UnitError as error:
            word = f"; or write {' or '.join(self.words)}" if self.words else ""
            raise wrong(f"{error}{word}") from None

    def _example(self) -> str:
        words = "".join(f"{word}, or " for word in self.words)
        return f"{words}a number in SI ({self.unit}) or text such as '2.5 {self.usual}'"

    def _implausible(self, value: Any, number: float) -> str:
        limits = f"{self.limit(self.low)} to {self.limit(self.high)}"
        if isinstance(value, str):
            return f"{shown(value, quote=False)} is outside the plausible {limits}"
        text = f"{shown(value)} {self.unit} is outside the plausible {limits}"
        factor = float(parse_unit(self.usual).factor)
        if factor != 1 and self.low <= number * factor <= self.high:
            text += f"; a bare number is in SI ({self.unit}): write '{shown(value)} {self.usual}'"
        return text

    def limit(self, value: float) -> str:
        """A limit as a message tells it, in the usual unit."""
        return format_quantity(value, self.usual)

    def json(self) -> dict[str, Any]:
        """A number in SI within its limits, or text with a unit."""
        units = ", ".join(units_that_fit(self.unit))
        options: list[dict[str, Any]] = [
            {"type": "number", "minimum": self.low, "maximum": self.high, "description": f"{IN_SI}{self.unit}"},
            {"type": "string", "pattern": r"^\s*[+-]?[0-9.]", "description": f"number, space, unit: {units}"},
        ]
        options += [{"const": word} for word in self.words]
        if self.optional or self.auto:
            options.append({"type": "null"})
        return {"anyOf": options}


@dataclass(frozen=True)
class Number(Kind):
    """A number without a unit, from `low` to `high`, both allowed."""

    low: float
    high: float
    optional: bool = False

    def read(self, value: Any) -> float | None:
        """The number."""
        if value is None and self.optional:
            return None
        if isinstance(value, str):
            raise wrong(f"{shown(value)} is text; a plain number from {self.low:g} to {self.high:g} is needed")
        if not is_number(value):
            raise wrong(f"{shown(value)} is no number; a number from {self.low:g} to {self.high:g} is needed")
        number = as_float(value)
        if not self.low <= number <= self.high:
            raise wrong(f"{shown(value)} is out of range; allowed: {self.low:g} to {self.high:g}")
        return number

    def json(self) -> dict[str, Any]:
        """A number within its limits."""
        number = {"type": "number", "minimum": self.low, "maximum": self.high}
        return {"anyOf": [number, {"type": "null"}]} if self.optional else number


@dataclass(frozen=True)
class Whole(Kind):
    """A whole number from `low` to `high`, both allowed."""

    low: int
    high: int

    def read(self, value: Any) -> int:
        """The number."""
        allowed = f"a whole number from {self.low} to {self.high} is needed"
        if isinstance(value, str):
            raise wrong(f"{shown(value)} is text; {allowed}, without quotes")
        if not isinstance(value, numbers.Integral) or isinstance(value, bool):
            raise wrong(f"{shown(value)} is no whole number; {allowed}")
        number = int(value)
        if not self.low <= number <= self.high:
            raise wrong(f"{shown(number)} is out of range; {allowed}")
        return number

    def json(self) -> dict[str, Any]:
        """An integer within its limits."""
        return {"type": "integer", "minimum": self.low, "maximum": self.high}


@dataclass(frozen=True)
class Choice(Kind):
    """One word out of a few. `later`: words that the design knows but that are not built yet."""

    words: tuple[str, ...]
    later: tuple[str, ...] = ()
    optional: bool = False

    def read(self, value: Any) -> str | None:
        """The word."""
        if value is None and self.optional:
            return None
        allowed = f"allowed: {', '.join(self.words)}"
        if isinstance(value, str) and value in self.words:
            return value
        if isinstance(value, str) and value in self.later:
            raise wrong(f"{shown(value)} is not built yet; {allowed}")
        hint = did_you_mean(value, self.words) if isinstance(value, str) else ""
        raise wrong(f"{shown(value)} is not known here; {hint}{allowed}")

    def json(self) -> dict[str, Any]:
        """An enumeration."""
        words = [*self.words, None] if self.optional else list(self.words)
        return {"enum": words} if len(words) > 1 else {"const": words[0]}


@dataclass(frozen=True)
class Flag(Kind):
    """Yes or no: true or false."""

    def read(self, value: Any) -> bool:
        """The flag."""
        if not isinstance(value, bool):
            raise wrong(f"{shown(value)} is neither true nor false")
        return value

    def json(self) -> dict[str, Any]:
        """A boolean."""
        return {"type": "boolean"}


@dataclass(frozen=True)
class Text(Kind):
    """Text that is not empty."""

    what: str
    optional: bool = False

    def read(self, value: Any) -> str | None:
        """The text."""
        if value is None and self.optional:
            return None
        if not isinstance(value, str) or not value.strip():
            raise wrong(f"{shown(value)} is no {self.what}; text is needed")
        return value

    def json(self) -> dict[str, Any]:
        """Text."""
        text = {"type": "string", "minLength": 1}
        return {"anyOf": [text, {"type": "null"}]} if self.optional else text


@dataclass(frozen=True)
class Row(Kind):
    """A short list with a meaning for each item: `[x, y]`, `[time, speed]`."""

    names: tuple[str, ...]
    kinds: tuple[Kind, ...]

    def read(self, value: Any) -> tuple[Any, ...]:
        """The items, each read by its kind."""
        form = f"[{', '.join(self.names)}]"
        if not isinstance(value, list | tuple):
            raise wrong(f"{shown(value)} is no list; {form} is needed")
        if len(value) != len(self.kinds):
            raise wrong(f"has {plural(len(value), 'item')}; {form} is needed")
        faults = Faults()
        row = tuple(
            faults.read((i,), kind.read, item) for i, (kind, item) in enumerate(zip(self.kinds, value, strict=True))
        )
        faults.raise_if_any()
        return row

    def json(self) -> dict[str, Any]:
        """An array of fixed length."""
        return {"type": "array", "prefixItems": [kind.json() for kind in self.kinds], **_exactly(len(self.kinds))}


@dataclass(frozen=True)
class OrNone(Kind):
    """A value of another kind, or nothing."""

    kind: Kind

    def read(self, value: Any) -> Any:
        """The value as its kind reads it."""
        return None if value is None else self.kind.read(value)

    def json(self) -> dict[str, Any]:
        """What its kind takes, or null."""
        return {"anyOf": [self.kind.json(), {"type": "null"}]}


@dataclass(frozen=True)
class Table(Kind):
    """A list of items of one kind; `fewest` to `most` of them."""

    row: Kind
    fewest: int
    most: int
    item: str = "row"
    optional: bool = False

    def read(self, value: Any) -> tuple[Any, ...] | None:
        """The items, each read by its kind."""
        if value is None and self.optional:
            return None
        if not isinstance(value, list | tuple):
            raise wrong(f"{shown(value)} is no list; a list of {self.item}s is needed")
        if not self.fewest <= len(value) <= self.most:
            limit = (
                f"at least {self.fewest} are needed" if len(value) < self.fewest else f"at most {self.most} are allowed"
            )
            raise wrong(f"has {plural(len(value), self.item)}; {limit}")
        faults = Faults()
        rows = tuple(faults.read((i,), self.row.read, item) for i, item in enumerate(value))
        faults.raise_if_any()
        return rows

    def json(self) -> dict[str, Any]:
        """An array of such items."""
        array = {"type": "array", "items": self.row.json(), "minItems": self.fewest, "maxItems": self.most}
        return {"anyOf": [array, {"type": "null"}]} if self.optional else array


def _exactly(count: int) -> dict[str, int]:
    return {"minItems": count, "maxItems": count}


def is_number(value: object) -> bool:
    """Whether a value is a real number; true and false are not."""
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def as_float(value: Any) -> float:
    """A real number as a finite float."""
    try:
        number = float(value)
    except OverflowError:
        raise wrong(f"{shown(value)} is too large a number") from None
    if not math.isfinite(number):
        raise wrong(f"{number} is no finite number")
    return number
