"""A friction study with an FMU, through fmpy alone: one instance that is reset from run to run.

    gw-exudyn fmu export arc90 -o arc90.fmu
    python fmu_parameter_study.py arc90.fmu

Any tool that imports FMUs does the same with three calls: reset, set the parameter, run.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

from fmpy import extract, read_model_description, simulate_fmu
from fmpy.simulation import instantiate_fmu

FRICTION = (0.0, 0.1, 0.2, 0.3, 0.4)
OUTPUTS = ("push.force", "wall.force.max", "status.code")


def study(
    file: str, friction: tuple[float, ...] = FRICTION, step: float = 0.1, stop: float | None = None
) -> list[tuple[float, ...]]:
    """(friction, largest push force, largest wall force, status) of each run; N. step, stop : s; None is the FMU's."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        extract(file, unzipdir=folder)
        description = read_model_description(folder)
        instance = instantiate_fmu(folder, description, "CoSimulation")
        try:
            for i, value in enumerate(friction):
                if i:
                    instance.reset()
                run = simulate_fmu(
                    folder,
                    model_description=description,
                    fmu_instance=instance,
                    validate=False,
                    start_values={"contact.friction_coefficient": value},
                    output=OUTPUTS,
                    output_interval=step,
                    stop_time=stop,
                )
                rows.append(
                    (value, run["push.force"].max(), run["wall.force.max"].max(), float(run["status.code"][-1]))
                )
        finally:
            instance.freeInstance()
    return rows


def main() -> None:
    """Print a table."""
    file = Path(sys.argv[1] if len(sys.argv) > 1 else "arc90.fmu")
    began = time.perf_counter()
    rows = study(str(file))
    sys.stdout.write("friction  push force, mN  wall force, mN  status\n")
    for friction, push, wall, status in rows:
        sys.stdout.write(f"{friction:8.2f}  {push * 1e3:14.2f}  {wall * 1e3:14.2f}  {status:6.0f}\n")
    sys.stdout.write(f"{len(rows)} runs in {time.perf_counter() - began:.1f} s\n")


if __name__ == "__main__":
    main()
