"""What Exudyn's Newton iteration asks of us: contact forces and tangent, a limit on its steps, checks of its result."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.engine.assembly import HUB_COORDINATES, System
from gw_exudyn.engine.library import exudyn
from gw_exudyn.engine.settings import acceleration_factor, velocity_factor
from gw_exudyn.model.contact import Contact
from gw_exudyn.model.kernel import Motion
from gw_exudyn.model.loads import Loads
from gw_exudyn.model.stability import negative_pivots

Floats = NDArray[np.float64]

_OPEN = 0.05
"""What a segment may pass in one go where it meets nothing, over the wire's length; else it is the wire's radius."""

_LIMIT = 0.75
"""Largest move of a segment in one Newton step, in radii of the wire or in what stands for it (`_passable`). With the
signed gap it keeps corners on their side."""

_GUESS = 0.25
"""How far the first guess of a step may move a segment beyond the drive's travel, in radii."""

_NEAR = 0.1
"""Newton is near its end where its last step moved no segment further than this, in radii."""

_TUNNELLED = 0.5
"""Penetration, in radii, that one step may not reach from less than the trusted depth."""

_JUMP, _FOLLOWED = 1.5, 2.0
"""A step may move a segment by so many radii, and by so many times the drive's travel, together."""

_SLIGHT = 1e-4
"""Share of the inertia in a nominal step that counts as stiffness when stability is judged: enough for a wire that
nothing holds yet, next to nothing beside a load."""

_SURPRISE = 0.5
"""By how much the way that a hub goes at its speed in a step may change over the step, in radii."""

_ROAMING = 3
"""Iteration from which a step is given up where a segment has moved too far for it; hardly any can have before."""

PIECE = 1 / 3
"""Share of the contact's reach that the drive may travel in one step: segments may move by some more."""

_ACCEPT, _REFUSE = [0.0, -1.0], [1e9, -1.0]


