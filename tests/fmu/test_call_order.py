"""Every function of FMI 2.0 and 3.0 called in every state, by the standards' state machines.

FMI 2.0.5, section 4.2.4 (table of states and functions for co-simulation); FMI 3.0.2, sections 2.3 and 4.2.1. The
states are those of the standard for FMI 2.0: instantiated, Initialization Mode, stepComplete, stepFailed (a step that
ended in fmi2Discard), terminated, error, fatal. In FMI 3.0 a run that has ended is still in Step Mode, but no further
step can be taken; after an error comes Terminated.

A letter a state: `+` allowed; `-` not allowed, which is an error and leads to the state after errors; `!` allowed by
the standard, and an error since the FMU does not provide it, which changes nothing; `~` not allowed by the standard,
and harmless, so that it is answered.
"""

from __future__ import annotations

import ctypes as c
import re

import pytest
import standin as stand
from standin import Wrapped

from gw_exudyn.fmi.wrapper.build import fmi_headers

OK, DISCARD, ERROR, FATAL = 0, 2, 3, 4
STATES = ("Instantiated", "Initialization Mode", "Step Mode", "Step Mode (run ended)", "Terminated", "Error", "Fatal")

SHARED = {
    "SetDebugLogging": "+++++++",
    "EnterInitializationMode": "+------",
    "ExitInitializationMode": "-+-----",
    "Terminate": "--++---",
    "Reset": "++++++-",
    "DoStep": "--+----",
}
FMI2 = {
    **SHARED,
    "SetupExperiment": "+------",
    "GetReal": "~+++++-",
    "GetInteger": "~+++++-",
    "GetBoolean": "~+++++-",
    "GetString": "~+++++-",
    "SetReal": "+++----",
    "SetInteger": "+++----",
    "SetBoolean": "++-----",  # the only one is a fixed parameter
    "SetString": "++-----",
    "GetFMUstate": "++++++-",
    "SetFMUstate": "++++++-",
    "FreeFMUstate": "++++++~",
    "SerializedFMUstateSize": "++++++~",
    "SerializeFMUstate": "++++++~",
    "DeSerializeFMUstate": "++++++~",
    "GetStatus": "--+++--",
    "GetRealStatus": "--+++--",
    "GetBooleanStatus": "--+++--",
    "GetStringStatus": "--+++--",
    "GetIntegerStatus": "--!!!--",
}
FMI3 = {
    **SHARED,
    "SetDebugLogging": "++++++~",
    "GetFloat64": "++++++-",
    "GetInt32": "++++++-",
    "GetBoolean": "++++++-",
    "GetString": "++++++-",
    "SetFloat64": "+++----",
    "SetInt32": "+++----",
    "SetBoolean": "++-----",
    "SetString": "++-----",
    "GetFMUState": "++++++-",
    "SetFMUState": "++++++-",
    "FreeFMUState": "++++++~",
    "SerializedFMUStateSize": "++++++~",
    "SerializeFMUState": "++++++~",
    "DeserializeFMUState": "++++++~",
}
LEADS_TO = {"EnterInitializationMode": STATES[1], "ExitInitializationMode": STATES[2], "Terminate": STATES[4],
            "Reset": STATES[0], "SetFMUstate": STATES[0], "SetFMUState": STATES[0]}  # fmt: skip
NO_INSTANCE = ("GetVersion", "GetTypesPlatform", "Instantiate", "InstantiateModelExchange", "FreeInstance",
               "InstantiateCoSimulation", "InstantiateScheduledExecution")  # fmt: skip


def functions(version: int) -> set[str]:
    """Every function of the standard that takes an instance, without its prefix."""
    header = (fmi_headers() / f"fmi{version}Functions.h").read_text()
    names = set(re.findall(rf"^ *FMI{version}_Export \w+TYPE +fmi{version}(\w+);", header, re.MULTILINE))
    return names - set(NO_INSTANCE)


def led_to(host: Wrapped, state: str) -> None:
    """Bring an instance, just made, into a state."""
    if state == "Instantiated":
        return
    assert host.enter() == OK
    if state == "Initialization Mode":
        return
    assert host.call("ExitInitializationMode") == OK
    assert host.step(0.0) == OK
    if state in ("Step Mode (run ended)", "Fatal"):
        assert host.set("behaviour", stand.STOP if state != "Fatal" else stand.END) == OK
        ended = DISCARD if host.version == 2 else OK
        assert host.step(0.5) == (FATAL if state == "Fatal" else ended)
    elif state == "Terminated":
        assert host.call("Terminate") == OK
    elif state == "Error":
        assert host.step(77.0) == ERROR


def state_of(host: Wrapped) -> str:
    """The state, by what a call says that none but one allows; the instance is of no use afterwards."""
    if host.call("ExitInitializationMode") == OK:
        return "Initialization Mode"
    return re.search(rb"not allowed in the state ([^;]+);", host.last)[1].decode()


