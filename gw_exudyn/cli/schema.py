"""`gw-exudyn schema`: the JSON schemas of scenario and study files, for editors and programs."""

from __future__ import annotations

import json
from pathlib import Path

import click

from gw_exudyn.cli.console import put
from gw_exudyn.errors import StorageError


@click.command(
    short_help="Write the JSON schema of the scenario file, or of the study file.",
    help="""Write the JSON schema of the scenario file to stdout, or to a file; with --study that of the file that
    sweep takes.

    An editor with a YAML language server completes and checks a file that begins with the line
    '# yaml-language-server: $schema=schema.json'.""",
)
@click.option("--output", "-o", metavar="FILE", help="Write to this file instead of stdout.")
@click.option("--study", is_flag=True, help="The schema of study files, which sweep takes.")
def command(output: str | None, study: bool) -> int:
    """Write the schema."""
    if study:
        from gw_exudyn.sweep.studies.form import study_schema

        schema = study_schema()
    else:
        from gw_exudyn.scenario import json_schema

        schema = json_schema()
    text = json.dumps(schema, indent=2)
    if output is None:
        put(text)
        return 0
    from gw_exudyn.storage.run_folder import write_file

    try:
        write_file(Path(output), f"{text}\n".encode())
    except OSError as error:
        raise StorageError(f"{output}: can't be written: {error.strerror or error}; name another file") from error
    return 0
