"""The wrapper's libraries are what the source in the repository makes."""

from __future__ import annotations

import pytest

from gw_exudyn.fmi.wrapper import LIBRARIES, PLATFORMS, library
from gw_exudyn.fmi.wrapper.build import wrappers
from gw_exudyn.native import compiler


def test_every_platform_has_its_library():
    assert {library(platform).name for platform in PLATFORMS} == set(wrappers().targets)
    for platform in PLATFORMS:
        assert 10_000 < library(platform).stat().st_size < 150_000


def test_the_libraries_are_those_of_the_present_source():
    assert wrappers().record().get("source") == wrappers().digest(), "fmu/ has changed: make wrappers"


def test_no_library_tells_of_the_machine_that_built_it():
    for platform in PLATFORMS:
        content = library(platform).read_bytes()
        for trace in (b"/home/", b"/root/", b"/tmp/", b"fmi2.c"):
            assert trace not in content, (platform, trace)


def test_the_linux_library_rebuilt_has_the_same_bytes(tmp_path):
    found, record = compiler(), wrappers().record()
    if found is None:
        pytest.skip("ziglang is not installed, so there is no compiler")
    if record.get("compiler") != f"ziglang {found}":
        pytest.skip(f"the libraries were made with {record.get('compiler')}, here is ziglang {found}")
    name = library("x86_64-linux").name
    assert wrappers().build(name, tmp_path).read_bytes() == (LIBRARIES / name).read_bytes()
