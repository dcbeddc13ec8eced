"""From what a simulation tells to the values of an FMU's outputs, in the table's order."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.errors import UsageError
from gw_exudyn.fmi import variables as names
from gw_exudyn.fmi.variables import Variable, output_name
from gw_exudyn.quantities import CONTACT_OWNERS, QUANTITIES, SCALARS
from gw_exudyn.simulation import Simulation

Reader = Callable[[Mapping[str, Any], Simulation, int], Iterable[float]]
"""Values of one or several variables in a row, of the outputs, the simulation and the status code."""

_VESSEL = next(value for value, word in CONTACT_OWNERS if word == "vessel")
_QUANTITY_OF = {output_name(quantity): quantity for quantity in SCALARS}
_PEAK_OF = {name: (peak, i) for peak in names.PEAKS for i, name in enumerate(names.peak_names(peak))}


def readers(outputs: Sequence[Variable]) -> Iterator[Reader]:
    """What gives the values of the outputs, in their order. Neighbours that are read alike are read at once.

    Raises UsageError for an output that there is none of.
    """
    for _, group in groupby(outputs, _alike):
        row = list(group)
        wanted = [variable.name for variable in row]
        if wanted[0] in _QUANTITY_OF:
            yield _scalars([_QUANTITY_OF[name] for name in wanted])
        elif wanted[0] in names.PLACE_OF_LARGEST:
            yield _place_of_largest([names.PLACE_OF_LARGEST[name] for name in wanted])
        elif wanted[0] in _PEAK_OF:
            yield _peaks([_PEAK_OF[name] for name in wanted])
        else:
            yield _single(row[0])


def _alike(variable: Variable) -> int | str:
    """The same for outputs that are read by one reader."""
    of_several = (_QUANTITY_OF, names.PLACE_OF_LARGEST, _PEAK_OF)
    return next((i for i, group in enumerate(of_several) if variable.name in group), variable.name)


def _scalars(quantities: Sequence[str]) -> Reader:
    if len(quantities) == 1:
        (quantity,) = quantities
        return lambda outputs, _, __: (outputs[quantity],)
    picked = itemgetter(*quantities)
    return lambda outputs, _, __: picked(outputs)


def _peaks(wanted: Sequence[tuple[str, int]]) -> Reader:
    """wanted : a peak, and 0 for its value or 1 for its time."""

    def read(_: Mapping[str, Any], simulation: Simulation, __: int) -> Iterable[float]:
        peaks = simulation.peaks
        return [peaks[peak][i] if peak in peaks else 0.0 for peak, i in wanted]

    return read


def _single(variable: Variable) -> Reader:
    name = variable.name
    if name == names.STATUS_CODE:
        return lambda _, __, code: (code,)
    if name in names.STATION_NAMES:
        return lambda outputs, simulation, _: _at_stations(name, variable.size, outputs, simulation).tolist()
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
