"""What the FMU costs beside the direct run, in one process and in several.

    python benchmarks/fmu.py

Needs fmpy. Everything is measured side by side, in turns, and the least of several tries counts, since other work on
the machine only ever adds. Hosts call through ctypes, some microseconds a call, which is part of the figures.
"""

from __future__ import annotations

import argparse
import os
import statistics
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from harness import machine, table, verdict

from gw_exudyn.fmi.export import export
from gw_exudyn.scenario import load_scenario
from gw_exudyn.simulation import Simulation

STEP, FIRST, LAST = 0.01, 12.0, 13.0
"""Communication and solver step, s, and the stretch that is timed: the wire is in contact there."""


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
    spent = sum(int((task / "schedstat").read_text().split()[0]) for task in Path(f"/proc/{process}/task").iterdir())
    return 1e-9 * spent + time.process_time()


def beside_the_direct_run(folder: Path, simulation: Simulation, tries: int) -> tuple[float, float, float, float]:
    """(direct, FMU) on the clock, and (direct, FMU) of processor time, host and worker together, s, for the timed
    stretch; the least of several tries in turns, from the same state."""
    others = set(children())
    host = Host(folder)
    worker = worker_of(others)
    before, count = round(FIRST / STEP), round((LAST - FIRST) / STEP)
    host.steps(before)
    handle = host.calls.getFMUstate()
    simulation.advance(FIRST)
    state = simulation.get_state()

    def direct() -> None:
        for _ in range(count):
            simulation.step(STEP)

    times = []
    for _ in range(tries):
        simulation.set_state(state)
        host.calls.setFMUstate(handle)
        host.number = before
        began = time.process_time()
        a = seconds(direct)
        spent = time.process_time() - began
        began = processor_time(worker)
        b = seconds(lambda: host.steps(count))
        times.append((a, b, spent, processor_time(worker) - began))
    host.free()
    return tuple(min(column) for column in zip(*times, strict=True))  # type: ignore[return-value]


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


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=5)
    tries = parser.parse_args().repeat
    print(machine())
    scenario = load_scenario("corner90-universal", [f"solver.step={STEP}"])
    with tempfile.TemporaryDirectory() as scratch:
        folder, coarse = Path(scratch) / "fine", Path(scratch) / "coarse"
        extract(str(export(scenario, Path(scratch) / "fine.fmu")), unzipdir=str(folder))
        extract(str(export(load_scenario("corner90-universal"), Path(scratch) / "x.fmu")), unzipdir=str(coarse))
        median, least = round_trip(folder)
        new, spent, again, changed = starts(folder, tries)
        direct, fmu, direct_spent, fmu_spent = beside_the_direct_run(folder, Simulation(scenario), tries)
        ratio, on_free_cores = side_by_side(folder, tries)
        small = small_steps(coarse, max(1, tries // 2))
    rows = [
        ["a step of an empty model, median, us", verdict(1e6 * median, 60)],
        ["a step of an empty model, least, us", f"{1e6 * least:.3g}"],
        ["a new instance ready, s", verdict(new, 0.4)],
        ["its processor time, s", f"{spent:.3g}"],
        ["reset, ms", verdict(1e3 * again, 20)],
        ["reset with another friction, ms", f"{1e3 * changed:.3g}"],
        ["100 steps of 10 ms directly, s", f"{direct:.4g}"],
        ["100 steps of 10 ms in the FMU, s", f"{fmu:.4g}"],
        ["the FMU over the direct run", verdict(fmu / direct, 1.05)],
        ["the same of processor time, host and worker", verdict(fmu_spent / direct_spent, 1.05)],
        ["two instances at once over one after the other", f"{ratio:.3g} ({'>=' if ratio >= 1.8 else 'MISSES'} 1.8)"],
        ["the same by processor time, as on two free cores", f"{on_free_cores:.3g}"],
    ]
    print(f"\ncorner90-universal, n = {scenario.wire.segments}, solver and communication step {STEP * 1e3:.0f} ms\n")
    print(table(["what", "measured (goal)"], rows))
    print("\nthe same with the solver's step of 50 ms, free wire\n")
    print(table(["communication step, ms", "s per s"], [[f"{1e3 * step:g}", f"{cost:.3g}"] for step, cost in small]))


if __name__ == "__main__":
    main()
