"""What came out of a run: labelled arrays with units, how the run ended, and what is needed to draw and repeat it."""

from __future__ import annotations

import platform
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gw_exudyn.quantities import CONTACT_FIELDS, JOINT_FIELDS, NODE_FIELDS, QUANTITIES, SCALARS, Quantity

if TYPE_CHECKING:
    import xarray as xr

    from gw_exudyn.scenario import Scenario

Floats = NDArray[np.float64]


class Status(Enum):
    """How a run ended. The value says what happened and, after the first full stop, what to change."""

    COMPLETED = "The run reached its end and passed every check."
    STOPPED = (
        "The run was stopped from outside before its end; what was computed until then holds. "
        "Run it again to reach the end."
    )
    NOT_CONVERGED = (
        "The solver found no balance of forces, even with its smallest step. "
        "Lower solver.step or contact.wall_stiffness, or use more segments (wire.segments)."
    )
    NOT_FINITE = (
        "A number became infinite or undefined. "
        "Lower solver.step, and look for a slip of units in wire.bending_stiffness and contact.wall_stiffness."
    )
    OUTSIDE_LUMEN = (
        "A part of the wire left the lumen through a wall. "
        "Lower solver.step, use more segments (wire.segments), or raise contact.wall_stiffness."
    )
    TOO_DEEP = (
        "The wire was pressed into a wall by more than 0.3 of its radius, so neither its path nor its forces can be "
        "trusted. If the push force has shot up, the wire is jammed: lower the friction, use more segments "
        "(wire.segments), or push less far; else raise contact.wall_stiffness, or leave it at auto."
    )
    ENERGY_OPEN = (
        "The energies do not add up to within 1 % of the largest work. Lower solver.step and solver.tolerance."
    )

    TIP_STALLED = (
        "The tip stayed where it was while the wire was pushed in: a dead end, a jam, or a wire that buckles or "
        "prolapses in a wide lumen. "
        "To go on all the same, set stop.tip_stall to off or to a longer travel."
    )
    FORCE_LIMIT = "The push force exceeded its limit. To go on, raise stop.push_force or leave it out."
    TARGET_REACHED = "The tip reached its target. To go on from there, set stop.at_target to false."
    END_OF_TRAVEL = (
        "The hub reached the end of its travel: further on, the wire's end would leave its guide in the catheter. "
        "Take a longer wire (wire.length), or a drive that ends earlier or is weaker."
    )

    @property
    def ok(self) -> bool:
        """The run reached its end and nothing is wrong with it."""
        return self is Status.COMPLETED

    @property
    def trusted(self) -> bool:
        """What was computed can be believed; true also for a run that somebody or an event ended early."""
        return self in (Status.COMPLETED, Status.STOPPED) or self.is_event

    @property
    def is_event(self) -> bool:
        """The run ended before its drive did, for a reason of its own that is an outcome and no failure."""
        return self in (Status.TIP_STALLED, Status.FORCE_LIMIT, Status.TARGET_REACHED, Status.END_OF_TRAVEL)

    @property
    def problem(self) -> str:
        """What happened, without the remedy and without a full stop."""
        return self.value.partition(". ")[0].rstrip(".")

    @property
    def remedy(self) -> str:
        """What to change; empty where there is nothing to change."""
        return self.value.partition(". ")[2]


@dataclass(frozen=True)
class StatusReport:
    """How a run ended, with when (s), where (in words) and the numbers of the case."""

    status: Status
    time: float | None = None
    place: str = ""
    detail: str = ""

    def sentence(self) -> str:
        """What happened, when, where, with which numbers, and what to change."""
        when = "" if self.time is None else f"t = {self.time:.6g} s"
        facts = "; ".join(part for part in (when, self.place, self.detail) if part)
        return f"{self.status.problem}{f' ({facts})' if facts else ''}. {self.status.remedy}".rstrip()


@dataclass(frozen=True)
class SnapEvent:
    """A snap-through: the wire jumped from one shape to another at `time` (s) and set free `released_energy` (J)."""

    time: float
    released_energy: float


