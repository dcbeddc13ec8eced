"""A straight wire pushed square against a wall: buckles, slides and goes on, whatever the size of its imperfection.

    python benchmarks/head_on.py

The default rest curvature, a tenth and ten times of it: same branch, tips within 0.1 mm. And how far it moves bend60's
tip.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import cases
import numpy as np
from harness import machine, run, table, verdict

from gw_exudyn.model.wire import DEFAULT_IMPERFECTION

FACTORS = (0.1, 1.0, 10.0)


def main() -> None:
    """Print the tables."""
    print(machine())
    print(f"\ndefault imperfection {DEFAULT_IMPERFECTION:g} 1/m\n")
    rows = []
    for scene in ("corner 90", "T"):
        for wire in cases.WIRES:
            for friction in (0.0, 0.2, 0.4):
                outcomes = [run(_case(scene, wire, friction, factor)) for factor in FACTORS]
                spread = max(float(np.hypot(*(o.tip - outcomes[1].tip))) for o in outcomes)
                ends = ", ".join(o.status.status.name for o in outcomes)
                tips = "; ".join(f"{o.tip[0]:.2f}, {o.tip[1]:.2f}" for o in outcomes)
                rows.append([scene, wire, f"{friction:g}", ends, tips, verdict(spread, 0.1)])
                print("  ".join(rows[-1]), flush=True)
    print("\n" + table(["scene", "wire", "friction", "status", "tips, mm", "tips apart, mm"], rows))
    bends = []
    for segments in (100, 400):
        perfect, given = (run(cases.bend60(segments, imperfection=k)) for k in (0.0, DEFAULT_IMPERFECTION))
        bends.append([str(segments), verdict(float(np.hypot(*(given.tip - perfect.tip))), 0.005)])
    print("\nbend60: how far the default imperfection moves the tip\n\n" + table(["n", "mm"], bends))


def _case(scene: str, wire: str, friction: float, factor: float) -> dict[str, object]:
    imperfection = {"imperfection": factor * DEFAULT_IMPERFECTION}
    return cases.insertion(cases.vessels()[scene], wire, 100, friction, wire_changes=imperfection)


if __name__ == "__main__":
    main()
