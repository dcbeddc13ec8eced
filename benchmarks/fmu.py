"""What the FMU costs beside the direct run, in one process and in several.

    python benchmarks/fmu.py

Needs fmpy and Linux. Everything is measured side by side, in turns. FMU and direct run take many short turns, and the
median of the ratios counts; elsewhere the least of several tries does, since other work on the machine only ever adds.
Hosts call through ctypes, some microseconds a call, which is part of the figures.
"""

from __future__ import annotations

import argparse
import os
import statistics
import tempfile
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from harness import machine, table, verdict

from gw_exudyn.fmi.export import export
from gw_exudyn.scenario import load_scenario
from gw_exudyn.simulation import Simulation

STEP = 0.01
"""Communication and solver step, s."""

STRETCHES = {"free wire": 12.0, "in contact": 18.0}
"""Where turns begin, s: before the wire touches the vessel, and where it has four to five contacts with friction."""

STEPS, TURNS = 10, 40
"""Steps of a turn; turns of each in one try."""


class Host:
    """An instance, as bare as ctypes allows."""

    def __init__(self, folder: Path) -> None:
        description: Any = read_model_description(str(folder), validate=False)
        identifier = description.coSimulation.modelIdentifier
        self.calls = FMU2Slave(
            guid=description.guid, unzipDirectory=str(folder), modelIdentifier=identifier, instanceName="bench"
        )
        # fmpy's own calls take 30 us to log what they do not log; the library's are the host's of a study in C.
        self._step = self.calls.dll.fmi2DoStep
        from ctypes import c_double, c_int, c_void_p

        self._step.argtypes, self._step.restype = [c_void_p, c_double, c_double, c_int], c_int
        self.calls.instantiate()
        self.component = self.calls.component
        self.start()

    def start(self) -> None:
        self.calls.setupExperiment()
        self.calls.enterInitializationMode()
        self.calls.exitInitializationMode()
        self.number = 0

    def reset(self) -> None:
        self.calls.reset()
        self.start()

    def steps(self, count: int, step: float = STEP) -> None:
        for _ in range(count):
            if self._step(self.component, self.number * step, step, 1) != 0:
                raise RuntimeError("a step failed")
            self.number += 1

    def free(self) -> None:
        self.calls.freeInstance()


def seconds(work: Callable[[], object]) -> float:
    """What a piece of work takes on the clock, s."""
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def worker_of(before: set[int]) -> int:
    """The process that has been started since."""
    return (set(children()) - before).pop()


def children() -> list[int]:
    """Processes that this one has started (Linux)."""
    return [int(word) for task in Path("/proc/self/task").iterdir() for word in (task / "children").read_text().split()]


def processor_time(process: int) -> float:
    """Time, s, that a process and this one have had a processor: other work on the machine leaves it alone."""
    return time.clock_gettime(~process << 3 | 2) + time.process_time()  # Linux's number of the process's clock


@dataclass(frozen=True)
class Beside:
    """The FMU beside the direct run. direct, fmu : (turns,), s a step on the clock; spent_direct, spent_fmu : (turns,),
    s a step of processor time, host and worker together."""

    direct: np.ndarray
    fmu: np.ndarray
    spent_direct: np.ndarray
    spent_fmu: np.ndarray

    @property
    def clock(self) -> np.ndarray:
        """(turns,), the FMU over the direct run just before or after it, on the clock."""
        return self.fmu / self.direct

    @property
    def processor(self) -> np.ndarray:
        """(turns,), the same of processor time."""
        return self.spent_fmu / self.spent_direct


