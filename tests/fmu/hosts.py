"""A host for tests: an instance driven call by call through fmpy, with every message that it logs."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2LastSuccessfulTime, fmi2Terminated
from fmpy.fmi3 import FMU3Slave
from fmpy.simulation import instantiate_fmu

OK, WARNING, DISCARD, ERROR, FATAL = range(5)


class Host:
    """One instance. `calls` are methods of fmpy's FMU2Slave or FMU3Slave."""

    def __init__(self, file: Path, early_return: bool = True) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="gw-fmu-test-"))
        extract(str(file), unzipdir=str(self.folder))
        self.description = read_model_description(str(self.folder), validate=False)
        self.variables = {v.name: v for v in self.description.modelVariables}
        self.messages: list[tuple[int, str, str]] = []
        self.early_return = early_return
        self.calls: FMU2Slave | FMU3Slave | None = None
        self.time = 0.0

    def __enter__(self) -> Host:
        return self

    def __exit__(self, *_: object) -> None:
        self.free()
        shutil.rmtree(self.folder, ignore_errors=True)

    @property
    def fmi2(self) -> bool:
        return self.description.fmiVersion == "2.0"

    @property
    def table(self) -> Path:
        return self.folder / "resources" / "wrapper.txt"

    def edit_table(self, old: str, new: str) -> None:
        text = self.table.read_text()
        assert old in text
        self.table.write_text(text.replace(old, new))

    def instantiate(self, logging: bool = True) -> Host:
        def log(*arguments: Any) -> None:
            status, category, message = arguments[-3:]
            texts = [x.decode() if isinstance(x, bytes) else x for x in (category, message)]
            self.messages.append((int(status), *texts))

        self.calls = instantiate_fmu(
            str(self.folder),
            self.description,
            "CoSimulation",
            debug_logging=logging,
            logger=log,
            early_return_allowed=self.early_return,
        )
        return self

    def free(self) -> None:
        if self.calls is not None:
            self.calls.freeInstance()
            self.calls = None

    def start(self, values: Mapping[str, Any] | None = None, begin: float = 0.0, stop: float | None = None) -> Host:
        """From Instantiated to Step Mode, with these values."""
        if self.calls is None:
            self.instantiate()
        if self.fmi2:
            self.calls.setupExperiment(startTime=begin, stopTime=stop)
        for name, value in (values or {}).items():
            self.set(name, value)
        if self.fmi2:
            self.calls.enterInitializationMode()
        else:
            self.calls.enterInitializationMode(startTime=begin, stopTime=stop)
        self.calls.exitInitializationMode()
        self.time = begin
        return self

    def step(self, dt: float) -> dict[str, Any]:
        """A step; terminate, early and reached as the standard tells them, status 0 to 4."""
        end = {"status": OK, "terminate": False, "early": False, "reached": self.time + dt}
        try:
            told = self.calls.doStep(currentCommunicationPoint=self.time, communicationStepSize=dt)
            if told is not None:
                _, end["terminate"], end["early"], end["reached"] = told
                end["status"] = WARNING if self.messages and self.messages[-1][0] == WARNING else OK
        except FMICallException as error:
            end["status"] = error.status
            if error.status == DISCARD:
                end["terminate"] = bool(self.calls.getBooleanStatus(fmi2Terminated))
                end["reached"] = self.calls.getRealStatus(fmi2LastSuccessfulTime)
        self.time = end["reached"]
        return end

    def set(self, name: str, value: Any) -> None:
        variable = self.variables[name]
        text = [value] if variable.type != "String" else [str(value)]
        getattr(self.calls, f"set{variable.type}")([variable.valueReference], text)

    def get(self, name: str) -> Any:
        variable = self.variables[name]
        getter = getattr(self.calls, f"get{variable.type}")
        size = int(variable.dimensions[0].start) if variable.dimensions else 1
        values = getter([variable.valueReference], nValues=size) if size > 1 else getter([variable.valueReference])
        values = [x.decode() if isinstance(x, bytes) else x for x in values]
        return values if size > 1 else values[0]

    def outputs(self) -> dict[str, Any]:
        return {name: self.get(name) for name, v in self.variables.items() if v.causality == "output"}

    def state(self) -> bytes:
        """The state, serialised."""
        calls = self.calls
        if self.fmi2:
            handle = calls.getFMUstate()
            data = calls.serializeFMUstate(handle)
            calls.freeFMUstate(handle)
        else:
            handle = calls.getFMUState()
            data = calls.serializeFMUState(handle)
            calls.freeFMUState(handle)
        return bytes(data)

    def restore(self, data: bytes, time: float) -> None:
        calls = self.calls
        if self.fmi2:
            handle = calls.deSerializeFMUstate(data)
            calls.setFMUstate(handle)
            calls.freeFMUstate(handle)
        else:
            handle = calls.deserializeFMUState(data)
            calls.setFMUState(handle)
            calls.freeFMUState(handle)
        self.time = time

    def worker(self) -> int:
        """Process number of the worker that this process started last."""
        return max(children(os.getpid()))


def children(parent: int) -> list[int]:
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                fields = (entry / "stat").read_text().rpartition(")")[2].split()
                command = (entry / "cmdline").read_bytes()
            except OSError:
                continue
            if int(fields[1]) == parent and fields[0] != "Z" and b"gw-fmu-test-" in command:
                found.append(int(entry.name))
    return found


def alive(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
