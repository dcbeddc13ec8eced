"""Words for messages: how a value, a path and a choice are shown to the user."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from typing import Any

_LONGEST = 60


def shown(value: Any, *, quote: bool = True) -> str:
    """A value as it may stand in a message: short, on one line, without control characters."""
    if value is None:
        return "nothing"
    if isinstance(value, dict):
        return "a mapping"
    if isinstance(value, list | tuple):
        return "an empty list" if not value else f"a list of {plural(len(value), 'item')}"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int) and abs(value) > 10**_LONGEST:
        return "a whole number of more than 60 digits"
    text = value if isinstance(value, str) else f"{value}"
    if len(text) > _LONGEST:
        text = text[: _LONGEST - 3] + "..."
    escaped = repr(text)
    if isinstance(value, str) and quote:
        return escaped
    return text if text.isprintable() else escaped


def path_text(parts: Iterable[str | int], longest: int = _LONGEST) -> str:
    """Dotted path of a value; a part that cannot be printed as it is, is escaped, and cut if it is too long."""
    return ".".join(_part(str(part), longest) for part in parts)


def _part(part: str, longest: int) -> str:
    if len(part) > longest:
        part = part[: longest - 3] + "..."
    return part if part.isprintable() else repr(part)[1:-1]


def plural(number: int, word: str) -> str:
    """`1 item`, `3 items`."""
    return f"{number} {word}{'' if number == 1 else 's'}"


def nearest(word: str, known: Iterable[str], count: int = 3) -> list[str]:
    """The known words that are most like `word`, best first."""
    by_lower = {name.lower().replace("-", "_"): name for name in known}
    key = word[:100].lower().replace("-", "_").replace(" ", "_")
    close = difflib.get_close_matches(key, by_lower, n=count, cutoff=0.6)
    extended = [name for name in by_lower if len(key) >= 3 and (name.startswith(key) or key in name.split("_"))]
    return [by_lower[name] for name in dict.fromkeys([*close, *extended])][:count]


def did_you_mean(word: str, known: Sequence[str]) -> str:
    """`did you mean 'diameter'? ` or nothing."""
    near = nearest(word, known)
    return f"did you mean {' or '.join(repr(name) for name in near)}? " if near else ""
