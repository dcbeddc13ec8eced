"""Where output goes: data to stdout, everything else to stderr; both cope with pipes, files and plain ASCII."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Mapping, Sequence
from io import TextIOWrapper
from typing import TYPE_CHECKING, Any, TextIO

from gw_exudyn.errors import StorageError

if TYPE_CHECKING:
    from rich.console import Console

_ASCII = str.maketrans({"µ": "u", "°": " deg", "·": "*", "²": "^2", "³": "^3", "…": "..."})
_WIDE = 200
"""Columns of a table that goes to no terminal; nothing of it is to be cut."""


def prepare_streams() -> None:
    """Keep output from failing on a name that the stream's encoding lacks: names of files go out as they came in."""
    if isinstance(sys.stdout, TextIOWrapper):
        utf8 = sys.stdout.encoding.lower().replace("-", "") == "utf8"
        sys.stdout.reconfigure(errors="surrogateescape" if utf8 else "backslashreplace")


def put(text: str) -> None:
    """Write data to stdout, with a line end.

    Raises StorageError if it cannot be written (a full disk); that nobody reads it any more is no error.
    """
    _write(f"{text}\n")


def put_json(content: Mapping[str, Any]) -> None:
    """Write data to stdout as JSON, in ASCII; numbers that are not finite become null."""
    from gw_exudyn.storage.manifest import to_text

    put(json.dumps(json.loads(to_text(content)), indent=2))


def put_table(rows: Sequence[Sequence[str]], numbers: Sequence[int] = ()) -> None:
    """Write rows of cells to stdout, the columns aligned, those of `numbers` to the right."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, show_header=False, pad_edge=False, padding=(0, 2, 0, 0))
    for column in range(max((len(row) for row in rows), default=0)):
        table.add_column(justify="right" if column in numbers else "left", overflow="fold")
    for row in rows:
        table.add_row(*(Text(plain(cell, sys.stdout)) for cell in row))
    terminal = sys.stdout is not None and sys.stdout.isatty()
    console = Console(width=None if terminal else _WIDE, highlight=False, emoji=False)
    with console.capture() as captured:
        console.print(table)
    _write("\n".join(line.rstrip() for line in captured.get().splitlines()) + "\n")


def tell(text: str) -> None:
    """Write a message to stderr, with a line end; a stderr that is closed or full is nobody's business."""
    if sys.stderr is not None:
        try:
            sys.stderr.write(f"{plain(text, sys.stderr)}\n")
            sys.stderr.flush()
        except (OSError, ValueError):
            pass


def stderr_console() -> Console:
    """A console on stderr, for progress."""
    from rich.console import Console

    return Console(stderr=True, highlight=False, emoji=False, soft_wrap=True)


def flush_data() -> None:
    """See that what was written to stdout has got there. Raises StorageError as `put`."""
    _write("")


def plain(text: str, stream: TextIO | None) -> str:
    """The text as the stream can show it: units in ASCII where it has no micro sign."""
    encoding = getattr(stream, "encoding", None) or "ascii"
    try:
        text.encode(encoding, "surrogateescape")
    except (UnicodeEncodeError, LookupError):
        return text.translate(_ASCII)
    return text


def _write(text: str) -> None:
    if sys.stdout is None:
        return
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except BrokenPipeError:
        _to_nowhere()
    except OSError as error:
        _to_nowhere()
        raise StorageError(f"stdout: can't be written: {error.strerror or error}") from error


def _to_nowhere() -> None:
    """Let whatever still goes to stdout vanish, also what Python flushes when it ends."""
    try:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)
    except (OSError, ValueError):  # a stream without a file behind it, as in tests
        pass
