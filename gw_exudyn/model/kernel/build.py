"""Build the contact kernel for every platform: `python -m gw_exudyn.model.kernel.build` (or `make kernels`).

The libraries use no C library: one file serves every Linux, with glibc or musl, of whatever version. Multiplications
and additions are never fused, so that all platforms round alike.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from gw_exudyn.native import Libraries, Target

HERE = Path(__file__).resolve().parent
LIBRARIES = HERE / "lib"

# The systems of macOS refuse a library that does not name the system's own.
_MACOS = ("-Wl,-install_name,@rpath/contact.dylib",)

TARGETS: Mapping[str, Target] = MappingProxyType(
    {
        "contact-linux-x86_64.so": Target("x86_64-linux-gnu"),
        "contact-linux-aarch64.so": Target("aarch64-linux-gnu"),
        "contact-windows-x86_64.dll": Target("x86_64-windows-gnu", ("contact.c", "windows_entry.c")),
        "contact-macos-arm64.dylib": Target("aarch64-macos.11.0", options=_MACOS),
        "contact-macos-x86_64.dylib": Target("x86_64-macos.11.0", options=_MACOS),
    }
)
"""What is built, by the name of the file."""

_OPTIONS = (
    "-std=c99",
    "-O2",
    "-shared",
    "-fPIC",
    "-ffreestanding",
    "-fno-builtin",  # no loop becomes a call of memset
    "-fno-math-errno",  # no square root becomes a call of sqrt
    "-ffp-contract=off",  # no fused multiply-add: the same numbers on every platform
    "-fvisibility=hidden",
    "-fno-stack-protector",
    "-fno-sanitize=all",
    "-fno-asynchronous-unwind-tables",
    "-g0",
    "-s",
    "-Wall",
    "-Wextra",
    "-Werror",
)

KERNELS = Libraries(HERE, LIBRARIES, TARGETS, _OPTIONS)
"""The libraries of the contact kernel."""

if __name__ == "__main__":
    sys.exit(KERNELS.main())