def beside_the_direct_run(folder: Path, simulation: Simulation, first: float, turns: int) -> Beside:
    """Turns of the same few steps from the same state, by the one and by the other; who is first changes each time.

    simulation : has the outputs that the FMU has, and makes them after each step.
    """
    others = set(children())
    host = Host(folder)
    worker, before = worker_of(others), round(first / STEP)
    host.steps(before)
    handle = host.calls.getFMUstate()
    simulation.reset()
    simulation.advance(first)
    state = simulation.get_state()

    def directly() -> tuple[float, float]:
        simulation.set_state(state)
        simulation.step(STEP)  # restoring has put other things into the caches
        worked = time.process_time()
        return seconds(lambda: [simulation.step(STEP) for _ in range(STEPS)]), time.process_time() - worked

    def in_the_fmu() -> tuple[float, float]:
        host.calls.setFMUstate(handle)
        host.number = before
        host.steps(1)
        worked = processor_time(worker)
        return seconds(lambda: host.steps(STEPS)), processor_time(worker) - worked

    rows = []
    for turn in range(turns):
        pair = [directly(), in_the_fmu()] if turn % 2 else [in_the_fmu(), directly()][::-1]
        rows.append([pair[0][0], pair[1][0], pair[0][1], pair[1][1]])
    host.free()
    return Beside(*np.transpose(rows) / STEPS)


def on_one_processor(work: Callable[[], Beside]) -> Beside:
    """Host, worker and direct run on the same processor: they take turns anyway, and none waits for another to wake."""
    mine = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {max(mine)})  # and so for the processes that are started from now on
    try:
        return work()
    finally:
        os.sched_setaffinity(0, mine)


def round_trip(folder: Path, calls: int = 3000) -> tuple[float, float]:
    """(median, least), s, of a step of an empty model."""
    file = folder / "resources" / "wrapper.txt"
    text = file.read_text(encoding="utf-8")
    empty = Path(__file__).with_name("empty_worker.py").resolve()
    file.write_text(text.replace("argument -m\nargument gw_exudyn.fmi.worker", f"argument {empty}"), encoding="utf-8")
    host = Host(folder)
    times = [seconds(lambda: host.steps(1)) for _ in range(calls)]
    host.free()
    file.write_text(text, encoding="utf-8")
    return statistics.median(times), min(times)


def starts(folder: Path, tries: int) -> tuple[float, float, float, float]:
    """Least times, s: a new instance until its first outputs, its processor time, a reset until then, a reset with
    another friction."""
    new, spent, again, changed = [], [], [], []
    for i in range(tries):
        others, began, worked = set(children()), time.perf_counter(), time.process_time()
        host = Host(folder)
        new.append(time.perf_counter() - began)
        spent.append(processor_time(worker_of(others)) - worked)
        host.steps(1)
        again.append(seconds(host.reset))
        description: Any = read_model_description(str(folder), validate=False)
        friction = next(v for v in description.modelVariables if v.name == "contact.friction_coefficient")
        began = time.perf_counter()
        host.calls.reset()
        host.calls.setReal([friction.valueReference], [0.1 + 0.01 * i])
        host.start()
        changed.append(time.perf_counter() - began)
        host.free()
    return min(new), min(spent), min(again), min(changed)


def side_by_side(folder: Path, tries: int) -> tuple[float, float]:
    """How many times as fast two instances are in two threads as one after the other, on the clock; and twice the
    processor time of both workers alone over that at once, which is what two free cores would give. Least times of
    several tries in turns."""
    hosts, workers = [], []
    for _ in range(2):
        others = set(children())
        hosts.append(Host(folder))
        workers.append(worker_of(others))
    count, rows = 300, []
    for _ in range(tries):
        for host in hosts:
            host.reset()
        began = [processor_time(worker) - time.process_time() for worker in workers]
        alone = sum(seconds(lambda host=host: host.steps(count)) for host in hosts)
        alone_spent = [processor_time(worker) - time.process_time() for worker in workers]
        for host in hosts:
            host.reset()
        threads = [threading.Thread(target=host.steps, args=(count,)) for host in hosts]
        again = [processor_time(worker) - time.process_time() for worker in workers]

        def together(threads: list[threading.Thread] = threads) -> None:
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()

        both = seconds(together)
        both_spent = [processor_time(worker) - time.process_time() for worker in workers]
        rows.append((alone, both, sum(alone_spent) - sum(began), sum(both_spent) - sum(again)))
    for host in hosts:
        host.free()
    alone, both, spent_alone, spent_both = (min(column) for column in zip(*rows, strict=True))
    return alone / both, 2 * spent_alone / spent_both


