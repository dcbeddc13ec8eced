"""The simulation of a scenario: `Simulation` to step it, `simulate` to run it whole."""

from __future__ import annotations

import hashlib
import json
import math
import time as clock
from collections.abc import Callable, Mapping
from dataclasses import astuple
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.engine.state import from_arrays, pack, to_arrays, unpack
from gw_exudyn.engine.stepper import Peaks, Stepper
from gw_exudyn.errors import UsageError
from gw_exudyn.events import Anchor, Watch
from gw_exudyn.model import Model, build
from gw_exudyn.model.contact import NOWHERE
from gw_exudyn.model.drive import AnyDrive, Drive, Force
from gw_exudyn.model.tip_speed import TipSpeed
from gw_exudyn.result import Result, Status, StatusReport
from gw_exudyn.sampling import sample
from gw_exudyn.trust import energy_report, snap_events, trust_report

if TYPE_CHECKING:
    from gw_exudyn.scenario import Scenario

Progress = Callable[[float, float, Mapping[str, Any]], None]
"""progress(time reached, time of the end, outputs), after each output interval."""


class Simulation:
    """A scenario in motion. Several may live in one process; none knows of the others.

    Raises ScenarioError for a scenario that cannot start, SolverError where Exudyn is not there.

    scenario : Scenario. model : Model, what was built of it. shape : False for outputs without the arrays over nodes
    and joints, for those who step often and do not look at them.
    """

    def __init__(self, scenario: Scenario, *, shape: bool = True) -> None:
        self.scenario = scenario
        self._shape = shape
        self.model: Model = build(scenario)
        self._stepper = Stepper(self.model)
        self._watch = Watch(self._stepper)
        self._stopped: StatusReport | None = None

    def reset(self) -> None:
        """Back to the start of the scenario, with the scenario's own drive."""
        self._stepper.reset()
        self._watch.reset()
        self._stopped = None

    @property
    def time(self) -> float:
        """Time reached, s."""
        return self._stepper.time

    @property
    def duration(self) -> float:
        """Time, s, at which the scenario's drive ends; stepping on beyond it holds the drive's last speed."""
        return self.scenario.drive.duration

    @property
    def status(self) -> StatusReport:
        """Whether what was run so far can be trusted; if not, what failed, when and where. An event that has ended the
        run is told here too."""
        return self._ended_as(Status.STOPPED)

    @property
    def ended(self) -> bool:
        """The run has ended by itself, by an event or a failure, and takes no more steps; `status` says why."""
        return self._stopped is not None

    @property
    def failed(self) -> bool:
        """The run has ended and cannot be trusted."""
        return self._stopped is not None and not self._stopped.status.trusted

    def _ended_as(self, otherwise: Status) -> StatusReport:
        """A failure before all, then energies that do not add up, then an event."""
        failure = self._stopped if self.failed else None
        return failure or energy_report(self._stepper) or self._stopped or StatusReport(otherwise, self.time)

    @property
    def penetration(self) -> float:
        """Deepest penetration of the wire into a wall at the time reached, m."""
        return self._stepper.contact.deepest().depth

    @property
    def counters(self) -> dict[str, int]:
        """Solver counts since the last reset."""
        return self._stepper.counts()

    @property
    def peaks(self) -> Mapping[str, tuple[float, float]]:
        """Largest value over all solver steps so far and its time, s, as `Result.peaks` has them."""
        return MappingProxyType(self._stepper.peaks)

    @property
    def outputs(self) -> Mapping[str, Any]:
        """Every quantity of the table of quantities at the time reached: floats, and arrays over nodes, joints and
        contacts."""
        return MappingProxyType(sample(self._stepper, shape=self._shape))

    def step(self, dt: float, *, speed: float | None = None, force: float | None = None) -> Mapping[str, Any]:
        """Go on by dt and return the outputs there.

        dt : s, positive; any length, it need not fit the solver's step: results do not depend on how time is cut into
            calls.
        speed : m/s of the drive from now on, positive into the vessel; with a tip_speed drive the wanted speed of the
            tip. force : N on the hub from now on, with a force drive. None keeps what drives it now (at first the
            scenario's own drive).

        When the run cannot go on, or an event ends it (see the scenario's `stop`), it ends early: `status` then says
        why, and `outputs` are those of the step that showed it.
        Raises UsageError for a step that is not positive, a speed or force that is no number or that this drive does
        not take, or a run that has ended before.
        """
        if not (_is_number(dt) and dt >= _SHORTEST):
            raise UsageError(f"a step of {dt!r} s cannot be taken; it must be positive, {_SHORTEST:g} s at least")
        # Rounded, so that the sum of many small steps is the same time as one large step.
        target = round(self.time + dt, 12)
        for given, value in (("speed", speed), ("force", force)):
            if value is not None:
                self._take_over(given, value, target)
        self.advance(target)
        return self.outputs

    def advance(self, target: float) -> bool:
        """Run to the time `target`, s; False when the run ended on the way, by an event or a failure (see `status`).

        Raises UsageError for a run that has ended before, and for a drive that would take the wire's end out of the
        catheter on the way; nothing has moved then.
        """
        if not _is_number(target):
            raise UsageError(f"{target!r} is no time to run to; it must be a finite number of seconds")
        if self._stopped is not None:
            raise UsageError(f"the run has ended: {self._stopped.sentence()} Reset it, or restore an earlier state.")
        self._check_travel(self._stepper.drive, target)
        while self.time < target - 1e-9:
            # One nominal step at a time, so that a run that went wrong is stopped there and not at the end.
            self._stepper.deepest = NOWHERE
            reached = self._stepper.advance(min(target, self._stepper.next_grid_time()))
            self._stopped = self._what_ends_it(reached)
            if self._stopped is not None:
                return False
        return True

    def _what_ends_it(self, reached: bool) -> StatusReport | None:
        """Failures first: an event counts only where what was computed can be trusted."""
        failure = trust_report(self._stepper, converged=reached)
        if failure is not None:
            unsolved = failure.status is Status.NOT_CONVERGED
            return (self._watch.out_of_travel() if unsolved else None) or failure
        return self._watch.look() if self._stepper.on_grid else None

    def _check_travel(self, drive: AnyDrive, target: float) -> None:
        """A prescribed speed keeps the proximal end in the catheter: in the table it was checked before, after it is
        here."""
        if not isinstance(drive, Drive):
            return  # how far it goes is not known before; its run ends at the end of the travel
        position, (furthest_back, wire) = drive.position_at(target), self.model.travel_range
        if not furthest_back < position <= wire:
            raise UsageError(
                f"at {target:.6g} s the drive would be at {position * 1e3:.6g} mm, and the wire of {wire * 1e3:.6g} mm "
                f"is guided from {furthest_back * 1e3:.6g} mm to its length only; take another speed or a shorter step"
            )

    def _take_over(self, given: str, value: float, target: float) -> None:
        """Checked first: what is refused has changed nothing. given : "speed" or "force"."""
        unit = "m/s" if given == "speed" else "N"
        stepper = self._stepper
        drive = stepper.drive
        takes = "force" if isinstance(drive, Force) else "speed"
        if given != takes:
            kind = self.scenario.drive.kind
            raise UsageError(f"a drive of kind {kind} takes a {takes} from outside, no {given}; give {takes}=")
        if not _is_number(value):
            raise UsageError(f"a {given} of {value!r} {unit} cannot be driven; it must be a finite number")
        if isinstance(drive, TipSpeed) and value < 0:
            raise UsageError(f"a tip speed of {value:.6g} m/s is refused; the hub never moves back: give 0 or more")
        if not drive.taken_over or drive.taken_over[-1] != value:
            self._check_travel(drive.taken_over_at(self.time, value), target)
            stepper.take_over(value)

    def get_state(self) -> bytes:
        """The whole state: a simulation of the same scenario that restores it goes on bit for bit, also in another
        process.

        At a time between two solver steps the state holds both that instant and the step's start.
        """
        arrays = {f"now.{name}": array for name, array in to_arrays(self._stepper.state()).items()}
        grid = self._stepper.grid_state
        if grid is not None:
            arrays |= {f"grid.{name}": array for name, array in to_arrays(grid).items()}
        arrays["drive"] = np.array(self._stepper.drive.taken_over)
        arrays["anchor"] = np.array(astuple(self._watch.anchor))
        arrays["counts"] = self._stepper.bookkeeping()
        peaks = self._stepper.all_peaks()
        arrays["words"] = _as_bytes({"peaks": peaks, "stopped": _as_words(self._stopped)})
        return pack(arrays, self._fingerprint())

    def set_state(self, state: bytes) -> None:
        """Go on from a state. Raises UsageError for bytes that are none, damaged, or of another scenario; the
        simulation then stays as it was."""
        arrays = unpack(state, self._fingerprint())
        drive = tuple(float(x) for x in arrays.pop("drive"))
        counts, anchor = arrays.pop("counts"), arrays.pop("anchor")
        words = json.loads(arrays.pop("words").tobytes())
        parts: dict[str, dict[str, Any]] = {"now": {}, "grid": {}}
        for name, array in arrays.items():
            part, _, rest = name.partition(".")
            parts[part][rest] = array
        grid = from_arrays(parts["grid"]) if parts["grid"] else None
        self._stepper.set_everything(
            from_arrays(parts["now"]), grid, drive, counts.astype(np.float64), _as_peaks(words["peaks"])
        )
        self._watch.anchor = Anchor(*anchor.tolist())
        self._stopped = _as_report(words["stopped"])

    def _fingerprint(self) -> str:
        text = json.dumps(self.scenario.to_dict(), sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()

    def finished(self) -> StatusReport:
        """How the run ended, now that it has reached its end: completed, unless an event or a failure came before."""
        return self._ended_as(Status.COMPLETED)

    def result(self, samples: list[dict[str, Any]], status: StatusReport, wall_time: float) -> Result:
        """A result of output instants (`outputs` at rising times). wall_time : s, of the solution alone."""
        stepper = self._stepper
        return Result.from_samples(
            samples,
            scenario=self.scenario,
            status=status,
            node_arc_length=self.model.wire.node_arc_length,
            joint_arc_length=self.model.wire.joint_arc_length,
            snaps=snap_events(stepper),
            vessel_outline=self.model.vessel_outline(),
            catheter_outline=self.model.catheter_outline(),
            wall_time=wall_time,
            counters=stepper.counts(),
            peaks=stepper.peaks,
        )


_SHORTEST = 1e-9
"""Shortest step that can be asked for, s: closer times are one."""


def _is_number(value: Any) -> bool:
    """A finite int or float, and no bool."""
    return (
        isinstance(value, int | float | np.integer | np.floating)
        and not isinstance(value, bool)
        and math.isfinite(value)
    )


def _as_bytes(words: dict[str, Any]) -> NDArray[np.uint8]:
    return np.frombuffer(json.dumps(words).encode(), np.uint8)


def _as_peaks(words: list[dict[str, list[float]]]) -> tuple[Peaks, Peaks]:
    now, grid = ({name: (float(value), float(time)) for name, (value, time) in part.items()} for part in words)
    return now, grid


def _as_words(report: StatusReport | None) -> list[Any] | None:
    return None if report is None else [report.status.name, report.time, report.place, report.detail]


def _as_report(words: list[Any] | None) -> StatusReport | None:
    return None if words is None else StatusReport(Status[words[0]], words[1], words[2], words[3])


def simulate(
    scenario: Scenario, progress: Progress | None = None, should_stop: Callable[[], bool] | None = None
) -> Result:
    """Run a scenario to the end of its drive.

    progress : called after each output interval. should_stop : asked there; True ends the run with the status STOPPED,
        and so
        does Ctrl-C (KeyboardInterrupt) at any time. What was computed until then is in the result.

    A run that cannot go on or cannot be trusted ends with a status that says why; it raises nothing. Raises
    ScenarioError for a scenario that cannot start.
    """
    simulation = Simulation(scenario)
    samples = [dict(simulation.outputs)]
    spent, status = 0.0, None
    try:
        for target in output_times(scenario):
            began = clock.perf_counter()
            going = simulation.advance(target)
            spent += clock.perf_counter() - began
            if not going:
                # A step that fails leaves the run at the step's start, before outputs on the way through it.
                samples = [sample for sample in samples if sample["time"] < simulation.time]
            samples.append(dict(simulation.outputs))
            if progress is not None:
                progress(simulation.time, simulation.duration, samples[-1])
            if not going:
                break
            if should_stop is not None and should_stop():
                status = simulation.status
                break
    except KeyboardInterrupt:
        status = simulation.status
    return simulation.result(samples, status or simulation.finished(), spent)


def output_times(scenario: Scenario) -> list[float]:
    """Times, s, of the outputs after the start: every interval, and the end."""
    duration, interval = scenario.drive.duration, scenario.output.interval
    count = math.floor(duration / interval + 1e-9)
    times = [round(interval * (i + 1), 12) for i in range(count)]
    if not times or times[-1] < duration - 1e-9:
        times.append(duration)
    else:
        times[-1] = duration
    return times
