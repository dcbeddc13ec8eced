"""The shipped kernels are what the source in the repository makes, and the one of this platform loads."""

from __future__ import annotations

import ctypes
import re

import pytest

from gw_exudyn.model.kernel import build, library_name
from gw_exudyn.native import compiler

EXPORTED = re.findall(r"^EXPORT \w+ (gw_\w+)\(", (build.HERE / "contact.c").read_text(), re.MULTILINE)


def test_every_platform_that_the_loader_knows_has_its_library():
    platforms = [
        ("Linux", "x86_64"),
        ("Linux", "aarch64"),
        ("Windows", "AMD64"),
        ("Darwin", "arm64"),
        ("Darwin", "x86_64"),
    ]
    assert {library_name(*platform) for platform in platforms} == set(build.TARGETS)
    for name in build.TARGETS:
        assert (build.LIBRARIES / name).is_file()


def test_the_libraries_are_those_of_the_present_source():
    assert build.KERNELS.record().get("source") == build.KERNELS.digest(), "contact.c has changed: make kernels"


@pytest.mark.parametrize("name", sorted(build.TARGETS))
def test_a_library_is_small_and_exports_the_functions(name):
    content = (build.LIBRARIES / name).read_bytes()
    assert len(content) < 100_000
    assert EXPORTED
    for function in EXPORTED:
        assert function.encode() in content


@pytest.mark.parametrize("name", [name for name in sorted(build.TARGETS) if "linux" in name])
def test_a_linux_library_needs_no_c_library(name):
    content = (build.LIBRARIES / name).read_bytes()
    assert b"libc" not in content
    assert b"GLIBC" not in content
    assert b"mem" not in content


def test_the_linux_library_loads():
    import platform

    if (platform.system(), platform.machine()) != ("Linux", "x86_64"):
        pytest.skip("this machine is not Linux on x86_64")
    library = ctypes.CDLL(str(build.LIBRARIES / "contact-linux-x86_64.so"))
    for function in EXPORTED:
        assert getattr(library, function)


def test_the_linux_library_rebuilt_has_the_same_bytes(tmp_path):
    found = compiler()
    if found is None:
        pytest.skip("ziglang is not installed, so there is no compiler")
    if build.KERNELS.record().get("compiler") != f"ziglang {found}":
        pytest.skip(f"the libraries were made with {build.KERNELS.record().get('compiler')}, here is ziglang {found}")
    name = "contact-linux-x86_64.so"
    assert build.KERNELS.build(name, tmp_path).read_bytes() == (build.LIBRARIES / name).read_bytes()