def small_steps(folder: Path, tries: int) -> list[tuple[float, float]]:
    """(communication step, s; s on the clock for a simulated second) where the solver's step is 50 ms."""
    rows = []
    for step in (0.1, 0.05, 0.01, 0.001):
        host = Host(folder)
        best = float("inf")
        for _ in range(tries):
            host.reset()
            best = min(best, seconds(lambda host=host, step=step: host.steps(round(1.0 / step), step)))
        host.free()
        rows.append((step, best))
    return rows


def beside_rows(folder: Path, simulation: Simulation, turns: int, first_of_all: bool) -> list[list[str]]:
    """A row a stretch and placing on processors: the medians, with the quartiles of the ratios. first_of_all : before
    all other work."""
    if first_of_all:
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))  # and so the workers that are started from now on
    rows = []
    for stretch, first in STRETCHES.items():
        for placed, run in {"on one processor": on_one_processor, "as the system likes": lambda work: work()}.items():
            found = run(lambda first=first: beside_the_direct_run(folder, simulation, first, turns))
            rows.append([stretch, placed, f"{1e3 * np.median(found.direct):.3g}"])
            for ratio in (found.clock, found.processor):
                low, middle, high = np.quantile(ratio, [0.25, 0.5, 0.75])
                rows[-1].append(f"{verdict(middle, 1.05)} [{low:.3f}, {high:.3f}]")
    if first_of_all:
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
    return rows


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=5)
    text = "FMU and direct run before all other work on the machine (as root, Linux), which then disturbs neither"
    parser.add_argument("--first", action="store_true", help=text)
    options = parser.parse_args()
    tries = options.repeat
    print(machine())
    scenario = load_scenario("corner90-universal", [f"solver.step={STEP}"])
    with tempfile.TemporaryDirectory() as scratch:
        folder, coarse = Path(scratch) / "fine", Path(scratch) / "coarse"
        extract(str(export(scenario, Path(scratch) / "fine.fmu")), unzipdir=str(folder))
        extract(str(export(load_scenario("corner90-universal"), Path(scratch) / "x.fmu")), unzipdir=str(coarse))
        median, least = round_trip(folder)
        new, spent, again, changed = starts(folder, tries)
        beside = beside_rows(folder, Simulation(scenario, shape=False), TURNS * tries, options.first)
        ratio, on_free_cores = side_by_side(folder, tries)
        small = small_steps(coarse, max(1, tries // 2))
    rows = [
        ["a step of an empty model, median, us", verdict(1e6 * median, 60)],
        ["a step of an empty model, least, us", f"{1e6 * least:.3g}"],
        ["a new instance ready, s", verdict(new, 0.4)],
        ["its processor time, s", f"{spent:.3g}"],
        ["reset, ms", verdict(1e3 * again, 20)],
        ["reset with another friction, ms", f"{1e3 * changed:.3g}"],
        ["two instances at once over one after the other", f"{ratio:.3g} ({'>=' if ratio >= 1.8 else 'MISSES'} 1.8)"],
        ["the same by processor time, as on two free cores", f"{on_free_cores:.3g}"],
    ]
    print(f"\ncorner90-universal, n = {scenario.wire.segments}, solver and communication step {STEP * 1e3:.0f} ms\n")
    print(table(["what", "measured (goal)"], rows))
    print(f"\nbeside the direct run, {TURNS * tries} turns of {STEPS} steps each; in brackets the quartiles\n")
    print(table(["stretch", "placed", "direct, ms a step", "FMU over direct, clock", "processor time"], beside))
    print("\nthe same with the solver's step of 50 ms, free wire\n")
    print(table(["communication step, ms", "s per s"], [[f"{1e3 * step:g}", f"{cost:.3g}"] for step, cost in small]))


if __name__ == "__main__":
    main()
