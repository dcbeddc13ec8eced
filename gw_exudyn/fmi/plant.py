"""What a worker drives: the simulation of the FMU's scenario with the parameters that the host has set."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from operator import itemgetter
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.errors import UsageError
from gw_exudyn.fmi import variables as names
from gw_exudyn.fmi.channel import DONE, FAILED, STOPPED
from gw_exudyn.fmi.resources import read_scenario, read_table
from gw_exudyn.fmi.variables import TEXT, Variable, command_of, constant_drive, output_name, status_code
from gw_exudyn.quantities import CONTACT_OWNERS, QUANTITIES, SCALARS
from gw_exudyn.scenario import Scenario, load_scenario, scenario_from_dict
from gw_exudyn.simulation import Simulation

_STEPS_AT_ONCE = 20
"""Solver steps between two signs of life."""

_VESSEL = next(value for value, word in CONTACT_OWNERS if word == "vessel")

_OF_THE_WIRE = ("diameter", "length", "density", "bending_stiffness")
"""What a wire of the catalogue fills in, where a file does not give it."""


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
        self._readers = list(_readers(outputs))
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
            self._simulation = Simulation(self._scenario(values, texts))
            self._built_of = key
        else:
            self._simulation.reset()
        self._commanded = bool(values[self._active_at])

    def step(self, target: float, numbers: bytes, alive: Callable[[], None]) -> int:
        """Go to the time `target`, s."""
        value, simulation = array("d", numbers)[self._command_at], self.simulation
        self._commanded = self._commanded or value != self._numbers[self._command_at].start
        given = {self._command: value} if self._commanded else {}
        target = round(target, 12)
        step = simulation.scenario.solver.step
        while simulation.time < target - 1e-9 and not simulation.ended:
            ahead = round((math.floor(simulation.time / step + 1e-6) + _STEPS_AT_ONCE) * step, 12)
            self._sampled = simulation.step(min(target, ahead) - simulation.time, **given)
            alive()
        if not simulation.ended:
            return DONE
        return FAILED if simulation.failed else STOPPED

    def outputs(self) -> tuple[bytes, Sequence[str]]:
        """The outputs at the time reached, in the table's order."""
        simulation = self.simulation
        outputs, report = self._sampled or simulation.outputs, simulation.status
        values = array("d")
        code = status_code(report.status)
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


def overridden(base: Scenario, changed: Mapping[str, Any]) -> Scenario:
    """A scenario with other values of an FMU's parameters, by their names. Raises ScenarioError."""
    plain = dict(changed)
    factors = {name: plain.pop(name) for name in changed if name.endswith(".factor")}
    data = base.to_dict()
    if {"wire.model", "wire.length"} & set(plain):
        _leave_to_the_catalogue(data["wire"], base, plain)
    if {"drive.speed", "drive.force", "drive.distance"} & set(plain):
        data["drive"] = _one_value(data["drive"], base, plain)
    scenario = scenario_from_dict(data, plain)
    return _scaled(scenario, factors) if factors else scenario


def _one_value(drive: dict[str, Any], base: Scenario, plain: dict[str, Any]) -> dict[str, Any]:
    """The drive with one speed or force instead of its table; what it takes from `plain` is taken out there."""
    what, known = command_of(base), constant_drive(base) or 0.0
    kept = {name: value for name, value in drive.items() if name != "table"}
    kept[what] = plain.pop(f"drive.{what}", known)
    if base.drive.kind == "speed":
        return {**kept, "distance": plain.pop("drive.distance", abs(known) * base.drive.duration)}
    return {**kept, "duration": base.drive.duration}


def _leave_to_the_catalogue(wire: dict[str, Any], base: Scenario, changed: Mapping[str, Any]) -> None:
    """Take out what the exported wire has from the catalogue, so that another model or length fills it in anew."""
    model = wire.get("model")
    if model is None:
        if "wire.model" in changed:
            for name in _OF_THE_WIRE:
                wire.pop(name, None)
        return
    known = scenario_from_dict({**base.to_dict(), "wire": {"model": model}}).wire
    for name in _OF_THE_WIRE:
        if name == "bending_stiffness" or getattr(known, name) == getattr(base.wire, name):
            same = getattr(known, name)[: len(base.wire.bending_stiffness)] if name == "bending_stiffness" else None
            if same is None or all(a.value == b.value for a, b in zip(same, base.wire.bending_stiffness, strict=False)):
                wire.pop(name, None)


