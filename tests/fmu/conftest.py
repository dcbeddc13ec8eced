"""FMUs of a small scenario: a coarse wire pushed quickly round a bend, in contact with friction soon."""

from __future__ import annotations

import platform
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("fmpy", reason="fmpy is not installed")
if (sys.platform, platform.machine()) not in {("linux", "x86_64"), ("linux", "aarch64"), ("darwin", "arm64")}:
    collect_ignore_glob = ["test_*.py"]

from gw_exudyn.fmi.export import export
from gw_exudyn.scenario import Scenario, load_scenario

OVERRIDES = ("wire.segments=20", "drive.speed=20 mm/s", "drive.distance=70 mm")


@pytest.fixture(scope="session")
def scenario() -> Scenario:
    return load_scenario("arc90", OVERRIDES)


@pytest.fixture(scope="session")
def fmus(scenario, tmp_path_factory) -> dict[int, Path]:
    folder = tmp_path_factory.mktemp("fmus")
    return {fmi: export(scenario, folder / f"small{fmi}.fmu", fmi, stations=7) for fmi in (2, 3)}


@pytest.fixture(params=[2, 3], ids=["fmi2", "fmi3"])
def fmu(request, fmus) -> Path:
    return fmus[request.param]


@pytest.fixture(scope="session", autouse=True)
def _own_cache(tmp_path_factory) -> Iterator[None]:
    """FMUs are unpacked in a cache of the tests' own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        yield
