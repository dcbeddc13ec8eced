"""Calls as the standard has them: what is allowed when, every function there, logging, early return."""

from __future__ import annotations

import ctypes
import math
import re
import subprocess
import zipfile

import pytest
from fmpy.fmi1 import FMICallException
from hosts import ERROR, OK, Host

from gw_exudyn.fmi.wrapper import library
from gw_exudyn.fmi.wrapper.build import fmi_headers


@pytest.mark.parametrize("version", [2, 3])
def test_every_function_of_the_standard_is_exported(version):
    header = (fmi_headers() / f"fmi{version}Functions.h").read_text()
    names = set(re.findall(rf"^ *FMI{version}_Export \w+TYPE +(fmi{version}\w+);", header, re.MULTILINE))
    assert len(names) > 40
    try:
        loaded = ctypes.CDLL(str(library("x86_64-linux")))
    except OSError:
        pytest.skip("this machine is not Linux on x86_64")
    assert [name for name in sorted(names) if not hasattr(loaded, name)] == []


def test_a_call_out_of_order_is_told_with_what_is_allowed(fmu):
    with Host(fmu).instantiate() as host:
        assert host.step(0.1)["status"] == ERROR
        assert re.search("DoStep is not allowed in the state Instantiated; allowed in: Step Mode", host.messages[-1][2])
        host.calls.reset()
        host.start()
        assert host.step(0.1)["status"] == OK
        with pytest.raises(FMICallException):
            host.calls.exitInitializationMode()


def test_a_step_that_is_not_positive_is_an_error(fmus):
    with Host(fmus[2]).start() as host:
        for dt in (0.0, -0.1, float("nan"), float("inf")):
            assert host.step(dt)["status"] == ERROR
            host.calls.reset()
            host.start()
        assert host.step(0.1)["status"] == OK


def test_a_step_from_elsewhere_and_beyond_the_stop_time_are_errors(fmu):
    with Host(fmu).start(stop=0.5) as host:
        assert host.step(0.5)["status"] == OK
        assert host.step(0.1)["status"] == ERROR
        assert "beyond the stop time" in host.messages[-1][2]
        host.calls.reset()
        host.start()
        host.time = 0.3
        assert host.step(0.1)["status"] == ERROR
        assert "the FMU is at 0 s" in host.messages[-1][2]


def test_outputs_follow_the_parameters_in_initialization_mode(fmus):
    with Host(fmus[2]).instantiate() as host:
        host.calls.setupExperiment()
        host.calls.enterInitializationMode()
        assert host.get("push.position") == pytest.approx(-0.15)
        host.set("wire.length", 0.12)
        assert host.get("push.position") == pytest.approx(-0.12)
        host.calls.exitInitializationMode()
        assert host.get("push.position") == pytest.approx(-0.12)


def test_what_is_fixed_or_computed_cannot_be_set(fmu):
    with Host(fmu).start() as host:
        for name, text in (("contact.friction_coefficient", "fixed parameter"), ("tip.x", "computed")):
            with pytest.raises(FMICallException):
                host.set(name, 0.2)
            assert text in host.messages[-1][2]
            host.calls.reset()
            host.start()


def test_unknown_references_and_other_types_are_errors(fmu):
    with Host(fmu).start() as host:
        for reference in (99999, host.variables["wire.segments"].valueReference):
            with pytest.raises(FMICallException):
                (host.calls.getReal if host.fmi2 else host.calls.getFloat64)([reference])


def test_messages_keep_their_percent_signs(fmus):
    with Host(fmus[2]).instantiate() as host:
        with pytest.raises(FMICallException):
            host.start({"scenarioFile": "a%s%n#r1#.yaml"})
        # A format and references, as FMI 2 has it; fmpy formats it and leaves the references.
        assert "a%s%n##r1##.yaml" in host.messages[-1][2]


def test_events_are_logged_only_when_they_are_asked_for(fmu):
    event = ("logEvents", "the worker has started")
    with Host(fmu).instantiate() as host:
        assert event in [m[1:] for m in host.messages]
    with Host(fmu).instantiate(logging=False) as host:
        assert host.messages == []


@pytest.mark.parametrize(
    ("on", "categories", "logged"),
    [
        (True, [], True),
        (True, ["logStatusError"], True),
        (True, ["logEvents", "logAll"], True),
        (True, ["logEvents"], False),
        (True, ["logStatusFatal", "logStatusWarning", "unheard of"], False),
        (False, [], True),  # a host that wants no debug messages is told its faults
        (False, ["logEvents"], True),
    ],
)
def test_only_messages_of_the_chosen_categories_are_logged(fmu, on, categories, logged):
    with Host(fmu).instantiate() as host:
        host.calls.setDebugLogging(on, categories)
        host.messages.clear()
        with pytest.raises(FMICallException):
            host.set("tip.x", 0.2)
        assert [message[1] for message in host.messages] == (["logStatusError"] if logged else [])


@pytest.mark.parametrize("value", [-1.0, math.nan])
def test_a_timeout_that_is_no_time_is_refused_whenever_it_is_set(fmu, value):
    with Host(fmu) as host:
        for begin in (host.instantiate, host.start):
            host.free()
            begin()
            with pytest.raises(FMICallException):
                host.set("worker.timeout", value)
            assert f"worker.timeout: {value:g} s is no time to wait" in host.messages[-1][2]
        host.calls.reset()
        host.start({"worker.timeout": 0.0})
        assert host.step(0.05)["status"] == OK


def test_fmpy_builds_the_wrapper_from_the_fmus_own_source(fmus, tmp_path):
    """As a host on a platform without a library would."""
    import shutil

    if shutil.which("gcc") is None:
        pytest.skip("there is no gcc")
    for file in fmus.values():
        folder = tmp_path / file.stem
        with zipfile.ZipFile(file) as archive:
            archive.extractall(folder)
        sources = sorted(str(path) for path in (folder / "sources").glob("*.c"))
        options = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fPIC", "-shared"]
        subprocess.run(["gcc", *options, *sources, "-o", str(folder / "made.so")], check=True)
        assert (folder / "made.so").stat().st_size > 10_000
