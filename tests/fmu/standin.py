"""The wrapper with a stand-in for its worker, and its functions called one by one, as a host in C would."""

from __future__ import annotations

import ctypes as c
import os
import shutil
import subprocess
import sys
import weakref
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from gw_exudyn.fmi import variables as v
from gw_exudyn.fmi.resources import TABLE, Launch, table_text
from gw_exudyn.fmi.variables import Variable

WELL, STOP, FAIL, REFUSE, END, HANG, TALK, WRONG_KIND, WRONG_COUNT, NO_TIME, LONG_WORDS = range(11)
"""How the stand-in answers a step: the value of `behaviour`."""

VARIABLES = (
    Variable("time", v.REAL, v.INDEPENDENT, "", 0.0),
    Variable("behaviour", v.INTEGER, v.INPUT, "", 0),
    Variable("worker.timeout", v.REAL, v.TUNABLE, "", 20.0),
    Variable("fixed", v.REAL, v.FIXED, "", 1.5),
    Variable("flag", v.BOOLEAN, v.FIXED, "", False),
    Variable("array", v.REAL, v.FIXED, "", 0.0, size=2),
    Variable("text", v.TEXT, v.FIXED, "", "words"),
    Variable("twice", v.REAL, v.OUTPUT, ""),
    Variable("count", v.INTEGER, v.OUTPUT, ""),
    Variable("row", v.REAL, v.OUTPUT, "", size=3),
    Variable("message", v.TEXT, v.OUTPUT, ""),
)
REFERENCE = {variable.name: i for i, variable in enumerate(VARIABLES)}
TOKEN, VERSION = "{stand-in}", "1.0"


