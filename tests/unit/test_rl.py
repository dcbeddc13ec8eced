"""The Gymnasium environment: it keeps the rules, repeats itself for a seed, and rewards what it says."""

from __future__ import annotations

import numpy as np
import pytest

from gw_exudyn.errors import ScenarioError, UsageError
from gw_exudyn.scenario import load_scenario

gymnasium = pytest.importorskip("gymnasium", reason="gymnasium is not installed")
rl = pytest.importorskip("gw_exudyn.rl")

AHEAD = (0.012, 0.0)
FULL = np.ones(1, np.float32)


def small(**changes):
    return load_scenario("straight", {"wire.segments": 10, "drive": DRIVE} | changes)


DRIVE = {"kind": "speed", "speed": 0.01, "duration": 2.0}
FORCE = {"kind": "force", "force": 0.02, "hub_mass": 0.01, "hub_damping": 2.0, "duration": 2.0}
TIP_SPEED = {"kind": "tip_speed", "speed": 0.01, "max_speed": 0.02, "force_limit": 1.0, "duration": 2.0}


@pytest.mark.parametrize("drive", [DRIVE, FORCE, TIP_SPEED], ids=lambda drive: drive["kind"])
def test_it_keeps_the_rules_of_gymnasium(drive):
    from gymnasium.utils.env_checker import check_env

    env = gymnasium.make("gw_exudyn/Guidewire-v0", scenario=small(drive=drive), target=AHEAD)
    check_env(env.unwrapped, skip_render_check=True)


def episode(env, seed, actions):
    seen = [env.reset(seed=seed)[0]]
    rewards = []
    for action in actions:
        observation, reward, terminated, truncated, _ = env.step(np.array([action], np.float32))
        seen.append(observation)
        rewards.append(reward)
        if terminated or truncated:
            break
    return np.array(seen), np.array(rewards)


def test_a_seed_gives_the_same_episode_and_another_seed_another():
    env = rl.GuidewireEnv(small(), AHEAD, randomise={"wire.imperfection": (-0.5, 0.5)})
    actions = [1.0, 0.5, -0.3, 1.0]
    first, second, other = (episode(env, seed, actions) for seed in (1, 1, 2))
    assert np.array_equal(first[0], second[0])
    assert np.array_equal(first[1], second[1])
    assert not np.array_equal(first[0], other[0])


def test_reaching_the_target_ends_the_episode_with_a_bonus():
    env = rl.GuidewireEnv(small(), AHEAD, within=1e-3)
    env.reset(seed=0)
    total, steps, terminated = 0.0, 0, False
    while not terminated:
        observation, reward, terminated, truncated, info = env.step(FULL)
        total, steps = total + reward, steps + 1
        assert not truncated
        assert info["status"] == ("The tip reached its target." if terminated else "The episode goes on.")
    assert info["target_reached"]
    with pytest.raises(UsageError, match=r"call reset\(\)"):
        env.step(FULL)
    # The progress made, one for the target, less 0.01 for each second.
    distance = observation[rl.OBSERVED.index("distance")]
    assert distance <= 1 / 12
    assert total == pytest.approx(1 - distance + 1 - 0.001 * steps, abs=1e-5)


def test_time_truncates():
    env = rl.GuidewireEnv(small(), AHEAD)
    env.reset(seed=0)
    steps = [env.step(np.zeros(1, np.float32)) for _ in range(20)]
    assert [step[2:4] for step in steps[:-1]] == [(False, False)] * 19
    assert steps[-1][2:4] == (False, True)
    assert steps[-1][4]["status"].startswith("The run reached its end")
    with pytest.raises(UsageError, match=r"call reset\(\)"):
        env.step(FULL)
    env.reset()
    env.step(FULL)


def test_a_step_before_the_first_reset_is_wrong_use():
    with pytest.raises(UsageError, match=r"call reset\(\)"):
        rl.GuidewireEnv(small(), AHEAD).step(FULL)


def test_an_event_that_ends_the_episode_is_told():
    env = rl.GuidewireEnv(small(stop={"push_force": 1e-6}, tip={"force": [-0.01, 0.0]}), AHEAD)
    env.reset(seed=0)
    *_, terminated, _, info = env.step(FULL)
    assert terminated
    assert "push force exceeded its limit" in info["status"]


@pytest.mark.parametrize("target", [(1,), (0.01, 0.02, 0.03), "ab", ("a", "b"), (float("nan"), 0.0), 0.01])
def test_a_target_that_is_no_place_is_wrong_use(target):
    with pytest.raises(UsageError, match="place in metres"):
        rl.GuidewireEnv(small(), target)


@pytest.mark.parametrize("given", [{"interval": 0.0}, {"limit": "fast"}, {"within": -1e-3}])
def test_a_number_that_is_none_is_wrong_use(given):
    with pytest.raises(UsageError, match=f"{next(iter(given))} is"):
        rl.GuidewireEnv(small(), AHEAD, **given)


@pytest.mark.parametrize("bounds", [(0.4, 0.1), (0.1,), 0.3, ("0.1", "0.4"), (0.0, float("inf")), None])
def test_bounds_that_are_none_are_told_at_once(bounds):
    with pytest.raises(UsageError, match="least and the largest"):
        rl.GuidewireEnv(small(), AHEAD, randomise={"contact.friction_coefficient": bounds})


def test_random_values_that_the_scenario_does_not_take_are_told_at_once():
    randomise = {"contact.friction_coeff": (0.1, 0.2), "wire.diameter": (-1e-3, 1e-3)}
    with pytest.raises(ScenarioError) as caught:
        rl.GuidewireEnv(small(), AHEAD, randomise=randomise)
    assert {problem.path for problem in caught.value.problems} == set(randomise)


def test_a_pull_beyond_the_guide_is_held_back():
    env = rl.GuidewireEnv(small(), AHEAD, limit=0.5)
    env.reset(seed=0)
    for _ in range(5):
        env.step(-FULL)
    observation, *_ = env.step(FULL)
    assert np.isfinite(observation).all()


def test_an_observation_is_what_it_says():
    env = rl.GuidewireEnv(small(), AHEAD)
    observation, _ = env.reset(seed=0)
    seen = dict(zip(rl.OBSERVED, observation, strict=True))
    assert seen["distance"] == pytest.approx(1)
    assert seen["target_ahead"] == pytest.approx(1, abs=1e-3)
    assert (seen["tip_cos"], seen["insertion_depth"]) == (pytest.approx(1, abs=1e-3), 0)
    observation, *_ = env.step(FULL)
    seen = dict(zip(rl.OBSERVED, observation, strict=True))
    assert seen["distance"] == pytest.approx(11 / 12, abs=1e-3)
    assert seen["last_action"] == 1


def test_without_a_target_it_is_wrong_use():
    with pytest.raises(UsageError, match=r"stop\.target"):
        rl.GuidewireEnv(small())


def test_the_scenarios_target_serves():
    env = rl.GuidewireEnv(small(stop={"target": {"at": [0.012, 0.0], "within": 0.001}}))
    assert env._target == AHEAD


def test_a_vector_of_environments_in_processes_of_their_own():
    envs = gymnasium.make_vec(
        "gw_exudyn/Guidewire-v0", num_envs=2, vectorization_mode="async", scenario=small(), target=AHEAD,
        vector_kwargs={"context": "spawn"},
    )  # fmt: skip
    try:
        envs.reset(seed=3)
        observations, rewards, *_ = envs.step(np.ones((2, 1), np.float32))
        assert np.array_equal(observations[0], observations[1])
        assert rewards[0] == rewards[1] > 0
    finally:
        envs.close()
