"""Stepping of the Exudyn system by one solver that lives through the run.

Time runs on a grid of nominal steps that begins at zero. A step that does not converge, or whose result the checks
refuse, is cut back, and ends at the next grid time all the same. A stop between two grid times is a step of its own
that is taken back before the run goes on, so that results do not depend on how time is cut into calls.
"""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass, replace

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.engine.assembly import HUB_COORDINATES, System, assemble
from gw_exudyn.engine.interrupt import after_the_step
from gw_exudyn.engine.library import exudyn
from gw_exudyn.engine.newton import PIECE, Newton
from gw_exudyn.engine.settings import simulation_settings
from gw_exudyn.engine.state import State
from gw_exudyn.errors import SolverError
from gw_exudyn.model import Model
from gw_exudyn.model.contact import NOWHERE, Contact, Deepest
from gw_exudyn.model.drive import AnyDrive, Force
from gw_exudyn.model.energy import Energies, Snapshot, advanced, snapshot
from gw_exudyn.model.hub import HubEnergies, HubInstant, hub_advanced
from gw_exudyn.model.loads import Loads
from gw_exudyn.model.tip_speed import Leg, TipSpeed

Floats = NDArray[np.float64]

_SAME_TIME = 1e-9
"""Times closer than this, s, are one."""

_SLOWER = 5
"""How often a step is taken again with a slower leg; the last time the hub stands still."""

_LEAST_RELEASE = 1e-11
"""Releases of less, J, are not kept: even a thousand in a row are nothing."""

Peaks = dict[str, tuple[float, float]]
"""Largest value of a quantity so far, and its time, s."""


@dataclass(frozen=True)
class Release:
    """Energy, J, that one solver step lost to dampers and to the integrator, and not to friction. time : s, its end."""

    time: float
    energy: float


