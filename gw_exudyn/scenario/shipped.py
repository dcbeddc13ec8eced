"""Where a scenario's file is: on the path given, or among those that come with gw-exudyn."""

from __future__ import annotations

import os
from pathlib import Path

from gw_exudyn.errors import Problem, ScenarioError
from gw_exudyn.scenario.words import nearest, path_text

_SUFFIXES = (".yaml", ".yml")


def shipped_folder() -> Path:
    """The folder of shipped scenarios: inside the package when it is installed, beside it in a source tree."""
    package = Path(__file__).resolve().parents[1]
    installed = package / "shipped"
    return installed if installed.is_dir() else package.parent / "scenarios"


def list_shipped() -> tuple[str, ...]:
    """Names of the shipped scenarios, sorted."""
    return tuple(sorted(file.stem for file in shipped_folder().glob("*.yaml")))


def resolve(path_or_name: str | os.PathLike[str]) -> Path:
    """The file of a scenario.

    An existing file wins; otherwise a bare name, without folder, is looked up among the shipped scenarios, with or
    without `.yaml`.

    Raises
    ------
    ScenarioError
        if there is neither; names the nearest shipped ones.
    """
    text = os.fspath(path_or_name)
    if not text.strip():
        names = ", ".join(list_shipped())
        raise ScenarioError(Problem("", f"no scenario is named; give a YAML file or a shipped scenario: {names}"))
    path = Path(text)
    try:
        if path.is_file() or (path.exists() and not path.is_dir()):
            return path
        bare = path.name == text
        shipped = shipped_folder() / (f"{path.stem}.yaml" if path.suffix in _SUFFIXES else f"{text}.yaml")
        if bare and shipped.is_file():
            return shipped
        message = _not_found(path, bare, path.is_dir())
    except (OSError, ValueError) as error:  # a name too long, or with a NUL in it
        message = f"is no file name: {getattr(error, 'strerror', None) or error}"
    raise ScenarioError(Problem("", message, path_text([text])))


def _not_found(path: Path, bare: bool, is_folder: bool) -> str:
    names = list_shipped()
    near = nearest(path.stem if path.suffix in _SUFFIXES else path.name, names)
    what = "is a folder; a scenario file is needed" if is_folder else "there is no such file"
    if near and (bare or not is_folder):
        return f"{what}, and no shipped scenario of that name; nearest: {', '.join(near)}"
    if bare:
        return f"{what}, and no shipped scenario of that name; shipped: {', '.join(names) or 'none'}"
    return what
