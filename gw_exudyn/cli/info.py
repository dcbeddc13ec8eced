"""`gw-exudyn info`: what a run folder or a scenario holds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from gw_exudyn.cli import options
from gw_exudyn.cli.console import put_json, put_table
from gw_exudyn.cli.plot import run_folder


@click.command(
    cls=options.ShippedCommand,
    short_help="Show a run's status and numbers, or a scenario's values.",
    help=f"""Show what came out of a RUN (a run folder): status, metrics, versions; or the values of a SCENARIO, with
    those that it leaves to the defaults and to the catalogue.

    {options.SCENARIO_HELP}.""",
)
@click.argument("run_or_scenario", metavar="RUN|SCENARIO")
@options.as_json
def command(run_or_scenario: str, as_json: bool) -> int:
    """Find out which of the two it is, and show it."""
    folder = run_folder(run_or_scenario)
    if _is_run(folder, run_or_scenario):
        return _show_run(folder, as_json)
    from gw_exudyn.cli.resolved import resolved_rows
    from gw_exudyn.scenario import load_scenario

    scenario = load_scenario(run_or_scenario)
    if as_json:
        put_json(scenario.to_dict())
    else:
        put_table(resolved_rows(scenario))
    return 0


def _is_run(folder: Path, given: str) -> bool:
    """A folder is a run, unless a shipped scenario has its name and it holds no run."""
    from gw_exudyn.scenario.shipped import list_shipped

    return folder.is_dir() and ((folder / "run.json").exists() or given not in list_shipped())


def _show_run(folder: Path, as_json: bool) -> int:
    from gw_exudyn.storage.manifest import as_damaged, read_manifest

    content = read_manifest(folder)
    with as_damaged(folder):
        facts, numbers = _fact_rows(content), _metric_rows(content)
    if as_json:
        put_json(content)
    else:
        put_table(facts)
        put_table(numbers, numbers=[1])
    return 0


def _fact_rows(content: dict[str, Any]) -> list[tuple[str, str]]:
    versions = ", ".join(f"{name} {version}" for name, version in content["versions"].items())
    wall_time = content["wall_time"]
    return [
        ("run", str(content["name"])),
        ("status", str(content["status"]["sentence"])),
        ("command", str(content["command"])),
        ("solved in", "-" if wall_time is None else f"{wall_time:.3g} s"),
        ("versions", versions),
    ]


def _metric_rows(content: dict[str, Any]) -> list[tuple[str, str, str]]:
    from gw_exudyn.quantities import number_text

    return [
        (name, str(metric.get("label") or number_text(name, metric["value"], metric["unit"])), str(metric["meaning"]))
        for name, metric in content["metrics"].items()
    ]
