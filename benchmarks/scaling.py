"""How cost and memory grow with the number of segments on bend60.

python benchmarks/scaling.py
"""

from __future__ import annotations

import os
import subprocess
import sys

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import cases
import numpy as np
from harness import machine, run, table, verdict

SEGMENTS = (100, 200, 400, 800)


def main() -> None:
    """Print the table and the exponent."""
    print(machine())
    # Interleaved, so that a machine that changes its speed does not tilt the exponent; the fastest of each counts.
    costs = dict.fromkeys(SEGMENTS, np.inf)
    for _ in range(3):
        for n in SEGMENTS:
            costs[n] = min(costs[n], run(cases.bend60(n)).cost)
    peaks = {n: _peak_memory(n) for n in SEGMENTS}
    print(
        table(["n", "s per s", "peak memory, MB"], [[str(n), f"{costs[n]:.3g}", f"{peaks[n]:.0f}"] for n in SEGMENTS])
    )
    exponent = np.polyfit(np.log(SEGMENTS), np.log([costs[n] for n in SEGMENTS]), 1)[0]
    print(f"\nexponent of cost from 100 to 800: {verdict(float(exponent), 1.1)}")
    print(f"peak memory, MB: {verdict(max(peaks.values()), 500)}")


def _peak_memory(segments: int) -> float:
    """Peak resident memory, MB, of a process that runs the case once (Linux, which counts it for each program anew)."""
    code = (
        f"import sys; sys.path.insert(0, {os.path.dirname(os.path.abspath(__file__))!r})\n"
        f"import cases, harness\nharness.run(cases.bend60({segments}))\n"
        "print(next(line for line in open('/proc/self/status') if line.startswith('VmHWM')).split()[1])"
    )
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return int(answer.stdout) / 1024


if __name__ == "__main__":
    main()
