"""Speed and accuracy on bend60, and MuJoCo on the same case in the same run.

    python benchmarks/bend60.py            (MuJoCo: pip install ".[peers]")
    python benchmarks/bend60.py --no-mujoco

The converged answer, tip (9.542, 12.892) mm and push force 0.0207 N at t = 10 s, is that of an independent solver of
the same mechanics (massless rigid segments, implicit Euler, minimal coordinates) with 400 segments and more.
"""

from __future__ import annotations

import argparse
import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import cases
import numpy as np
from harness import machine, run, table, verdict

TIP, PUSH = np.array([9.542, 12.892]), 0.0207
SEGMENTS = (20, 40, 100, 200, 400)
COST = dict(zip(SEGMENTS, (0.015, 0.02, 0.03, 0.05, 0.1), strict=True))
TIP_ERROR = {20: 0.05, 40: 0.05, 100: 0.02, 200: 0.02, 400: 0.02}
PUSH_ERROR = {20: 25.0, 40: 25.0, 100: 2.0, 200: 2.0, 400: 2.0}
GRADED_TIP_ERROR = 0.005
PENETRATION = 10.0


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--no-mujoco", action="store_true")
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    print(machine())
    rows = []
    for segments in SEGMENTS:
        ours = run(cases.bend60(segments), options.repeat)
        peer = None if options.no_mujoco else _mujoco(segments)
        error, push = float(np.hypot(*(ours.tip - TIP))), 100 * abs(ours.push - PUSH) / PUSH
        rows.append(
            [
                str(segments),
                verdict(ours.cost, COST[segments]),
                "-" if peer is None else f"{peer:.3g}",
                "-" if peer is None else f"{peer / ours.cost:.1f}",
                verdict(error, TIP_ERROR[segments]),
                verdict(push, PUSH_ERROR[segments]),
                verdict(ours.deepest, PENETRATION),
                str(ours.residuals),
            ]
        )
    head = ["n", "s per s (goal)", "MuJoCo s per s", "ratio", "tip error, mm", "push error, %", "penetration, um"]
    print("\nUniform segments, wall 2000 N/m, steps of 0.1 s\n")
    print(table([*head, "residuals"], rows))
    print("\nGraded segments (proximal : distal = 3)\n")
    graded = []
    for segments in (100, 200, 400):
        outcome = run(cases.bend60(segments, grading=3.0))
        error = float(np.hypot(*(outcome.tip - TIP)))
        graded.append([str(segments), f"{outcome.cost:.3g}", verdict(error, GRADED_TIP_ERROR)])
    print(table(["n", "s per s", "tip error, mm"], graded))


def _mujoco(segments: int) -> float:
    import mujoco_peer

    return mujoco_peer.cost(segments)


if __name__ == "__main__":
    main()
