"""The command as a process: what it loads, and how it gets on with pipes, full disks and plain terminals."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import gw_exudyn

HEAVY = ("pydantic", "xarray", "matplotlib", "exudyn", "shapely", "numpy", "scipy", "h5netcdf", "rich", "yaml", "dask")
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(Path(gw_exudyn.__file__).parents[1])}


def loaded_by(code: str) -> set[str]:
    """The heavy packages that are loaded after some code ran."""
    report = f"{code}\nimport sys, json; sys.stderr.write(json.dumps([n for n in {HEAVY!r} if n in sys.modules]))"
    done = subprocess.run([sys.executable, "-c", report], capture_output=True, text=True, check=True, env=ENVIRONMENT)
    return set(json.loads(done.stderr))


def gw(*arguments: str, stdout=subprocess.PIPE, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "gw_exudyn", *arguments],
        stdout=stdout,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        env={**ENVIRONMENT, **environment},
        check=False,
    )


@pytest.mark.parametrize(
    "code",
    [
        "import gw_exudyn; gw_exudyn.__version__; dir(gw_exudyn)",
        "from gw_exudyn.cli import main; main(['--help'])",
        "from gw_exudyn.cli import main; main(['run', '--help'])",
        "from gw_exudyn.cli import main; main(['sweep', '--help'])",
        "from gw_exudyn.cli import main; main(['--version'])",
    ],
)
def test_import_and_help_load_nothing_heavy(code):
    assert loaded_by(code) == set()


def test_the_public_names_are_all_there():
    for name in gw_exudyn.__all__:
        assert getattr(gw_exudyn, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'simulat'"):
        _ = gw_exudyn.simulat


def test_version_and_help_go_to_stdout():
    done = gw("--version")
    assert (done.returncode, done.stdout, done.stderr) == (0, f"gw-exudyn {gw_exudyn.__version__}\n", "")
    done = gw("--help")
    assert done.returncode == 0
    assert all(command in done.stdout for command in ("run", "sweep", "check", "schema", "info", "plot"))


@pytest.mark.parametrize("command", ["run", "sweep", "check", "schema", "info", "plot"])
def test_every_command_has_its_help(command):
    done = gw(command, "--help")
    assert done.returncode == 0
    assert done.stdout.startswith(f"Usage: gw-exudyn {command}")


@pytest.mark.skipif(sys.platform == "win32", reason="pipes break in another way there")
@pytest.mark.parametrize("arguments", [("schema",), ("--help",), ("info", "straight")])
def test_a_reader_that_has_had_enough_is_no_error(arguments):
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer, "w") as pipe:
        done = gw(*arguments, stdout=pipe)
    assert done.returncode == 0
    assert done.stderr == ""


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")
@pytest.mark.parametrize("arguments", [("schema",), ("info", "straight"), ("check", "straight")])
def test_data_that_cannot_be_written_ends_with_7(arguments):
    with open("/dev/full", "w") as full:
        done = gw(*arguments, stdout=full)
    assert done.returncode == 7
    assert "No space left" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_plain_terminal_gets_plain_text(tmp_path):
    plain = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "PYTHONIOENCODING": "ascii", "NO_COLOR": "1"}
    for arguments in (("check", "corner90-universal"), ("info", "straight"), ("--help",)):
        done = gw(*arguments, **plain)
        assert done.returncode == 0, done.stderr
        assert done.stdout.isascii()
        assert "\x1b" not in done.stdout


def test_a_name_beyond_ascii_comes_through(tmp_path):
    file = tmp_path / "größe.yaml"
    file.write_text("name: größe\nwire: 3\n", encoding="utf-8")
    done = gw("check", str(file), PYTHONUTF8="1")
    assert done.returncode == 3
    assert "größe.yaml:2: wire" in done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent in another way there")
@pytest.mark.parametrize("pause", [0.0, 0.3], ids=["at once", "a moment later"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_second_signal_gives_the_run_up(tmp_path, number, pause):
    # One output in the whole run, so that the first signal has nothing to stop at before the second comes.
    overrides = ("--set", "solver.step=0.5 ms", "--set", "output.interval=35 s")
    process = subprocess.Popen(
        [sys.executable, "-m", "gw_exudyn", "run", "corner90-universal", *overrides, "--out", "run"],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=ENVIRONMENT,
    )
    try:
        first = process.stderr.readline()
        assert "simulating" in first
        time.sleep(1.0)
        process.send_signal(number)
        assert "stopping" in process.stderr.readline()
        time.sleep(pause)
        process.send_signal(number)
        out, err = process.communicate(timeout=60)
    finally:
        process.kill()
        process.wait()
    assert process.returncode == 130, err
    assert err.splitlines()[-1] == "interrupted"
    assert "mistake" not in err
    assert "Traceback" not in out + err
    assert not (tmp_path / "run").exists()


def test_a_run_from_the_source_knows_its_version():
    code = "from gw_exudyn.result import software_versions; print(software_versions()['gw-exudyn'])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=ENVIRONMENT)
    assert done.stdout.strip() == gw_exudyn.__version__
