"""A controller holds the tip force: the FMU coupled to a control law, through fmpy alone.

    gw-exudyn fmu export straight --set vessel.end=dead --set "vessel.length=20 mm" --set "solver.step=10 ms" \
        -o dead_end.fmu
    python fmu_tip_force_control.py dead_end.fmu

The wire is pushed against the closed end of a channel. Every 10 ms the controller reads the tip force and commands the
speed of the drive: a constant speed through free space, then one in proportion to what the force is off its set point.
"""

from __future__ import annotations

import sys
import tempfile

from fmpy import extract, read_model_description
from fmpy.simulation import instantiate_fmu

SET_POINT = 20e-3
"""N. Below the force at which the wire buckles."""

APPROACH, FASTEST, GAIN, STEP = 1e-3, 2e-3, 0.01, 0.01
"""Speed until the tip first touches and speed limit, m/s; gain, m/s per N (with the wall's stiffness of some kN/m it
takes a third off the error in each step); time between two actions of the controller, s."""


def hold(file: str, duration: float = 24.0, set_point: float = SET_POINT) -> list[tuple[float, float, float]]:
    """(time, s; tip force, N; commanded speed, m/s) at every action."""
    rows: list[tuple[float, float, float]] = []
    with tempfile.TemporaryDirectory() as folder:
        extract(file, unzipdir=folder)
        description = read_model_description(folder)
        references = {variable.name: variable.valueReference for variable in description.modelVariables}
        fmu = instantiate_fmu(folder, description, "CoSimulation")
        try:
            fmu.setupExperiment(startTime=0.0)
            fmu.setBoolean([references["command.active"]], [True])
            fmu.enterInitializationMode()
            fmu.exitInitializationMode()
            touched = False
            for i in range(round(duration / STEP)):
                force = fmu.getReal([references["tip.force"]])[0]
                touched = touched or force > 0
                speed = max(-FASTEST, min(FASTEST, GAIN * (set_point - force))) if touched else APPROACH
                fmu.setReal([references["command.speed"]], [speed])
                fmu.doStep(currentCommunicationPoint=i * STEP, communicationStepSize=STEP)
                rows.append((i * STEP, force, speed))
            fmu.terminate()
        finally:
            fmu.freeInstance()
    return rows


def main() -> None:
    """Print the course of the force."""
    rows = hold(sys.argv[1] if len(sys.argv) > 1 else "dead_end.fmu")
    for time, force, speed in rows[:: len(rows) // 28]:
        sys.stdout.write(f"{time:6.2f} s  tip force {force * 1e3:6.3f} mN  speed {speed * 1e3:6.3f} mm/s\n")


if __name__ == "__main__":
    main()
