"""What the benchmarks share: running a case, the line about the machine, tables."""

from __future__ import annotations

import os
import platform
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

import numpy as np

from gw_exudyn.result import StatusReport
from gw_exudyn.scenario import scenario_from_dict
from gw_exudyn.simulation import Simulation


@dataclass(frozen=True)
class Outcome:
    """How a case went.

    cost : clock seconds per simulated second. work : processor seconds per simulated second, which other work on the
    machine disturbs less. tip : mm. push : N. deepest : micrometres, over all nominal steps. residuals : of the run.
    """

    status: StatusReport
    reached: float
    cost: float
    work: float
    tip: np.ndarray
    push: float
    deepest: float
    residuals: int


def run(case: dict[str, Any], repeat: int = 1) -> Outcome:
    """Run a case to its end or failure; of several runs the fastest counts, the result is the same. Time of the
    solution alone, in one thread."""
    simulation = Simulation(scenario_from_dict(case))
    step, cost, work = simulation.scenario.solver.step, np.inf, np.inf
    for _ in range(repeat):
        simulation.reset()
        began, worked, deepest = time.perf_counter(), time.process_time(), 0.0
        for i in range(round(simulation.duration / step)):
            going = simulation.advance(round((i + 1) * step, 9))
            deepest = max(deepest, simulation.penetration)
            if not going:
                break
        cost = min(cost, (time.perf_counter() - began) / simulation.time)
        work = min(work, (time.process_time() - worked) / simulation.time)
    outputs = simulation.outputs
    return Outcome(
        status=simulation.finished(),
        reached=simulation.time,
        cost=cost,
        work=work,
        tip=np.array([outputs["tip_x"], outputs["tip_y"]]) * 1e3,
        push=float(outputs["push_force"]),
        deepest=deepest * 1e6,
        residuals=simulation.counters["residuals"],
    )


def machine() -> str:
    """One line about where the numbers come from."""
    packages = ", ".join(f"{name} {version(name)}" for name in ("exudyn", "numpy"))
    return f"{cpu_name()}, {os.cpu_count()} cores, {platform.system()}, Python {platform.python_version()}, {packages}"


def cpu_name() -> str:
    """Name of the processor, where the system tells."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            for line in file:
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table in Markdown."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def verdict(value: float, limit: float) -> str:
    """A figure with its goal and whether it is met."""
    return f"{value:.3g} ({'<=' if value <= limit else 'MISSES'} {limit:g})"
