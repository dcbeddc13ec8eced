"""Native libraries for every platform, from C sources by the package `ziglang` (extra `dev`), a compiler that builds
for all platforms from any of them.

The same source and compiler give the same bytes; a record beside the libraries says which source and which compiler
made them. Each set of libraries has a small module that names its sources, and builds them when it is run.
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

from gw_exudyn.errors import UsageError

RECORD = "build.json"


@dataclass(frozen=True)
class Target:
    """A platform as zig names it, the sources, and what the linker needs besides."""

    triple: str
    sources: tuple[str, ...] = ("contact.c",)
    options: tuple[str, ...] = ("-nostdlib",)


@dataclass(frozen=True)
class Libraries:
    """A set of libraries.

    source : folder of the sources. folder : where the libraries go. targets : by the file's name. options : of the
    compiler. headers : files that the sources include, besides those of the system. include : folders of headers that
    belong to somebody else.
    """

    source: Path
    folder: Path
    targets: Mapping[str, Target]
    options: tuple[str, ...]
    headers: tuple[str, ...] = ()
    include: tuple[Path, ...] = ()

    def digest(self) -> str:
        """SHA-256 of all that goes into the libraries: sources and options."""
        digest = hashlib.sha256()
        sources = {source for target in self.targets.values() for source in target.sources}
        for name in sorted({*sources, *self.headers}):
            digest.update((self.source / name).read_bytes())
        digest.update(repr((self.options, sorted(self.targets.items()))).encode())
        return digest.hexdigest()

    def record(self) -> dict[str, str]:
        """What the libraries in the folder were made of: `compiler`, `source`; empty if there is no record."""
        path = self.folder / RECORD
        if not path.is_file():
            return {}
        content: dict[str, str] = json.loads(path.read_text(encoding="utf-8"))
        return content

    def build(self, name: str, folder: Path) -> Path:
        """Build one library into a folder and return its file.

        Raises UsageError where the compiler is missing or refuses the source.
        """
        target, output = self.targets[name], folder / name
        with tempfile.TemporaryDirectory() as scratch:
            made = Path(scratch) / name
            command = [sys.executable, "-m", "ziglang", "cc", "-target", target.triple, *self.options, *target.options]
            command += [f"-I{place}" for place in self.include]
            command += [*target.sources, "-o", str(made)]
            # A cache of its own, and relative names of the sources: nothing of this machine gets into the file.
            caches = {"ZIG_LOCAL_CACHE_DIR": f"{scratch}/local", "ZIG_GLOBAL_CACHE_DIR": f"{scratch}/global"}
            run = subprocess.run(command, cwd=self.source, env={**os.environ, **caches}, capture_output=True, text=True)
            if run.returncode != 0:
                raise UsageError(f"{name} could not be built:\n{run.stderr.strip()}")
            fresh = folder / f".{name}.part"
            fresh.write_bytes(made.read_bytes())
        fresh.chmod(0o644)
        os.replace(fresh, output)  # never written in place: a running program may have it loaded
        return output

    def main(self) -> int:
        """Build all libraries into their folder and write down what they were made of."""
        found = compiler()
        if found is None:
            sys.stderr.write("the package ziglang is not installed; install it with: pip install ziglang\n")
            return UsageError.exit_code
        self.folder.mkdir(exist_ok=True)
        try:
            for name in self.targets:
                path = self.build(name, self.folder)
                sys.stdout.write(f"{path.name}  {path.stat().st_size} bytes\n")
        except UsageError as error:
            sys.stderr.write(f"{error}\n")
            return error.exit_code
        content = {"compiler": f"ziglang {found}", "source": self.digest()}
        (self.folder / RECORD).write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
        return 0


def compiler() -> str | None:
    """Version of the compiler; None if it is not installed."""
    if find_spec("ziglang") is None:
        return None
    try:
        return version("ziglang")
    except PackageNotFoundError:
        return None
