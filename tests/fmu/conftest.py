"""FMUs of a small scenario: a coarse wire pushed quickly round a bend, in contact with friction soon."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("fmpy", reason="fmpy is not installed")
if (sys.platform, platform.machine()) not in {("linux", "x86_64"), ("linux", "aarch64"), ("darwin", "arm64")}:
    collect_ignore_glob = ["test_*.py"]

import standin as stand

from gw_exudyn.fmi import wrapper
from gw_exudyn.fmi.export import export
from gw_exudyn.fmi.wrapper.build import fmi_headers
from gw_exudyn.scenario import Scenario, load_scenario

SANITIZED = bool(os.environ.get("GW_FMU_SANITIZE"))
"""`make sanitize`: every test with a wrapper that is built with AddressSanitizer and UndefinedBehaviorSanitizer."""
if SANITIZED:
    collect_ignore = ["test_wrapper_build.py", "test_valgrind.py"]  # of the wrapper as it is shipped

PLATFORM = f"{platform.machine().replace('arm64', 'aarch64')}-{sys.platform}"
OVERRIDES = ("wire.segments=20", "drive.speed=20 mm/s", "drive.distance=70 mm")


@pytest.fixture(scope="session", autouse=SANITIZED)
def _sanitized(tmp_path_factory) -> Iterator[None]:
    """The library of this machine from the source, with both sanitizers; the others as they are."""
    folder = tmp_path_factory.mktemp("sanitized") / "lib"
    shutil.copytree(wrapper.LIBRARIES, folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(wrapper, "LIBRARIES", folder)
        sources = [str(wrapper.source_folder() / name) for name in wrapper.SOURCES]
        options = ["-std=c99", "-g", "-O1", "-shared", "-fPIC", *stand.sanitizers(), f"-I{fmi_headers()}"]
        subprocess.run(["gcc", *options, *sources, "-o", str(wrapper.library(PLATFORM))], check=True)
        yield


@pytest.fixture(scope="session")
def native() -> Path:
    """The wrapper's library for this machine."""
    return wrapper.library(PLATFORM)


@pytest.fixture(scope="session")
def standin(tmp_path_factory) -> Path:
    """A folder of resources whose worker is the stand-in."""
    folder = tmp_path_factory.mktemp("gw-standin")
    program = stand.compile_c(Path(stand.__file__).with_name("standin.c"), folder / "program")
    return stand.resources(folder / "resources", program)


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
