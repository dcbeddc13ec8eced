"""Sweeps: speed-up on two workers, overhead, same bits whatever the workers, and ten thousand points.

`python benchmarks/sweep.py speed` and `python benchmarks/sweep.py many`. Each part prints goal and figure.

A machine that others use gives no clean speed-up on the clock. So next to it stands what the sweep itself can lose:
the share of time in which a child process waits for its next point, and the processor time of everything but the
children. Speed-up is told on the clock and as what these leave of it.
"""

from __future__ import annotations

import argparse
import hashlib
import itertools
import json
import os
import resource
import shutil
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import psutil

sys.path.insert(0, str(Path(__file__).parent))
from harness import machine, verdict

from gw_exudyn.sweep.plan import Options, Progress
from gw_exudyn.sweep.run import run_sweep
from gw_exudyn.sweep.runner import Outcome, SimulationRunner, Task
from gw_exudyn.sweep.studies.loading import load_study

TIMES = "times.json"

SECOND = """
base: corner90-universal
set: {wire.segments: 200, solver.step: 100 ms, drive.distance: 45 mm}
vary:
  contact.friction_coefficient: {linspace: [0.05, 0.4, COUNT]}
"""
TRIVIAL = """
base: straight
set: {wire.segments: 5, solver.step: 1 s, output.interval: 1 s, drive.distance: 4 mm}
vary:
  contact.friction_coefficient: {linspace: [0.05, 0.4, COUNT]}
"""


class TimedRunner(SimulationRunner):
    """Runs scenarios and writes down when, on the clock and by the processor."""

    def run(self, task: Task) -> Outcome:
        """Run a point; its folder gets times.json besides."""
        began, worked = time.time(), time.process_time()
        outcome = super().run(task)
        times = {"process": os.getpid(), "began": began, "ended": time.time(), "work": time.process_time() - worked}
        files = {**outcome.files, TIMES: json.dumps(times).encode()}
        return Outcome(outcome.status, outcome.sentence, outcome.trusted, outcome.versions, files)


@dataclass(frozen=True)
class Look:
    """A look at a sweep: s on the clock, points done, processor seconds of sweep and workers, children apart."""

    clock: float
    done: int
    work: float


def sweep(text: str, count: int, jobs: int, folder: Path) -> list[Look]:
    """Run a study in `folder`; a look whenever a point came in."""
    file = folder / "study.yaml"
    file.write_text(text.replace("COUNT", str(count)))
    seen: list[Look] = []

    def look(progress: Progress) -> None:
        if not seen or seen[-1].done != progress.done:
            seen.append(Look(time.perf_counter(), progress.done, work_of_the_rest()))

    options = Options(jobs=jobs, figures=False, runner="sweep:TimedRunner")
    summary = run_sweep(load_study(file), folder / "out", options, report=look)
    if summary.completed != count:
        raise SystemExit(f"{summary.failed} points failed: {summary.failures[:3]}")
    return seen


def times_of(folder: Path) -> list[dict[str, float]]:
    """What the children wrote down, in order of time."""
    found = [json.loads(file.read_text()) for file in (folder / "out" / "points").glob(f"*/{TIMES}")]
    return sorted(found, key=lambda times: times["began"])


def waiting(times: list[dict[str, float]]) -> tuple[float, float]:
    """Share of their time in which children waited for their next point, and seconds of waiting a point."""
    waited, busy, gaps = 0.0, 0.0, 0
    for process in {one["process"] for one in times}:
        mine = [one for one in times if one["process"] == process]
        busy += sum(one["ended"] - one["began"] for one in mine)
        waited += sum(after["began"] - before["ended"] for before, after in itertools.pairwise(mine))
        gaps += len(mine) - 1
    return waited / (waited + busy), waited / gaps


def span(times: list[dict[str, float]]) -> float:
    """From the start of the first point to the end of the last, s."""
    return max(one["ended"] for one in times) - min(one["began"] for one in times)


