"""How a command ends: every outcome becomes a message on stderr and an exit code, in this one place."""

from __future__ import annotations

import os
import re
import sys
import tempfile
import traceback
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

import click

from gw_exudyn.cli.console import flush_data, prepare_streams, tell
from gw_exudyn.errors import GwError, Interrupted, SolverError, StorageError, UsageError

BUG = 1
"""Exit code of what should not happen."""

_LIBRARY = re.compile(r"\.so\b|\.dll\b|\.dylib\b|DLL load failed")


def exit_code_of(command: Callable[[], object]) -> int:
    """Run a command and return the exit code of the process; whatever goes wrong is told in a sentence, never by a
    traceback.
    """
    try:
        prepare_streams()
        with _warnings_as_lines():
            try:
                code = _code(command)
                flush_data()
            except GwError as error:  # the data did not get through
                tell(str(error))
                code = error.exit_code
    except KeyboardInterrupt:  # pressed again while the outcome was being told
        code = Interrupted.exit_code
    return code


def _code(command: Callable[[], object]) -> int:
    try:
        outcome = _uncovered(command)
    except GwError as error:
        tell(str(error))
        return error.exit_code
    except click.ClickException as error:
        error.show()
        return UsageError.exit_code
    except click.exceptions.Exit as finished:
        return finished.exit_code
    except (click.Abort, KeyboardInterrupt):
        tell("interrupted")
        return Interrupted.exit_code
    except (BrokenPipeError, SystemExit):  # whoever read the data has had enough; click's own way is to leave
        return 0
    except MemoryError:
        tell("there is not enough memory; use fewer segments (wire.segments) or a longer output.interval")
        return GwError.exit_code
    except ImportError as error:
        return _import_failed(error)
    except Exception as error:
        return _bug(error)
    return outcome if isinstance(outcome, int) else 0


def _uncovered(command: Callable[[], object]) -> object:
    """What the command returns. A Ctrl-C that comes out of a library as another error is a KeyboardInterrupt again."""
    try:
        return command()
    except Exception as error:
        if _is_interruption(error):
            raise KeyboardInterrupt from error
        raise


def _is_interruption(error: BaseException | None) -> bool:
    """Whether an error stands for a KeyboardInterrupt: it was raised because of one, or its text tells of one."""
    while error is not None:
        # Text of ours may quote the user; only what a solver says is searched.
        quotes = isinstance(error, GwError) and not isinstance(error, SolverError)
        if isinstance(error, KeyboardInterrupt):
            return True
        if not quotes and not isinstance(error, click.ClickException) and "KeyboardInterrupt" in str(error):
            return True
        error = error.__cause__ or (None if error.__suppress_context__ else error.__context__)
    return False


def _import_failed(error: ImportError) -> int:
    """A package that the environment lacks, or a library that the system lacks, is trouble with files (7): no change of
    the scenario helps. (Exudyn itself is told of where it is imported.)
    """
    own = error.name is not None and error.name.partition(".")[0] == "gw_exudyn"
    if isinstance(error, ModuleNotFoundError) and error.name and not own:
        tell(f"the Python package {error.name.partition('.')[0]!r} is missing; install gw-exudyn again with pip")
    elif _LIBRARY.search(str(error)) is not None:
        tell(f"a library of the system could not be loaded: {error}")
    else:
        return _bug(error)
    return StorageError.exit_code


def _bug(error: Exception) -> int:
    text = "".join(traceback.format_exception(error))
    where = "the traceback could not be written"
    try:
        handle, path = tempfile.mkstemp(prefix="gw-exudyn-", suffix=".txt")
        with open(handle, "w", encoding="utf-8", errors="backslashreplace") as file:
            file.write(f"gw-exudyn {' '.join(sys.argv[1:])}\n\n{text}")
        where = f"the traceback is in {path}"
    except OSError:
        pass
    summary = f"{type(error).__name__}: {error}".strip().splitlines()[0][:200]
    tell(f"gw-exudyn made a mistake ({summary}); this is a bug: please report it, {where}")
    return BUG


@contextmanager
def _warnings_as_lines() -> Iterator[None]:
    """Show a warning as one line of its own."""

    def show(
        message: Warning | str,
        category: type[Warning],
        filename: str,
        lineno: int,
        file: TextIO | None = None,
        line: str | None = None,
    ) -> None:
        tell(f"warning: {message}")

    with warnings.catch_warnings():
        warnings.showwarning = show
        if not sys.warnoptions and "PYTHONWARNINGS" not in os.environ:
            warnings.simplefilter("once", UserWarning)
            warnings.simplefilter("once", RuntimeWarning)
        yield
