"""Every shipped scenario, shortened: it runs, is finite and trusted, its energy closes, and it repeats exactly."""

from __future__ import annotations

import numpy as np
import pytest

from gw_exudyn.quantities import SCALARS
from gw_exudyn.result import Result, Status
from gw_exudyn.scenario import list_shipped, load_scenario
from gw_exudyn.simulation import simulate

SEGMENTS = {"wire.segments": 60, "solver.step": 0.1, "output.interval": 0.2}


@pytest.fixture(scope="module", params=list_shipped())
def result(request: pytest.FixtureRequest) -> Result:
    """A run with fewer segments and longer steps, to its end."""
    return simulate(load_scenario(request.param, SEGMENTS))


def test_it_completes_and_can_be_trusted(result: Result) -> None:
    assert result.status.status is Status.COMPLETED, result.status.sentence()


def test_every_scalar_is_finite(result: Result) -> None:
    for name in SCALARS:
        assert np.isfinite(result.values(name)).all(), name


def test_the_energy_closes(result: Result) -> None:
    largest = np.abs(result.values("insertion_work")).max()
    # The floor is the project's: below it there is no energy to speak of.
    assert np.abs(result.values("energy_error")).max() <= max(0.01 * largest, 1e-9)


def test_contact_never_pulls_and_friction_stays_in_its_cone(result: Result) -> None:
    normal = result.dataset["contact_normal_force"].values
    tangential = np.abs(result.dataset["contact_tangential_force"].values)
    there = np.isfinite(normal)
    friction = result.scenario.contact.friction_coefficient
    assert (normal[there] >= 0).all()
    assert (tangential[there] <= friction * normal[there] * (1 + 1e-9)).all()


def test_the_wire_keeps_its_length(result: Result) -> None:
    x, y = result.values("node_x"), result.values("node_y")
    length = np.hypot(np.diff(x, axis=1), np.diff(y, axis=1)).sum(axis=1)
    # Segments are rigid, and the joints close to well under a micrometre each.
    assert length == pytest.approx(result.scenario.wire.length, rel=1e-5)


def test_the_same_scenario_gives_the_same_numbers() -> None:
    short = {**SEGMENTS, "drive.distance": 0.035}
    first, second = (simulate(load_scenario("corner90-universal", short)) for _ in range(2))
    assert first.dataset.equals(second.dataset)
