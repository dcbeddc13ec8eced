"""The command's entry: the group of commands, and its one way out."""

from __future__ import annotations

import difflib
import os
from collections.abc import Mapping, Sequence
from importlib import import_module
from types import MappingProxyType

import click

from gw_exudyn import __version__
from gw_exudyn.cli.outcome import exit_code_of

COMMANDS: Mapping[str, str] = MappingProxyType(
    {
        name: f"gw_exudyn.cli.{name}"
        for name in ("run", "check", "plot", "animate", "compare", "report", "verify", "info", "list", "schema")
    }
)
"""Name of each command and the module that holds it as `command`, in the order of the help."""


class CommandGroup(click.Group):
    """A group that imports a command's module when the command is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The names, in the order of the table."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of that name; None if there is none."""
        if cmd_name not in COMMANDS:
            return None
        found = import_module(COMMANDS[cmd_name]).command
        return found if isinstance(found, click.Command) else None

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command that is meant; one that is not there is answered with the nearest."""
        if args and args[0] not in COMMANDS and not args[0].startswith("-"):
            near = difflib.get_close_matches(args[0], COMMANDS, n=1)
            hint = f"did you mean {near[0]!r}? " if near else ""
            ctx.fail(f"there is no command {args[0]!r}; {hint}commands: {', '.join(COMMANDS)}")
        return super().resolve_command(ctx, args)


@click.group(
    cls=CommandGroup,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Exit codes: 0 done, 2 wrong use, 3 bad scenario, 4 solver failed or run not to be trusted, "
    "6 comparison beyond its tolerance, 7 trouble with files or the system, 130 interrupted.",
)
@click.version_option(__version__, prog_name="gw-exudyn", message="%(prog)s %(version)s")
def gw_exudyn() -> None:
    """Push a guidewire into a vessel, and see where it goes and what forces act.

    Begin with: gw-exudyn run corner90-universal
    """


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code. `arguments`: without the program's name; None takes those of the
    process.
    """
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        # Our matrices are small: threads of the linear algebra only get in each other's way. Read when numpy is loaded.
        os.environ.setdefault(name, "1")
    return exit_code_of(lambda: gw_exudyn.main(arguments, prog_name="gw-exudyn", standalone_mode=False))
