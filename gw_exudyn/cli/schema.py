"""`gw-exudyn schema`: the JSON schema of the scenario file, for editors and programs."""

from __future__ import annotations

import json
from pathlib import Path

import click

from gw_exudyn.cli.console import put
from gw_exudyn.errors import StorageError


@click.command(
    short_help="Write the JSON schema of the scenario file.",
    help="""Write the JSON schema of the scenario file to stdout, or to a file.

    An editor with a YAML language server completes and checks a scenario that begins with the line
    '# yaml-language-server: $schema=schema.json'.""",
)
@click.option("--output", "-o", metavar="FILE", help="Write to this file instead of stdout.")
def command(output: str | None) -> int:
    """Write the schema."""
    from gw_exudyn.scenario import json_schema

    text = json.dumps(json_schema(), indent=2)
    if output is None:
        put(text)
        return 0
    from gw_exudyn.storage.run_folder import write_file

    try:
        write_file(Path(output), f"{text}\n".encode())
    except OSError as error:
        raise StorageError(f"{output}: can't be written: {error.strerror or error}; name another file") from error
    return 0
