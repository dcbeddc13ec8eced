"""The axes of a study: for one dotted path of the scenario, the values that it takes or the distribution it has."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic_core import PydanticCustomError

from gw_exudyn.errors import UnitError
from gw_exudyn.result import Floats
from gw_exudyn.scenario.catalogue import catalogue_names
from gw_exudyn.scenario.faults import Faults, wrong
from gw_exudyn.scenario.fields import as_float, is_number
from gw_exudyn.scenario.units import parse_quantity
from gw_exudyn.scenario.words import did_you_mean, shown
from gw_exudyn.sweep.studies.distributions import FORMS, Distribution, describe, is_pure
from gw_exudyn.sweep.studies.value_kinds import ValueKind, value_kind

MOST_VALUES = 100_000
SPACED = ("linspace", "logspace")
CATALOGUE = "catalogue"
"""The word that stands for all wires of the catalogue as values of wire.model."""


@dataclass(frozen=True)
class Axis:
    """One parameter of a study.

    path : dotted, in the scenario. unit : in SI, `1` for a pure number; None where the values are no numbers.
    values : as a scenario takes them; empty for a distribution. labels : the same as coordinates: floats in SI, or
    text where there is no unit. lines : item of the list in the file, where the values are one; else empty.
    """

    path: str
    unit: str | None
    values: tuple[Any, ...] = ()
    labels: tuple[float | str, ...] = ()
    distribution: Distribution | None = None
    whole: bool = False
    listed: str = ""
    """Path in the study file of the list that holds the values one by one; empty if they do not stand there."""

    def drawn(self, probability: Floats) -> list[tuple[Any, float | str]]:
        """Value and coordinate at each of the probabilities (k,), 0 to 1: quantiles of the distribution, or the values
        with equal shares.
        """
        if self.distribution is None:
            count = len(self.values)
            picked = [min(int(u * count), count - 1) for u in probability]
            return [(self.values[i], self.labels[i]) for i in picked]
        values = self.distribution.quantile(probability)
        if self.whole:
            return [(round(float(value)), float(round(float(value)))) for value in values]
        return [(float(value), float(value)) for value in values]


def read_axis(path: str, raw: Any) -> Axis:
    """The axis of a path, from what stands behind it in `vary`. Raises ValidationError with all that is wrong."""
    faults = Faults()
    kind = faults.read((), _known, path)
    axis = _read(path, raw, kind, faults) if kind is not None else None
    faults.raise_if_any()
    if axis is None:
        raise wrong("is no axis")
    return axis


def axis_schema() -> dict[str, Any]:
    """JSON schema of what may stand behind a path in `vary`."""
    number = {"type": ["number", "string"]}

    def form(name: str, inner: Mapping[str, Any], *further: tuple[str, Mapping[str, Any]]) -> dict[str, Any]:
        properties = {name: inner, **dict(further)}
        return {"type": "object", "properties": properties, "required": [name], "additionalProperties": False}

    def row(*items: Mapping[str, Any]) -> dict[str, Any]:
        return {"type": "array", "prefixItems": list(items), "minItems": len(items), "maxItems": len(items)}

    listed = {"type": "array", "minItems": 1, "maxItems": MOST_VALUES}
    forms = [form("values", listed, ("labels", {"type": "array", "items": {"type": "string"}}))]
    forms += [form(name, row(number, number, {"type": "integer", "minimum": 1})) for name in SPACED]
    ends = (("low", number), ("high", number))
    forms += [
        form(name, {**row(*(number for _ in words)), "description": describe(name)}, *ends)
        for name, words in FORMS.items()
    ]
    return {"anyOf": [listed, {"const": CATALOGUE}, *forms]}


def _known(path: str) -> ValueKind:
    try:
        return value_kind(path)
    except LookupError as error:
        raise wrong(str(error)) from None


def _read(path: str, raw: Any, kind: ValueKind, faults: Faults) -> Axis | None:
    if raw == CATALOGUE and path == "wire.model":
        return Axis(path, None, catalogue_names(), catalogue_names())
    if isinstance(raw, list):
        return _listed(path, raw, None, kind, faults, ())
    if not isinstance(raw, Mapping):
        faults.add((), f"{shown(raw)} is neither a list of values nor one of {_forms()}")
        return None
    forms = [key for key in raw if key in ("values", *SPACED, *FORMS)]
    if len(forms) != 1:
        unknown = next((str(key) for key in raw if key not in forms), "")
        faults.add((), f"{did_you_mean(unknown, ['values', *SPACED, *FORMS])}one of these is needed: {_forms()}")
        return None
    form = forms[0]
    further = {"values": ("labels",), "linspace": (), "logspace": ()}.get(form, ("low", "high"))
    for key in raw:
        if key != form and key not in further:
            faults.add((key,), f"unknown key beside {form}; allowed: {', '.join(further) or 'nothing'}")
    if form == "values":
        return _listed(path, raw[form], raw.get("labels"), kind, faults, (form,))
    if kind.unit is None:
        faults.add((form,), f"{path} is no number; give a list of values")
        return None
    if form in SPACED:
        return _spaced(path, form, raw[form], kind, faults)
    return _distributed(path, form, raw, kind, faults)


def _forms() -> str:
    spaced = [f"{{{form}: [first, last, count]}}" for form in SPACED]
    return ", ".join(["[value, ...]", "{values: [...], labels: [...]}", *spaced, *map(describe, FORMS)])


def _listed(path: str, raw: Any, labels: Any, kind: ValueKind, faults: Faults, loc: tuple[str, ...]) -> Axis | None:
    if not isinstance(raw, list) or not 1 <= len(raw) <= MOST_VALUES:
        faults.add(loc, f"{shown(raw)}; a list of 1 to {MOST_VALUES} values is needed")
        return None
    listed = ".".join(("vary", path, *loc))
    if labels is not None:
        if not isinstance(labels, list) or len(labels) != len(raw) or not all(isinstance(x, str) for x in labels):
            faults.add(("labels",), f"a list of {len(raw)} texts is needed, one for each value")
            return None
        return Axis(path, None, tuple(raw), tuple(labels), listed=listed)
    numbers = [_number(value, kind) for value in raw]
    if all(number is not None for number in numbers):
        return Axis(path, kind.unit, tuple(raw), tuple(n for n in numbers if n is not None), listed=listed)
    return Axis(path, None, tuple(raw), tuple(_label(value, i) for i, value in enumerate(raw)), listed=listed)


def _number(value: Any, kind: ValueKind) -> float | None:
    """The value in SI, or None where it is no number of this kind; the scenario's own checks say what is wrong."""
    if kind.unit is None:
        return None
    try:
        if isinstance(value, str):
            return None if kind.unit == "1" else parse_quantity(value, kind.unit)
        return as_float(value) if is_number(value) else None
    except (UnitError, PydanticCustomError):
        return None