def bits(folder: Path) -> str:
    """Digest of the time series of all points."""
    digest = hashlib.sha256()
    for file in sorted((folder / "out" / "points").glob("*/series.csv")):
        digest.update(file.parent.name.encode() + file.read_bytes())
    return digest.hexdigest()


def work_of_the_rest() -> float:
    """Processor seconds so far of this process and of the workers that it started, without those of their children."""
    here = psutil.Process()
    used = [process.cpu_times() for process in (here, *here.children())]
    return sum(one.user + one.system for one in used)


def speed(count: int) -> None:
    """Points of about a second on one and on two workers."""
    spans, digests = {}, set()
    for jobs in (1, 2):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            seen, times = sweep(SECOND, count, jobs, folder), times_of(folder)
            spans[jobs] = span(times)
            digests.add(bits(folder))
        work = sum(one["work"] for one in times)
        share, each = waiting(times)
        # Between the first points and the last ones, so without the start of anything.
        first = next(look for look in seen if look.done >= jobs)
        rest = (seen[-1].work - first.work) / (seen[-1].done - first.done) / (work / count)
        print(f"{jobs} worker(s): {count} points, {spans[jobs]:.1f} s from the first to the last on the clock")
        print(f"  processor time of a point {work / count:.3f} s, clock {spans[jobs] * jobs / count:.3f} s")
        print(f"  children wait {share:.4f} of their time ({each * 1e3:.1f} ms a point), goal: {verdict(share, 0.03)}")
        print(f"  processor time of the sweep and its workers over that of the points: {verdict(rest, 0.03)}")
        expected = jobs * (1 - share) / (1 + rest)
        print(f"  speed-up to expect of {jobs} cores of its own, all of that taken off: {expected:.3f}")
    print(f"speed-up measured on the clock: {spans[1] / spans[2]:.3f} (goal >= 1.85), load {os.getloadavg()[0]:.1f}")
    print(f"same bits on one and two workers: {'yes' if len(digests) == 1 else 'NO'}")


def many(count: int) -> None:
    """Trivial points: time a point along the sweep, and memory of the parent."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        seen = sweep(TRIVIAL, count, 2, folder)
        finished = time.perf_counter()
        times = times_of(folder)
        size = sum(file.stat().st_size for file in (folder / "out").glob("sweep.*"))
        shutil.rmtree(folder / "out")
    done, clock = np.array([look.done for look in seen]), np.array([look.clock for look in seen])
    rest = np.array([look.work for look in seen])
    edges = np.linspace(count * 0.05, done[-1], 6)
    pieces, rests = (np.diff(np.interp(edges, done, values)) / np.diff(edges) for values in (clock, rest))
    work = [one["work"] for one in times]
    fifths = [float(np.mean(part)) for part in np.array_split(work, 5)]
    print("clock time a point in fifths of the sweep, ms:", ", ".join(f"{piece * 1e3:.2f}" for piece in pieces))
    print("processor time of a point in the child, ms:   ", ", ".join(f"{piece * 1e3:.2f}" for piece in fifths))
    print("processor time of sweep and workers besides, ms: ", ", ".join(f"{piece * 1e3:.2f}" for piece in rests))
    for words, values in (("clock", pieces), ("processor", rests + fifths)):
        print(f"largest over smallest by the {words}: {verdict(float(values.max() / values.min()), 1.2)}")
    print(f"load {os.getloadavg()[0]:.1f}")
    print(f"table and data set after the last point: {finished - clock[-1]:.1f} s, {size / 1e6:.1f} MB")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"peak memory of the parent, MB: {verdict(peak, 500)}")


def main() -> None:
    """Run a part."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("part", choices=("speed", "many"))
    parser.add_argument("--points", type=int)
    chosen = parser.parse_args()
    # Children find the runner by its name.
    os.environ["PYTHONPATH"] = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    print(machine())
    if chosen.part == "speed":
        speed(chosen.points or 64)
    else:
        many(chosen.points or 10_000)


if __name__ == "__main__":
    main()
