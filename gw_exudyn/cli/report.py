"""`gw-exudyn report`: one page of a run, or of a few, with a player; or of a sweep, with its points."""

from __future__ import annotations

from pathlib import Path

import click

from gw_exudyn.cli.apart import names_apart
from gw_exudyn.cli.console import put, tell
from gw_exudyn.cli.plot import run_folder, short
from gw_exudyn.errors import UsageError


@click.command(
    short_help="Make one HTML page of a run, of up to four, or of a sweep.",
    help="""Write one self-contained HTML page of each RUN (a run folder): status, metrics, inputs, figures, versions,
    and a player in which wire, walls, contact forces and force curves move together. Of several runs (up to four) the
    page shows them over each other.

    Of a sweep's folder, also of one that was interrupted, the page has a table of the points that sorts and filters, a
    chart of any two of its columns, and each point with its numbers, its curves and the command that runs it again.

    A page works offline, from a file; its name is written to stdout.""",
)
@click.argument("runs", nargs=-1, required=True, metavar="RUN...|SWEEP")
@click.option("-o", "--out", metavar="FILE", help="The page; report.html in the first folder if not given.")
@click.option("--title", default="", help="Title of the page; the names of the runs or of the study if not given.")
@click.option("--no-figures", is_flag=True, help="Leave the figures out: a smaller page.")
def command(runs: tuple[str, ...], out: str | None, title: str, no_figures: bool) -> int:
    """Read the runs or the sweep, write the page, and name it."""
    from gw_exudyn.report import save_report
    from gw_exudyn.storage import read_run

    folders = [run_folder(run) for run in runs]
    if any(_is_sweep(folder) for folder in folders):
        return _of_sweep(folders, Path(out) if out else None, title, not no_figures)
    results = [read_run(folder) for folder in folders]
    names = names_apart(results, folders)
    for result, name in zip(results, names, strict=True):
        if not result.status.status.trusted:
            tell(f"{name}: {result.status.sentence()}")
    target = Path(out) if out else folders[0] / "report.html"
    put(str(short(save_report(results, target, title=title, figures=not no_figures, names=names))))
    return 0


def _is_sweep(folder: Path) -> bool:
    from gw_exudyn.sweep.folder import is_sweep

    return is_sweep(folder)


def _of_sweep(folders: list[Path], out: Path | None, title: str, figures: bool) -> int:
    from gw_exudyn.sweep.page import save_study_page

    if len(folders) > 1:
        raise UsageError("the page of a sweep shows that sweep alone; name its folder only, or folders of runs only")
    put(str(short(save_study_page(folders[0], out, title=title, figures=figures))))
    return 0
