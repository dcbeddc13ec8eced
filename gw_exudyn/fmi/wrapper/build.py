"""Build the FMU's native wrapper for every platform: `python -m gw_exudyn.fmi.wrapper.build` (or `make wrappers`).

The headers of the FMI standard come with the package fmpy. The Linux libraries need glibc 2.17 or newer.
"""

from __future__ import annotations

import sys
from importlib.util import find_spec
from pathlib import Path

from gw_exudyn.errors import UsageError
from gw_exudyn.fmi.wrapper import HEADERS, LIBRARIES, PLATFORMS, SOURCES, library, source_folder
from gw_exudyn.native import Libraries, Target

_OPTIONS = (
    "-std=c99",
    "-O2",
    "-shared",
    "-fPIC",
    "-fvisibility=hidden",
    "-fno-stack-protector",
    "-fno-sanitize=all",
    "-g0",
    "-s",
    "-Wall",
    "-Wextra",
    "-Werror",
)
_TRIPLES = {
    "x86_64-linux": "x86_64-linux-gnu.2.17",
    "aarch64-linux": "aarch64-linux-gnu.2.17",
    "x86_64-windows": "x86_64-windows-gnu",
    "aarch64-darwin": "aarch64-macos.11.0",
    "x86_64-darwin": "x86_64-macos.11.0",
}


def fmi_headers() -> Path:
    """The folder of the standard's headers. Raises UsageError where fmpy is not installed."""
    found = find_spec("fmpy")
    if found is None or found.origin is None:
        raise UsageError("the package fmpy, which has the headers of the FMI standard, is missing; pip install fmpy")
    return Path(found.origin).parent / "c-code"


def wrappers() -> Libraries:
    """The libraries of the wrapper. Raises UsageError without fmpy."""
    targets = {}
    for platform in PLATFORMS:
        linking = ("-Wl,-install_name,@rpath/wrapper.dylib",) if platform.endswith("darwin") else ()
        targets[library(platform).name] = Target(_TRIPLES[platform], SOURCES, linking)
    return Libraries(source_folder(), LIBRARIES, targets, _OPTIONS, HEADERS, (fmi_headers(),))


if __name__ == "__main__":
    sys.exit(wrappers().main())