class Newton:
    """The callbacks of one system. Exudyn's coordinates count from the reference places; contact wants places."""

    def __init__(self, contact: Contact, loads: Loads) -> None:
        self._contact, self._loads = contact, loads
        count = contact.wire.segments
        rows = (3 * np.arange(count)[:, None] + np.repeat(np.arange(3), 3)).ravel()
        columns = (3 * np.arange(count)[:, None] + np.tile(np.arange(3), 3)).ravel()
        # The same pattern at every call lets the factorisation keep its analysis.
        self._triplets = np.column_stack([rows, columns, np.zeros(9 * count)]).astype(float)
        self._radius = _passable(contact, loads)
        self._force, self._tangent = np.zeros((count, 3)), np.zeros(9 * count)
        self._reaction: Floats = np.zeros(2 * count)
        self._step, self._travel = 1.0, 0.0
        self._end = 0.0
        self._last: Floats = np.zeros(0)
        self._last_move = 0.0
        self._before = Motion(count)
        self.reset_counts()

    def reset_counts(self) -> None:
        """Count from zero."""
        self.residuals = self.iterations = self.tangents = self.refused = 0

    def counts(self) -> dict[str, int]:
        """Newton iterations, residuals and tangents evaluated, converged steps refused by the checks."""
        return {
            "newton_iterations": self.iterations,
            "residuals": self.residuals,
            "tangents": self.tangents,
            "refused_steps": self.refused,
        }

    def set_counts(self, counts: list[int]) -> None:
        """Go on counting from what `counts` gave."""
        self.iterations, self.residuals, self.tangents, self.refused = counts

    def attach(self, system: System, nominal_step: float) -> None:
        """Work on this system. nominal_step : s."""
        self._inertia = _SLIGHT * acceleration_factor(nominal_step)
        self._system = system
        self._data = system.mbs.systemData

    def install(
        self,
        start_trial: Callable[[float], tuple[float, float]],
        end_step: Callable[[float], None],
        give_up: Callable[[], None],
    ) -> None:
        """Hand the callbacks to Exudyn. start_trial(end) -> (step, s; travel of the drive in it, m); end_step(time)
        for each accepted step; give_up() ends an iteration that has not converged, and the step is cut."""
        mbs = self._system.mbs
        self._give_up = give_up

        def before_step(_: Any, time: float) -> bool:
            self._step, self._travel = start_trial(time)
            self._loads.time = time
            return True

        def after_step(_: Any, time: float) -> bool:
            # Exudyn calls this also where SolveSteps begins, at a time that is done.
            if time > self._end:
                self._end = time
                self._multipliers = self._data.GetAECoordinates()
                end_step(time)
            return True

        mbs.SetPreStepUserFunction(before_step)
        mbs.SetPreNewtonResidualUserFunction(lambda *a: self._before_residual(*a))
        mbs.SetPostNewtonUserFunction(self._after_newton)
        mbs.SetPostStepUserFunction(after_step)

    def look(self, q: Floats, q_t: Floats, time: float) -> None:
        """Set the motion from Exudyn's coordinates outside of a step, and evaluate the loads there; steps after
        `time`, s, are new."""
        self._move(q, q_t)
        self._loads.time = time
        self._loads.evaluate(self._contact.motion)
        self._end = time
        self._multipliers = self._data.GetAECoordinates()

    def tangent(self, _mbs: Any, _t: float, _item: int, _q: Any, _q_t: Any, factor: float, _factor_t: float) -> Any:
        """Share of contact and loads in the tangent at the place of the last residual. Exudyn wants minus the
        derivative of the force.

        Position and velocity parts were joined with the ratio of the two factors, which the integrator fixes.
        """
        self.tangents += 1
        np.multiply(self._tangent, -factor, out=self._triplets[:, 2])
        matrix = exudyn().MatrixContainer()
        count = len(self._triplets) // 3
        matrix.SetWithSparseMatrix(self._triplets, count, count)
        return matrix

    def _before_residual(self, mbs: Any, _time: float, iteration: int, _outer: int) -> None:
        """Forces and tangent at Newton's present place, after shortening the step that led there."""
        self.residuals += 1
        self.iterations += iteration > 0
        data = self._data
        q, q_t = data.GetODE2Coordinates(), data.GetODE2Coordinates_t()
        if iteration == 0:
            data.SetAECoordinates(self._multipliers)
            q = self._guessed(q, q_t)
        else:
            q = self._shortened(q, q_t)
        self._last = q
        self._sum_up()
        mbs.SetObjectParameter(self._system.contact, "forceVector", self._force.reshape(-1))
        if iteration >= _ROAMING and self._jumped():
            # What lies beyond is mostly a snap, which the check after Newton would refuse.
            self._give_up()

    def _guessed(self, q: Floats, q_t: Floats) -> Floats:
        """Evaluate the first guess, Exudyn's from the last step's motion, but not rushing on after a snap."""
        self._last_move = 0.0
        change = q - self._data.GetODE2Coordinates(exudyn().ConfigurationType.StartOfStep)
        most = _GUESS * self._radius + abs(self._travel)
        share = min(1.0, most / max(_largest_move(change), 1e-30))
        place, rate = self._go_back(q, q_t, (share - 1) * change)
        self._evaluate(place, rate, guessed=True)
        return place

    def _go_back(self, q: Floats, q_t: Floats, back: Floats) -> tuple[Floats, Floats]:
        """Take back a part of Newton's step, in place, rate and acceleration together; the place and rate that
        remain."""
        place, rate = q + back, q_t + velocity_factor(self._step) * back
        if back.any():
            data = self._data
            data.SetODE2Coordinates(place)
            data.SetODE2Coordinates_t(rate)
            data.SetODE2Coordinates_tt(data.GetODE2Coordinates_tt() + acceleration_factor(self._step) * back)
        return place, rate

    def _evaluate(self, q: Floats, q_t: Floats, *, guessed: bool) -> None:
        self._move(q, q_t)
        # Far from the end contacts are taken as they are: on the way they decide to which side a wire buckles.
        followed = not guessed and self._near_end
        self._contact.evaluate(1.0, velocity_factor(self._step), predicted=guessed, followed=followed)
        self._loads.evaluate(self._contact.motion)

    def _move(self, q: Floats, q_t: Floats) -> None:
        places = np.asarray(q)[HUB_COORDINATES:].reshape(-1, 3) + self._system.reference
        self._contact.motion.set(places, np.asarray(q_t)[HUB_COORDINATES:].reshape(-1, 3))

    def _shortened(self, q: Floats, q_t: Floats) -> Floats:
        """Evaluate Newton's new place, or one nearer to the last: no segment moves too far, and a contact that was
        open no more than closes, so that the next tangent knows of it. Place, rate and acceleration are shortened
        together."""
        change = q - self._last
        self._last_move = _largest_move(change)
        share = min(1.0, _LIMIT * self._radius / max(self._last_move, 1e-30))
        self._before.take(self._contact.motion)
        self._contact.step_on()
        for _ in range(2):
            back = (share - 1) * change
            self._evaluate(q + back, q_t + velocity_factor(self._step) * back, guessed=False)
            free = self._contact.share_to_touch(self._before)
            if free >= 1:
                break
            share *= free
        return self._go_back(q, q_t, back)[0]

    def _sum_up(self) -> None:
        """Force and tangent of contact and loads, and in the tangent how the joints' forces turn each segment as it
        turns, which Exudyn leaves out.

        A segment pushed at both ends resists a turn the less, the larger the push: the term that makes columns buckle.
        Far from the end of the iteration that part is left out, since a tangent without it does not throw the wire
        about.
        """
        self._force[:], self._tangent[:] = self._contact.force, self._contact.tangent
        if self._loads.present:
            self._force += self._loads.force
            self._tangent += self._loads.tangent.reshape(-1)
        self._reaction = np.asarray(self._data.GetAECoordinates())[self._system.hub.constraints :]
        self._contact.add_turning(self._tangent, self._reaction, stiffening=not self._near_end)

    @property
    def _near_end(self) -> bool:
        """Newton's last step was a small one."""
        return self._last_move <= _NEAR * self._radius

    def _after_newton(self, _mbs: Any, _time: float) -> list[float]:
        """Refuse what converged to the wrong thing; the step is then cut."""
        wrong = self._ran_away() or self._jumped() or self._tunnelled() or self._unstable()
        self.refused += wrong
        return _REFUSE if wrong else _ACCEPT

    def _ran_away(self) -> bool:
        """A hub that moves freely went further than contact looks ahead, out of its range, or much further or less far
        than its speed foretold: the step is too long for it. Its travel is known from here on."""
        if not self._system.hub.moves_freely:
            return False
        there, foretold = float(self._data.GetODE2Coordinates()[0]), self._travel
        self._travel = there - float(self._data.GetODE2Coordinates(exudyn().ConfigurationType.StartOfStep)[0])
        surprise = abs(float(self._data.GetODE2Coordinates_t()[0]) * self._step - foretold)
        (back, far), contact = self._system.range, self._contact
        far_off = surprise > _SURPRISE * self._radius or abs(self._travel) > contact.reach * PIECE
        return far_off or not back < there <= far

    def _jumped(self) -> bool:
        """A node moved much further than the drive: the step skipped a snap-through, whose branch only short steps
        find."""
        motion, half = self._contact.motion, self._contact.wire.lengths / 2
        along = np.abs(motion.q[:, 0] - motion.q0[:, 0] + half * (motion.c - motion.c0)).max()
        across = np.abs(motion.q[:, 1] - motion.q0[:, 1] + half * (motion.s - motion.s0)).max()
        moved = max(float(along), float(across))
        return moved > _JUMP * self._radius + _FOLLOWED * abs(self._travel)

    def _tunnelled(self) -> bool:
        return self._contact.deepest().depth > _TUNNELLED * self._contact.wire.radius

    def _unstable(self) -> bool:
        wire = self._contact.wire
        stiffness = wire.joint_stiffness + velocity_factor(self._step) * wire.joint_damping
        if not (self._loads.present or self._system.base_moves):
            return self._contact.is_unstable(stiffness)
        tangent = self._contact.tangent + self._loads.tangent.reshape(-1)
        self._contact.add_turning(tangent, self._reaction, stiffening=False)
        blocks = -tangent.reshape(-1, 3, 3)
        blocks[:, (0, 1, 2), (0, 1, 2)] += self._inertia * np.column_stack([wire.mass, wire.mass, wire.inertia])
        negative = negative_pivots(wire, self._contact.motion, blocks, stiffness, base_moves=self._system.base_moves)
        # Without a potential there is no minimum; what can be lost is divergence, where the determinant changes its
        # sign [Ziegler 1968].
        has_potential = not self._loads.follows and not self._contact.rubs()
        return negative > 0 if has_potential else negative % 2 == 1


def _largest_move(change: Floats) -> float:
    """Largest component, m, of the segments' moves in a change of Exudyn's coordinates."""
    shift = change[HUB_COORDINATES:].reshape(-1, 3)[:, :2]
    return max(float(shift.max()), -float(shift.min()))


def _passable(contact: Contact, loads: Loads) -> float:
    """m, of which the limits of a segment's moves are multiples: the size of what it must not pass through."""
    radius = contact.wire.radius
    if len(contact.walls.length):
        return radius
    discs = [disc.radius + radius for disc in loads.discs.discs]
    return min([*discs, _OPEN * contact.wire.length])
