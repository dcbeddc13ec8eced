"""Running an FMU through fmpy: one instance, reset from run to run, so that a study pays for its start once."""

from __future__ import annotations

import difflib
import os
import shutil
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from numpy.typing import NDArray

from gw_exudyn.errors import SolverError, StorageError, UsageError
from gw_exudyn.fmi.cache import may_run, unpacked
from gw_exudyn.fmi.variables import STATUS_CODE, STATUS_MESSAGE
from gw_exudyn.result import Status

_TAKES_TEXT = ("String",)
_WHOLE = ("Integer", "Int32")


@dataclass(frozen=True)
class FmuRun:
    """One run of an FMU.

    outputs : structured array, one row an instant, `time` (s) first, then every output by its name, SI. code : 0 while
    nothing is wrong. message : how the run stands, a sentence.
    """

    outputs: NDArray[Any]
    code: int
    message: str

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the columns."""
        return tuple(self.outputs.dtype.names or ())

    @property
    def trusted(self) -> bool:
        """The run is still good, or has ended by an event of its own."""
        return self.code == 0 or list(Status)[self.code].trusted

    @property
    def final(self) -> dict[str, Any]:
        """The outputs at the last instant."""
        return {name: self.outputs[name][-1] for name in self.names}


class FmuSession:
    """An FMU with one instance that serves run after run. It is unpacked in the user's cache folder, once.

    Raises StorageError for a file that is no FMU, UsageError without fmpy, SolverError where the FMU does not start.
    """

    def __init__(self, file: str | os.PathLike[str]) -> None:
        try:
            from fmpy import extract, read_model_description
            from fmpy.simulation import instantiate_fmu
        except ImportError as error:
            raise UsageError("the package fmpy is missing; install it with: pip install fmpy") from error
        self._messages: list[str] = []
        self._used = False
        self._own_folder: Path | None = None
        self._instance: Any = None
        try:
            try:
                self._folder = unpacked(file) or self._apart(file, extract)
                self.description: Any = read_model_description(str(self._folder), validate=False)
            except StorageError:
                raise
            except Exception as error:  # whatever a file that is no FMU leads to in fmpy
                raise StorageError(f"{os.fspath(file)}: can't be read as an FMU: {error}") from error
            self.variables = {variable.name: variable for variable in self.description.modelVariables}
            with self._told():
                self._instance = instantiate_fmu(
                    str(self._folder), self.description, "CoSimulation", logger=self._log()
                )
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """End the instance and its worker, and take the unpacked files away."""
        if self._instance is not None:
            self._instance.freeInstance()
            self._instance = None
        if self._own_folder is not None:
            shutil.rmtree(self._own_folder, ignore_errors=True)

    def _apart(self, file: str | os.PathLike[str], extract: Callable[..., Any]) -> Path:
        """Unpacked in a folder of its own, where there is no cache. Raises StorageError where nothing there may run."""
        self._own_folder = Path(tempfile.mkdtemp(prefix="gw-fmu-"))
        if not may_run(self._own_folder):
            raise StorageError(
                f"{tempfile.gettempdir()} forbids running what is in it (mount option noexec), and so does, or is "
                "missing, the cache folder; an FMU must be unpacked where it may run: let the environment variable "
                "TMPDIR name another folder"
            )
        extract(os.fspath(file), unzipdir=str(self._own_folder))
        return self._own_folder

    @property
    def version(self) -> str:
        """Version of gw-exudyn that exported the FMU; empty for an FMU of others."""
        program, _, version = str(self.description.generationTool or "").partition(" ")
        return version if program == "gw-exudyn" else ""

    @property
    def resources(self) -> Path:
        """The folder of the FMU's resources."""
        return self._folder / "resources"

    @property
    def units(self) -> dict[str, str]:
        """Unit of every variable by its name, as FMI writes it; empty for none."""
        return {name: str(variable.unit or "") for name, variable in self.variables.items()}

    def run(
        self,
        values: Mapping[str, Any] | None = None,
        *,
        inputs: NDArray[Any] | None = None,
        stop: float | None = None,
        step: float | None = None,
    ) -> FmuRun:
        """One run from the start.

        values : parameters and starts of inputs by name, SI; what is not named has its exported start. inputs :
        structured array with `time` and inputs by name. stop : s; None takes the FMU's default. step : s, between two
        communication points; None takes the FMU's.
        Raises UsageError for a name or value that does not fit, SolverError with the FMU's own sentence.
        """
        from fmpy import simulate_fmu

        starts = {name: self._value(name, value) for name, value in (values or {}).items()}
        for name in [] if inputs is None else (inputs.dtype.names or ())[1:]:
            self._known(name, ("input",))
        default = self.description.defaultExperiment
        with self._told():
            if self._used:
                self._instance.reset()
            self._used = True
            outputs = simulate_fmu(
                str(self._folder),
                validate=False,
                model_description=self.description,
                fmu_instance=self._instance,
                fmi_type="CoSimulation",
                start_values=starts,
                input=inputs,
                stop_time=float(default.stopTime) if stop is None else stop,
                output_interval=float(default.stepSize) if step is None else step,
                early_return_allowed=True,
            )
            return FmuRun(outputs, *self._ending())

    def _ending(self) -> tuple[int, str]:
        if STATUS_CODE not in self.variables:
            return 0, "The FMU tells nothing of its status."
        code, message = (self.variables[name].valueReference for name in (STATUS_CODE, STATUS_MESSAGE))
        getter = self._instance.getInteger if self.description.fmiVersion == "2.0" else self._instance.getInt32
        text = self._instance.getString([message])[0]
        return int(getter([code])[0]), text.decode() if isinstance(text, bytes) else text

    def _known(self, name: str, causalities: tuple[str, ...]) -> Any:
        """The variable of that name. Raises UsageError with the nearest where there is none of such causality."""
        variable = self.variables.get(name)
        allowed = [n for n, v in self.variables.items() if v.causality in causalities]
        if variable is None or name not in allowed:
            near = difflib.get_close_matches(name, allowed, n=2)
            hint = f"; nearest: {', '.join(near)}" if near else f"; there are: {', '.join(allowed)}"
            raise UsageError(f"{name}: no {' or '.join(causalities)} of the FMU has this name{hint}")
        return variable

    def _value(self, name: str, value: Any) -> Any:
        """The value as fmpy takes it: text is read as the variable's type wants it."""
        variable = self._known(name, ("parameter", "input"))
        if variable.type in _TAKES_TEXT or not isinstance(value, str):
            return value
        readers: dict[str, Callable[[str], Any]] = {"Boolean": _boolean, **dict.fromkeys(_WHOLE, int)}
        try:
            return readers.get(variable.type, float)(value)
        except ValueError:
            raise UsageError(f"{name}: {value!r} is no {variable.type}; write {_wanted(variable)}") from None

    def _log(self) -> Any:
        def note(*arguments: Any) -> None:
            status, message = arguments[-3], arguments[-1]
            if status:
                self._messages.append(message.decode() if isinstance(message, bytes) else str(message))

        return note

    def _told(self) -> _Told:
        return _Told(self._messages)


class _Told:
    """Turns what fmpy raises into the FMU's own sentence."""

    def __init__(self, messages: list[str]) -> None:
        self._messages = messages

    def __enter__(self) -> None:
        self._messages.clear()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if isinstance(error, Exception) and self._messages:
            raise SolverError("\n".join(self._messages)) from error


def _boolean(text: str) -> bool:
    words = {"true": True, "1": True, "false": False, "0": False}
    if text.lower() not in words:
        raise ValueError(text)
    return words[text.lower()]


def _wanted(variable: Any) -> str:
    """What a variable takes, in words."""
    if variable.type == "Boolean":
        return "true or false"
    if variable.type in _WHOLE:
        return "a whole number"
    return "a number" if variable.unit in (None, "", "1") else f"a number in {variable.unit}"
