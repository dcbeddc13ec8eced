"""Columns of a table that a page sorts, filters and draws: numbers in the unit that people read, or words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.plots.style import shown
from gw_exudyn.quantities import LIKE, QUANTITIES, plain
from gw_exudyn.report.packing import base64_text

if TYPE_CHECKING:
    from gw_exudyn.result import Floats


@dataclass(frozen=True)
class Column:
    """A column of a table.

    label, unit : its head; the unit is empty for a pure number. values : (rows,) numbers, NaN where there is none; or
    words. factor : from the numbers to the unit. meaning : a sentence. role : what it is to the page, as `parameter`.
    open : it is shown at first. digits : of a number, that are shown.
    """

    label: str
    values: Floats | Sequence[str]
    unit: str = ""
    meaning: str = ""
    role: str = ""
    open: bool = True
    factor: float = 1.0
    digits: int = 4

    def packed(self) -> dict[str, Any]:
        """As the page's scripts read it."""
        about = {name: getattr(self, name) for name in ("label", "unit", "meaning", "role", "open", "factor", "digits")}
        if isinstance(self.values, np.ndarray):
            # Parameters in full, so that a point can be run again as it was.
            kind = "f8" if self.role == "parameter" else "f4"
            return {**about, "kind": kind, "values": base64_text(self.values, f"<{kind}")}
        words = list(dict.fromkeys(self.values))
        if len(words) > len(self.values) // 2:
            return {**about, "kind": "text", "values": list(self.values)}
        number = {word: i for i, word in enumerate(words)}
        return {**about, "kind": "words", "words": words, "values": [number[word] for word in self.values]}


def si_column(name: str, label: str, unit: str, values: Floats, trusted: NDArray[np.bool_], **further: Any) -> Column:
    """A column of numbers in SI, shown in the unit of the quantity `name`, or of any of its unit, that fits them.

    trusted : (rows,) bool, which of them decide on the unit.
    """
    like = name if name in QUANTITIES else LIKE.get(unit)
    text, factor = shown(like, values[trusted]) if like else (unit, 1.0)
    return Column(label, values, "" if text == "1" else plain(text), factor=factor, **further)


def text_column(label: str, texts: Sequence[str], **further: Any) -> Column:
    """A column from texts, as a CSV file has them: of numbers if all that is not empty are numbers."""
    try:
        numbers = np.array([float(text) if text else np.nan for text in texts])
    except ValueError:
        return Column(label, list(texts), **further)
    if not np.isfinite(numbers).any():
        return Column(label, list(texts), **further)
    head, bracket, unit = label.rpartition(" [")
    if bracket and unit.endswith("]"):
        return Column(head, numbers, plain(unit[:-1]).replace("mm2", "mm\u00b2"), digits=6, **further)
    return Column(label, numbers, digits=6, **further)
