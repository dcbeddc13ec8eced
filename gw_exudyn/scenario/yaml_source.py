"""Strict reading of YAML: plain data, the line of every value, and no surprises.

YAML is read by its events rather than by PyYAML's own constructor, because that constructor loads `1e-3` as text,
`no` as False, `1_000` and `1:30` as numbers, lets the second of two equal keys win, and follows aliases that grow
without bound. Here a plain scalar is a number, `true`, `false`, `null` or text, by the rules of YAML 1.2, and
everything beyond plain mappings, lists and scalars is refused. Size, depth and count are bounded.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from gw_exudyn.errors import Problem, ScenarioError
from gw_exudyn.scenario.words import path_text, shown

Place = tuple[str, int | None]
"""Where a value stands: file (or `--set path`) and line."""

LARGEST = 1_000_000
"""Bytes of a YAML file; long tables belong in a CSV file."""

_DEEPEST = 20
_MOST_NODES = 50_000
_LONGEST_INTEGER = 300  # digits; beyond, even a float cannot hold it

_INTEGER = re.compile(r"[-+]?(?:0|[1-9][0-9]*)")
_FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|(?:0|[1-9][0-9]*)(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
_NOT_FINITE = re.compile(r"[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)")
_WORDS = {"": None, "~": None, "null": None, "Null": None, "NULL": None}
_WORDS_BOOL = {"true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False}

# What PyYAML says, and what we say instead: by a piece of its text.
_SYNTAX = (
    (
        "mapping values are not allowed",
        "a ':' where none may be; check the indentation, and quote text that contains ': '",
    ),
    ("could not find expected ':'", "a key without ':' after it; write 'key: value'"),
    ("found character '\\t'", "a tab where a value or a key begins; use spaces"),
    ("cannot start any token", "this character cannot begin a value; put the text in quotes"),
    ("expected <block end>", "the indentation does not fit the lines above; indent with the same number of spaces"),
    ("expected ',' or ']'", "a list [...] is not closed, or a ',' is missing in it"),
    ("expected ',' or '}'", "a mapping {...} is not closed, or a ',' is missing in it"),
    ("while scanning a quoted scalar", "a quoted text is not closed"),
    ("expected the node content", "a value is missing, or a bracket is not closed"),
    ("end of stream", "the text ends early"),
)


@dataclass
class YamlSource:
    """What a YAML file says.

    data : its top-level mapping, as plain dict, list, str, int, float, bool and None.
    places : file and line of every value by its dotted path; list items as `points.0`.
    problems : what is wrong with the text itself but does not stop the reading (keys given twice, aliases, .nan).
    """

    data: dict[str, Any]
    places: dict[str, Place] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)


def read_yaml(path: Path) -> YamlSource:
    """Read a YAML file whose top level is a mapping. Raises ScenarioError if there is nothing to go on with."""
    return parse_yaml(read_text(path, LARGEST), str(path))


def read_text(path: Path, largest: int) -> str:
    """The UTF-8 text of a file of at most `largest` bytes, with or without a byte order mark. Raises ScenarioError."""
    name = str(path)
    try:
        with open(path, "rb") as stream:
            raw = stream.read(largest + 1)
    except FileNotFoundError:
        raise ScenarioError(Problem("", "there is no such file", name)) from None
    except IsADirectoryError:
        raise ScenarioError(Problem("", "is a folder; a file is needed", name)) from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise ScenarioError(Problem("", f"cannot be read: {reason}", name)) from None
    if len(raw) > largest:
        raise ScenarioError(Problem("", f"is larger than {largest / 1e6:g} MB, which no scenario needs", name))
    return _decoded(raw, name)


def _decoded(raw: bytes, name: str) -> str:
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise ScenarioError(Problem("", "is UTF-16 text; save it as UTF-8", name))
    if b"\0" in raw:
        line = raw.count(b"\n", 0, raw.index(b"\0")) + 1
        raise ScenarioError(Problem("", "is a binary file, not text", name, line))
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        message = f"is not UTF-8 text (byte 0x{raw[error.start]:02x}); save it as UTF-8"
        raise ScenarioError(Problem("", message, name, line)) from None


def parse_yaml(text: str, file: str) -> YamlSource:
    """Read YAML text whose top level is a mapping; `file` names it in problems and places."""
    builder = _built(text, file)
    if builder.root is None and not builder.problems:
        raise ScenarioError(Problem("", "is empty; a scenario needs at least wire, vessel, catheter and drive", file))
    if not isinstance(builder.root, dict):
        message = f"holds {shown(builder.root)} at its top level; lines of 'key: value' are needed"
        raise ScenarioError([*builder.problems, Problem("", message, file, 1)])
    return YamlSource(builder.root, {"": (file, None), **builder.places}, builder.problems)


def parse_value(text: str, place: str, path: str = "") -> Any:
    """Read one value as YAML would (`3`, `0.4`, `2 mm/s`, `[0 mm, 1 mm]`), for overrides. Raises ScenarioError at
    `place`.
    """
    try:
        builder = _built(text, place)
        problems = builder.problems
    except ScenarioError as error:
        problems = list(error.problems)
    if problems:
        raise ScenarioError([Problem(path, problem.message, place) for problem in problems])
    return builder.root


def _built(text: str, file: str) -> _Builder:
    tabs = [
        n
        for n, line in enumerate(text.splitlines(), 1)
        if "\t" in line[: len(line) - len(line.lstrip())] and line.strip()
    ]
    if tabs:
        message = "a tab in the indentation; YAML indents with spaces"
        raise ScenarioError([Problem("", message, file, line) for line in tabs[:10]])
    builder = _Builder(file)
    try:
        for event in _events(text):
            builder.take(event)
    except yaml.MarkedYAMLError as error:
        raise ScenarioError([*builder.problems, _syntax_problem(error, file)]) from None
    except yaml.reader.ReaderError as error:
        line = text.count("\n", 0, error.position) + 1
        message = f"holds the character {error.character:#04x}, which text files do not have"
        raise ScenarioError([*builder.problems, Problem("", message, file, line)]) from None
    return builder


def _events(text: str) -> Iterator[Any]:
    yield from yaml.parse(text, Loader=yaml.SafeLoader)


def _syntax_problem(error: yaml.MarkedYAMLError, file: str) -> Problem:
    said = f"{error.context or ''} {error.problem or ''}".strip()
    mark = error.problem_mark or error.context_mark
    if "while scanning a quoted scalar" in said and error.context_mark is not None:
        mark = error.context_mark  # where the quote opens helps more than where the file ends
    remedy = next((ours for theirs, ours in _SYNTAX if theirs in said), said)
    return Problem("", f"not valid YAML: {remedy}", file, mark.line + 1 if mark else None)


@dataclass
class _Open:
    """A mapping or list that is being filled."""

    items: dict[str, Any] | list[Any]
    path: tuple[str, ...]
    key: str | None = None
    key_lines: dict[str, int] = field(default_factory=dict)
    again: bool = False
    """The key is one that this mapping already has: its value is read but not kept."""


class _Builder:
    """Builds plain data from YAML events, with an explicit stack so that depth is bounded by us and not by Python's."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.root: Any = None
        self.places: dict[str, Place] = {}
        self.problems: list[Problem] = []
        self._stack: list[_Open] = []
        self._nodes = 0
        self._documents = 0

    def take(self, event: Any) -> None:
        """Take the next event."""
        line = event.start_mark.line + 1
        if isinstance(event, yaml.DocumentStartEvent):
            self._documents += 1
            if self._documents > 1:
                raise self._fatal("", "a second document begins here ('---'); one file holds one scenario", line)
        elif isinstance(event, yaml.AliasEvent):
            self._refuse_key(line)
            self._complain(line, f"alias '*{event.anchor}' is not supported; write the value out")
            self._keep(None, line)
        elif isinstance(event, yaml.ScalarEvent):
            self._scalar(event, line)
        elif isinstance(event, yaml.CollectionStartEvent):
            self._collection(event, line)
        elif isinstance(event, yaml.CollectionEndEvent):
            self._stack.pop()

    def _scalar(self, event: Any, line: int) -> None:
        top = self._stack[-1] if self._stack else None
        if top is not None and isinstance(top.items, dict) and top.key is None:
            self._key(top, event, line)
            return
        self._check_node(event, line)
        self._keep(self._plain(event.value, line) if event.style is None else event.value, line)

    def _key(self, top: _Open, event: Any, line: int) -> None:
        key = event.value
        if not key:
            raise self._fatal(path_text(top.path), "a key is missing before ':'", line)
        top.key, top.again = key, key in top.key_lines
        if top.again:
            first = top.key_lines[key]
            message = f"is given twice, in lines {first} and {line}; remove one"
            self.problems.append(Problem(path_text((*top.path, key)), message, self.file, line))
        else:
            top.key_lines[key] = line

    def _collection(self, event: Any, line: int) -> None:
        self._refuse_key(line)
        self._check_node(event, line)
        if len(self._stack) >= _DEEPEST:
            raise self._fatal(path_text(self._path()[:4]), f"is nested deeper than {_DEEPEST} levels", line)
        items: dict[str, Any] | list[Any] = {} if isinstance(event, yaml.MappingStartEvent) else []
        path = self._path()
        self._keep(items, line)
        self._stack.append(_Open(items, path))

    def _refuse_key(self, line: int) -> None:
        top = self._stack[-1] if self._stack else None
        if top is not None and isinstance(top.items, dict) and top.key is None:
            raise self._fatal(path_text(top.path), "a key must be plain text", line)

    def _check_node(self, event: Any, line: int) -> None:
        self._nodes += 1
        if self._nodes > _MOST_NODES:
            raise self._fatal("", f"holds more than {_MOST_NODES} values; put long tables in a CSV file", line)
        if event.anchor is not None:
            self._complain(
                line, f"anchor '&{event.anchor}' is not supported; write the value out wherever it is needed"
            )
        if event.tag is not None:
            self._complain(line, f"tag {shown(event.tag)} is not supported; write plain values")

    def _plain(self, text: str, line: int) -> Any:
        """The value of an unquoted scalar, by YAML 1.2's core rules."""
        if text in _WORDS:
            return _WORDS[text]
        if text in _WORDS_BOOL:
            return _WORDS_BOOL[text]
        if _INTEGER.fullmatch(text) and len(text) <= _LONGEST_INTEGER:
            return int(text)
        if _FLOAT.fullmatch(text):
            value = float(text)
            if value in (float("inf"), float("-inf")):
                self._complain(line, f"{shown(text, quote=False)} is too large a number")
            return value
        if _NOT_FINITE.fullmatch(text):
            self._complain(line, f"{text} is no finite number")
            return float(text.replace(".", "", 1))
        return text

    def _keep(self, value: Any, line: int) -> None:
        """Put a value where it belongs: under the open key, at the end of the open list, or at the top."""
        path = self._path()
        top = self._stack[-1] if self._stack else None
        if top is None:
            self.root = value
        elif isinstance(top.items, list):
            self.places.setdefault(path_text(path), (self.file, line))
            top.items.append(value)
        elif top.key is not None:
            self.places.setdefault(path_text(path), (self.file, top.key_lines[top.key]))
            if not top.again:
                top.items[top.key] = value
            top.key = None

    def _path(self) -> tuple[str, ...]:
        """Path of the value that comes next."""
        if not self._stack:
            return ()
        top = self._stack[-1]
        return (*top.path, str(len(top.items)) if isinstance(top.items, list) else str(top.key))

    def _complain(self, line: int, message: str) -> None:
        self.problems.append(Problem(path_text(self._path()), message, self.file, line))

    def _fatal(self, path: str, message: str, line: int) -> ScenarioError:
        return ScenarioError([*self.problems, Problem(path, message, self.file, line)])
