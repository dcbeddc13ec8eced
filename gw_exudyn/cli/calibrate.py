"""`gw-exudyn calibrate`: parameters of a scenario fitted to what was measured."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING

import click

from gw_exudyn.cli import options
from gw_exudyn.cli.console import put, put_json, put_table, tell
from gw_exudyn.errors import SolverError

if TYPE_CHECKING:
    from gw_exudyn.calibration.form import Calibration
    from gw_exudyn.calibration.objective import Step
    from gw_exudyn.calibration.run import Look, Summary

CALIBRATIONS = Path("results", "calibrations")
"""Where the folders of calibrations go under the current folder."""


@click.command(
    short_help="Fit friction, stiffness and the like to measured paths and forces.",
    help="""Fit values of a scenario to measured tip paths and force curves by least squares, as FILE (YAML) says, and
    tell how well they are known: 95 % intervals, correlations, and what cannot be identified.

    Writes fit.json, the scenario with the fitted values, residuals and figures to a folder. Simulations that are done
    are not run again: after a stop of whatever kind, the same command goes on.

    Exit code 4 where the fit did not converge.""",
)
@click.argument("file", metavar="FILE")
@options.overrides
@click.option("--out", metavar="DIR", help=f"The folder. Without: {CALIBRATIONS.as_posix()}/NAME.")
@options.jobs
@options.scheduler
@click.option(
    "--timeout",
    type=click.FloatRange(0.0, min_open=True),
    metavar="SECONDS",
    help="Give a simulation up that takes longer; the fit then tries a smaller step.",
)
@click.option("--retry-failed", is_flag=True, help="Run simulations again that failed.")
@click.option("--fresh", is_flag=True, help="Forget what is done and run all simulations.")
@click.option("--no-figures", is_flag=True, help="Leave out the figures.")
@options.as_json
@click.option("--quiet", "-q", is_flag=True, help="No progress; only what goes wrong is told.")
def command(
    file: str,
    overrides: tuple[str, ...],
    out: str | None,
    jobs: int | None,
    scheduler: str | None,
    timeout: float | None,
    retry_failed: bool,
    fresh: bool,
    no_figures: bool,
    as_json: bool,
    quiet: bool,
) -> int:
    """Check the file, fit, and say what came out."""
    from gw_exudyn.calibration import load_calibration, run_calibration
    from gw_exudyn.cli.stopping import Stop
    from gw_exudyn.cli.sweep_progress import cores
    from gw_exudyn.engine.library import exudyn
    from gw_exudyn.sweep.plan import Options

    loaded = load_calibration(file, overrides)
    exudyn()
    chosen = Options(
        jobs=jobs or cores(),
        scheduler=scheduler,
        timeout=timeout,
        retry_failed=retry_failed,
        fresh=fresh,
        figures=not no_figures,
        command=_command_line(file, overrides, out),
    )
    folder = Path(out) if out else CALIBRATIONS / loaded.name
    with Stop() as stop:
        look = _progress(loaded, quiet)
        done = run_calibration(loaded, folder, chosen, look=look, should_stop=stop.should_stop)
    if as_json:
        put_json({**done.content, "folder": str(folder), "written": [str(path) for path in done.files]})
    else:
        _put_tables(done)
    for line in _doubts(done):
        tell(line)
    return 0 if done.report.fit.converged else SolverError.exit_code


def _command_line(file: str, overrides: tuple[str, ...], out: str | None) -> str:
    words = ["gw-exudyn", "calibrate", file, *(word for text in overrides for word in ("--set", text))]
    return shlex.join([*words, "--out", out] if out else words)


def _progress(calibration: Calibration, quiet: bool) -> Look:
    """A line for every point that was tried."""
    number = 0

    def look(step: Step, simulations: int) -> None:
        nonlocal number
        number += 1
        if quiet:
            return
        values = zip(calibration.parameters, calibration.values(step.point), strict=True)
        told = ", ".join(f"{one.path} {one.text(value)}" for one, value in values)
        how = f"refused: {step.reason}" if step.reason else f"chi square {step.chi_square:.6g}"
        tell(f"{number}: {how} at {told} ({simulations} simulations)")

    return look


def _put_tables(done: Summary) -> None:
    from gw_exudyn.quantities import number_text

    report = done.report
    rows: list[tuple[str, ...]] = [("parameter", "value", "+- (95 %)", "low", "high", "")]
    for one in report.estimates:
        texts = [one.parameter.text(value) for value in (one.parameter.low, one.parameter.high)]
        known = "NOT identified" if one.doubts else "identified"
        width = one.parameter.text(one.half_width, 2)
        rows.append((one.parameter.path, one.parameter.text(one.value), width, *texts, known))
    put_table(rows, [1, 2, 3, 4])
    put("")
    measured = [("measured", "in", "values", "rms of residuals", "by noise")]
    for entry in done.content["measured"]:
        rms = number_text(entry["quantity"], entry["rms"], entry["unit"])
        measured.append((entry["quantity"], entry["file"], str(entry["count"]), rms, f"{entry['rms_by_noise']:.2f}"))
    put_table(measured, [2, 3, 4])
    put("")
    paths = [one.parameter.path for one in report.estimates]
    if len(paths) > 1:
        matrix = report.statistics.correlation
        put_table(
            [
                ("correlation", *(f"({i + 1})" for i in range(len(paths)))),
                *(
                    (f"({i + 1}) {path}", *(f"{value:+.2f}" for value in row))
                    for i, (path, row) in enumerate(zip(paths, matrix, strict=True))
                ),
            ],
            range(1, len(paths) + 1),
        )
        put("")
    found = report.statistics
    values = ", ".join(f"{value:.3g}" for value in found.singular_values)
    put(f"reduced chi square {found.reduced:.4g} with {found.degrees} degrees of freedom; singular values {values}")
    put(str(done.folder))


def _doubts(done: Summary) -> list[str]:
    told = [
        f"{one.parameter.path} is not identified: {'; '.join(one.doubts)}"
        for one in done.report.estimates
        if one.doubts
    ]
    return [*told, *done.report.notes]