@dataclass(frozen=True, eq=False)
class Result:
    """One run.

    dataset : xarray.Dataset
        Every quantity of `gw_exudyn.quantities` over time, in SI, each with `units` and `long_name`; the dimensions
        are `time`, `node`, `joint` and `contact` (padded with NaN or -1, since the number of contacts changes).
    status : StatusReport
        How the run ended; results of a run whose status is not `trusted` are for finding the reason only.
    vessel_outline, catheter_outline : tuples of (k, 2) float arrays, m
        The walls as polylines, for drawing.
    provenance : dict
        Versions and whatever else is needed to repeat the run; nothing about the machine's name or user.
    wall_time : float, s
        What the solution alone took on the clock.
    counters : dict
        Solver counts of the whole run.
    peaks : dict of (value in SI, time in s)
        Largest value over all solver steps, not only over the outputs, by name: `push_force`, `pull_force` (of
        -push_force), `wall_force_max`, `penetration_max`; empty where the run kept none.
    """

    dataset: xr.Dataset
    status: StatusReport
    scenario: Scenario
    snaps: tuple[SnapEvent, ...] = ()
    vessel_outline: tuple[Floats, ...] = ()
    catheter_outline: tuple[Floats, ...] = ()
    provenance: dict[str, Any] = field(default_factory=dict)
    wall_time: float = float("nan")
    counters: dict[str, int] = field(default_factory=dict)
    peaks: dict[str, tuple[float, float]] = field(default_factory=dict)

    @classmethod
    def from_samples(
        cls,
        samples: Sequence[Mapping[str, ArrayLike]],
        *,
        scenario: Scenario,
        status: StatusReport,
        node_arc_length: ArrayLike,
        joint_arc_length: ArrayLike,
        snaps: Sequence[SnapEvent] = (),
        vessel_outline: Sequence[ArrayLike] = (),
        catheter_outline: Sequence[ArrayLike] = (),
        provenance: Mapping[str, Any] | None = None,
        wall_time: float = float("nan"),
        counters: Mapping[str, int] | None = None,
        peaks: Mapping[str, tuple[float, float]] | None = None,
    ) -> Result:
        """Make a result of output instants.

        Each sample maps `time`, every scalar, node field, joint field and contact field of the table to its value at
        that instant: numbers, arrays of n + 1 nodes, of n joints, and of as many contacts as there are just then. A
        sample at the time of the one before takes its place.

        Raises ValueError for missing or unknown names, wrong lengths, times that run backwards, or no sample at all.
        """
        return cls(
            dataset=_dataset(_without_repeats(samples), node_arc_length, joint_arc_length),
            status=status,
            scenario=scenario,
            snaps=tuple(snaps),
            vessel_outline=_polylines(vessel_outline),
            catheter_outline=_polylines(catheter_outline),
            provenance={"versions": software_versions(), **(provenance or {})},
            wall_time=float(wall_time),
            counters={name: int(count) for name, count in (counters or {}).items()},
            peaks={name: (float(value), float(time)) for name, (value, time) in (peaks or {}).items()},
        )

    @property
    def time(self) -> Floats:
        """(t,) float, s. The output instants."""
        return self.values("time")

    def values(self, name: str) -> Floats:
        """The quantity `name` as a plain float array in SI."""
        return np.asarray(self.dataset[name].values, dtype=float)

    def contacts_at(self, instant: int) -> dict[str, Floats]:
        """Contact fields of one output instant (an index), without the padding."""
        there = self.dataset["contact_owner"].values[instant] >= 0
        return {name: np.asarray(self.dataset[name].values[instant][there], dtype=float) for name in CONTACT_FIELDS}


def attributes(quantity: Quantity) -> dict[str, Any]:
    """Attributes of a variable after the CF conventions: units, long_name, and the meaning of coded values."""
    attrs: dict[str, Any] = {"units": quantity.unit, "long_name": quantity.long_name}
    if quantity.flags:
        attrs["flag_values"] = np.array([value for value, _ in quantity.flags], dtype=np.int8)
        attrs["flag_meanings"] = " ".join(meaning for _, meaning in quantity.flags)
    return attrs


def software_versions(*further: str) -> dict[str, str]:
    """Versions of what takes part in a run, and of the `further` packages."""
    from importlib.metadata import PackageNotFoundError, version

    import gw_exudyn

    # Its own word, since a checkout on the path is not installed, or is another version than the one that is.
    versions = {"python": platform.python_version(), "gw-exudyn": gw_exudyn.__version__}
    for package in ("exudyn", "numpy", "xarray", "h5netcdf", *further):
        try:
            versions[package] = version(package)
        except PackageNotFoundError:
            versions[package] = "not installed"
    return versions


