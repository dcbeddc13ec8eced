"""`gw-exudyn run`: simulate scenarios and write their run folders."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gw_exudyn.cli import options
from gw_exudyn.cli.console import put, put_json, tell
from gw_exudyn.errors import Interrupted, Problem, ScenarioError, SolverError, UsageError

if TYPE_CHECKING:
    from gw_exudyn.cli.stopping import Stop
    from gw_exudyn.result import Result
    from gw_exudyn.scenario import Scenario

RUNS = Path("results", "runs")
"""Where run folders go under the current folder."""


@dataclass(frozen=True)
class Job:
    """A scenario to simulate. folder : where its run goes. command : what a person types to repeat it."""

    scenario: Scenario
    folder: Path
    command: str


@click.command(
    cls=options.ShippedCommand,
    short_help="Simulate scenarios and write their run folders.",
    help=f"""Simulate each SCENARIO and write its run folder: run.nc, series.csv, run.json and figures.

    {options.SCENARIO_HELP}. The names of the run folders are written to stdout. Ctrl-C stops the simulation and keeps
    what it has got to.""",
)
@click.argument("scenarios", nargs=-1, required=True, metavar="SCENARIO...")
@options.overrides
@click.option(
    "--out",
    metavar="DIR",
    help="The run folder (of one scenario), or the folder that holds the run folders (of several). "
    f"Without: {RUNS.as_posix()}/NAME. A run of before is replaced.",
)
@options.as_json
@click.option("--quiet", "-q", is_flag=True, help="No progress and no summary; only what goes wrong is told.")
@click.option("--no-figures", is_flag=True, help="Leave out the figures.")
def command(
    scenarios: tuple[str, ...],
    overrides: tuple[str, ...],
    out: str | None,
    as_json: bool,
    quiet: bool,
    no_figures: bool,
) -> int:
    """Check everything first, then simulate one after the other; the exit code is that of the worst run."""
    from gw_exudyn.cli.stopping import Stop

    jobs = plan(scenarios, overrides, out)
    _check_before_start(jobs)
    code, entries = 0, []
    with Stop() as stop:
        for job in jobs:
            result = _simulate(job, stop, quiet)
            entries.append(_keep(job, result, quiet, as_json, not no_figures))
            if not result.status.status.trusted:
                code = SolverError.exit_code
            if stop.asked:
                _tell_left_out(jobs[len(entries) :])
                code = Interrupted.exit_code
                break
    if as_json:
        put_json({"runs": entries})
    return code


def plan(scenarios: tuple[str, ...], overrides: tuple[str, ...], out: str | None) -> list[Job]:
    """Load all scenarios and give each its folder.

    Raises ScenarioError with the problems of all of them, and UsageError if two would share a folder.
    """
    from gw_exudyn.scenario import load_scenario

    jobs, problems = [], []
    for name in scenarios:
        try:
            scenario = load_scenario(name, overrides)
        except ScenarioError as error:
            problems += [problem for problem in error.problems if problem not in problems]
            continue
        folder = Path(out) if out and len(scenarios) == 1 else Path(out or RUNS) / scenario.name
        jobs.append(Job(scenario, folder, _command_line(name, overrides, folder if out else None)))
    if problems:
        raise ScenarioError(problems)
    _refuse_shared_folders(jobs)
    return jobs


def _command_line(scenario: str, overrides: tuple[str, ...], folder: Path | None) -> str:
    words = ["gw-exudyn", "run", scenario, *(word for text in overrides for word in ("--set", text))]
    return shlex.join([*words, "--out", str(folder)] if folder else words)


def _refuse_shared_folders(jobs: list[Job]) -> None:
    folders: set[Path] = set()
    for job in jobs:
        place = job.folder.resolve()
        if place in folders:
            raise UsageError(
                f"two scenarios are named {job.scenario.name!r} and would share the run folder {job.folder}; "
                "rename one (name: in its file), or run them one by one with --out"
            )
        folders.add(place)


def _check_before_start(jobs: list[Job]) -> None:
    """Find out before a long run what would stop it at the start or at the end."""
    from gw_exudyn import model
    from gw_exudyn.engine.library import exudyn
    from gw_exudyn.storage import check_run_folder

    problems: list[Problem] = []
    warnings: list[str] = []
    for job in jobs:
        try:
            warnings += model.build(job.scenario).warnings
        except ScenarioError as error:
            problems += error.problems
    if problems:
        raise ScenarioError(problems)
    for warning in warnings:
        tell(f"warning: {warning}")
    for job in jobs:
        check_run_folder(job.folder)
    exudyn()


def _simulate(job: Job, stop: Stop, quiet: bool) -> Result:
    from gw_exudyn import simulation
    from gw_exudyn.cli.progress import progress

    with progress(job.scenario, quiet) as report:
        result = simulation.simulate(job.scenario, progress=report, should_stop=stop.should_stop)
    stop.leave_if_pressed_again()
    return result


def _keep(job: Job, result: Result, quiet: bool, as_json: bool, figures: bool) -> dict[str, Any]:
    """Write the run folder, say what came out, and give the run's entry for JSON."""
    from gw_exudyn.storage import write_run
    from gw_exudyn.storage.manifest import read_manifest

    folder = write_run(result, job.folder, job.command, figures=figures)
    report = result.status
    if not report.status.ok:
        tell(f"{job.scenario.name}: {report.sentence()}")
    if not quiet:
        _tell_summary(job.scenario.name, result)
    if not as_json:
        put(str(folder))
        return {}
    content = read_manifest(folder)
    kept = {name: content[name] for name in ("name", "status", "trusted", "wall_time", "metrics", "snaps", "command")}
    drawn = sorted((folder / "figures").glob("*")) if figures else []
    return {"folder": str(folder), **kept, "figures": [str(path) for path in drawn]}


def _tell_summary(name: str, result: Result) -> None:
    from gw_exudyn.cli.numbers import metric_text
    from gw_exudyn.metrics import metrics

    found = metrics(result)
    shown = {
        "depth": "final_insertion_depth",
        "largest push force": "push_force_max",
        "largest wall force": "wall_force_max",
        "deepest penetration": "penetration_max",
    }
    facts = ", ".join(f"{words} {metric_text(key, found[key])}" for words, key in shown.items())
    tell(f"{name}: {facts} ({result.wall_time:.3g} s)")


def _tell_left_out(jobs: list[Job]) -> None:
    if jobs:
        tell(f"interrupted; not run: {', '.join(job.scenario.name for job in jobs)}")
