"""`gw-exudyn report`: one page of a run, or of a few, with a player."""

from __future__ import annotations

from pathlib import Path

import click

from gw_exudyn.cli.console import put, tell
from gw_exudyn.cli.plot import run_folder, short


@click.command(
    short_help="Make one HTML page of a run, or of up to four, with a player.",
    help="""Write one self-contained HTML page of each RUN (a run folder): status, metrics, inputs, figures, versions,
    and a player in which wire, walls, contact forces and force curves move together. Of several runs (up to four) the
    page shows them over each other. It works offline, from a file; its name is written to stdout.""",
)
@click.argument("runs", nargs=-1, required=True, metavar="RUN...")
@click.option("-o", "--out", metavar="FILE", help="The page; report.html in the first run folder if not given.")
@click.option("--title", default="", help="Title of the page; the names of the runs if not given.")
@click.option("--no-figures", is_flag=True, help="Leave the figures out: a smaller page.")
def command(runs: tuple[str, ...], out: str | None, title: str, no_figures: bool) -> int:
    """Read the runs, write the page, and name it."""
    from gw_exudyn.report import save_report
    from gw_exudyn.storage import read_run

    folders = [run_folder(run) for run in runs]
    results = [read_run(folder) for folder in folders]
    for result in results:
        if not result.status.status.trusted:
            tell(f"{result.scenario.name}: {result.status.sentence()}")
    target = Path(out) if out else folders[0] / "report.html"
    put(str(short(save_report(results, target, title=title, figures=not no_figures))))
    return 0
