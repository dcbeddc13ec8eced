"""What hosts hand over: state handles that are none, texts of any length and encoding, numbers at their limits."""

from __future__ import annotations

import ctypes as c
import math
import os
import subprocess
import sys

import pytest
import standin as stand
from fmpy.fmi1 import FMICallException
from hosts import Host
from standin import Wrapped

OK, ERROR, FATAL = 0, 3, 4
LONG = b"x" * (1 << 20)
TEXTS = {
    "empty": b"",
    "1 MB": LONG,
    "1 MB of two-byte letters": "ß".encode() * (1 << 19),
    "invalid UTF-8": b"a\xff\xfe\xc3(\xe2\x82 \xed\xa0\x80 \xc0\x80 \xf8\x88\x80\x80\x80",
    "cut-off letter": b"abc\xf0\x9f\x98",
    "formats": b"%s%n%99999d#1#",
    "line ends": b"a\r\n\tb\x01\x7f",
}
every_version = pytest.mark.parametrize("version", [2, 3])
every_text = pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS.keys())


def readable(host: Wrapped) -> None:
    """Every message is UTF-8, and of a length that a host can show."""
    for _, category, message in host.messages:
        category.decode("ascii")
        assert 0 < len(message.decode("utf-8")) < 8192


# State handles


def state(host: Wrapped) -> c.c_void_p:
    handle = c.c_void_p()
    assert host.call("GetFMUstate" if host.version == 2 else "GetFMUState", c.byref(handle)) == OK
    return handle


def state_calls(host: Wrapped, handle: c.c_void_p) -> dict[str, int]:
    """Every function that takes a handle, with this one."""
    word, data = "FMUstate" if host.version == 2 else "FMUState", (c.c_char * 4096)()
    copy = c.c_void_p(handle.value)
    return {
        "Set": host.call(f"Set{word}", handle),
        "Size": host.call(f"Serialized{word}Size", handle, c.byref(c.c_size_t())),
        "Serialize": host.call(f"Serialize{word}", handle, data, c.c_size_t(4096)),
        "Free": host.call(f"Free{word}", c.byref(copy)),
    }


@every_version
def test_a_handle_that_is_none_is_told(native, standin, version):
    with Wrapped(native, version, standin) as host, Wrapped(native, version, standin) as other:
        freed = state(host)
        word = "FMUstate" if version == 2 else "FMUState"
        assert host.call(f"Free{word}", c.byref(c.c_void_p(freed.value))) == OK
        foreign = state(other)
        for handle in (freed, foreign, c.c_void_p(1), c.c_void_p(host.handle), c.c_void_p(2**64 - 1)):
            assert set(state_calls(host, handle).values()) == {ERROR}
            assert b"no state of this instance" in host.last
            if handle is not freed:
                assert host.call(f"Get{word}", c.byref(c.c_void_p(handle.value))) == ERROR
        assert other.start() == OK  # its own state has not been touched
        assert state_calls(other, foreign) == dict.fromkeys(("Set", "Size", "Serialize", "Free"), OK)


@every_version
def test_a_handle_that_is_null(native, standin, version):
    with Wrapped(native, version, standin) as host:
        word, null = "FMUstate" if version == 2 else "FMUState", c.c_void_p()
        found = state_calls(host, null)
        assert found == {"Set": ERROR, "Size": ERROR, "Serialize": ERROR, "Free": OK}  # to free nothing is no error
        assert host.call(f"Free{word}", None) == OK
        kept = state(host)
        assert host.call(f"Get{word}", None) == ERROR
        assert host.call(f"Serialized{word}Size", kept, None) == ERROR
        for data, size in ((None, 4096), ((c.c_char * 8)(), 8)):
            assert host.call(f"Serialize{word}", kept, data, c.c_size_t(size)) == ERROR
        assert (
            host.call(f"{'DeS' if version == 2 else 'Des'}erialize{word}", None, c.c_size_t(9), c.byref(null)) == ERROR
        )


