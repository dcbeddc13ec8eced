"""What a worker drives: the simulation of the FMU's scenario with the parameters that the host has set."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from gw_exudyn.errors import UsageError
from gw_exudyn.fmi import variables as names
from gw_exudyn.fmi.channel import DONE, FAILED, STOPPED
from gw_exudyn.fmi.overriding import OWN_FMU, overridden
from gw_exudyn.fmi.parameters import command_of
from gw_exudyn.fmi.reading import readers
from gw_exudyn.fmi.resources import read_scenario, read_table
from gw_exudyn.fmi.variables import TEXT, status_code
from gw_exudyn.scenario import Scenario, load_scenario, scenario_from_dict
from gw_exudyn.simulation import Simulation

_STEPS_AT_ONCE = 20
"""Solver steps between two signs of life."""


class ScenarioPlant:
    """The simulation behind one FMU instance.

    resources : folder of the unpacked FMU's resources.
    """

    def __init__(self, resources: str) -> None:
        folder = Path(resources)
        self._data = read_scenario(folder)
        table = read_table(folder)
        settable = [v for v in table if v.settable]
        self._numbers = [v for v in settable if v.kind != TEXT]
        self._texts = [v for v in settable if v.kind == TEXT]
        place = {v.name: i for i, v in enumerate(self._numbers)}
        # The FMU has the one of the two that its scenario's drive takes.
        self._command = "force" if names.COMMAND_FORCE in place else "speed"
        self._command_at = place[f"command.{self._command}"]
        # What does not change the model: a run with other values of these alone begins from the same simulation.
        self._not_structure = {self._command_at, place[names.TIMEOUT], place[names.COMMAND_ACTIVE]}
        self._active_at = place[names.COMMAND_ACTIVE]
        outputs = [v for v in table if v.role == names.OUTPUT and v.kind != TEXT]
        self._readers = list(readers(outputs))
        self._shape = any(v.name in names.STATION_NAMES for v in outputs)
        self._built_of: tuple[Any, ...] | None = None
        self._simulation: Simulation | None = None
        self._commanded = False
        self._sampled: Mapping[str, Any] | None = None

    @property
    def simulation(self) -> Simulation:
        """The simulation. Raises UsageError before the first `start`."""
        if self._simulation is None:
            raise UsageError("the run has not begun; end the initialization first")
        return self._simulation

    @property
    def time(self) -> float:
        """Time reached, s, since the start of the scenario."""
        return self.simulation.time

    def start(self, numbers: bytes, texts: Sequence[str]) -> None:
        """Begin the run anew with these parameters; the simulation is built again only where one has changed.

        Raises ScenarioError with everything that is wrong.
        """
        values, self._sampled = array("d", numbers), None
        key = (*(v for i, v in enumerate(values) if i not in self._not_structure), *texts)
        if self._simulation is None or key != self._built_of:
            self._simulation, self._built_of = None, None
            self._simulation = Simulation(self._scenario(values, texts), shape=self._shape)
            self._built_of = key
        else:
            self._simulation.reset()
        self._commanded = bool(values[self._active_at])

    def step(self, target: float, numbers: bytes, alive: Callable[[], None]) -> int:
        """Go to the time `target`, s."""
        value, simulation = array("d", numbers)[self._command_at], self.simulation
        self._commanded = self._commanded or value != self._numbers[self._command_at].start
        given = {self._command: value} if self._commanded else {}
        if given:
            self._check_command()
        target = round(target, 12)
        step = simulation.scenario.solver.step
        while simulation.time < target - 1e-9 and not simulation.ended:
            ahead = round((math.floor(simulation.time / step + 1e-6) + _STEPS_AT_ONCE) * step, 12)
            self._sampled = simulation.step(min(target, ahead) - simulation.time, **given)
            alive()
        if not simulation.ended:
            return DONE
        return FAILED if simulation.failed else STOPPED

    def _check_command(self) -> None:
        """Raises UsageError where another scenario runs than the exported one, whose drive takes something else."""
        drive, takes = self.simulation.scenario.drive, command_of(self.simulation.scenario)
        if takes != self._command:
            raise UsageError(
                f"command.{self._command}: a drive of kind {drive.kind} takes a {takes} from outside, for which this "
                f"FMU has no input; {OWN_FMU}"
            )

    def outputs(self) -> tuple[bytes, Sequence[str]]:
        """The outputs at the time reached, in the table's order."""
        simulation = self.simulation
        outputs, report = self._sampled or simulation.outputs, simulation.status
        code, values = status_code(report.status), array("d")
        for reader in self._readers:
            values.extend(reader(outputs, simulation, code))
        wrong = simulation.ended or code
        return values.tobytes(), [report.sentence() if wrong else "Nothing is wrong."]

    def get_state(self) -> bytes:
        """The simulation's state, and whether the host drives."""
        return bytes([self._commanded]) + self.simulation.get_state()

    def set_state(self, state: bytes) -> None:
        """Go on from a state of a run with the same parameters. Raises UsageError."""
        self._sampled = None
        self.simulation.set_state(state[1:])
        self._commanded = bool(state[0])

    def _scenario(self, values: Sequence[float], texts: Sequence[str]) -> Scenario:
        """The scenario with every parameter that differs from its exported start."""
        changed: dict[str, Any] = {}
        for variable, number in zip(self._numbers, values, strict=True):
            if number != variable.start:
                changed[variable.name] = number if variable.kind == names.REAL else int(number)
        for variable, text in zip(self._texts, texts, strict=True):
            if text != variable.start:
                changed[variable.name] = text
        file = changed.pop(names.SCENARIO_FILE, None)
        for own in (names.COMMAND_SPEED, names.COMMAND_FORCE, names.COMMAND_ACTIVE, names.TIMEOUT):
            changed.pop(own, None)
        base = scenario_from_dict(self._data) if file is None else load_scenario(file)
        return overridden(base, changed)
