"""Names that tell runs apart: their scenarios', or their folders' where scenarios have the same."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gw_exudyn.result import Result


def names_apart(results: Sequence[Result], folders: Sequence[Path]) -> list[str]:
    """A name for each run; of as many last parts of its folder's path as are needed where its scenario's is not its
    alone. Only runs from one and the same folder keep the same name.
    """
    plain = [result.scenario.name for result in results]
    paths = [folder.resolve().parts[1:] for folder in folders]
    names = plain
    for depth in range(1, max(map(len, paths), default=0) + 1):
        if len(set(names)) == len(set(paths)):
            break
        names = [
            re.sub(r"[^\w.+-]", "-", "-".join(path[-depth:])) if plain.count(name) > 1 else name
            for name, path in zip(plain, paths, strict=True)
        ]
    return names


def called(result: Result, name: str) -> Result:
    """The run under another name, for a figure."""
    return dataclasses.replace(result, scenario=result.scenario.model_copy(update={"name": name}))
