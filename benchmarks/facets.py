"""What a vessel of many walls costs: the same smooth bend with 50 walls and with 2000.

python benchmarks/facets.py
"""

from __future__ import annotations

import argparse
import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import cases
from harness import Outcome, machine, run, table, verdict

FACETS = (24, 999)
"""Of each side of the bend; with the two straight stretches 50 and 2000 walls."""

MOST = 1.3


def bend(facets: int, wire: str, segments: int) -> dict[str, object]:
    """A quarter circle, friction 0.2, 40 mm of insertion."""
    case = cases.insertion(cases.arc(facets), wire, segments, 0.2)
    return {**case, "drive": {**case["drive"], "duration": 20.0}}


def walls(facets: int) -> int:
    """Number of walls of the vessel."""
    return 2 * facets + 2


def best_of(repeat: int, wire: str, segments: int) -> list[Outcome]:
    """The fastest run of each vessel, by processor time; taken in turns, so that a machine that changes its speed
    treats both alike."""
    runs = [[run(bend(facets, wire, segments)) for facets in FACETS] for _ in range(repeat)]
    return [min(column, key=lambda outcome: outcome.work) for column in zip(*runs, strict=True)]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=5)
    repeat = parser.parse_args().repeat
    print(machine())
    few, many = map(walls, FACETS)
    rows = []
    for wire in cases.WIRES:
        for segments in (100, 200, 400):
            coarse, fine = best_of(repeat, wire, segments)
            apart = float(abs(coarse.tip - fine.tip).max())
            residuals = f"{coarse.residuals}, {fine.residuals}"
            cost = verdict(fine.work / coarse.work, MOST)
            rows.append(
                [wire, str(segments), f"{coarse.work:.3g}", f"{fine.work:.3g}", cost, residuals, f"{apart:.3g}"]
            )
    header = ["wire", "n", f"{few} walls, s per s", f"{many} walls, s per s", "ratio", "residuals", "tips apart, mm"]
    print(table(header, rows))


if __name__ == "__main__":
    main()
