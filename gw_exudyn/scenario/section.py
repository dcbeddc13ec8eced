"""The sections of a scenario file: mappings with known keys, on top of pydantic.

`Section` is the base of every part of the file: it refuses unknown keys with the nearest known one, and reports
everything that is wrong with it at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, NoReturn

from pydantic import (
    BaseModel,
    ConfigDict,
    GetCoreSchemaHandler,
    ModelWrapValidatorHandler,
    ValidationError,
    model_validator,
)
from pydantic_core import core_schema

from gw_exudyn.scenario.faults import Faults, Loc, refuse, wrong
from gw_exudyn.scenario.fields import Choice, Quantity
from gw_exudyn.scenario.words import did_you_mean, nearest, shown

KIND_TAG = "kind="
"""Pydantic puts the tag of a union into the place of an error; ours begin with this, to be taken out again."""


class Section(BaseModel):
    """A part of the scenario: a mapping with known keys. Frozen; unknown keys are refused."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    what: ClassVar[str] = "section"
    """What the section is, for the message when something else stands in its place."""

    @model_validator(mode="wrap")
    @classmethod
    def _in_our_words(cls, data: Any, handler: ModelWrapValidatorHandler[Any]) -> Any:
        try:
            return handler(data)
        except ValidationError as error:
            raise_in_our_words(cls, data, error)

    def to_plain(self) -> dict[str, Any]:
        """The section as a scenario file could hold it: SI numbers, text and lists only. What is None is left out, or
        the word for it (`auto`, `off`).
        """
        plain: dict[str, Any] = {}
        for name, info in type(self).model_fields.items():
            value = getattr(self, name)
            word = next((kind.word_for(value) for kind in info.metadata if isinstance(kind, Quantity)), "")
            if value is not None or word:
                plain[info.alias or name] = word or to_plain(value)
        return plain


@dataclass(frozen=True)
class Form:
    """Lets a field hold one thing while a file gives it in a form of its own, whose `resolve()` makes the thing.

    form : type of what a file holds. resolved : classes that are taken as they are. check : called first with the raw
        value, raises.
    """

    form: Any
    resolved: tuple[type, ...]
    check: Callable[[Any], None] | None = None

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        """Pydantic's hook: read the form, then resolve it."""

        def read(value: Any, form: core_schema.ValidatorFunctionWrapHandler) -> Any:
            if isinstance(value, self.resolved):
                return value
            if self.check is not None:
                self.check(value)
            found = form(value)
            return found if isinstance(found, self.resolved) else found.resolve()

        return core_schema.no_info_wrap_validator_function(read, handler.generate_schema(self.form))


def kind_tag(value: Any) -> str:
    """The tag of a value in a union of kinds, by its key or field `kind`."""
    kind = value.get("kind") if isinstance(value, dict) else getattr(value, "kind", None)
    return f"{KIND_TAG}{kind}"


def check_kind(value: Any, kinds: Choice, what: str) -> None:
    """Check that a raw value is a mapping of a known kind, first of all: the kind says what the other keys mean.
    what : its name, for the message. Raises what `wrong` makes, or a ValidationError.
    """
    allowed = ", ".join(kinds.words)
    if not isinstance(value, dict):
        found = f"is empty; a {what} is needed" if value is None else f"{shown(value)} stands where a {what} is needed"
        raise wrong(f"{found}: lines of 'key: value', the first kind: {allowed.replace(', ', ' | ')}")
    if "kind" not in value:
        refuse(("kind",), wrong(f"is missing: what the {what} is; allowed: {allowed}", missing=True))
    faults = Faults()
    faults.read(("kind",), kinds.read, value["kind"])
    faults.raise_if_any()


def to_plain(value: Any) -> Any:
    """A value of a section as plain data."""
    if isinstance(value, Section):
        return value.to_plain()
    if isinstance(value, list | tuple):
        return [to_plain(item) for item in value]
    return value


def raise_in_our_words(cls: type[Section], data: Any, error: ValidationError) -> NoReturn:
    """Raise the same faults again, pydantic's own sentences about the keys of `cls` replaced by ours."""
    all_details = error.errors(include_url=False)
    keys = {info.alias or name: info for name, info in cls.model_fields.items()}
    unknown = [str(d["loc"][0]) for d in all_details if d["type"] == "extra_forbidden" and len(d["loc"]) == 1]
    absent = [key for key in keys if not isinstance(data, dict) or key not in data]
    misspelt = {did[0] for key in unknown if (did := nearest(key, absent, count=1))}
    faults = Faults()
    for details in all_details:
        kind, loc = details["type"], details["loc"]
        ours = details.get("ctx", {}) if kind.startswith("scenario") else {}
        missing = kind in ("missing", "scenario_missing")
        if missing and len(loc) == 1 and not misspelt.isdisjoint((loc[0], *ours.get("instead", ()))):
            continue  # the misspelt key is the one mistake; that its right name is absent is no second one
        text = ours["text"] if ours else _sentence(cls, kind, loc, data, details)
        faults.add(loc, wrong(text, missing=missing, file=ours.get("file"), line=ours.get("line")), details["input"])
    faults.raise_if_any()
    raise error


def _sentence(cls: type[Section], kind: str, loc: Loc, data: Any, details: Any) -> str:
    keys = {info.alias or name: info for name, info in cls.model_fields.items()}
    if kind == "extra_forbidden":
        # A key that is already there cannot be meant, unless nothing else comes near.
        absent = [key for key in keys if key not in data]
        hint = did_you_mean(str(loc[-1]), absent) or did_you_mean(str(loc[-1]), list(keys))
        return f"unknown key; {hint}allowed: {', '.join(keys)}"
    if kind == "missing" and len(loc) == 1:
        info = keys[str(loc[0])]
        example = f"; for example {loc[0]}: {info.examples[0]}" if info.examples else ""
        return f"is missing: {info.description}{example}"
    if kind in ("model_type", "model_attributes_type", "dict_type"):
        found = details["input"]
        start = "is empty;" if found is None else f"{shown(found)} stands where"
        return f"{start} {cls.what} is needed: lines of 'key: value' with {', '.join(keys)}"
    if kind in ("tuple_type", "list_type"):
        return f"{shown(details['input'])} is no list; a list is needed"
    return str(details["msg"])
