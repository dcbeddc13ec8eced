"""Parts of the engine that runs do not show: the step's tangent, the settings, the state's bytes."""

from __future__ import annotations

import numpy as np
import pytest
from scenes import scenario

from gw_exudyn.engine import settings
from gw_exudyn.engine.state import from_arrays, pack, to_arrays, unpack
from gw_exudyn.engine.stepper import Stepper
from gw_exudyn.errors import UsageError
from gw_exudyn.model import build


@pytest.fixture(scope="module")
def stepper() -> Stepper:
    return Stepper(build(scenario()))


def test_the_integrator_is_the_one_the_factors_are_for(stepper: Stepper) -> None:
    """Exudyn's own constants and ours: they scale what a shortened Newton step takes back."""
    solver = stepper._solver
    assert solver.newmarkGamma == pytest.approx(settings.GAMMA, rel=1e-15)
    assert solver.newmarkBeta == pytest.approx(settings.BETA, rel=1e-15)
    assert solver.alphaM == pytest.approx(settings.ALPHA_M, rel=1e-15)
    assert solver.alphaF == pytest.approx(settings.ALPHA_F, abs=1e-15)


def test_newton_converges_quadratically_on_a_bent_wire(stepper: Stepper) -> None:
    """Contact's tangent and the turning term are exact: few iterations a step once the wire is in the corner."""
    stepper.reset()
    assert stepper.advance(13.0)
    before = stepper.counts()
    assert stepper.advance(14.0)
    iterations = stepper.counts()["newton_iterations"] - before["newton_iterations"]
    # Ten steps; a wrong sign in a tangent block doubles this at least.
    assert iterations <= 80


def test_joints_stay_closed(stepper: Stepper) -> None:
    stepper.reset()
    stepper.advance(12.0)
    motion, half = stepper.contact.motion, stepper.model.wire.lengths / 2
    along = np.column_stack([motion.c, motion.s])
    distal = motion.q[:-1, :2] + half[:-1, None] * along[:-1]
    proximal = motion.q[1:, :2] - half[1:, None] * along[1:]
    assert np.abs(distal - proximal).max() < 1e-8


def test_a_state_survives_the_way_through_bytes(stepper: Stepper) -> None:
    stepper.reset()
    stepper.advance(11.5)
    state = stepper.state()
    again = from_arrays(unpack(pack(to_arrays(state), "same"), "same"))
    for name, array in to_arrays(state).items():
        assert np.array_equal(to_arrays(again)[name], array), name
    assert again.energies == state.energies


def test_empty_arrays_survive_too() -> None:
    arrays = {"none": np.zeros(0), "flat": np.zeros((0, 3)), "one": np.array([1.5])}
    again = unpack(pack(arrays, "f"), "f")
    assert {name: array.shape for name, array in again.items()} == {"none": (0,), "flat": (0, 3), "one": (1,)}


def test_every_single_flipped_bit_is_noticed() -> None:
    data = pack({"x": np.arange(3.0)}, "f")
    for place in range(len(data)):
        spoiled = data[:place] + bytes([data[place] ^ 4]) + data[place + 1 :]
        with pytest.raises(UsageError):
            unpack(spoiled, "f")
