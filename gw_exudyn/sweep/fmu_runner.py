"""Points run by an FMU: one instance a process, reset from point to point."""

from __future__ import annotations

import hashlib
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gw_exudyn.errors import UsageError
from gw_exudyn.fmi import variables as names
from gw_exudyn.result import Result, Status, StatusReport
from gw_exudyn.sweep.runner import Outcome, SimulationRunner, Task

if TYPE_CHECKING:
    from gw_exudyn.fmi.session import FmuRun
    from gw_exudyn.scenario import Scenario
    from gw_exudyn.sweep.studies.study import Study

FMU = "gw_exudyn.sweep.fmu_runner:FmuRunner"
"""The runner, without the file of its FMU, which goes behind another colon."""

NOT_TOLD = ("snaps", "snap_energy_max")
"""Metrics that an FMU's outputs do not give."""


@contextmanager
def fmu_runner(study: Study) -> Iterator[str]:
    """The name of a runner of a study's FMU: its base where that is one, else exported for as long as this lasts."""
    if study.fmu is not None:
        yield f"{FMU}:{study.fmu.absolute()}"
        return
    from gw_exudyn.fmi.export import export

    with tempfile.TemporaryDirectory(prefix="gw-fmu-") as folder:
        yield f"{FMU}:{export(study.scenario(0), Path(folder, 'base.fmu'))}"


class FmuRunner:
    """Runs scenarios by an FMU of the same version of this package. What its parameters can't say it reads from a
    file; so every scenario can be run, and none differs from what was asked.

    file : the FMU.
    """

    def __init__(self, file: str) -> None:
        import gw_exudyn
        from gw_exudyn.fmi.resources import read_scenario
        from gw_exudyn.fmi.session import FmuSession
        from gw_exudyn.scenario import scenario_from_dict

        self._session = FmuSession(file)
        theirs = self._session.version
        if theirs != gw_exudyn.__version__:
            self._session.close()
            raise UsageError(f"{file} is of gw-exudyn {theirs}, and this is {gw_exudyn.__version__}; export it again")
        self._base = scenario_from_dict(read_scenario(self._session.resources))
        self._starts = _parameters(self._base)
        self._native: SimulationRunner | None = None

    def run(self, task: Task) -> Outcome:
        """Run a scenario. Its whole folder, with the wire's shape, comes from the simulation itself."""
        from gw_exudyn.scenario import scenario_from_dict

        if task.whole:
            self._native = self._native or SimulationRunner()
            return self._native.run(task)
        scenario = scenario_from_dict(task.scenario)
        with self._values(scenario) as values:
            began = time.perf_counter()
            run = self._session.run(values, stop=scenario.drive.duration, step=_interval(scenario))
            spent = time.perf_counter() - began
        result = as_result(run, scenario, spent, task.note)
        return Outcome(
            status=result.status.status.name.lower(),
            sentence=result.status.sentence(),
            trusted=result.status.status.trusted,
            versions=result.provenance["versions"],
            files=_encoded(result, task.command),
        )

    @contextmanager
    def _values(self, scenario: Scenario) -> Iterator[dict[str, Any]]:
        """Values of the FMU's parameters that make this scenario of the exported one; or a file that holds it."""
        from gw_exudyn.fmi.overriding import overridden

        wanted = _parameters(scenario)
        changed = {name: wanted[name] for name, start in self._starts.items() if wanted.get(name, start) != start}
        if _same(overridden(self._base, changed), scenario):
            yield changed
            return
        import yaml

        with tempfile.NamedTemporaryFile("w", suffix=".yaml", prefix="gw-fmu-", encoding="utf-8") as file:
            yaml.safe_dump(scenario.to_dict(), file)
            file.flush()
            yield {names.SCENARIO_FILE: file.name}


def _interval(scenario: Scenario) -> float:
    return float(min(scenario.output.interval, scenario.drive.duration))