def _label(value: Any, index: int) -> str:
    """Words for a value that is no number: itself, or its place in the list where it is a mapping or a list."""
    return f"#{index}" if isinstance(value, list | dict) else str(value)


def read_number(value: Any, unit: str) -> float:
    """A number or a quantity, in SI. Raises what `wrong` makes."""
    if is_number(value):
        return as_float(value)
    if not isinstance(value, str) or unit == "1":
        raise wrong(f"{shown(value)} is no {'number' if unit == '1' else 'quantity'}")
    try:
        return parse_quantity(value, unit)
    except UnitError as error:
        raise wrong(str(error)) from None


def _spaced(path: str, form: str, raw: Any, kind: ValueKind, faults: Faults) -> Axis | None:
    if not isinstance(raw, list) or len(raw) != 3:
        faults.add((form,), f"{shown(raw)}; [first, last, count] is needed")
        return None
    unit = kind.unit or "1"
    first, last = (faults.read((form, i), lambda value: read_number(value, unit), raw[i]) for i in range(2))
    count = raw[2]
    if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= MOST_VALUES:
        faults.add((form, 2), f"{shown(count)} is no count; a whole number from 1 to {MOST_VALUES} is needed")
        return None
    if first is None or last is None:
        return None
    if form == "logspace" and not (first > 0 and last > 0):
        faults.add((form,), "both ends must be positive; they are the first and last value, not their logarithms")
        return None
    spaced = (np.linspace if form == "linspace" else np.geomspace)(first, last, count)
    # 0.3 and not 0.30000000000000004, so that a person can ask the data set for it.
    values = [round(float(x)) if kind.whole else float(f"{x:.12g}") for x in spaced]
    return Axis(path, kind.unit, tuple(values), tuple(float(x) for x in values))


def _distributed(path: str, form: str, raw: Mapping[str, Any], kind: ValueKind, faults: Faults) -> Axis | None:
    numbers, unit = raw[form], kind.unit or "1"
    if not isinstance(numbers, list) or len(numbers) != len(FORMS[form]):
        faults.add((form,), f"{shown(numbers)}; {describe(form)} is needed")
        return None

    def read(loc: Sequence[str | int], value: Any, pure: bool = False) -> float | None:
        found: float | None = faults.read(tuple(loc), lambda text: read_number(text, "1" if pure else unit), value)
        return found

    found = [read((form, i), value, is_pure(form, i)) for i, value in enumerate(numbers)]
    low, high = (None if raw.get(end) is None else read((end,), raw[end]) for end in ("low", "high"))
    if any(number is None for number in found):
        return None
    distribution = Distribution(form, tuple(x for x in found if x is not None), low, high)
    fault = distribution.fault()
    if fault is not None:
        faults.add((form,), fault)
        return None
    return Axis(path, kind.unit, distribution=distribution, whole=kind.whole)
