"""A Gymnasium environment: an agent moves the guidewire and sees what a person at the table might be shown.

Needs the extra `rl`. Importing this module registers `gw_exudyn/Guidewire-v0`:

    import gymnasium, gw_exudyn.rl
    env = gymnasium.make("gw_exudyn/Guidewire-v0", scenario="phantom-universal", target=(0.06, 0.0205))
    both_cores = gymnasium.make_vec("gw_exudyn/Guidewire-v0", 2, "async", scenario=..., target=...)
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from gw_exudyn.errors import ScenarioError, UsageError
from gw_exudyn.model.law import estimated_force
from gw_exudyn.result import Status
from gw_exudyn.scenario import Scenario, load_scenario, scenario_from_dict
from gw_exudyn.simulation import Simulation

Observation = NDArray[np.float32]
Span = tuple[float, float]

OBSERVED = (
    "target_ahead",
    "target_to_the_left",
    "distance",
    "tip_x",
    "tip_y",
    "tip_cos",
    "tip_sin",
    "insertion_depth",
    "push_force",
    "tip_force",
    "wall_force_max",
    "last_action",
)
"""What an observation holds, in its order. Lengths are over the distance from the catheter's exit to the target (the
target's place as seen from the tip), the insertion depth over the wire's length, forces over the force that is expected
in the tightest bend; all cut off at `LARGEST`."""

LARGEST = 10.0
_FORCE_COST = 0.1
_TIME_COST = 0.01


class GuidewireEnv(gymnasium.Env[Observation, NDArray[np.float32]]):
    """Push, hold and pull a guidewire until its tip is at the target.

    Parameters
    ----------
    scenario : file, shipped name, or Scenario, with a drive of kind speed, force or tip_speed; its duration is the time
        that an episode has.
    target : (x, y), m, and within, m : the scenario's `stop.target` if not given.
    interval : s between two actions.
    limit : what an action of 1 stands for, m/s or N: the largest of the scenario's drive if not given.
    randomise : bounds by dotted path, as {"contact.friction_coefficient": (0.1, 0.4)}: drawn anew, evenly, at each
        reset.

    Action: one number from -1 to 1, speed or force over its limit. A speed that would take the wire's end out of its
    guide is held back to what the guide allows.
    Reward: progress towards the target over the distance from the exit, less `_FORCE_COST` times the largest wall force
    (over the expected) and `_TIME_COST`, both per second; 1 more at the target.
    Terminated: at the target, or where the run cannot go on (a failure, or one of the scenario's own stops), which
    costs 1. Truncated: at the end of the scenario's time.

    Raises UsageError without a target, and for a target, numbers or bounds that are none; ScenarioError for a scenario
    that cannot start, and for random values whose path there is not or that it does not take.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012  # gymnasium declares it so

    def __init__(
        self,
        scenario: str | os.PathLike[str] | Scenario,
        target: Span | None = None,
        within: float | None = None,
        interval: float = 0.1,
        limit: float | None = None,
        randomise: Mapping[str, Span] | None = None,
    ) -> None:
        self._scenario = scenario if isinstance(scenario, Scenario) else load_scenario(scenario)
        self._target, self._within = _target_of(self._scenario, target, within)
        self._interval, self._randomise = interval, _checked_bounds(self._scenario, randomise or {})
        self._simulation = Simulation(self._scenario)
        self._takes, largest = _driven_by(self._scenario)
        self._limit = largest if limit is None else limit
        positive = {"interval": self._interval, "limit": self._limit, "within": self._within}
        wrong = [f"{name} is {value!r}" for name, value in positive.items() if not (_is_number(value) and value > 0)]
        if wrong:
            raise UsageError(f"{', '.join(wrong)}; it must be a positive number, in SI")
        self._length = max(math.dist(self._scenario.catheter.exit, self._target), 1e-3)
        self._force = estimated_force(self._scenario, self._simulation.model.around)
        self.action_space = Box(-1.0, 1.0, (1,), np.float32)
        self.observation_space = Box(-LARGEST, LARGEST, (len(OBSERVED),), np.float32)
        self._action, self._distance = 0.0, self._length
        self._over = True

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Back to the start, with values drawn anew where some are random. The same seed gives the same episode."""
        super().reset(seed=seed)
        drawn = {path: float(self.np_random.uniform(*bounds)) for path, bounds in self._randomise.items()}
        if drawn:
            self._simulation = Simulation(scenario_from_dict(self._scenario.to_dict(), drawn))
        else:
            self._simulation.reset()
        self._action, self._over = 0.0, False
        outputs = self._simulation.outputs
        self._distance = self._distance_to_target(outputs)
        return self._observation(outputs), {"drawn": drawn}

    def step(self, action: NDArray[np.float32]) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Drive for one interval. `info`: `status`, a sentence on how the episode goes or has ended; `time`, s;
        `target_reached`. Raises UsageError where the episode is over, or has not been begun by a reset.
        """
        if self._over:
            raise UsageError("there is no episode to step in: it is over or was not begun; call reset() first")
        simulation = self._simulation
        self._action = float(np.clip(np.asarray(action).ravel()[0], -1.0, 1.0))
        dt = min(self._interval, simulation.duration - simulation.time)
        value = self._within_reach(self._action * self._limit, dt)
        outputs = simulation.step(dt, speed=value) if self._takes == "speed" else simulation.step(dt, force=value)
        before, self._distance = self._distance, self._distance_to_target(outputs)
        reached = self._distance <= self._within
        stopped = simulation.ended and simulation.status.status is not Status.TARGET_REACHED
        force = float(outputs["wall_force_max"]) / self._force
        reward = (before - self._distance) / self._length - (_FORCE_COST * force + _TIME_COST) * dt
        reward += float(reached) - float(stopped and not reached)
        late = simulation.time >= simulation.duration - 1e-9
        info = {"status": self._status(reached, late), "time": simulation.time, "target_reached": reached}
        terminated = bool(reached or simulation.ended)
        self._over = terminated or late
        return self._observation(outputs), float(reward), terminated, bool(late and not terminated), info

    def _status(self, reached: bool, late: bool) -> str:
        """How the episode goes: what went wrong before all, then the target, an event, the end of the time."""
        simulation = self._simulation
        report = simulation.finished() if late else simulation.status
        if report.status.trusted and reached:
            return f"{Status.TARGET_REACHED.problem}."
        return "The episode goes on." if report.status is Status.STOPPED else report.sentence()

    def _within_reach(self, value: float, dt: float) -> float:
        """The speed that keeps the proximal end in its guide over the next interval; other drives need no help."""
        if self._scenario.drive.kind == "tip_speed":
            return max(value, 0.0)
        if self._scenario.drive.kind != "speed":
            return value
        back, far = self._simulation.model.travel_range
        place = float(self._simulation.outputs["insertion_depth"])
        margin = 1e-6
        return float(np.clip(value, (back + margin - place) / dt, (far - margin - place) / dt))

    def _distance_to_target(self, outputs: Mapping[str, Any]) -> float:
        return math.dist((outputs["tip_x"], outputs["tip_y"]), self._target)

    def _observation(self, outputs: Mapping[str, Any]) -> Observation:
        c, s = math.cos(outputs["tip_angle"]), math.sin(outputs["tip_angle"])
        dx, dy = self._target[0] - outputs["tip_x"], self._target[1] - outputs["tip_y"]
        lengths = [c * dx + s * dy, c * dy - s * dx, math.hypot(dx, dy), outputs["tip_x"], outputs["tip_y"]]
        forces = [outputs["push_force"], outputs["tip_force"], outputs["wall_force_max"]]
        seen = [
            *(length / self._length for length in lengths),
            c,
            s,
            outputs["insertion_depth"] / self._scenario.wire.length,
            *(force / self._force for force in forces),
            self._action,
        ]
        observation: Observation = np.clip(np.nan_to_num(np.array(seen)), -LARGEST, LARGEST).astype(np.float32)
        return observation


def _target_of(scenario: Scenario, target: Span | None, within: float | None) -> tuple[Span, float]:
    given = scenario.stop.target
    place = target if target is not None else (given.at if given is not None else None)
    if place is None:
        raise UsageError(
            "the environment has no target; give target=(x, y) in metres, or a place as stop.target in the scenario"
        )
    if not _is_pair(place):
        raise UsageError(f"target is {place!r}; it must be a place in metres, as target=(0.06, 0.02)")
    near = within if within is not None else (given.within if given is not None else None)
    return (float(place[0]), float(place[1])), 2e-3 if near is None else near


def _checked_bounds(scenario: Scenario, randomise: Mapping[str, Span]) -> dict[str, Span]:
    """The bounds by path, each tried at both ends, so that what is wrong shows before the first episode. Raises
    UsageError for what is no pair of bounds, ScenarioError for paths and values that the scenario does not take.
    """
    wrong = [
        f"randomise: {path} has {bounds!r}; give the least and the largest value, in SI, as (0.1, 0.4)"
        for path, bounds in randomise.items()
        if not (_is_pair(bounds) and bounds[0] <= bounds[1])
    ]
    if wrong:
        raise UsageError("\n".join(wrong))
    plain, problems = scenario.to_dict(), []
    for path, bounds in randomise.items():
        for value in map(float, bounds):
            try:
                scenario_from_dict(plain, {path: value})
            except ScenarioError as error:
                problems += [problem for problem in error.problems if problem not in problems]
    if problems:
        raise ScenarioError(problems)
    return {path: (float(low), float(high)) for path, (low, high) in randomise.items()}


def _is_pair(given: object) -> bool:
    return isinstance(given, Sequence | np.ndarray) and len(given) == 2 and all(map(_is_number, given))


def _is_number(given: object) -> bool:
    return isinstance(given, int | float | np.number) and not isinstance(given, bool) and math.isfinite(given)


def _driven_by(scenario: Scenario) -> tuple[str, float]:
    """What `Simulation.step` takes for this drive, and the largest that the scenario has of it, in SI."""
    drive = scenario.drive
    if drive.kind == "force":
        return "force", max(abs(value) for value in drive.force)
    return "speed", max(abs(value) for value in drive.speed)


gymnasium.register("gw_exudyn/Guidewire-v0", entry_point="gw_exudyn.rl:GuidewireEnv", disable_env_checker=True)