@every_version
def test_a_state_is_overwritten_in_place_and_many_are_kept_apart(native, standin, version):
    with Wrapped(native, version, standin) as host:
        word = "FMUstate" if version == 2 else "FMUState"
        assert host.start() == OK
        taken = []
        for i in range(50):
            taken.append(state(host))
            assert host.step(0.5 * i) == OK
        reused = c.c_void_p(taken[3].value)
        assert host.call(f"Get{word}", c.byref(reused)) == OK  # now of the end
        taken[3] = reused
        for i in (20, 3, 49, 0):
            assert host.call(f"Set{word}", taken[i]) == OK
            time = 25.0 if i == 3 else 0.5 * i
            assert host.step(time) == OK
            assert host.get("twice") == (OK, [2 * (time + 0.5)])


@every_version
def test_bytes_with_times_that_are_none_are_no_state(native, standin, version):
    """A header's numbers are checked, not only its length."""
    with Wrapped(native, version, standin) as host:
        word, read = "FMUstate" if version == 2 else "FMUState", "DeSerialize" if version == 2 else "Deserialize"
        assert host.start() == OK
        handle, size = state(host), c.c_size_t()
        assert host.call(f"Serialized{word}Size", handle, c.byref(size)) == OK
        data = (c.c_char * size.value)()
        assert host.call(f"Serialize{word}", handle, data, size) == OK
        for place in (24, 40):  # the start and the present time
            spoiled = bytearray(data.raw)
            assert spoiled[place : place + 8] == bytes(8)
            spoiled[place : place + 8] = b"\xff" * 8
            given, made = (c.c_char * size.value).from_buffer(spoiled), c.c_void_p()
            assert host.call(f"{read}{word}", given, size, c.byref(made)) == ERROR
            assert made.value is None


# Texts


@every_text
@every_version
def test_a_text_comes_back_as_it_was_set(native, standin, version, text):
    with Wrapped(native, version, standin) as host:
        assert host.set("text", text) == OK
        assert host.get("text") == (OK, [text])
        saved = state(host)
        assert host.set("text", b"other") == OK
        assert host.call("SetFMUstate" if version == 2 else "SetFMUState", saved) == OK
        assert host.get("text") == (OK, [text])
        assert host.start() == OK
        assert host.set("text", None) == ERROR
        readable(host)


@every_text
@every_version
def test_any_token_and_any_path_are_answered_with_a_sentence(native, standin, version, text):
    for folder, token, told in (
        (standin, text, b"is not this FMU's"),
        (b"/" + text, stand.TOKEN.encode(), b"resources"),
        (b"/" + text + b"%41" * 1000, text, b"resources"),
    ):
        with Wrapped(native, version, folder, token) as host:
            assert not host.handle
            assert told in host.last
            readable(host)


@every_text
@every_version
def test_any_name_of_an_instance_will_do(native, standin, version, text):
    with Wrapped(native, version, standin, name=text) as host:
        assert host.start() == OK
        assert host.step(0.0) == OK


@every_version
def test_a_folder_whose_name_is_no_text_can_be_used(native, standin, tmp_path, version):
    folder = os.fsencode(tmp_path) + b"/\xff\xfe %41 \xc3"
    os.symlink(standin, folder)
    with Wrapped(native, version, folder.replace(b"%", b"%25") if version == 2 else folder) as host:
        assert host.start() == OK


@every_version
def test_what_a_worker_says_last_is_shown_as_text(native, standin, version):
    for behaviour in (stand.END, stand.LONG_WORDS):
        with Wrapped(native, version, standin) as host:
            assert host.start() == OK
            host.set("behaviour", behaviour)
            assert host.step(0.0) == FATAL
            assert b"word" in host.last
            readable(host)
    with Wrapped(native, version, standin) as host:
        assert host.start() == OK
        host.set("behaviour", stand.REFUSE)
        assert host.step(0.0) == ERROR
        assert host.last == b"no??"


@pytest.mark.parametrize("text", [LONG, b"\xff\xfe.yaml", b"a\nb.yaml"], ids=["1 MB", "invalid UTF-8", "line end"])
def test_the_real_worker_refuses_a_file_of_such_a_name(fmu, text):
    with Host(fmu).instantiate() as host:
        reference = c.c_uint32(host.variables["scenarioFile"].valueReference)
        function = getattr(host.calls.dll, "fmi2SetString" if host.fmi2 else "fmi3SetString")
        function.argtypes = None
        count = [] if host.fmi2 else [c.c_size_t(1)]
        values = (c.c_char_p * 1)(text)
        assert function(c.c_void_p(host.calls.component), c.byref(reference), c.c_size_t(1), values, *count) == OK
        with pytest.raises(FMICallException) as error:
            host.start()
        assert error.value.status == ERROR
        assert "no file name" in host.messages[-1][2] or "no such file" in host.messages[-1][2]


