"""What the scripts of the paper's study share: runs on two cores, tables that repeat byte for byte, timings.

Every script has `main(out, quick)`. `quick` runs a short and coarse version of all of it, for tests and for looking.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")  # a run is one thread; before numpy is loaded
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import csv
import io
import sys
import time
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from multiprocessing import get_context
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from gw_exudyn import Result, load_scenario, simulate
from gw_exudyn.plots.style import BLUE, VERMILLION

HERE = Path(__file__).resolve().parent
OUT = HERE.parents[1] / "results" / "paper"
WORKERS = 2

WIRES = {"universal": "phantom-universal", "amplatz": "phantom-amplatz"}
"""The paper's two wires by the shipped scenario of each."""

TITLES = {"universal": "Universal II", "amplatz": "Amplatz Super Stiff"}
COLOURS = {"universal": BLUE, "amplatz": VERMILLION}
ESTIMATES = ("low", "best", "high")
"""Bending stiffness is an estimate: every figure shows the runs at its bounds as a band."""

QUICK = {"wire.segments": 24, "solver.step": 0.1, "output.interval": 0.2, "drive.distance": 0.03}

Key = TypeVar("Key", bound=Hashable)
Floats = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class Case:
    """A scenario (its file, or the name of a shipped one) with overrides."""

    scenario: str | Path
    overrides: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class _Job:
    case: Case
    keep: Callable[[Result], Any]

    def __call__(self) -> tuple[Any, float, float]:
        """What is kept of the run, and what it took: s on the clock, s of the processor."""
        scenario = load_scenario(self.case.scenario, self.case.overrides)
        began = time.process_time()
        result = simulate(scenario)
        return self.keep(result), result.wall_time, time.process_time() - began


def whole(result: Result) -> Result:
    """Keeps all of a run."""
    return result


def run_all(script: str, cases: Mapping[Key, Case], out: Path, keep: Callable[[Result], Any] = whole) -> dict[Key, Any]:
    """Run all cases and return what `keep` (a function of a module) makes of each, by key and in the cases' order.

    How long each took goes into timings.csv, in place of what the script wrote there before.
    """
    jobs = [_Job(case, keep) for case in cases.values()]
    if WORKERS == 1:
        found = [job() for job in jobs]
    else:
        # spawn: a fresh process knows nothing of this one, on every system alike.
        with ProcessPoolExecutor(WORKERS, mp_context=get_context("spawn")) as pool:
            found = list(pool.map(_call, jobs))
    _write_timings(script, {_words(key): row[1:] for key, row in zip(cases, found, strict=True)}, out)
    return {key: row[0] for key, row in zip(cases, found, strict=True)}


def _call(job: _Job) -> tuple[Any, float, float]:
    return job()


def _words(key: Hashable) -> str:
    return " ".join(str(part) for part in key) if isinstance(key, tuple) else str(key)


TIMINGS = "timings.csv"


def _write_timings(script: str, times: Mapping[str, Sequence[float]], out: Path) -> None:
    """Timings stand in a file of their own, since they are never the same twice."""
    rows = [row for row in read_table(out / TIMINGS) if row["script"] != script] if (out / TIMINGS).exists() else []
    rows += [
        {"script": script, "run": name, "wall_time [s]": round(wall, 2), "processor_time [s]": round(used, 2)}
        for name, (wall, used) in times.items()
    ]
    write_table(out / TIMINGS, sorted(rows, key=lambda row: row["script"]))


def write_table(path: Path, rows: Sequence[Mapping[str, Any]]) -> None:
    """Rows of one shape as CSV; floats with six digits."""
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows({name: _cell(value) for name, value in row.items()} for row in rows)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(text.getvalue().encode())


def _cell(value: Any) -> Any:
    if isinstance(value, float | np.floating):
        return "" if np.isnan(value) else f"{float(value):.6g}"
    return value


def read_table(path: Path) -> list[dict[str, str]]:
    """A table as `write_table` wrote it, all cells as text."""
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def status(result: Result) -> str:
    """How a run ended, in one word."""
    return result.status.status.name.lower()


def check(results: Iterable[Result]) -> None:
    """Stops the script where a run cannot be trusted: no figure is drawn of it."""
    for result in results:
        if not result.status.status.trusted:
            sys.exit(f"{result.scenario.name}: {result.status.sentence()}")


def phantom_cases(wires: Iterable[str], overrides: Mapping[str, Any], quick: bool) -> dict[tuple[str, str], Case]:
    """Each wire in the phantom at each estimate of its bending stiffness, by (wire, estimate)."""
    extra = QUICK if quick else {}
    return {
        (wire, estimate): Case(WIRES[wire], {"wire.estimate": estimate, **overrides, **extra})
        for wire in wires
        for estimate in ESTIMATES
    }


def entries(result: Result) -> dict[str, float]:
    """Time, s, at which the tip first came into each branch of the vessel."""
    tip = np.column_stack([result.values("tip_x"), result.values("tip_y")])
    names = [str(name) for name in result.scenario.vessel.branch_at(tip)]
    return {name: float(result.time[names.index(name)]) for name in dict.fromkeys(names) if name}


def band(curves: Sequence[Floats]) -> tuple[Floats, Floats]:
    """Lowest and highest of curves over the same abscissa."""
    return np.min(curves, axis=0), np.max(curves, axis=0)


def over(result: Result, name: str, grid: Floats, abscissa: str = "time") -> Floats:
    """A quantity on a grid of time (s) or insertion depth (m), linear in between; NaN where the run had ended."""
    return np.interp(grid, result.values(abscissa), result.values(name), left=np.nan, right=np.nan)


def command(main: Callable[..., None]) -> None:
    """Runs a script as a command: `python scenarios/paper/fig6.py [--quick] [--out FOLDER]`."""
    from argparse import ArgumentParser

    parser = ArgumentParser(description=(sys.modules["__main__"].__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, default=OUT, help="folder of tables and figures")
    parser.add_argument("--quick", action="store_true", help="a short and coarse version of all of it")
    given = parser.parse_args()
    began = time.monotonic()
    main(given.out, quick=given.quick)
    sys.stdout.write(f"{Path(sys.argv[0]).stem}: {given.out} ({time.monotonic() - began:.0f} s)\n")
