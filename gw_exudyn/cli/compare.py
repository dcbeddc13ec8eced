"""`gw-exudyn compare`: how far apart two runs are, and what their scenarios say otherwise."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import click

from gw_exudyn.cli import options
from gw_exudyn.cli.apart import called, names_apart
from gw_exudyn.cli.console import put, put_json, put_table, tell
from gw_exudyn.cli.plot import run_folder, short
from gw_exudyn.errors import ComparisonError, UnitError, UsageError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from gw_exudyn.comparison import Course, Difference, Norm
    from gw_exudyn.result import Result


@click.command(
    short_help="Set two runs against each other: overlay, differences, norms.",
    help="""Set B against run A (a run folder): norms of the difference at equal times, what differs in their
    scenarios, and a figure of both, `compare-A-B`, beside the first run folder.

    Time 0 is the start of the drive, also in a measured file. Where the clock of a camera or load cell showed another
    time then, take that from all its times first.

    B is another run folder, or a CSV file of measured values: a column `time [s]`, and `tip_x [mm]` with `tip_y [mm]`,
    `push_force [mN]` or other quantities of series.csv, at any rate, also at several in one file: each quantity is
    interpolated between its own values. Empty cells are a gap where these lie further apart than one and a half times
    their usual spacing.

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
@click.option("--align", is_flag=True, help="Turn and shift a measured path onto the run's before comparing.")
@click.option("--out", metavar="DIR", help="The folder for the figure.")
@click.option("--no-figure", is_flag=True, help="Draw no figure.")
@options.as_json
def command(
    first: str, second: str, tolerances: tuple[str, ...], align: bool, out: str | None, no_figure: bool, as_json: bool
) -> int:
    """Read both, compare, draw, and tell."""
    from gw_exudyn.comparison import Course, compare, course_of, differences
    from gw_exudyn.storage import read_run

    folder = run_folder(first)
    run = read_run(folder)
    other = _other(second, run, align)
    courses = course_of(run), other if isinstance(other, Course) else course_of(other)
    norms = compare(*courses)
    _tell_overlap(*courses)
    limits = _limits(tolerances, norms)
    without = [name for name, norm in norms.items() if not math.isfinite(norm.value)]
    if without:
        tell(f"no number for {', '.join(without)}: at no time have both a value; see the gaps in the measured file")
    changed = None if isinstance(other, Course) else differences(run.scenario.to_dict(), other.scenario.to_dict())
    if not isinstance(other, Course):
        names = names_apart((run, other), (folder, run_folder(second)))
        run, other = (called(one, name) for one, name in zip((run, other), names, strict=True))
    files = [] if no_figure else _drawn(run, other, Path(out) if out else folder.absolute().parent)
    for one in (run, other):
        if not isinstance(one, Course) and not one.status.status.trusted:
            tell(f"{one.scenario.name}: {one.status.sentence()}")
    beyond = {name: limit for name, limit in limits.items() if not norms[name].value <= limit}
    if as_json:
        _put_json(norms, limits, changed, align, files)
    else:
        _put_tables(norms, changed, align, files)
    if beyond:
        raise ComparisonError("\n".join(_beyond(name, norms[name], limit) for name, limit in beyond.items()))
    return 0


def _other(given: str, run: Result, align: bool) -> Result | Course:
    """What the run is compared with: another run, or a measured course."""
    from gw_exudyn.comparison import course_of
    from gw_exudyn.measured import aligned, read_measured
    from gw_exudyn.storage import read_run
    from gw_exudyn.storage.series import SERIES

    path = Path(given)
    if path.suffix.lower() == ".csv" and path.name != SERIES:
        measured = read_measured(path)
        return aligned(measured, course_of(run)) if align else measured
    if align:
        raise UsageError("--align turns a measured path; two runs lie in the same frame and are compared as they are")
    return read_run(run_folder(given))


def _tell_overlap(first: Course, second: Course) -> None:
    """Say so where the two share little time: another clock, more likely than not."""
    from gw_exudyn.comparison import shared_time

    shared, whole = shared_time(first, second)
    if shared < whole / 2:
        spans = (f"{one.name} has {one.time[0]:.4g} to {one.time[-1]:.4g} s" for one in (first, second))
        tell(
            f"{' and '.join(spans)}: only {shared:.3g} s are common. Time 0 is the start of the drive; "
            "where a measured clock showed another time then, take that from all its times"
        )


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


def _drawn(first: Result, second: Result | Course, folder: Path) -> list[Path]:
    from gw_exudyn.comparison import Course
    from gw_exudyn.plots import plot_comparison, save_figure

    other = second.name if isinstance(second, Course) else second.scenario.name
    names = "-".join(dict.fromkeys((first.scenario.name, other)))[:120]
    return save_figure(plot_comparison(first, second), folder / f"compare-{names}")


def _put_json(
    norms: Mapping[str, Norm],
    limits: Mapping[str, float],
    changed: list[Difference] | None,
    align: bool,
    files: list[Path],
) -> None:
    put_json(
        {
            "aligned": align,
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
            "scenarios": None if changed is None else {one.path: [one.first, one.second] for one in changed},
            "figures": [str(short(file)) for file in files],
        }
    )


def _put_tables(norms: Mapping[str, Norm], changed: list[Difference] | None, align: bool, files: list[Path]) -> None:
    from gw_exudyn.quantities import number_text, value_text

    put_table([(name, number_text(name, norm.value, norm.unit), norm.meaning) for name, norm in norms.items()], [1])
    put("")
    if changed is None:
        places = "B's path was turned and shifted onto A's" if align else "places are as they are in the file"
        put(f"B is measured: pairs are taken at equal time, B's as it is in the file; {places}")
    elif changed:
        rows = ((one.path, value_text(one.first), value_text(one.second)) for one in changed)
        put_table([("differs", "A", "B"), *rows])
    else:
        put("the scenarios are the same")
    for file in files:
        put(str(short(file)))


def _beyond(name: str, norm: Norm, limit: float) -> str:
    from gw_exudyn.quantities import number_text

    if not math.isfinite(norm.value):
        return f"{name}: at no time have both a value, so nothing can be held against the tolerance"
    return f"{name}: {number_text(name, norm.value, norm.unit)} is beyond {number_text(name, limit, norm.unit)}"
