"""A calibration from its file to its folder."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from gw_exudyn.calibration.fit import fitted
from gw_exudyn.calibration.form import Calibration
from gw_exudyn.calibration.objective import Step
from gw_exudyn.calibration.outputs import SIMULATIONS, content_of, prepare, write_outputs
from gw_exudyn.calibration.report import Report, report_of
from gw_exudyn.calibration.simulations import simulations
from gw_exudyn.sweep.folder import SweepFolder
from gw_exudyn.sweep.identity import this_maker
from gw_exudyn.sweep.plan import Options

Look = Callable[[Step, int], None]
"""Called with every point that was tried, and the simulations so far."""


@dataclass(frozen=True, eq=False)
class Summary:
    """What a calibration came to. content : of fit.json. files : all that were written."""

    folder: Path
    report: Report
    content: Mapping[str, Any]
    files: list[Path] = field(default_factory=list)


def run_calibration(
    calibration: Calibration,
    folder: Path,
    options: Options | None = None,
    *,
    look: Look = lambda step, count: None,
    should_stop: Callable[[], bool] = lambda: False,
) -> Summary:
    """Fit, and write the folder. What was simulated before is not run again.

    options : as a sweep's. should_stop : asked a few times a second.

    Raises Interrupted where it was stopped (what is done is kept), SolverError where the start values give no
    simulation, ScenarioError where there is nothing to compare, StorageError for the folder or the disk, UsageError
    for a scheduler that does not answer.
    """
    options = options or Options(command=f"gw-exudyn calibrate {calibration.file}")
    maker = this_maker(options.runner)
    prepare(folder)
    with SweepFolder(folder / SIMULATIONS) as place:
        place.write_about(
            {
                "name": calibration.name,
                "calibration": str(calibration.file),
                "parameters": {one.path: one.unit for one in calibration.parameters},
                "command": options.command,
                "versions": dict(maker.versions),
                "code": maker.code,
            }
        )
        if options.fresh:
            place.clear()
        with simulations(place, options, should_stop) as simulate:
            fit, observations = fitted(calibration, simulate, lambda step: look(step, simulate.asked))
            counts = {"asked": simulate.asked, "run": simulate.run, "failed": simulate.failed}
        report = report_of(calibration, fit, observations)
        further = {"simulations": counts, "versions": dict(maker.versions), "code": maker.code}
        content = content_of(report, options.command, further)
        files = write_outputs(report, folder, content, options.figures)
    return Summary(folder, report, content, files)
