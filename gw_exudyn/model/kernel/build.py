"""Build the contact kernel for every platform: `python -m gw_exudyn.model.kernel.build` (or `make kernels`).

Needs the package `ziglang` (extra `dev`), a C compiler that builds for all platforms from any of them. The libraries
use no C library: one file serves every Linux, with glibc or musl, of whatever version. Multiplications and additions
are never fused, so that all platforms round alike. The same source and compiler give the same bytes; `build.json`
beside the libraries says which source and which compiler made them.
"""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType

from gw_exudyn.errors import UsageError

HERE = Path(__file__).resolve().parent
LIBRARIES = HERE / "lib"
RECORD = "build.json"


@dataclass(frozen=True)
class Target:
    """A platform as zig names it, the sources, and what the linker needs besides."""

    triple: str
    sources: tuple[str, ...] = ("contact.c",)
    options: tuple[str, ...] = ("-nostdlib",)


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


def compiler() -> str | None:
    """Version of the compiler; None if it is not installed."""
    if find_spec("ziglang") is None:
        return None
    try:
        return version("ziglang")
    except PackageNotFoundError:
        return None


def source_digest() -> str:
    """SHA-256 of all that goes into the libraries: sources and options."""
    digest = hashlib.sha256()
    for name in sorted({source for target in TARGETS.values() for source in target.sources}):
        digest.update((HERE / name).read_bytes())
    digest.update(repr((_OPTIONS, sorted(TARGETS.items()))).encode())
    return digest.hexdigest()


def record() -> dict[str, str]:
    """What the libraries in the folder were made of: `compiler`, `source`; empty if there is no record."""
    path = LIBRARIES / RECORD
    if not path.is_file():
        return {}
    content: dict[str, str] = json.loads(path.read_text(encoding="utf-8"))
    return content


def build(name: str, folder: Path) -> Path:
    """Build one library of `TARGETS` into a folder and return its file.

    Raises UsageError where the compiler is missing or refuses the source.
    """
    target, output = TARGETS[name], folder / name
    with tempfile.TemporaryDirectory() as scratch:
        made = Path(scratch) / name
        command = [sys.executable, "-m", "ziglang", "cc", "-target", target.triple, *_OPTIONS, *target.options]
        command += [*target.sources, "-o", str(made)]
        # A cache of its own, and relative names of the sources: nothing of this machine gets into the file.
        caches = {"ZIG_LOCAL_CACHE_DIR": f"{scratch}/local", "ZIG_GLOBAL_CACHE_DIR": f"{scratch}/global"}
        run = subprocess.run(command, cwd=HERE, env={**os.environ, **caches}, capture_output=True, text=True)
        if run.returncode != 0:
            raise UsageError(f"{name} could not be built:\n{run.stderr.strip()}")
        fresh = folder / f".{name}.part"
        fresh.write_bytes(made.read_bytes())
    fresh.chmod(0o644)
    os.replace(fresh, output)  # never written in place: a running program may have it loaded
    return output


def main() -> int:
    """Build all libraries into `lib/` and write down what they were made of."""
    found = compiler()
    if found is None:
        sys.stderr.write("the package ziglang is not installed; install it with: pip install ziglang\n")
        return UsageError.exit_code
    LIBRARIES.mkdir(exist_ok=True)
    try:
        for name in TARGETS:
            path = build(name, LIBRARIES)
            sys.stdout.write(f"{path.name}  {path.stat().st_size} bytes\n")
    except UsageError as error:
        sys.stderr.write(f"{error}\n")
        return error.exit_code
    content = {"compiler": f"ziglang {found}", "source": source_digest()}
    (LIBRARIES / RECORD).write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
