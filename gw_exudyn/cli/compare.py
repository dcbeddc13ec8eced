"""`gw-exudyn compare`: how far apart two runs are, and what their scenarios say otherwise."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from gw_exudyn.cli import options
from gw_exudyn.cli.console import put, put_json, put_table, tell
from gw_exudyn.cli.plot import run_folder, short
from gw_exudyn.errors import ComparisonError, UnitError, UsageError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from gw_exudyn.comparison import Difference, Norm
    from gw_exudyn.result import Result


@click.command(
    short_help="Set two runs against each other: overlay, differences, norms.",
    help="""Set run B against run A (run folders): norms of the difference at equal times, what differs in their
    scenarios, and a figure of both, `compare-A-B`, beside the first run folder.

    Exit code 6 where a norm is beyond its --tolerance.""",
)
@click.argument("first", metavar="A")
@click.argument("second", metavar="B")
@click.option(
    "--tolerance",
    "tolerances",
    multiple=True,
    metavar="NORM=VALUE",
    help="Largest value that a norm may have, as tip_max='0.1 mm' or push_force_rms='1 mN'. May be repeated.",
)
@click.option("--out", metavar="DIR", help="The folder for the figure.")
@click.option("--no-figure", is_flag=True, help="Draw no figure.")
@options.as_json
def command(
    first: str, second: str, tolerances: tuple[str, ...], out: str | None, no_figure: bool, as_json: bool
) -> int:
    """Read both, compare, draw, and tell."""
    from gw_exudyn.comparison import compare, course_of, differences
    from gw_exudyn.storage import read_run

    folders = [run_folder(given) for given in (first, second)]
    runs = [read_run(folder) for folder in folders]
    norms = compare(course_of(runs[0]), course_of(runs[1]))
    limits = _limits(tolerances, norms)
    changed = differences(runs[0].scenario.to_dict(), runs[1].scenario.to_dict())
    files = [] if no_figure else _drawn(runs[0], runs[1], Path(out) if out else folders[0].absolute().parent)
    for run in runs:
        if not run.status.status.trusted:
            tell(f"{run.scenario.name}: {run.status.sentence()}")
    beyond = {name: limit for name, limit in limits.items() if not norms[name].value <= limit}
    if as_json:
        _put_json(norms, limits, changed, files)
    else:
        _put_tables(norms, changed, files)
    if beyond:
        raise ComparisonError("\n".join(_beyond(name, norms[name], limit) for name, limit in beyond.items()))
    return 0


def _limits(tolerances: tuple[str, ...], norms: Mapping[str, Norm]) -> dict[str, float]:
    """Limits in SI by the name of the norm. Raises UsageError for what is none."""
    import difflib

    from gw_exudyn.scenario.units import parse_quantity

    limits: dict[str, float] = {}
    for given in tolerances:
        name, _, text = (part.strip() for part in given.partition("="))
        if name not in norms:
            near = difflib.get_close_matches(name, norms, n=1)
            hint = f"did you mean {near[0]!r}? " if near else ""
            raise UsageError(f"--tolerance {given}: there is no norm {name!r}; {hint}norms: {', '.join(norms)}")
        try:
            limits[name] = float(text) if _is_plain(text) else parse_quantity(text, norms[name].unit)
        except UnitError as error:
            raise UsageError(f"--tolerance {given}: {error}") from None
        if not limits[name] >= 0:
            raise UsageError(f"--tolerance {given}: a tolerance is zero or more")
    return limits


def _is_plain(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _drawn(first: Result, second: Result, folder: Path) -> list[Path]:
    from gw_exudyn.plots import plot_comparison, save_figure

    names = "-".join(dict.fromkeys(run.scenario.name for run in (first, second)))[:120]
    return save_figure(plot_comparison(first, second), folder / f"compare-{names}")


def _put_json(
    norms: Mapping[str, Norm], limits: Mapping[str, float], changed: list[Difference], files: list[Path]
) -> None:
    put_json(
        {
            "norms": {
                name: {
                    "value": norm.value,
                    "unit": norm.unit,
                    "meaning": norm.meaning,
                    "tolerance": limits.get(name),
                    "within": norm.value <= limits[name] if name in limits else None,
                }
                for name, norm in norms.items()
            },
            "scenarios": {one.path: [one.first, one.second] for one in changed},
            "figures": [str(short(file)) for file in files],
        }
    )


def _put_tables(norms: Mapping[str, Norm], changed: list[Difference], files: list[Path]) -> None:
    from gw_exudyn.cli.numbers import number_text

    put_table([(name, number_text(name, norm.value, norm.unit), norm.meaning) for name, norm in norms.items()], [1])
    put("")
    if changed:
        put_table([("differs", "A", "B"), *((one.path, _text(one.first), _text(one.second)) for one in changed)])
    else:
        put("the scenarios are the same")
    for file in files:
        put(str(short(file)))


def _text(value: object) -> str:
    return "-" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)


def _beyond(name: str, norm: Norm, limit: float) -> str:
    from gw_exudyn.cli.numbers import number_text

    return f"{name}: {number_text(name, norm.value, norm.unit)} is beyond {number_text(name, limit, norm.unit)}"
