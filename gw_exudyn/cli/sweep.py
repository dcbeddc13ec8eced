"""`gw-exudyn sweep`: a scenario over a grid, a list or a sample of parameters, in parallel."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gw_exudyn.cli import options
from gw_exudyn.cli.console import put, put_json, put_table, tell
from gw_exudyn.errors import Interrupted, SweepError

if TYPE_CHECKING:
    from gw_exudyn.sweep.plan import Options, Plan, Summary
    from gw_exudyn.sweep.studies.study import Study

SWEEPS = Path("results", "sweeps")
"""Where the folders of sweeps go under the current folder."""

_FAILURES_TOLD = 10


@click.command(
    short_help="Run a scenario over a grid, a list or a sample of parameters.",
    help="""Run the points of a STUDY (a YAML file, or the name of a shipped one) in parallel, and write their table
    sweep.csv, their data set sweep.nc and figures.

    Points that are done are not run again: after a stop of whatever kind, the same command goes on. The name of the
    folder is written to stdout. Ctrl-C stops the sweep and keeps what is done.""",
)
@click.argument("study", metavar="STUDY")
@options.overrides
@click.option("--out", metavar="DIR", help=f"The folder of the sweep. Without: {SWEEPS.as_posix()}/NAME.")
@options.jobs
@options.scheduler
@click.option(
    "--timeout",
    type=click.FloatRange(0.0, min_open=True),
    metavar="SECONDS",
    help="Give a point up that takes longer; it is in the table as timed_out.",
)
@click.option("--keep-runs", is_flag=True, help="Keep the whole run folder of every point (run.nc).")
@click.option("--retry-failed", is_flag=True, help="Run points again that failed.")
@click.option("--fresh", is_flag=True, help="Forget what is done and run all points.")
@click.option("--dry-run", is_flag=True, help="Show the points and what they will cost; run none.")
@click.option("--engine", type=click.Choice(["native", "fmu"]), default="native", show_default=True,
              help="What runs the points: the simulation itself, or its FMU.")  # fmt: skip
@click.option("--no-figures", is_flag=True, help="Leave out the figures, and the best and the worst run.")
@options.as_json
@click.option("--quiet", "-q", is_flag=True, help="No progress and no summary; only what goes wrong is told.")
def command(
    study: str,
    overrides: tuple[str, ...],
    out: str | None,
    jobs: int | None,
    scheduler: str | None,
    timeout: float | None,
    keep_runs: bool,
    retry_failed: bool,
    fresh: bool,
    dry_run: bool,
    engine: str,
    no_figures: bool,
    as_json: bool,
    quiet: bool,
) -> int:
    """Check all points, run what is missing, and say what came out."""
    from contextlib import nullcontext
    from dataclasses import replace

    from gw_exudyn.cli.sweep_progress import checking, cores, running
    from gw_exudyn.engine.library import exudyn
    from gw_exudyn.sweep.fmu_runner import FMU, check_options, fmu_runner
    from gw_exudyn.sweep.plan import Options, make_plan
    from gw_exudyn.sweep.run import run_sweep
    from gw_exudyn.sweep.runner import SIMULATION
    from gw_exudyn.sweep.studies.loading import load_study

    if engine == "fmu":
        check_options(keep_runs, scheduler)
    loaded = load_study(study, overrides)
    folder = Path(out) if out else SWEEPS / loaded.name
    chosen = Options(
        jobs=jobs or cores(),
        scheduler=scheduler,
        timeout=timeout,
        keep_runs=keep_runs,
        retry_failed=retry_failed,
        fresh=fresh,
        figures=not no_figures,
        command=_command_line(study, overrides, out, keep_runs, engine),
        runner=FMU if engine == "fmu" else SIMULATION,
    )
    exudyn()
    with checking(len(loaded), quiet) as look:
        plan = make_plan(loaded, folder, chosen, look)
    if dry_run:
        return _show_plan(loaded, plan, folder, chosen, as_json)
    with (
        fmu_runner(loaded) if engine == "fmu" else nullcontext(SIMULATION) as runner,
        running(loaded.name, chosen, quiet) as (report, stop),
    ):
        chosen = replace(chosen, runner=runner)
        summary = run_sweep(loaded, folder, chosen, plan=plan, report=report, should_stop=stop.should_stop)
    _tell(summary, quiet)
    if as_json:
        put_json(_as_json(summary))
    else:
        put(str(folder))
    if summary.interrupted:
        return Interrupted.exit_code
    return SweepError.exit_code if summary.failed else 0


def _command_line(study: str, overrides: tuple[str, ...], out: str | None, keep_runs: bool, engine: str) -> str:
    words = ["gw-exudyn", "sweep", study, *(word for text in overrides for word in ("--set", text))]
    words += ["--keep-runs"] if keep_runs else []
    words += [] if engine == "native" else ["--engine", engine]
    return shlex.join([*words, "--out", out] if out else words)


def _show_plan(study: Study, plan: Plan, folder: Path, chosen: Options, as_json: bool) -> int:
    from gw_exudyn.sweep.estimate import estimate

    guess = estimate(study, plan, folder, chosen)
    if as_json:
        put_json(
            {
                "points": len(plan.ids),
                "unique": len(plan.first),
                "missing": len(plan.missing),
                "estimate": guess.to_dict(),
                "list": [{"point": i, "id": found, **study.design.labels(i)} for i, found in enumerate(plan.ids)],
            }
        )
        return 0
    missing = set(plan.missing)
    heads = [axis.path if axis.unit in (None, "1") else f"{axis.path} [{axis.unit}]" for axis in study.design.axes]
    rows = [("point", "id", *heads, "")]
    for point, found in enumerate(plan.ids):
        labels = [label if isinstance(label, str) else f"{label:.6g}" for label in study.design.labels(point).values()]
        state = "to run" if point in missing else "done" if plan.first[found] == point else f"as {plan.first[found]}"
        rows.append((str(point), found, *labels, state))
    put_table(rows)
    for line in guess.sentences():
        tell(line)
    return 0


def _tell(summary: Summary, quiet: bool) -> None:
    for failure in summary.failures[:_FAILURES_TOLD]:
        tell(f"point {failure.point} ({failure.id}): {failure.status}: {failure.reason.partition('. ')[0].rstrip('.')}")
    if summary.failed > _FAILURES_TOLD:
        tell(f"... and {summary.failed - _FAILURES_TOLD} more failed points; sweep.csv has them all")
    for note in summary.notes:
        tell(note)
    left = summary.unique - summary.completed - summary.failed
    if summary.interrupted:
        tell(f"interrupted with {left} points left; the same command goes on")
    if not quiet:
        earlier = f", {summary.earlier} of them before" if summary.earlier else ""
        again = "; --retry-failed runs these again" if summary.failed and not summary.interrupted else ""
        tell(f"{summary.completed} points completed, {summary.failed} failed{earlier}: {summary.folder}{again}")


def _as_json(summary: Summary) -> dict[str, Any]:
    from dataclasses import asdict

    content = asdict(summary)
    return {**content, "folder": str(summary.folder), "files": [str(file) for file in summary.files]}
