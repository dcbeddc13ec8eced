"""A vessel in a file of its own, which several scenarios share: put in its place before anything else is read.

So overrides reach into it, its mistakes are told with its own file and line, and the resolved scenario holds it whole.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from gw_exudyn.errors import Problem, ScenarioError
from gw_exudyn.scenario.words import did_you_mean, shown
from gw_exudyn.scenario.yaml_source import YamlSource, read_yaml

KIND = "file"


def insert_vessel(source: YamlSource, folder: Path) -> None:
    """Replace `vessel: {kind: file, file: vessels/phantom.yaml}` by what that file holds. Changes `source`; what is
    wrong is added to its problems.
    """
    vessel = source.data.get("vessel")
    if not isinstance(vessel, dict) or vessel.get("kind") != KIND:
        return
    name = vessel.get("file")
    unknown = [key for key in vessel if key not in ("kind", "file")]
    if unknown:
        hint = did_you_mean(unknown[0], ["file"])
        _note(source, f"vessel.{unknown[0]}", f"unknown key; {hint}allowed: kind, file")
    if not isinstance(name, str) or not name.strip():
        text = f"{shown(name)} is no file name" if "file" in vessel else "is missing"
        _note(source, "vessel.file", f"{text}; write file: vessels/phantom.yaml, a file of a vessel's own keys")
        return
    try:
        found = read_yaml(folder / name)
    except ScenarioError as error:
        for problem in error.problems:
            if problem.line is None:
                _note(source, "vessel.file", f"{problem.file}: {problem.message}")
            else:
                source.problems.append(Problem("vessel.file", problem.message, problem.file, problem.line))
        return
    if found.data.get("kind") == KIND:
        _note(source, "vessel.file", "names a file that names a file again; name the last one")
        return
    for old in [path for path in source.places if path.startswith("vessel.")]:
        del source.places[old]
    _relative_to(found.data, (folder / name).parent, folder)
    source.data["vessel"] = found.data
    source.places["vessel"] = (str(folder / name), None)
    source.places.update({f"vessel.{path}": place for path, place in found.places.items() if path})
    source.problems.extend(Problem(f"vessel.{p.path}".rstrip("."), p.message, p.file, p.line) for p in found.problems)


def _note(source: YamlSource, path: str, message: str) -> None:
    file, line = source.places.get(path, source.places.get("vessel", (None, None)))
    source.problems.append(Problem(path, message, file, line))


def _relative_to(vessel: dict[str, Any], own: Path, scenario: Path) -> None:
    """Files that the vessel names are relative to its own file; the scenario reads them from its folder."""
    if own == scenario:
        return

    def moved(name: Any) -> Any:
        return str(own.absolute() / name) if isinstance(name, str) else name

    if "file" in vessel:
        vessel["file"] = moved(vessel["file"])
    if isinstance(vessel.get("files"), list):
        vessel["files"] = [moved(name) for name in vessel["files"]]
