"""Overrides by dotted path, `wire.segments=100`: put into the raw data before it is checked, so that they are checked
as it is.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from gw_exudyn.errors import Problem, ScenarioError, UsageError
from gw_exudyn.scenario.words import path_text, plural, shown
from gw_exudyn.scenario.yaml_source import YamlSource, parse_value

Overrides = Mapping[str, Any] | Sequence[str]
"""Dotted paths with their values, or texts `path=value` whose value is read as YAML."""

OVERRIDE = "override "
"""What the place of an override of a mapping begins with; its path follows."""

_DEEPEST = 20


def apply_overrides(source: YamlSource, overrides: Overrides, resolved: Callable[[], dict[str, Any]]) -> None:
    """Put overrides into the data of a file; what is wrong with them is added to its problems.

    Parameters
    ----------
    source : what the file says; changed.
    overrides : as `load_scenario` takes them.
    resolved : gives the complete scenario as plain data, for an override of an item of a list that the file leaves to
        its default or to the catalogue. Raises ScenarioError if there is no such thing.
    """
    for path, place, read in _read(overrides):
        try:
            _set(source, path, read(), place, resolved)
        except ScenarioError as error:
            source.problems.extend(error.problems)


def _read(overrides: Overrides) -> list[tuple[str, str, Callable[[], Any]]]:
    """Path, place and a function that gives the value, of every override."""
    if isinstance(overrides, Mapping):
        return [_given(str(path), value) for path, value in overrides.items()]
    if isinstance(overrides, str):
        overrides = [overrides]
    return [split_override(text) for text in overrides]


def _given(path: str, value: Any) -> tuple[str, str, Callable[[], Any]]:
    return path, f"{OVERRIDE}{path_text([path])}", lambda: copy.deepcopy(value)


def split_override(text: str) -> tuple[str, str, Callable[[], Any]]:
    """Path, place for messages, and a function that reads the value, of a text `path=value`. Raises UsageError for
    another text; the function raises ScenarioError.
    """
    path, equals, value = text.partition("=")
    path = path.strip()
    place = f"--set {path_text([path])}"
    if not equals or not path:
        raise UsageError(f"--set: {shown(text)} is no override; write path=value, as wire.segments=100")
    return path, place, lambda: parse_value(value.strip(), place, path_text([path]))


def _set(source: YamlSource, path: str, value: Any, place: str, resolved: Callable[[], dict[str, Any]]) -> None:
    parts = path.split(".")
    if not all(parts) or len(parts) > _DEEPEST:
        raise ScenarioError(
            Problem(path_text([path]), "is no dotted path; write it as wire.segments or vessel.points.0", place)
        )
    node: Any = source.data
    for depth in range(len(parts) - 1):
        node = _step(source, node, parts, depth, place, resolved)
    node[_key(node, parts, len(parts) - 1, place)] = value
    dotted = path_text(parts)
    for known in [known for known in source.places if _within(known, dotted)]:
        del source.places[known]
    source.problems[:] = [
        problem for problem in source.problems if not problem.path or not _within(problem.path, dotted)
    ]
    source.places[dotted] = (place, None)


def _within(path: str, parent: str) -> bool:
    return path == parent or path.startswith(parent + ".")


def _step(
    source: YamlSource, node: Any, parts: list[str], depth: int, place: str, resolved: Callable[[], dict[str, Any]]
) -> Any:
    """What lies at parts[depth] inside `node`; made if a mapping lacks it."""
    key = _key(node, parts, depth, place)
    if isinstance(node, dict) and node.get(key) is None:
        # The file does not have it: a new mapping, or, to set an item of a list, the list that a complete scenario
        # has there.
        node[key] = _default_list(parts, depth, place, resolved) if _is_index(parts[depth + 1]) else {}
        source.places.setdefault(path_text(parts[: depth + 1]), (place, None))
    return node[key]


def _key(node: Any, parts: list[str], depth: int, place: str) -> Any:
    """parts[depth] as a key or an index of `node`, checked."""
    part, path, parent = parts[depth], path_text(parts), path_text(parts[:depth])
    if isinstance(node, dict):
        return part
    if not isinstance(node, list):
        raise ScenarioError(
            Problem(path, f"{parent} is {shown(node)}, a single value; there is no {shown(part)} in it", place)
        )
    if not node:
        raise ScenarioError(Problem(path, f"{parent} is an empty list; set it as a whole", place))
    names = [item.get("name") if isinstance(item, dict) else None for item in node]
    if part in names:
        parts[depth] = str(names.index(part))  # so that it is the item's own place in what follows
        return int(parts[depth])
    if not _is_index(part) or len(part) > 9 or int(part) >= len(node):
        known = ", ".join(name for name in names if isinstance(name, str))
        allowed = (
            f"{parent} has {plural(len(node), 'item')}, 0 to {len(node) - 1}{f', or by name {known}' if known else ''}"
        )
        raise ScenarioError(Problem(path, f"there is no item {shown(part)}; {allowed}", place))
    return int(part)


def _is_index(part: str) -> bool:
    return part.isascii() and part.isdigit()


def _default_list(parts: list[str], depth: int, place: str, resolved: Callable[[], dict[str, Any]]) -> Any:
    """The list at parts[:depth + 1] of the complete scenario."""
    try:
        node: Any = resolved()
        for part in parts[: depth + 1]:
            node = node[int(part) if isinstance(node, list) else part]
    except (ScenarioError, LookupError, ValueError, TypeError):
        node = None
    if isinstance(node, list):
        return node
    parent = path_text(parts[: depth + 1])
    raise ScenarioError(Problem(path_text(parts), f"{parent} is no list in the file; set {parent} as a whole", place))