def test_the_real_worker_in_a_folder_whose_name_is_no_text(fmu, native, tmp_path):
    """The sentence about a missing file names the folder all the same."""
    with Host(fmu) as host:
        version, token = 2 if host.fmi2 else 3, host.description.guid.encode()
        (host.folder / "resources" / "scenario.json").unlink()
        folder = os.fsencode(tmp_path) + b"/\xff\xc3"
        os.symlink(host.folder / "resources", folder)
        with Wrapped(native, version, folder, token) as instance:
            assert instance.start() == ERROR
            assert b"scenario.json" in instance.last
            readable(instance)


# Numbers


@every_version
@pytest.mark.parametrize(
    ("given", "behaviour"),
    [(0, 1), (2**31 - 1, 2**31 - 1), (-(2**31), -(2**31) + 1)],
)
def test_whole_numbers_stay_within_their_type(native, standin, version, given, behaviour):
    """The stand-in answers with the number and one more; a larger one than fits is the largest."""
    with Wrapped(native, version, standin) as host:
        assert host.set("behaviour", given) == OK
        assert host.get("behaviour") == (OK, [given])
        assert host.start() == OK
        assert host.get("count") == (OK, [behaviour])


@every_version
def test_numbers_that_are_none_pass_through(native, standin, version):
    with Wrapped(native, version, standin) as host:
        for value in (math.nan, math.inf, -math.inf, 5e-324, -0.0):
            assert host.set("fixed", value) == OK
            assert repr(host.get("fixed")[1]) == repr([value])
        for start in (math.nan, math.inf):
            assert host.enter(start) == ERROR
            assert host.call("Reset") == OK


@pytest.mark.parametrize("behaviour", [stand.WRONG_KIND, stand.WRONG_COUNT, stand.NO_TIME])
@every_version
def test_a_reply_that_is_none_is_fatal(native, standin, version, behaviour):
    with Wrapped(native, version, standin) as host:
        assert host.start() == OK
        assert host.set("behaviour", behaviour) == OK
        assert host.step(0.0) == FATAL
        assert b"reply is not understood" in host.last


@every_version
def test_counts_and_places_that_are_none_are_errors(native, standin, version):
    kind = "Real" if version == 2 else "Float64"
    with Wrapped(native, version, standin) as host:
        references, values = (c.c_uint32 * 1)(stand.REFERENCE["fixed"]), (c.c_double * 4)()
        counts = [] if version == 2 else [c.c_size_t(1)]
        one = c.c_size_t(1)
        for access in ("Get", "Set"):
            assert host.call(f"{access}{kind}", None, one, values, *counts) == ERROR
            assert host.call(f"{access}{kind}", references, one, None, *counts) == ERROR
            assert b"gave no references or no values" in host.last
            assert host.call(f"{access}{kind}", None, c.c_size_t(0), None, *([c.c_size_t(0)] if counts else [])) == OK
        if version == 3:
            for size in (0, 2):
                assert host.call("GetFloat64", references, one, values, c.c_size_t(size)) == ERROR
                assert b"number of values" in host.last


def test_without_descriptors_left_it_says_so(native, standin):
    """A host that has opened all files that it may."""
    script = f"""
import os, resource, sys
sys.path[:0] = {sys.path!r}
from standin import Wrapped
from pathlib import Path
with Wrapped(Path({str(native)!r}), 3, Path({str(standin)!r})) as first:
    pass
open_files = len(os.listdir("/proc/self/fd"))
for spare in range(9):
    resource.setrlimit(resource.RLIMIT_NOFILE, (open_files + spare, 4096))
    with Wrapped(Path({str(native)!r}), 3, Path({str(standin)!r})) as host:
        made = bool(host.handle)
    resource.setrlimit(resource.RLIMIT_NOFILE, (4096, 4096))
    assert made or host.last, spare
    assert len(os.listdir("/proc/self/fd")) == open_files, spare
    print(int(made), end="")
"""
    if not sys.platform.startswith("linux"):
        pytest.skip("counts descriptors in /proc")
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert run.returncode == 0, run.stderr
    assert run.stdout.startswith("0")