def sanitizers() -> list[str]:
    """What makes a compiler add the sanitizers to whatever is to run with the sanitized wrapper; nothing without."""
    if not os.environ.get("GW_FMU_SANITIZE"):
        return []
    return ["-fsanitize=address,undefined,float-cast-overflow", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer"]


def compile_c(source: Path, program: Path, *options: str) -> Path:
    """A program or library from C, by the system's compiler or else the one that the wrapper is built with."""
    found = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    command = [found] if found else [sys.executable, "-m", "ziglang", "cc"]
    if found is None:
        pytest.importorskip("ziglang", reason="there is no C compiler")
    subprocess.run([*command, "-std=gnu99", "-O1", "-Wall", "-Wextra", str(source), "-o", str(program), *options],
                   check=True)  # fmt: skip
    return program


def resources(folder: Path, program: Path) -> Path:
    """A folder of resources whose worker is the stand-in."""
    folder.mkdir(parents=True, exist_ok=True)
    launch = Launch(str(program), "", VERSION, arguments=(VERSION,))
    (folder / TABLE).write_text(table_text(VARIABLES, TOKEN, launch), encoding="utf-8")
    return folder


_LOG2 = c.CFUNCTYPE(None, c.c_void_p, c.c_char_p, c.c_int, c.c_char_p, c.c_char_p)
_LOG3 = c.CFUNCTYPE(None, c.c_void_p, c.c_int, c.c_char_p, c.c_char_p)


class _Callbacks(c.Structure):
    _fields_ = (("log", _LOG2), ("allocate", c.c_void_p), ("free", c.c_void_p), ("done", c.c_void_p),
                ("environment", c.c_void_p))  # fmt: skip


class Wrapped:
    """An instance of the wrapper; `call("DoStep", ...)` calls `fmi2DoStep` or `fmi3DoStep` and returns its status."""

    def __init__(self, library: Path, version: int, folder: Path | bytes, token: bytes = TOKEN.encode(),
                 name: bytes = b"i", *, log: bool = True) -> None:  # fmt: skip
        self.library, self.version = c.CDLL(str(library)), version
        self.messages: list[tuple[int, bytes, bytes]] = []
        place = folder if isinstance(folder, bytes) else str(folder).encode()
        notes = self.messages  # no cycle: what is no longer used is freed at once

        def note(*arguments: Any) -> None:
            notes.append(arguments[-3:])

        self._log: Any = (_LOG2 if version == 2 else _LOG3)(note)
        if version == 2:
            self._callbacks = _Callbacks(self._log, None, None, None, None)
            self._function("Instantiate").restype = c.c_void_p
            uri = b"file://" + place
            self.handle = self._function("Instantiate")(name, 1, token, uri, c.byref(self._callbacks), 0, int(log))
        else:
            make = self._function("InstantiateCoSimulation")
            make.restype = c.c_void_p
            flags = [c.c_bool(x) for x in (False, log, False, True)]
            self.handle = make(name, token, place, *flags, None, c.c_size_t(0), None, self._log, None)
        if self.handle:
            free = self._function("FreeInstance")
            self.free = weakref.finalize(self, free, c.c_void_p(self.handle))

    def __enter__(self) -> Wrapped:
        return self

    def __exit__(self, *_: object) -> None:
        if self.handle:
            self.free()

    def _function(self, name: str) -> Any:
        return getattr(self.library, f"fmi{self.version}{name}")

    def call(self, name: str, *arguments: Any) -> int:
        return int(self._function(name)(c.c_void_p(self.handle), *arguments))

    @property
    def last(self) -> bytes:
        """The last message."""
        return self.messages[-1][2] if self.messages else b""

    def _accessed(self, access: str, name: str, values: Any) -> int:
        variable = VARIABLES[REFERENCE[name]]
        kinds = {v.REAL: "Float64", v.INTEGER: "Int32", v.BOOLEAN: "Boolean", v.TEXT: "String"}
        kind = kinds[variable.kind] if self.version == 3 else {"Float64": "Real", "Int32": "Integer"}.get(
            kinds[variable.kind], kinds[variable.kind])  # fmt: skip
        count = [c.c_size_t(len(values))] if self.version == 3 else []
        return self.call(f"{access}{kind}", (c.c_uint32 * 1)(REFERENCE[name]), c.c_size_t(1), values, *count)

    def _type(self, name: str) -> Any:
        boolean = c.c_int if self.version == 2 else c.c_bool
        return {v.REAL: c.c_double, v.INTEGER: c.c_int32, v.BOOLEAN: boolean, v.TEXT: c.c_char_p}[
            VARIABLES[REFERENCE[name]].kind]  # fmt: skip

    def set(self, name: str, *values: Any) -> int:
        return self._accessed("Set", name, (self._type(name) * len(values))(*values))

    def get(self, name: str, size: int = 1) -> tuple[int, list[Any]]:
        """Status and values."""
        values = (self._type(name) * size)()
        return self._accessed("Get", name, values), list(values)

    def enter(self, start: float = 0.0) -> int:
        """Into Initialization Mode."""
        if self.version == 2:
            setup = self.call("SetupExperiment", 0, c.c_double(0), c.c_double(start), 0, c.c_double(0))
            return setup or self.call("EnterInitializationMode")
        no = c.c_bool(False)
        return self.call("EnterInitializationMode", no, c.c_double(0), c.c_double(start), no, c.c_double(0))

    def start(self) -> int:
        """Into Step Mode."""
        return self.enter() or self.call("ExitInitializationMode")

    def step(self, time: float, dt: float = 0.5) -> int:
        if self.version == 2:
            return self.call("DoStep", c.c_double(time), c.c_double(dt), 1)
        flags, last = [c.byref(c.c_bool()) for _ in range(3)], c.c_double()
        return self.call("DoStep", c.c_double(time), c.c_double(dt), c.c_bool(True), *flags, c.byref(last))


def processes_of(folder: Path) -> Iterator[int]:
    """Processes whose command names a folder; those that have ended and are not waited for count too."""
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                if str(folder).encode() in (entry / "cmdline").read_bytes():
                    yield int(entry.name)
            except OSError:
                continue