class Saved:
    """A state taken when the instance was made, as a handle and as bytes."""

    def __init__(self, host: Wrapped) -> None:
        word = "FMUstate" if host.version == 2 else "FMUState"
        self.handle, size = c.c_void_p(), c.c_size_t()
        assert host.call(f"Get{word}", c.byref(self.handle)) == OK
        assert host.call(f"Serialized{word}Size", self.handle, c.byref(size)) == OK
        self.data = (c.c_char * size.value)()
        assert host.call(f"Serialize{word}", self.handle, self.data, size) == OK


def call(host: Wrapped, name: str, saved: Saved) -> int:
    """The function with arguments that make sense."""
    flag = c.c_int if host.version == 2 else c.c_bool
    zero, none = c.c_double(0), c.c_void_p()
    access = re.fullmatch(r"(Get|Set)(Real|Float64|Integer|Int32|Boolean|String)", name)
    if access and access[1] == "Get":
        return host.get({"R": "twice", "F": "twice", "I": "count", "B": "flag", "S": "text"}[access[2][0]])[0]
    if access:
        name = {"R": "worker.timeout", "F": "worker.timeout", "I": "behaviour", "B": "flag", "S": "text"}[access[2][0]]
        return host.set(name, b"x" if name == "text" else 1)
    if name == "EnterInitializationMode" and host.version == 3:
        return host.enter()
    if name == "DoStep":
        return host.step(0.5)
    kind = {"GetStatus": 0, "GetStringStatus": 1, "GetRealStatus": 2, "GetBooleanStatus": 3, "GetIntegerStatus": 0}
    size = c.c_size_t(len(saved.data))
    arguments = {
        "SetDebugLogging": (flag(1), c.c_size_t(0), none),
        "SetupExperiment": (0, zero, zero, 0, zero),
        "GetFMUstate": (c.byref(none),),
        "SetFMUstate": (saved.handle,),
        "FreeFMUstate": (c.byref(saved.handle),),
        "SerializedFMUstateSize": (saved.handle, c.byref(c.c_size_t())),
        "SerializeFMUstate": (saved.handle, saved.data, size),
        "DeSerializeFMUstate": (saved.data, size, c.byref(none)),
        **{status: (kind[status], c.byref(c.c_double())) for status in kind},
    }
    arguments |= {key.replace("state", "State").replace("DeS", "Des"): given for key, given in arguments.items()}
    plain = ("EnterInitializationMode", "ExitInitializationMode", "Terminate", "Reset")
    # What is not provided looks at none of its arguments.
    return host.call(name, *(() if name in plain else arguments.get(name, (None,) * 10)))


def table(version: int) -> dict[str, str]:
    """What a function answers in each state; what is not in the tables above is not provided."""
    known = FMI2 if version == 2 else FMI3
    return {**dict.fromkeys(functions(version), "!!!!!!!"), **known}


@pytest.mark.parametrize("version", [2, 3])
def test_the_tables_have_the_functions_of_the_standard(version):
    known = FMI2 if version == 2 else FMI3
    assert set(known) <= functions(version)
    assert all(len(letters) == len(STATES) for letters in known.values())


@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize("version", [2, 3])
def test_every_function_in_every_state(native, standin, version, state):
    wrong = []
    for name, letters in sorted(table(version).items()):
        letter = letters[STATES.index(state)]
        with Wrapped(native, version, standin) as host:
            saved = Saved(host)
            led_to(host, state)
            host.messages.clear()
            status = call(host, name, saved)
            told = bool(host.messages)
            if letter == "-":
                then = "Fatal" if state == "Fatal" else "Error"
            else:
                then = LEADS_TO.get(name, state) if letter in "+~" else state
            found = (status, told if status else True, state_of(host))
            wanted = (OK if letter in "+~" else ERROR, True, then)
            if found != wanted:
                wrong.append((name, found, wanted))
    assert wrong == []


@pytest.mark.parametrize("version", [2, 3])
def test_an_instance_that_is_null_is_an_error(native, standin, version):
    with Wrapped(native, version, standin) as host:
        saved, host.handle = Saved(host), None
        for name in table(version):
            assert call(host, name, saved) == ERROR, name
        host._function("FreeInstance")(None)


@pytest.mark.parametrize("version", [2, 3])
def test_a_reset_forgets_the_times_of_the_run_before(native, standin, version):
    with Wrapped(native, version, standin) as host:
        if version == 2:
            assert host.call("SetupExperiment", 0, c.c_double(0), c.c_double(3), 1, c.c_double(4)) == OK
            assert host.call("EnterInitializationMode") == OK
        else:
            no, yes = c.c_bool(False), c.c_bool(True)
            assert host.call("EnterInitializationMode", no, c.c_double(0), c.c_double(3), yes, c.c_double(4)) == OK
        assert host.call("ExitInitializationMode") == OK
        assert host.step(3.0) == OK
        assert host.call("Reset") == OK
        if version == 2:
            assert host.call("EnterInitializationMode") == OK  # a host that sets no experiment up
            assert host.call("ExitInitializationMode") == OK
        else:
            assert host.start() == OK
        assert host.step(0.0, 50.0) == OK
