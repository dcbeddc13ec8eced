"""The files in an FMU's resources: the wrapper's table (fmu/table.c reads the same) and the scenario."""

from __future__ import annotations

import json
import struct
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gw_exudyn.errors import StorageError
from gw_exudyn.fmi.variables import REAL, TEXT, TIMEOUT, Variable

TABLE, SCENARIO = "wrapper.txt", "scenario.json"
HASHES = "resources/hashes.json"
"""Where an FMU tells the SHA-256 of its larger files, by name."""
_HEAD = "gw-fmu-wrapper 1"
# One thread a worker: instances run side by side. Set before numpy is loaded.
_ENVIRONMENT = ("OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1", "MKL_NUM_THREADS=1")


@dataclass(frozen=True)
class Launch:
    """How the worker is started. python : interpreter to try first. path : folder from which it takes the package,
    where that is not installed. version : of the package that it must have. program : worker in the resources that
    needs no Python, which has its libraries in `path` there; empty for none. glibc : version that it needs."""

    python: str
    path: str
    version: str
    arguments: tuple[str, ...] = ("-P", "-m", "gw_exudyn.fmi.worker")
    program: str = ""
    glibc: str = ""

    @property
    def remedy(self) -> str:
        """What to do where the worker does not start."""
        if self.program:
            return "export the FMU on a machine like this one, or without --bundled"
        return (
            f"{how_to_install(self.version)}, and let the environment variable GW_EXUDYN_PYTHON name the Python that "
            "has it"
        )


def how_to_install(version: str) -> str:
    """How a Python comes to have the package in this version: it is in no registry."""
    return f"install it with `pip install .` in a checkout of gw-exudyn {version}"


def table_text(variables: Sequence[Variable], token: str, launch: Launch) -> str:
    """The wrapper's table. Numbers are written as their bits, so that no locale can misread them."""
    lines = [_HEAD, f"token {token}", f"version {launch.version}", f"python {launch.python}", f"path {launch.path}"]
    lines += [f"program {launch.program}", f"glibc {launch.glibc}"] if launch.program else []
    lines += [f"remedy {launch.remedy}"]
    lines += [f"argument {argument}" for argument in launch.arguments]
    lines += [f"environment {pair}" for pair in _ENVIRONMENT]
    lines += [f"timeout {i}" for i, variable in enumerate(variables) if variable.name == TIMEOUT]
    lines += [_line(variable) for variable in variables]
    return "\n".join(lines) + "\n"


def _line(variable: Variable) -> str:
    number = 0.0 if variable.kind == TEXT or variable.start is None else float(variable.start)
    bits = struct.pack(">d", number).hex()
    words = ["variable", variable.kind, variable.role, str(variable.size), bits, variable.name]
    if variable.kind == TEXT:
        text = str(variable.start or "")
        if any(ord(letter) < ord(" ") for letter in text):
            raise StorageError(f"{variable.name}: {text!r} has a line end or control character in it; take it out")
        words.append(text)
    return " ".join(words)


def read_table(folder: Path) -> list[Variable]:
    """The variables of an unpacked FMU, without what only a person reads. Raises StorageError."""
    file = folder / TABLE
    try:
        lines = file.read_text(encoding="utf-8").split("\n")
        return [_parsed(line) for line in lines if line.startswith("variable ")]
    except (OSError, ValueError) as error:
        raise StorageError(f"{file}: can't be read ({error}); export the FMU again") from error


def _parsed(line: str) -> Variable:
    _, kind, role, size, bits, name, *text = line.split(" ", 6)
    start: Any = text[0] if text else ""
    if kind != TEXT:
        (number,) = struct.unpack(">d", bytes.fromhex(bits))
        start = number if kind == REAL else int(number)
    return Variable(name, kind, role, "", start, size=int(size))


def read_scenario(folder: Path) -> dict[str, Any]:
    """The exported scenario as plain data. Raises StorageError."""
    file = folder / SCENARIO
    try:
        content: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise StorageError(f"{file}: can't be read ({error}); export the FMU again") from error
    return content


def scenario_in(file: Path) -> dict[str, Any]:
    """The scenario of an FMU that is not unpacked, as plain data. Raises StorageError."""
    try:
        with zipfile.ZipFile(file) as archive:
            content: dict[str, Any] = json.loads(archive.read(f"resources/{SCENARIO}"))
    except (OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
        raise StorageError(f"{file}: is no FMU of gw-exudyn ({error})") from error
    return content