def _scaled(scenario: Scenario, factors: Mapping[str, float]) -> Scenario:
    """With the bending stiffness times the factors: one of all pieces, and one a piece."""
    pieces = [piece.to_plain() for piece in scenario.wire.bending_stiffness]
    for name, factor in factors.items():
        if name == names.STIFFNESS_FACTOR:
            chosen = pieces
        else:
            index = int(name.partition("[")[2].partition("]")[0])
            if index >= len(pieces):
                raise UsageError(f"{name}: the wire has {len(pieces)} pieces of bending stiffness; leave it at 1")
            chosen = [pieces[index]]
        for piece in chosen:
            value = piece["value"]
            piece["value"] = [factor * v for v in value] if isinstance(value, list) else factor * value
    return scenario_from_dict(scenario.to_dict(), {"wire.bending_stiffness": pieces})


Reader = Callable[[Mapping[str, Any], Simulation, int], Iterable[float]]
"""Values of one or several variables in a row, of the outputs, the simulation and the status code."""


def _readers(outputs: Sequence[Variable]) -> Iterator[Reader]:
    """What gives the values of the outputs, in their order. Neighbours that are read alike are read at once."""
    quantity_of = {output_name(q): q for q in SCALARS}
    for scalar, group in groupby(outputs, lambda variable: variable.name in quantity_of):
        if scalar:
            yield _scalars([quantity_of[variable.name] for variable in group])
        else:
            for placed, rest in groupby(group, lambda variable: variable.name in names.PLACE_OF_LARGEST):
                if placed:
                    yield _place_of_largest([names.PLACE_OF_LARGEST[variable.name] for variable in rest])
                else:
                    yield from map(_reader, rest)


def _scalars(quantities: Sequence[str]) -> Reader:
    if len(quantities) == 1:
        (quantity,) = quantities
        return lambda outputs, _, __: (outputs[quantity],)
    picked = itemgetter(*quantities)
    return lambda outputs, _, __: picked(outputs)


def _reader(variable: Variable) -> Reader:
    name = variable.name
    if name == names.STATUS_CODE:
        return lambda _, __, code: (code,)
    if name in names.STATION_NAMES:
        return lambda outputs, simulation, _: _at_stations(name, variable.size, outputs, simulation).tolist()
    for peak in names.PEAKS:
        if name in names.peak_names(peak):
            which = names.peak_names(peak).index(name)
            return lambda _, simulation, __: (simulation.peaks.get(peak, (0.0, 0.0))[which],)
    known = ", ".join(q for q in QUANTITIES)
    raise UsageError(f"there is no quantity for the output {name}; export the FMU again (known: {known})")


def _place_of_largest(fields: Sequence[str]) -> Reader:
    """Fields of the contact that presses hardest on the vessel; 0 without one."""

    def read(outputs: Mapping[str, Any], _: Simulation, __: int) -> Iterable[float]:
        if not outputs["contacts"]:
            return [0.0] * len(fields)
        force = np.hypot(outputs["contact_normal_force"], outputs["contact_tangential_force"])
        place = int(np.where(outputs["contact_owner"] == _VESSEL, force, -1.0).argmax())
        return [outputs[field][place] for field in fields]

    return read


def _at_stations(name: str, count: int, outputs: Mapping[str, Any], simulation: Simulation) -> NDArray[np.float64]:
    """Values at stations that divide the wire evenly, the first at the tip."""
    nodes = simulation.model.wire.node_arc_length
    stations: NDArray[np.float64] = np.linspace(0.0, float(nodes[0]), count)
    if name == "wire.station.arc_length":
        return stations
    if name == "wire.station.normal_force":
        spacing = float(nodes[0]) / max(1, count - 1)
        nearest = np.rint(np.asarray(outputs["contact_arc_length"]) / spacing).astype(int).clip(0, count - 1)
        summed: NDArray[np.float64] = np.bincount(nearest, outputs["contact_normal_force"], count).astype(np.float64)
        return summed
    field = "node_x" if name == "wire.station.x" else "node_y"
    # The nodes run from the proximal end to the tip, arc length from the tip.
    along: NDArray[np.float64] = np.interp(stations, nodes[::-1], np.asarray(outputs[field])[::-1])
    return along
