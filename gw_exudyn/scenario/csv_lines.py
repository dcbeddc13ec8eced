"""The lines of a CSV file that hold something, and their cells."""

from __future__ import annotations

import csv
from collections.abc import Iterator


def data_lines(text: str) -> Iterator[tuple[int, str]]:
    """Number and text of every line that is not empty and no comment (#)."""
    for number, line in enumerate(text.splitlines(), 1):
        if line.strip() and not line.lstrip().startswith("#"):
            yield number, line


def csv_cells(line: str) -> list[str]:
    """The cells of one line. Raises ValueError with a sentence."""
    try:
        return next(csv.reader([line]))
    except csv.Error as error:
        raise ValueError(f"is no CSV row: {error}") from None
