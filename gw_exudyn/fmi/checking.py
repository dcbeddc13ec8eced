"""Every checker of FMUs that is installed, over one file, as one table."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from gw_exudyn.errors import GwError
from gw_exudyn.fmi.session import FmuSession


@dataclass(frozen=True)
class Verdict:
    """What a checker said. passed : None where it could not be asked; then `found` says why."""

    checker: str
    passed: bool | None
    found: tuple[str, ...]


_STEPS = 5


def check(file: str | os.PathLike[str]) -> list[Verdict]:
    """All checkers over one FMU."""
    return [_asked(name, module, checker, Path(file)) for name, module, checker in _CHECKERS]


def _asked(name: str, module: str, checker: Callable[[Path], list[str]], file: Path) -> Verdict:
    if find_spec(module) is None:
        return Verdict(name, None, (f"the package {module} is not installed",))
    try:
        found = checker(file)
    except NotImplementedError as error:
        return Verdict(name, None, (str(error),))
    except Exception as error:  # a checker that breaks down has found something
        return Verdict(name, False, (f"{type(error).__name__}: {error}",))
    return Verdict(name, not found, tuple(found))


def _fmpy(file: Path) -> list[str]:
    from fmpy.validation import validate_fmu

    return [str(problem) for problem in validate_fmu(str(file))]


def _fmutool(file: Path) -> list[str]:
    _only_fmi2(file, "fmutool")
    run = subprocess.run(
        [sys.executable, "-m", "fmu_manipulation_toolbox", "-input", str(file), "-check"],
        capture_output=True,
        text=True,
        timeout=120,
    )
    lines = [line.strip() for line in (run.stdout + run.stderr).splitlines()]
    problems = [line for line in lines if any(word in line for word in ("ERROR", "FAIL", "not compliant", "Traceback"))]
    if run.returncode != 0 and not problems:
        problems = lines[-3:] or [f"ended with code {run.returncode}"]
    return problems


def _runs(file: Path) -> list[str]:
    """It runs, and a second run after a reset gives the same to the bit."""
    try:
        with FmuSession(file) as session:
            step = float(session.description.defaultExperiment.stepSize)
            first, second = (session.run(stop=_STEPS * step, step=step) for _ in range(2))
    except GwError as error:
        return [str(error)]
    return [] if first.outputs.tobytes() == second.outputs.tobytes() else ["a second run after a reset differs"]


def _only_fmi2(file: Path, checker: str) -> Any:
    """The FMU's description. Raises NotImplementedError for another version than 2.0."""
    from fmpy import read_model_description

    description = read_model_description(str(file), validate=False)
    if description.fmiVersion != "2.0":
        raise NotImplementedError(f"{checker} has no FMI {description.fmiVersion}")
    return description


def _libcosim(file: Path) -> list[str]:
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimSlave import CosimLocalSlave

    description = _only_fmi2(file, "libcosim")
    log_output_level(CosimLogLevel.ERROR)

    nanoseconds = round(float(description.defaultExperiment.stepSize) * 1e9)
    execution = CosimExecution.from_step_size(nanoseconds)
    execution.add_local_slave(CosimLocalSlave(fmu_path=str(file), instance_name="checked"))
    if not execution.step(_STEPS):
        return ["it does not step"]
    reached = execution.status().current_time
    return [] if reached == _STEPS * nanoseconds else [f"it stepped to {reached} ns, not {_STEPS * nanoseconds} ns"]


_CHECKERS: tuple[tuple[str, str, Callable[[Path], list[str]]], ...] = (
    ("fmpy validation", "fmpy", _fmpy),
    ("fmpy run and rerun", "fmpy", _runs),
    ("fmutool", "fmu_manipulation_toolbox", _fmutool),
    ("libcosim", "libcosimpy", _libcosim),
)