class Stepper:
    """A model in motion. Places and forces in the catheter's frame."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.contact = Contact(model.wire, model.walls, model.law)
        self.drive: AnyDrive = model.drive
        spec = model.scenario.solver
        self.loads = Loads(model.wire, model.loads)
        self._newton = Newton(self.contact, self.loads)
        self.system: System = assemble(model, self._newton.tangent)
        self._newton.attach(self.system, spec.step)
        self._settings = simulation_settings(spec.step, spec.minimum_step, spec.tolerance, spec.absolute_tolerance)
        self._solver = exudyn().MainSolverImplicitSecondOrder()
        self._newton.install(self._start_trial, self._end_step, self._give_up)
        if not self._solver.InitializeSolver(self.system.mbs, self._settings):
            raise SolverError("Exudyn refused to initialise its solver for this model")
        self._time = 0.0
        self._grid: tuple[State, int, Peaks] | None = None
        self.peaks: Peaks = {}
        self.deepest = NOWHERE
        self._instant: Snapshot = snapshot(model.wire, self.contact.motion, 0.0, 0.0)
        self.energies, self.hub_energies = Energies(), HubEnergies()
        self._hub = HubInstant()
        self.releases: list[Release] = []
        self.steps, self.smallest_step = 0, math.inf
        self._initial = self._first_state()
        self.reset()

    def reset(self) -> None:
        """Back to the start: the straight wire, inserted as far as the scenario says."""
        self.drive = self.model.drive
        self.steps, self.smallest_step = 0, math.inf
        self._newton.reset_counts()
        self.releases = []
        self.peaks = {}
        self.deepest = NOWHERE
        self._grid = None
        self.restore(self._initial)

    @property
    def time(self) -> float:
        """Time reached, s."""
        return self._time

    def advance(self, target: float) -> bool:
        """Run to the time `target`, s; False where the solver finds no way on (the time reached is then the last good
        one).

        Ctrl-C raises KeyboardInterrupt; the state is then that of the last step taken.
        """
        if target > self._time + _SAME_TIME:
            self._return_to_grid()
        while self._time < target - _SAME_TIME:
            following = self.next_grid_time()
            if following > target + _SAME_TIME:
                self._grid = (self.state(), len(self.releases), dict(self.peaks))
                self._find_leg(following)
                return self._solve(target)
            if not self._nominal_step(following):
                return False
        return True

    def next_grid_time(self) -> float:
        """Time, s, of the next nominal step's end; rounded, so that it prints as a person would write it."""
        step = self.model.scenario.solver.step
        return round((math.floor(self._time / step + 1e-6) + 1) * step, 12)

    @property
    def on_grid(self) -> bool:
        """The time reached ends a nominal step."""
        step = self.model.scenario.solver.step
        return abs(self._time - round(self._time / step) * step) < _SAME_TIME

    def take_over(self, value: float) -> None:
        """From now on the drive has this constant speed, m/s, or force, N. What was run so far stays."""
        self._grid = None
        self.drive = self.drive.taken_over_at(self._time, value)

    def _return_to_grid(self) -> None:
        if self._grid is not None:
            state, releases, self.peaks = self._grid
            del self.releases[releases:]
            self.restore(state)
            self._grid = None

    def _solve(self, end: float) -> bool:
        """Exudyn's steps from the time reached to `end`."""
        travel = (end - self._time) * self.system.hub.fastest(self.drive, self._hub, self._time, end)
        pieces = max(1, math.ceil(travel / (self.contact.reach * PIECE) - 1e-9))
        for piece in np.linspace(self._time, end, pieces + 1)[1:]:
            it = self._solver.it
            it.startTime = it.currentTime = self._time
            it.endTime = float(piece)
            it.maxStepSize = it.initialStepSize = it.currentStepSize = float(piece) - self._time
            self._solver.it = it
            with after_the_step():
                solved = self._solver.SolveSteps(self.system.mbs, self._settings)
            if not solved:
                return False
        return True

    def _nominal_step(self, end: float) -> bool:
        """To the next grid time. A controlled drive chooses its leg, from the state alone, so that what is run from
        here twice is run alike; where the push force would pass its limit, the step is taken again with a slower leg.
        """
        if not isinstance(self.drive, TipSpeed):
            return self._solve(end)
        before = self._instant.push
        self.drive = self._decided(self.drive)
        mark = self._mark()
        solved = self._solve(end)
        for attempt in range(_SLOWER):
            if not (solved and self.drive.is_too_fast(self._instant.push)):
                break
            slower = self.drive.slowed(before, self._instant.push, last=attempt == _SLOWER - 1)
            self._back_to(mark)
            self.drive = slower
            solved = self._solve(end)
        return solved

    def _decided(self, drive: TipSpeed) -> TipSpeed:
        return drive.decided(self._time, self.tip(), self._instant.push, self.model.scenario.solver.step)

    def _find_leg(self, end: float) -> None:
        """The leg of a controlled drive up to the next grid time, for a stop on the way; nothing else has moved."""
        if not isinstance(self.drive, TipSpeed):
            return
        if math.isinf(self.drive.force_limit):
            self.drive = self._decided(self.drive)
            return
        mark = self._mark()
        self._nominal_step(end)
        drive = self.drive
        self._back_to(mark)
        self.drive = drive

    def _mark(self) -> tuple[State, int, Peaks, Deepest]:
        return self.state(), len(self.releases), dict(self.peaks), self.deepest

    def _back_to(self, mark: tuple[State, int, Peaks, Deepest]) -> None:
        """As if nothing had been run since `mark`; only the counts of work go on."""
        state, releases, peaks, self.deepest = mark
        self.peaks = dict(peaks)
        del self.releases[releases:]
        self.restore(state)

    def tip(self) -> tuple[float, float]:
        """Place of the tip, m."""
        motion, half = self.contact.motion, self.model.wire.lengths[-1] / 2
        return float(motion.q[-1, 0] + half * motion.c[-1]), float(motion.q[-1, 1] + half * motion.s[-1])

    def _start_trial(self, end: float) -> tuple[float, float]:
        """Exudyn begins a (perhaps repeated) step that ends at `end`: move the hub. Returns the step, s, and the
        travel, m, to expect."""
        self.system.hub.aim(self.system.mbs, self.drive, end)
        return end - self._time, self.system.hub.travel(self.drive, self._hub, self._time, end)

    def _give_up(self) -> None:
        """Newton's iteration leads nowhere: Exudyn cuts the step."""
        self._solver.conv.stopNewton = True

    def _end_step(self, time: float) -> None:
        """A step was accepted: take over its forces, count its energies, find the pairs of the next."""
        step = time - self._time
        self.steps += 1
        self.smallest_step = min(self.smallest_step, step)
        self._time = time
        before, hub, lost = self._instant, self._hub, self.energies.numerical_loss + self.energies.damping_loss
        self._instant = self._look()
        acceleration = np.asarray(self.system.mbs.systemData.GetODE2Coordinates_tt())[HUB_COORDINATES:].reshape(-1, 3)
        self.energies = advanced(
            self.energies, self.contact, self._wall_energy, before, self._instant, acceleration, step
        )
        if isinstance(self.drive, Force):
            mass, damping = self.drive.hub_mass, self.drive.hub_damping
            self.hub_energies = hub_advanced(self.hub_energies, mass, damping, hub, self._hub, step)
        released = self.energies.numerical_loss + self.energies.damping_loss - lost
        if released > _LEAST_RELEASE:
            self.releases.append(Release(time, released))
        self._note_peaks(time)
        self.contact.accept()
        self._prepare()

    def _note_peaks(self, time: float) -> None:
        """Keep the largest values of the run; they may lie between two outputs."""
        deepest = self.contact.deepest()
        if deepest.depth > self.deepest.depth:
            self.deepest = deepest
        values = {
            "push_force": self._instant.push,
            "pull_force": -self._instant.push,
            "wall_force_max": self.contact.summary().largest,
            "penetration_max": deepest.depth,
        }
        for name, value in values.items():
            if value > self.peaks.get(name, (0.0, 0.0))[0]:
                self.peaks[name] = (value, time)

    def _look(self) -> Snapshot:
        self._hub = self.system.hub.instant(self.system.mbs, self.drive, self._time)
        loads = self.loads.instant(self.contact.motion)
        return snapshot(self.model.wire, self.contact.motion, self._hub.push, self._hub.travel, loads)

    def _prepare(self) -> None:
        self.contact.start_step()
        self.contact.evaluate()
        self._wall_energy = self.contact.summary().energy

    @property
    def hub(self) -> HubInstant:
        """The hub at the time reached."""
        return self._hub

    @property
    def energy_error(self) -> float:
        """What does not add up so far, J, of the wire's energies and the hub's."""
        return self.energies.error + self.hub_energies.error

    @property
    def instant(self) -> Snapshot:
        """Place, rate, push force and travel at the time reached."""
        return self._instant

    def state(self) -> State:
        """The state at the time reached, for `restore`."""
        data = self.system.mbs.systemData
        return State(
            time=self._time,
            q=np.array(data.GetODE2Coordinates()),
            q_t=np.array(data.GetODE2Coordinates_t()),
            q_tt=np.array(data.GetODE2Coordinates_tt()),
            algorithmic=np.array(self._solver.GetAAlgorithmic()),
            multipliers=np.array(data.GetAECoordinates()),
            contact=self.contact.memory,
            energies=self.energies,
            hub=self.hub_energies,
            control=self._control(),
        )

    def _control(self) -> Floats:
        """What the drive's controller remembers."""
        return np.array(astuple(self.drive.leg) if isinstance(self.drive, TipSpeed) else ())

    def restore(self, state: State) -> None:
        """Go on from a state exactly as the run did that it was taken from."""
        exu, data = exudyn(), self.system.mbs.systemData
        initial, start = exu.ConfigurationType.Initial, exu.ConfigurationType.StartOfStep
        data.SetODE2Coordinates(state.q, initial)
        data.SetODE2Coordinates_t(state.q_t, initial)
        # The integrator's own accelerations can only be set as initial ones.
        data.SetODE2Coordinates_tt(state.algorithmic, initial)
        self._solver.InitializeSolverInitialConditions(self.system.mbs, self._settings)
        for configuration in (exu.ConfigurationType.Current, start):
            data.SetODE2Coordinates(state.q, configuration)
            data.SetODE2Coordinates_t(state.q_t, configuration)
            data.SetODE2Coordinates_tt(state.q_tt, configuration)
            data.SetAECoordinates(state.multipliers, configuration)
            data.SetTime(state.time, configuration)
        self._time = state.time
        self.energies, self.hub_energies = state.energies, state.hub
        if isinstance(self.drive, TipSpeed):
            self.drive = replace(self.drive, leg=Leg(*state.control.tolist()))
        self.contact.memory = state.contact
        self._newton.look(state.q, state.q_t, state.time)
        self._instant = self._look()
        self._prepare()

    @property
    def grid_state(self) -> State | None:
        """The start of the step that was stopped half-way, where the time reached lies between two grid times."""
        return None if self._grid is None else self._grid[0]

    def bookkeeping(self) -> Floats:
        """Counts and releases as numbers, for `set_everything`."""
        kept = len(self.releases) if self._grid is None else self._grid[1]
        rows = [value for release in self.releases for value in (release.time, release.energy)]
        return np.array([self.steps, self.smallest_step, *self._newton.counts().values(), kept, *rows])

    def all_peaks(self) -> tuple[Peaks, Peaks]:
        """The peaks so far, and those at the last grid time."""
        return self.peaks, (self.peaks if self._grid is None else self._grid[2])

    def set_everything(
        self,
        now: State,
        grid: State | None,
        taken_over: tuple[float, ...],
        bookkeeping: Floats,
        peaks: tuple[Peaks, Peaks],
    ) -> None:
        """Go on from what `state`, `grid_state`, the drive's `taken_over`, `bookkeeping` and `all_peaks` gave."""
        counts = len(self._newton.counts())
        self.steps, self.smallest_step = int(bookkeeping[0]), float(bookkeeping[1])
        self._newton.set_counts([int(x) for x in bookkeeping[2 : 2 + counts]])
        rows = bookkeeping[3 + counts :].reshape(-1, 2)
        self.releases = [Release(float(time), float(energy)) for time, energy in rows]
        self.drive = self.model.drive
        if taken_over:
            self.drive = replace(self.model.drive, taken_over=taken_over)
        self.peaks, self.deepest = dict(peaks[0]), NOWHERE
        self._grid = None if grid is None else (grid, int(bookkeeping[2 + counts]), dict(peaks[1]))
        self.restore(now)

    def _first_state(self) -> State:
        """At rest in the catheter; corners beside the wire from the start (its own lips) know their side."""
        data = self.system.mbs.systemData
        q, q_t = np.array(data.GetODE2Coordinates()), np.array(data.GetODE2Coordinates_t())
        self._newton.look(q, q_t, 0.0)
        self.contact.start_step()
        self.contact.evaluate()
        self.contact.accept()
        multipliers = np.zeros(len(data.GetAECoordinates()))
        loads = self.loads.instant(self.contact.motion)
        instant = snapshot(self.model.wire, self.contact.motion, 0.0, 0.0, loads)
        stored = instant.elastic + loads.stored + instant.kinetic
        energies = replace(
            Energies(),
            elastic=instant.elastic,
            wall=loads.stored,
            kinetic=instant.kinetic,
            start=stored,
            largest_work=stored,
        )
        zeros, memory = np.zeros_like(q), self.contact.memory
        return State(0.0, q, q_t, zeros, zeros.copy(), multipliers, memory, energies, HubEnergies(), self._control())

    def counts(self) -> dict[str, int]:
        """Solver counts since the last reset."""
        return {"solver_steps": self.steps, **self._newton.counts()}