def _dataset(
    samples: Sequence[Mapping[str, ArrayLike]], node_arc_length: ArrayLike, joint_arc_length: ArrayLike
) -> xr.Dataset:
    import xarray as xr

    nodes = np.asarray(node_arc_length, dtype=float)
    joints = np.asarray(joint_arc_length, dtype=float)
    variables: dict[str, Any] = {}
    for name in SCALARS:
        variables[name] = _variable(name, _stacked(samples, name, ()))
    for name in NODE_FIELDS:
        variables[name] = _variable(name, _stacked(samples, name, nodes.shape))
    for name in JOINT_FIELDS:
        variables[name] = _variable(name, _stacked(samples, name, joints.shape))
    for name, padded in _padded_contacts(samples).items():
        variables[name] = _variable(name, padded)
    coordinates = {
        "time": _variable("time", _stacked(samples, "time", ())),
        "node_arc_length": _variable("node_arc_length", nodes),
        "joint_arc_length": _variable("joint_arc_length", joints),
    }
    return xr.Dataset(variables, coordinates)


def _variable(name: str, values: NDArray[Any]) -> tuple[tuple[str, ...], NDArray[Any], dict[str, Any]]:
    quantity = QUANTITIES[name]
    return quantity.dims, values.astype(_dtype(quantity)), attributes(quantity)


def _dtype(quantity: Quantity) -> type[np.generic]:
    if quantity.flags:
        return np.int8
    return np.int32 if quantity.integer else np.float64


def _without_repeats(samples: Sequence[Mapping[str, ArrayLike]]) -> list[Mapping[str, ArrayLike]]:
    """The samples at strictly rising times: of two at one instant the later counts."""
    if not samples:
        raise ValueError("a result needs at least one sample (the state at the start)")
    kept: list[Mapping[str, ArrayLike]] = []
    for number, sample in enumerate(samples):
        _check_names(sample, number)
        last = _time(kept[-1]) if kept else -np.inf
        if not _time(sample) >= last:
            raise ValueError(f"sample {number}: time {_time(sample)} s does not follow on {last} s")
        if _time(sample) == last:
            kept.pop()
        kept.append(sample)
    return kept


def _time(sample: Mapping[str, ArrayLike]) -> float:
    return float(np.asarray(sample["time"], dtype=float))


def _check_names(sample: Mapping[str, ArrayLike], number: int) -> None:
    expected = {"time", *SCALARS, *NODE_FIELDS, *JOINT_FIELDS, *CONTACT_FIELDS}
    missing, unknown = sorted(expected - set(sample)), sorted(set(sample) - expected)
    if missing or unknown:
        parts = [f"{what}: {', '.join(names)}" for what, names in (("missing", missing), ("unknown", unknown)) if names]
        raise ValueError(f"sample {number}: {'; '.join(parts)}")


def _stacked(samples: Sequence[Mapping[str, ArrayLike]], name: str, shape: tuple[int, ...]) -> NDArray[Any]:
    rows = [np.asarray(sample[name]) for sample in samples]
    for number, row in enumerate(rows):
        if row.shape != shape:
            raise ValueError(f"sample {number}: {name} has shape {row.shape}, expected {shape}")
    return np.stack(rows)


def _padded_contacts(samples: Sequence[Mapping[str, ArrayLike]]) -> dict[str, NDArray[Any]]:
    """The contact fields, each (t, c): c is the largest number of contacts of any instant, and one where there never
    is any.
    """
    counts = [np.size(sample[CONTACT_FIELDS[0]]) for sample in samples]
    # One column even without contacts: a dimension of length zero is an unlimited one to netCDF.
    shape = (len(samples), max(1, *counts))
    padded: dict[str, NDArray[Any]] = {}
    for name in CONTACT_FIELDS:
        table = np.full(shape, -1.0 if QUANTITIES[name].integer else np.nan)
        for number, (sample, count) in enumerate(zip(samples, counts, strict=True)):
            row = np.asarray(sample[name], dtype=float)
            if row.shape != (count,):
                raise ValueError(
                    f"sample {number}: {name} has shape {row.shape}, expected ({count},) like {CONTACT_FIELDS[0]}"
                )
            table[number, :count] = row
        padded[name] = table
    return padded


def _polylines(lines: Sequence[ArrayLike]) -> tuple[Floats, ...]:
    """Polylines as (k, 2) float arrays. Raises ValueError for another shape."""
    polylines = tuple(np.asarray(line, dtype=float) for line in lines)
    for number, line in enumerate(polylines):
        if line.ndim != 2 or line.shape[1] != 2:
            raise ValueError(f"wall polyline {number} has shape {line.shape}, expected (k, 2)")
    return polylines
