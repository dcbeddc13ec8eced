"""Calibration: known values recovered from noisy synthetic data, and how often the stated intervals hold them.

`python benchmarks/calibration.py [--seeds 20] [--jobs 2] [--scene arc90] [--starts 1]`. A small wire round a bend; tip
path, push force and force on the vessel, 15 a second, with gaps and Gaussian noise. The truth is drawn anew for each
seed, so that no derivative step and no start value can suit it by chance. All fits share their simulations. The data is
made at the fit's own fineness: what is measured here is the statistics, not the model.
"""

from __future__ import annotations

import argparse
import math
import os
import tempfile
from functools import reduce
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from harness import machine, table

from gw_exudyn.calibration.fit import fitted
from gw_exudyn.calibration.form import load_calibration
from gw_exudyn.calibration.report import report_of
from gw_exudyn.calibration.simulations import simulations
from gw_exudyn.comparison import Course, at, course_of
from gw_exudyn.scenario import load_scenario
from gw_exudyn.simulation import simulate
from gw_exudyn.sweep.folder import SweepFolder
from gw_exudyn.sweep.plan import Options

SCENES = {"arc90": 0.2, "corner90-universal": 2.0}
"""Shipped scenarios, and the noise of forces in each, mN."""

SET = {"wire.segments": 30, "drive.distance": 0.045, "drive.speed": 4e-3, "output.interval": 1 / 15}
FORCES = ("push_force", "wall_force_x", "wall_force_y")
TIP = 0.2e-3  # standard deviation, m
RATE, GAP = 15.0, 0.1  # 1/s, and share of frames without a tip
FILE = f"""
base: BASE
set: {{{", ".join(f"{path}: {value}" for path, value in SET.items())}}}
measured: [camera.csv, cell.csv]
starts: STARTS
noise: {{tip: {TIP}, push_force: NOISE, wall_force_x: NOISE, wall_force_y: NOISE}}
fit:
  contact.friction_coefficient: {{start: 0.2, low: 0.05, high: 0.5}}
  wire.stiffness_factor.tip: {{start: 1, low: 0.5, high: 2}}
"""
TRUTH = {"contact.friction_coefficient": (0.15, 0.35), "wire.stiffness_factor.tip": (0.8, 1.4)}


def measure(course: Course, force_noise: float, random: np.random.Generator, folder: Path) -> None:
    """Write what a camera and a load cell would have seen of a run."""
    time = np.arange(0.0, course.time[-1], 1 / RATE)
    tip = [1e3 * (at(course, name, time) + random.normal(0, TIP, len(time))) for name in ("tip_x", "tip_y")]
    forces = [1e3 * (at(course, name, time) + random.normal(0, force_noise, len(time))) for name in FORCES]
    seen = random.random(len(time)) >= GAP
    camera = [f"{t},{x},{y}" if known else f"{t},," for t, x, y, known in zip(time, *tip, seen, strict=True)]
    (folder / "camera.csv").write_text("\n".join(["time [s],tip_x [mm],tip_y [mm]", *camera]) + "\n")
    cell = [",".join(map(str, row)) for row in zip(time, *forces, strict=True)]
    header = ",".join(["time [s]", *(f"{name} [mN]" for name in FORCES)])
    (folder / "cell.csv").write_text("\n".join([header, *cell]) + "\n")


def main() -> None:
    """Fit once for each seed and count."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--scene", choices=tuple(SCENES), default="arc90")
    parser.add_argument("--starts", type=int, default=1)
    chosen = parser.parse_args()
    base, force_noise = chosen.scene, SCENES[chosen.scene] * 1e-3
    print(machine())
    held, pulls, rows = dict.fromkeys(TRUTH, 0), {path: [] for path in TRUTH}, []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        given = {"BASE": base, "NOISE": repr(force_noise), "STARTS": str(chosen.starts)}
        (folder / "fit.yaml").write_text(reduce(lambda text, pair: text.replace(*pair), given.items(), FILE))
        with SweepFolder(folder / "simulations") as place, simulations(place, Options(jobs=chosen.jobs)) as engine:
            for seed in range(chosen.seeds):
                random = np.random.default_rng(seed)
                truth = {path: random.uniform(*ends) for path, ends in TRUTH.items()}
                measure(course_of(simulate(load_scenario(base, SET | truth))), force_noise, random, folder)
                calibration = load_calibration(folder / "fit.yaml")
                report = report_of(calibration, *fitted(calibration, engine))
                cells = []
                for one in report.estimates:
                    path, true = one.parameter.path, truth[one.parameter.path]
                    low, high = one.interval
                    held[path] += low <= true <= high
                    pulls[path].append((one.value - true) / one.standard_error)
                    mark = "" if low <= true <= high else " missed"
                    cells.append(f"{true:.4f}: {one.value:.4f} +- {one.half_width:.4f}{mark}")
                end = "" if report.fit.converged else " not converged"
                reduced = f"{report.statistics.reduced:.3f}"
                rows.append([str(seed), *cells, reduced, f"{len(report.fit.steps)}{end}"])
                print(" | ".join(rows[-1]), flush=True)
            print(f"{engine.asked} different simulations, {engine.run} run, {engine.failed} failed")
    print(table(["seed", *(f"{path}, true: fitted" for path in TRUTH), "reduced chi square", "steps"], rows))
    for path, values in pulls.items():
        spread, bias = float(np.std(values, ddof=1)), float(np.mean(values)) * math.sqrt(len(values))
        print(
            f"{path}: {held[path]} of {chosen.seeds} intervals of 95 % hold the truth; error by standard error: "
            f"spread {spread:.2f} (1 expected), mean over its own standard error {bias:+.2f}"
        )


if __name__ == "__main__":
    main()
