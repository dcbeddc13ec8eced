"""`gw-exudyn plot`: figures of one run, or of several side by side."""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import TYPE_CHECKING

import click

from gw_exudyn.cli.apart import called, names_apart
from gw_exudyn.cli.console import put, tell
from gw_exudyn.errors import UsageError

if TYPE_CHECKING:
    from gw_exudyn.result import Result

FIGURES = ("insertion", "forces", "tip_path", "energy", "contact_map")
"""Names of the figures; a test holds them against those that are drawn."""
TOGETHER = ("insertion", "forces", "tip_path")
"""Figures that show several runs side by side."""


@click.command(
    short_help="Draw figures of one run, or of several side by side.",
    help="""Draw figures of each RUN (a run folder) as PNG and PDF; the names of the files are written to stdout.

    Of one run all figures are drawn, into its folder figures. Of several, those that show runs side by side are drawn,
    beside the first run folder.""",
)
@click.argument("runs", nargs=-1, required=True, metavar="RUN...")
@click.option("--out", metavar="DIR", help="The folder for the figures.")
@click.option(
    "--figure",
    "figures",
    multiple=True,
    metavar="NAME",
    help=f"Draw this figure only: {', '.join(FIGURES)}. May be repeated. Several runs: {', '.join(TOGETHER)}.",
)
def command(runs: tuple[str, ...], out: str | None, figures: tuple[str, ...]) -> int:
    """Read the runs, draw, and name the files."""
    from gw_exudyn.storage import read_run

    names = _wanted(figures, TOGETHER if len(runs) > 1 else FIGURES)
    folders = [run_folder(run) for run in runs]
    results = [read_run(folder) for folder in folders]
    called_so = names_apart(results, folders)
    for result, name in zip(results, called_so, strict=True):
        if not result.status.status.trusted:
            tell(f"{name}: {result.status.sentence()}")
    if len(results) == 1:
        from gw_exudyn.plots import save_figures

        files = save_figures(results[0], Path(out) if out else folders[0] / "figures", names)
    else:
        results = [called(result, name) for result, name in zip(results, called_so, strict=True)]
        files = _side_by_side(results, Path(out) if out else folders[0].absolute().parent, names)
    for file in files:
        put(str(short(file)))
    return 0


def run_folder(given: str) -> Path:
    """The run folder that is meant: itself, or that of one of its files."""
    path = Path(given)
    return path.parent if path.is_file() and path.name in ("run.json", "run.nc", "series.csv") else path


def _wanted(figures: tuple[str, ...], possible: tuple[str, ...]) -> tuple[str, ...]:
    for name in figures:
        if name in possible:
            continue
        if name in FIGURES:
            raise UsageError(f"--figure {name} shows one run; of several runs there are: {', '.join(possible)}")
        near = difflib.get_close_matches(name, possible, n=1)
        hint = f"did you mean {near[0]!r}? " if near else ""
        raise UsageError(f"there is no figure {name!r}; {hint}figures: {', '.join(possible)}")
    return tuple(dict.fromkeys(figures)) or possible


def _side_by_side(results: list[Result], folder: Path, names: tuple[str, ...]) -> list[Path]:
    from gw_exudyn import plots
    from gw_exudyn.plots import save_figure

    draw = {"insertion": plots.plot_insertion, "forces": plots.plot_forces, "tip_path": plots.plot_tip_path}
    files: list[Path] = []
    runs = "-".join(dict.fromkeys(result.scenario.name for result in results))[:120]
    for name in names:
        files += save_figure(draw[name](results), folder / f"{name}-{runs}")
    return files


def short(path: Path) -> Path:
    """The path as seen from the current folder, if it is inside."""
    return path.relative_to(Path.cwd()) if path.is_absolute() and path.is_relative_to(Path.cwd()) else path
