"""Fuzz the parsers of the FMU's wrapper: what a worker sends, the table in the resources, serialised states.

`make fuzz`, or `python tests/fmu/fuzz/fuzz.py --seconds 60 [target...]`; needs clang with libFuzzer (Debian and Ubuntu:
clang and libclang-rt-dev). The seeds are the frames, the table and the states of a real run, made anew each time. What
breaks the wrapper is kept in the folder that --out names.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
from array import array
from collections.abc import Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parents[2])]

from hosts import Host

from gw_exudyn import __version__
from gw_exudyn.fmi import channel as words
from gw_exudyn.fmi.channel import HostGone, Request
from gw_exudyn.fmi.export import export
from gw_exudyn.fmi.plant import ScenarioPlant
from gw_exudyn.fmi.resources import read_table
from gw_exudyn.fmi.variables import TEXT
from gw_exudyn.fmi.worker import serve
from gw_exudyn.fmi.wrapper import source_folder
from gw_exudyn.fmi.wrapper.build import fmi_headers
from gw_exudyn.scenario import load_scenario

TARGETS = ("replies", "table", "states")
SOURCES = ("table.c", "request.c", "instance.c", "state.c", "fmi2.c", "fmi3.c")
SANITIZERS = "-fsanitize=fuzzer,address,undefined,float-cast-overflow"
# What a table is made of, so that the fuzzer need not guess whole words.
WORDS = ("gw-fmu-wrapper 1", "token ", "version ", "python ", "path ", "program ", "glibc ", "remedy ", "argument ",
         "environment ", "timeout ", "variable ", "S t 1 ", "R t 3 ", "R o 7 ", "I u 1 ", "B f 1 ", "S i 1 ",
         "0000000000000000 ", "7ff8000000000000 ")  # fmt: skip
SCENARIO = ("arc90", ("wire.segments=20", "drive.speed=20 mm/s", "drive.distance=70 mm"))


class Recorder:
    """A channel whose host asks a list of requests; `sent` is what the worker says to it."""

    def __init__(self, requests: list[Request]) -> None:
        self._requests = iter(requests)
        self.sent: list[bytes] = []

    def receive(self) -> Request:
        try:
            return next(self._requests)
        except StopIteration:
            raise HostGone from None

    def reply(self, kind: int, numbers: bytes = b"", rest: bytes = b"") -> None:
        self.sent.append(struct.pack("=IIII", kind, len(numbers) // 8, len(rest), 0) + numbers + rest)


def frames(resources: Path) -> list[bytes]:
    """What a real worker sends: its greeting, then to a start, to two steps, for a state, to a step that it refuses."""
    settable = [v for v in read_table(resources) if v.settable]
    numbers = array("d", [float(v.start or 0) for v in settable if v.kind != TEXT]).tobytes()
    texts = words.pack_texts([str(v.start or "") for v in settable if v.kind == TEXT])
    asked = [
        Request(words.START, 0.0, numbers, texts),
        Request(words.STEP, 0.5, numbers, b""),
        Request(words.STEP, 1.0, numbers, b""),
        Request(words.GET_STATE, 0.0, numbers, b""),
        Request(words.STEP, 1e9, numbers, b""),
        Request(99, 0.0, numbers, b""),
    ]
    recorder = Recorder(asked)
    recorder.reply(words.HELLO, rest=__version__.encode())
    try:
        serve(recorder, lambda: ScenarioPlant(str(resources)))
    except HostGone:
        return recorder.sent
    raise RuntimeError("the worker went on without a host")


def seeds(target: str, folder: Path, file: Path) -> Iterator[bytes]:
    """The corpus to begin with."""
    if target == "table":
        yield (folder / "resources" / "wrapper.txt").read_bytes()
        yield b"gw-fmu-wrapper 1\ntoken t\nversion 1\nargument a\ntimeout 0\nvariable R i 1 0000000000000000 x\n"
        yield b"gw-fmu-wrapper 1\ntoken t\nversion 1\nprogram p\nglibc 2.9\nvariable S o 1 0000000000000000 s text\n"
    elif target == "states":
        with Host(file).instantiate() as host:
            yield host.state()
            host.start()
            host.step(0.5)
            yield host.state()
    else:
        said = frames(folder / "resources")
        alive = struct.pack("=IIII", words.ALIVE, 0, 0, 0)
        for version in (0, 1):
            for calls in (b"\0\1\2\2\4", b"\0\1\2\7\3\0\1", b"\0\1\4\6\2", b"\0\1"):
                yield bytes([len(calls) << 2 | version]) + calls + b"".join(said)
            # Initialize and save, each with what the worker sends to that; signs of life before.
            calls, replies = b"\0\1\4\5\11", [said[0], said[1], alive, said[4], said[1], said[1]]
            yield bytes([len(calls) << 2 | version]) + calls + b"".join(replies)


def build(target: str, folder: Path) -> Path:
    """The target's program, by clang with libFuzzer and the sanitizers."""
    compiler = shutil.which("clang")
    if compiler is None:
        raise SystemExit("clang is not here; on Debian and Ubuntu: apt-get install clang libclang-rt-dev")
    program = folder / target
    sources = [str(source_folder() / name) for name in SOURCES]
    sources += [str(HERE / name) for name in ("memory.c", "drive.c", f"{target}.c")]
    options = ["-std=gnu99", "-g", "-O1", "-Wall", "-Wextra", "-Werror", SANITIZERS, "-fno-sanitize-recover=all"]
    includes = [f"-I{source_folder()}", f"-I{fmi_headers()}"]
    subprocess.run([compiler, *options, *includes, *sources, "-o", str(program)], check=True)
    return program


