"""What may stand at a dotted path of a scenario: a number and in which unit, a whole number, or something else."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from gw_exudyn.scenario.fields import IN_SI
from gw_exudyn.scenario.schema import json_schema
from gw_exudyn.scenario.words import did_you_mean

Node = Mapping[str, Any]


@dataclass(frozen=True)
class ValueKind:
    """unit : in SI, `1` for a pure number; None where there are words or lists. whole : whole numbers only."""

    unit: str | None
    whole: bool = False


def value_kind(path: str) -> ValueKind:
    """What may stand at a path. Raises LookupError, with a sentence, for a path that no scenario has."""
    nodes: list[Node] = [_schema()]
    reached = ""
    for part in path.split("."):
        options = [option for node in nodes for option in _options(node)]
        nodes = [child for option in options for child in _children(option, part)]
        if not nodes:
            known = sorted({key for option in options for key in option.get("properties", {})})
            listed = any("items" in option or "prefixItems" in option for option in options)
            parts = f"{reached} is a list; give an item's number, from 0" if listed else f"{reached} has no parts"
            allowed = f"allowed there: {', '.join(known)}" if known else parts
            raise LookupError(f"no scenario has this value; {did_you_mean(part, known)}{allowed}")
        reached = f"{reached}.{part}".lstrip(".")
    return _kind([option for node in nodes for option in _options(node)])


@cache  # the schema of a program does not change
def _schema() -> Node:
    return json_schema()


def _options(node: Node) -> Iterator[Node]:
    """The node with its references followed and its alternatives taken apart."""
    if "$ref" in node:
        yield from _options(_schema()["$defs"][node["$ref"].rpartition("/")[2]])
        return
    alternatives = [*node.get("anyOf", ()), *node.get("oneOf", ()), *node.get("allOf", ())]
    if not alternatives:
        yield node
    for alternative in alternatives:
        yield from _options(alternative)


def _children(node: Node, part: str) -> Iterator[Node]:
    if part in node.get("properties", {}):
        yield node["properties"][part]
    items = node.get("items")
    if part.isascii() and part.isdigit():
        fixed = node.get("prefixItems", ())
        if int(part) < len(fixed):
            yield fixed[int(part)]
        elif isinstance(items, Mapping):
            yield items
    elif isinstance(items, Mapping) and any("name" in option.get("properties", {}) for option in _options(items)):
        yield items  # an item by its name; whether there is one of that name is for the scenario to say


def _kind(options: list[Node]) -> ValueKind:
    for option in options:
        if option.get("type") == "integer":
            return ValueKind("1", whole=True)
        if option.get("type") == "number":
            told = str(option.get("description", ""))
            return ValueKind(told.removeprefix(IN_SI) if told.startswith(IN_SI) else "1")
    return ValueKind(None)
