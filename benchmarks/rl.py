"""Steps per second of the Gymnasium environment, alone and as a vector of two on two cores.

python benchmarks/rl.py [--segments 100] [--seconds 10]
"""

from __future__ import annotations

import argparse
import os
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import gymnasium
import numpy as np
from harness import machine, table

import gw_exudyn.rl  # noqa: F401  # registers the environment
from gw_exudyn.scenario import load_scenario

TARGET = (0.06, 0.0205)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--segments", type=int, default=100)
    parser.add_argument("--seconds", type=float, default=10.0)
    options = parser.parse_args()
    scenario = load_scenario("phantom-universal", {"wire.segments": options.segments})
    print(machine())
    rows = []
    for count in (1, 2):
        rate = steps_per_second(scenario, count, options.seconds)
        rows.append([str(count), f"{rate:.0f}"])
    print(table(["environments", "steps of 0.1 s per second"], rows))


def steps_per_second(scenario: object, count: int, seconds: float) -> float:
    """Environment steps per wall second over all environments, pushing, begun anew at each end."""
    envs = gymnasium.make_vec(
        "gw_exudyn/Guidewire-v0",
        num_envs=count,
        vectorization_mode="async",
        scenario=scenario,
        target=TARGET,
    )
    envs.reset(seed=0)
    push = np.ones((count, 1), np.float32)
    envs.step(push)
    began, steps = time.perf_counter(), 0
    while time.perf_counter() - began < seconds:
        envs.step(push)
        steps += count
    rate = steps / (time.perf_counter() - began)
    envs.close()
    return rate


if __name__ == "__main__":
    main()
