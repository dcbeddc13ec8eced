"""What is wrong with a value: one sentence, or all sentences about its parts at once, on top of pydantic."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NoReturn

from pydantic import ValidationError
from pydantic_core import InitErrorDetails, PydanticCustomError

Loc = tuple[str | int, ...]


def wrong(
    message: str,
    *,
    missing: bool = False,
    instead: tuple[str, ...] = (),
    file: str | None = None,
    line: int | None = None,
) -> PydanticCustomError:
    """The error to raise for one value.

    missing : the value is not there. instead : other keys that would do; if one of them is there but misspelt, that is
    the one mistake, and this error is dropped. file, line : only if they are not those of the value (of a CSV file).
    """
    context = {"text": message, "instead": instead, "file": file, "line": line}
    return PydanticCustomError("scenario_missing" if missing else "scenario", "{text}", context)


class Faults:
    """Collects what is wrong with the parts of a value, to raise all of it at once."""

    def __init__(self) -> None:
        self._details: list[InitErrorDetails] = []

    def add(self, loc: Loc, error: PydanticCustomError | str, value: object = None) -> None:
        """Note a fault at the place `loc`, relative to the value."""
        kind = wrong(error) if isinstance(error, str) else error
        self._details.append(InitErrorDetails(type=kind, loc=loc, input=value))

    def read(self, loc: Loc, reader: Callable[[Any], Any], value: object) -> Any:
        """`reader(value)`, or None and a note of what is wrong."""
        try:
            return reader(value)
        except PydanticCustomError as error:
            self.add(loc, error, value)
        except ValidationError as error:
            for details in error.errors(include_url=False):
                context = details.get("ctx", {})
                inner = wrong(context.get("text", details["msg"]), file=context.get("file"), line=context.get("line"))
                self.add((*loc, *details["loc"]), inner, details["input"])
        return None

    def raise_if_any(self) -> None:
        """Raise everything noted, if anything was."""
        if self._details:
            raise ValidationError.from_exception_data("scenario", self._details)


def refuse(loc: Loc, error: PydanticCustomError | str) -> NoReturn:
    """Raise the one fault of a value, at the place `loc` in it."""
    kind = wrong(error) if isinstance(error, str) else error
    raise ValidationError.from_exception_data("scenario", [InitErrorDetails(type=kind, loc=loc, input=None)])
