"""`gw-exudyn fmu`: export a scenario as an FMU, run one, check one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from gw_exudyn.cli import options
from gw_exudyn.cli.console import put, put_json, put_table, tell
from gw_exudyn.errors import ComparisonError, SolverError, UsageError


@click.group(short_help="Export a scenario as a co-simulation FMU; run and check FMUs.")
def command() -> None:
    """A scenario as a co-simulation FMU (FMI 2.0 or 3.0), for any tool that imports such."""


@command.command(
    cls=options.ShippedCommand,
    short_help="Write a scenario's FMU.",
    help=f"""Write the FMU of SCENARIO: co-simulation, for Linux, Windows and macOS.

    {options.SCENARIO_HELP}. The FMU needs a Python that has gw-exudyn where it runs: the one of the environment
    variable GW_EXUDYN_PYTHON, else the one recorded in the FMU, else the first on the PATH.""",
)
@click.argument("scenario")
@options.overrides
@click.option("--out", "-o", metavar="FILE.fmu", help="The file. Without: NAME.fmu in the current folder.")
@click.option("--fmi", type=click.Choice(["2", "3"]), default="2", show_default=True, help="Version of the standard.")
@click.option("--stations", type=click.IntRange(2, 5000),
              help="Points along the wire at which FMI 3 shows its shape. Without: 51.")  # fmt: skip
@click.option("--bundled", is_flag=True, help="Put the worker with its own Python inside, for this platform alone.")
@click.option("--ssp", is_flag=True, help="Write a parameter set (SSV) and an example system (SSP) beside the FMU.")
@click.option("--python", metavar="PATH", help="Interpreter to record in the FMU. Without: this one.")
def export(
    scenario: str,
    overrides: tuple[str, ...],
    out: str | None,
    fmi: str,
    stations: int | None,
    bundled: bool,
    ssp: bool,
    python: str | None,
) -> None:
    """Load, check and write."""
    from gw_exudyn.fmi import export as exporting
    from gw_exudyn.fmi.ssp import files_beside, write_ssp
    from gw_exudyn.fmi.table import DEFAULT_STATIONS, variables_of
    from gw_exudyn.scenario import load_scenario

    if stations is not None and fmi == "2":
        raise UsageError("--stations: FMI 2.0 has no arrays to show the wire's shape in; add --fmi 3, or leave it out")
    points = stations or DEFAULT_STATIONS
    loaded = load_scenario(scenario, overrides)
    file = out or f"{loaded.name}.fmu"
    if ssp:
        files_beside(Path(file))  # before anything is written
    launch = exporting.launch_of(python)
    written = exporting.export(loaded, file, int(fmi), stations=points, launch=launch, bundled=bundled)
    put(str(written))
    if ssp:
        for further in write_ssp(loaded, written, variables_of(loaded, int(fmi), points)):
            put(str(further))
    if bundled:
        from gw_exudyn.fmi.bundle import this_platform

        tell(f"runs on {this_platform()} alone; the libraries for other platforms are left out")


@command.command(short_help="Run an FMU through fmpy.")
@click.argument("file", metavar="FILE.fmu")
@click.option("--set", "values", multiple=True, metavar="NAME=VALUE", help="Value of a parameter or an input, in SI.")
@click.option("--input", "inputs", metavar="FILE.csv", help="Inputs against time: header time,command.speed [mm/s].")
@click.option("--stop", type=float, help="Stop time, s. Without: the FMU's own.")
@click.option("--step", type=float, help="Communication step, s. Without: the FMU's own.")
@click.option(
    "--out", metavar="DIR", help="Folder for outputs.csv, stations.csv (FMI 3.0: the wire's shape) and run.json."
)
@options.as_json
def run(
    file: str,
    values: tuple[str, ...],
    inputs: str | None,
    stop: float | None,
    step: float | None,
    out: str | None,
    as_json: bool,
) -> int:
    """Run FILE.fmu and show its outputs at the end, or write them all into a folder."""
    from gw_exudyn.fmi.run_files import read_inputs, write_run
    from gw_exudyn.fmi.session import FmuSession

    chosen = dict(_pair(text) for text in values)
    with FmuSession(file) as session:
        table = read_inputs(inputs, session.units) if inputs else None
        done = session.run(chosen, inputs=table, stop=stop, step=step)
        final: dict[str, Any] = {n: value.item() for n, value in done.final.items() if value.ndim == 0}
        if out is not None:
            folder = write_run(done, session, chosen, out)
        units = {name: getattr(session.variables.get(name), "unit", None) or "" for name in final}
    if as_json:
        put_json({"status": done.code, "message": done.message, "final": final})
    elif out is not None:
        put(str(folder))
    else:
        put_table(
            [(name, f"{value:.9g}", "s" if name == "time" else units[name]) for name, value in final.items()], [1]
        )
    if done.code:
        tell(done.message)
    return 0 if done.trusted else SolverError.exit_code


def _pair(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals or not name.strip():
        raise UsageError(f"--set: {text!r} sets nothing; write name=value, as contact.friction_coefficient=0.2")
    return name.strip(), value.strip()


@command.command(short_help="Check FMUs with every checker that is installed.")
@click.argument("files", nargs=-1, required=True, metavar="FILE.fmu...")
@options.as_json
def check(files: tuple[str, ...], as_json: bool) -> int:
    """Check each FILE.fmu with every checker that is installed: fmpy, fmutool, libcosim."""
    from gw_exudyn.fmi.checking import check as checked

    verdicts = [(file, verdict) for file in files for verdict in checked(file)]
    if as_json:
        put_json(
            {"checks": [{"file": f, "checker": v.checker, "passed": v.passed, "found": v.found} for f, v in verdicts]}
        )
    else:
        words = {None: "not asked", True: "passed", False: "FAILED"}
        put_table([(file, v.checker, words[v.passed], "; ".join(v.found)) for file, v in verdicts])
    return ComparisonError.exit_code if any(v.passed is False for _, v in verdicts) else 0
