"""The licence of gw-exudyn itself, for what is handed on."""

from __future__ import annotations

import importlib.metadata
from pathlib import Path


def own_licence() -> str:
    """The text: of the source tree, or of the package as it is installed."""
    tree = Path(__file__).resolve().parents[2] / "LICENSE"
    if tree.is_file():
        return tree.read_text(encoding="utf-8")
    files = importlib.metadata.distribution("gw-exudyn").files or []
    texts = [str(file.locate().read_text(encoding="utf-8")) for file in files if file.name == "LICENSE"]  # type: ignore[attr-defined]
    return "\n".join(texts)


def licence(bundled: bool) -> str:
    """documentation/licenses/license.txt of an FMU: the entry to all that is in it."""
    more = "The headers of the FMI standard in sources/ are under the BSD 2-Clause licence that stands in them.\n"
    if bundled:
        more += "What is frozen into resources/worker has the licences that stand in bundled.txt beside this file.\n"
    return f"{own_licence()}\n{more}"