def _parameters(scenario: Scenario) -> dict[str, Any]:
    """Values of a scenario that an FMU of it has as parameters, by name."""
    from gw_exudyn.fmi.table import variables_of

    return {v.name: v.start for v in variables_of(scenario, 2) if v.role == names.FIXED and v.source not in ("", "-")}


def _same(one: Scenario, other: Scenario) -> bool:
    """Nothing but their names differs, which no number depends on, and how often outputs are kept, which is the
    host's business here."""
    ours, theirs = ({k: v for k, v in x.to_dict().items() if k not in ("name", "output")} for x in (one, other))
    return ours == theirs


def as_result(run: FmuRun, scenario: Scenario, wall_time: float, note: Mapping[str, Any]) -> Result:
    """A result of the FMU's outputs. The wire's shape is not among them, and is not a number there."""
    nodes = scenario.wire.segments + 1
    peaks = {peak: tuple(float(run.final[name]) for name in names.peak_names(peak)) for peak in names.PEAKS}
    return Result.from_samples(
        [_sample(row, run, nodes) for row in run.outputs],
        scenario=scenario,
        status=_report(run),
        node_arc_length=np.full(nodes, np.nan),
        joint_arc_length=np.full(nodes - 1, np.nan),
        provenance={"engine": "fmu", **note},
        wall_time=wall_time,
        peaks={name: (value, at) for name, (value, at) in peaks.items() if value > 0},
    )


def _sample(row: Any, run: FmuRun, nodes: int) -> dict[str, Any]:
    """One instant: the scalars, and of the contacts the one that presses hardest on the vessel."""
    from gw_exudyn.fmi.variables import output_name
    from gw_exudyn.metrics.forces import VESSEL
    from gw_exudyn.quantities import CONTACT_FIELDS, JOINT_FIELDS, NODE_FIELDS, QUANTITIES, SCALARS

    # fmpy adds the steps up; their sum is this time but for the last bits.
    sample: dict[str, Any] = {"time": round(float(row["time"]), 12)}
    sample |= {name: float(row[output_name(name)]) for name in SCALARS}
    sample |= {name: np.full(nodes, np.nan) for name in NODE_FIELDS}
    sample |= {name: np.full(nodes - 1, np.nan) for name in JOINT_FIELDS}
    touches = int(sample["wall_force_max"] > 0)
    contact = {name: -1.0 if QUANTITIES[name].integer else np.nan for name in CONTACT_FIELDS}
    contact |= {"contact_normal_force": sample["wall_force_max"], "contact_tangential_force": 0.0}
    contact |= {"contact_owner": VESSEL}
    contact |= {field: float(row[name]) for name, field in names.PLACE_OF_LARGEST.items()}
    return sample | {name: np.full(touches, value) for name, value in contact.items()}


def _report(run: FmuRun) -> StatusReport:
    """How the run ended. The FMU tells the facts in a sentence, in brackets behind what happened."""
    if run.code == 0:
        return StatusReport(Status.COMPLETED, float(run.final["time"]))
    status = list(Status)[run.code]
    facts = run.message.removeprefix(f"{status.problem} (").removesuffix(f"). {status.remedy}")
    return StatusReport(status, None, "", facts)


def _encoded(result: Result, command: str) -> dict[str, bytes]:
    """Content of series.csv and run.json by name."""
    from gw_exudyn.storage.manifest import MANIFEST, manifest, to_text
    from gw_exudyn.storage.series import SERIES, series_text

    series = series_text(result).encode()
    content = manifest(result, command, {SERIES: hashlib.sha256(series).hexdigest()})
    for name in NOT_TOLD:
        content["metrics"][name]["value"] = float("nan")
    return {SERIES: series, MANIFEST: to_text(content).encode()}


def check_options(keep_runs: bool, scheduler: str | None) -> None:
    """Raises UsageError for what can't be had of an FMU."""
    if keep_runs:
        raise UsageError("--keep-runs: an FMU tells no shapes of the wire to keep; leave it out, or --engine fmu")
    if scheduler is not None:
        raise UsageError("--scheduler: the FMU is a file of this machine; leave it out, or --engine fmu")
