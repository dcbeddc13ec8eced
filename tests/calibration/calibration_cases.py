"""A tiny calibration, and measured files for it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from gw_exudyn.comparison import Course, at, course_of
from gw_exudyn.scenario import load_scenario
from gw_exudyn.simulation import simulate

FRICTION, TIP = "contact.friction_coefficient", "wire.stiffness_factor.tip"
FORCES = ("push_force", "wall_force_x", "wall_force_y")
BASE = "arc90"
TINY = {"wire.segments": 20, "drive.distance": 0.045, "drive.speed": 4e-3, "solver.step": 0.2, "output.interval": 0.2}
FILE = f"""base: {BASE}
set: {{wire.segments: 20, drive.distance: 45 mm, drive.speed: 4 mm/s, solver.step: 0.2 s, output.interval: 0.2 s}}
measured: [camera.csv, cell.csv]
noise: {{tip: 0.1 mm, push_force: 0.1 mN}}
fit:
  {FRICTION}: {{start: 0.3, low: 0.05, high: 0.6}}
  {TIP}: {{start: 1, low: 0.5, high: 2}}
"""


def measure(course: Course, seed: int, tip: float = 0.1e-3, push: float = 0.1e-3) -> None:
    """Write what a camera with gaps, 15 frames a second, and a load cell would have seen of a run. tip, push : standard
    deviations of the noise, m and N.
    """
    random = np.random.default_rng(seed)
    time = np.arange(0.0, course.time[-1], 1 / 15)
    x, y = (1e3 * (at(course, name, time) + random.normal(0, tip, len(time))) for name in ("tip_x", "tip_y"))
    forces = [1e3 * (at(course, name, time) + random.normal(0, push, len(time))) for name in FORCES]
    gap = random.random(len(time)) < 0.1
    rows = [f"{t},," if lost else f"{t},{a},{b}" for t, a, b, lost in zip(time, x, y, gap, strict=True)]
    Path("camera.csv").write_text("\n".join(["time [s],tip_x [mm],tip_y [mm]", *rows]) + "\n")
    cell = [",".join(map(str, row)) for row in zip(time, *forces, strict=True)]
    header = ",".join(["time [s]", *(f"{name} [mN]" for name in FORCES)])
    Path("cell.csv").write_text("\n".join([header, *cell]) + "\n")


def run_of(base: str = BASE, **values: object) -> Course:
    """The course of a tiny run. values : by path, with __ for a dot."""
    return course_of(simulate(load_scenario(base, TINY | {k.replace("__", "."): v for k, v in values.items()})))