def fuzz(target: str, seconds: float, folder: Path, file: Path, out: Path) -> bool:
    """Fuzz one target for so long; whether it held. Prints what was run."""
    program, corpus = build(target, folder), folder / f"{target}-corpus"
    corpus.mkdir()
    with Host(file) as host:
        for i, seed in enumerate(seeds(target, host.folder, file)):
            (corpus / str(i)).write_bytes(seed)
        table = folder / "wrapper.txt"
        shutil.copyfile(host.table, table)
    dictionary = folder / "words"
    dictionary.write_text("".join(f'"{word}"\n' for word in WORDS))
    limits = [f"-max_total_time={seconds:.0f}", "-max_len=20000", "-timeout=10", "-rss_limit_mb=2048", "-seed=1"]
    limits += [f"-dict={dictionary}"] if target == "table" else []
    command = [str(program), *limits, f"-artifact_prefix={out}/{target}-", "-print_final_stats=1", str(corpus)]
    run = subprocess.run(command, env={**os.environ, "GW_FUZZ_TABLE": str(table)}, capture_output=True, text=True)
    told = run.stderr
    runs = re.findall(r"number_of_executed_units: (\d+)", told)
    covered = re.findall(r"cov: (\d+)", told)
    held = run.returncode == 0
    sys.stdout.write(f"{target}: {runs[-1] if runs else '?'} runs, {covered[-1] if covered else '?'} edges, "
                     f"{'nothing found' if held else 'BROKEN'}\n")  # fmt: skip
    if not held:
        sys.stderr.write(told[-6000:])
    return held


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("targets", nargs="*", choices=[*TARGETS, []], help="without: all")
    parser.add_argument("--seconds", type=float, default=60, help="for all targets together")
    parser.add_argument("--out", type=Path, default=Path(tempfile.gettempdir()), help="folder for what breaks it")
    chosen = parser.parse_args()
    targets = chosen.targets or TARGETS
    chosen.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="gw-fuzz-") as scratch:
        file = export(load_scenario(*SCENARIO), Path(scratch) / "small.fmu", 3, stations=7)
        held = [fuzz(t, max(1.0, chosen.seconds / len(targets)), Path(scratch), file, chosen.out) for t in targets]
    return 0 if all(held) else 1


if __name__ == "__main__":
    sys.exit(main())
