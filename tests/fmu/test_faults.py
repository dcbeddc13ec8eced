"""What goes wrong gets the standard's status and a sentence that says what to do; no orphan, no dead host."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from pathlib import Path

import pytest
from fmpy.fmi1 import FMICallException
from hosts import DISCARD, ERROR, FATAL, OK, WARNING, Host, alive, children

from gw_exudyn import __version__
from gw_exudyn.errors import ScenarioError
from gw_exudyn.fmi.overriding import overridden

REMEDY = f"install it with `pip install .` in a checkout of gw-exudyn {__version__}, and let"
linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks into /proc")


def gone(process: int, within: float = 5.0) -> bool:
    until = time.monotonic() + within
    while alive(process) and time.monotonic() < until:
        time.sleep(0.01)
    return not alive(process)


@linux
def test_a_worker_that_is_killed_is_fatal_and_a_new_instance_works(fmu):
    with Host(fmu).start() as other, Host(fmu).start() as host:
        os.kill(host.worker(), signal.SIGKILL)
        assert host.step(0.05)["status"] == FATAL
        assert "worker process has ended" in host.messages[-1][2]
        assert "new instance" in host.messages[-1][2]
        assert host.step(0.05)["status"] == ERROR
        assert other.step(0.05)["status"] == OK
        host.free()
        assert host.start().step(0.05)["status"] == OK


@linux
def test_a_worker_that_hangs_is_fatal_after_the_timeout(fmu):
    with Host(fmu).start() as host:
        worker = host.worker()
        host.set("worker.timeout", 0.3)  # a tunable parameter
        os.kill(worker, signal.SIGSTOP)
        begin = time.monotonic()
        assert host.step(0.05)["status"] == FATAL
        assert 0.2 < time.monotonic() - begin < 10
        assert "no sign of life for 0.3 s" in host.messages[-1][2]
        assert gone(worker)


def test_a_parameter_out_of_range_is_told_with_what_is_allowed(fmu):
    with Host(fmu).instantiate() as host:
        with pytest.raises(FMICallException) as error:
            host.start({"contact.friction_coefficient": 3.0, "wire.segments": 0})
        assert error.value.status == ERROR
        text = host.messages[-1][2]
        assert "contact.friction_coefficient: 3.0 is out of range; allowed: 0 to 2" in text
        assert "wire.segments" in text
        host.calls.reset()
        host.start()
        assert host.step(0.05)["status"] == OK


@pytest.mark.parametrize(
    "name", ["wire.bending_stiffness.factor", "wire.bending_stiffness[1].factor"], ids=["whole wire", "piece"]
)
@pytest.mark.parametrize("factor", [0.0, -1.0, 5000.0, math.nan])
def test_a_stiffness_factor_out_of_range_is_told_beside_all_else(scenario, name, factor):
    for others in ({}, {"contact.friction_coefficient": 9.0}):
        with pytest.raises(ScenarioError) as error:
            overridden(scenario, {name: factor, **others})
        assert f"{name}: {factor:g} is out of range; allowed: 0.001 to 1000" in str(error.value)
        assert [problem.path for problem in error.value.problems] == [*others, name]


def test_a_mistake_is_told_once_by_the_parameters_name(scenario):
    with pytest.raises(ScenarioError) as error:
        overridden(scenario, {"contact.friction_coefficient": 3.0, "tip.dead_force[0]": 1000.0})
    told = sorted(str(error.value).splitlines())
    assert told[0].startswith("contact.friction_coefficient: 3.0 is out of range")
    assert told[1].startswith("tip.dead_force[0]: ")
    assert "override" not in str(error.value)


def test_a_speed_that_is_no_number_is_an_error(fmus):
    with Host(fmus[2]).start() as host:
        for value in (float("nan"), float("inf")):
            host.set("command.speed", value)
            assert host.step(0.05)["status"] == ERROR
            assert "finite number" in host.messages.pop()[2]
            host.calls.reset()
            host.start()


def test_a_speed_that_pulls_the_wire_out_is_an_error_and_names_the_limits(fmus):
    with Host(fmus[2]).start() as host:
        host.set("command.speed", 1.0)
        assert host.step(10.0)["status"] == ERROR
        assert "guided from" in host.messages[-1][2]


def test_a_scenario_file_that_is_not_there(fmus):
    with Host(fmus[2]).instantiate() as host:
        with pytest.raises(FMICallException):
            host.start({"scenarioFile": "nowhere.yaml"})
        assert "nowhere.yaml: there is no such file" in host.messages[-1][2]


def failed_start(host: Host) -> str:
    with pytest.raises(Exception, match=r"(?i)instantiate"):
        host.instantiate()
    host.calls = None
    assert host.messages[-1][0] == ERROR
    return host.messages[-1][2]


def test_no_python(fmus, monkeypatch):
    monkeypatch.setenv("GW_EXUDYN_PYTHON", "/nowhere/python")
    with Host(fmus[2]) as host:
        text = failed_start(host)
    assert "'/nowhere/python' can't be started" in text
    assert REMEDY in text
    assert "GW_EXUDYN_PYTHON" in text


def test_a_python_that_may_not_run(fmus, monkeypatch, tmp_path):
    python = tmp_path / "python"
    python.write_text("#!/bin/sh\n")
    python.chmod(0o644)
    monkeypatch.setenv("GW_EXUDYN_PYTHON", str(python))
    with Host(fmus[2]) as host:
        assert "Permission denied" in failed_start(host)


def test_a_python_without_the_package(fmus, monkeypatch, tmp_path):
    python = tmp_path / "python"
    python.write_text("#!/bin/sh\necho \"No module named 'gw_exudyn'\" >&2\nexit 1\n")
    python.chmod(0o755)
    monkeypatch.setenv("GW_EXUDYN_PYTHON", str(python))
    with Host(fmus[2]) as host:
        text = failed_start(host)
    assert "No module named 'gw_exudyn'" in text
    assert REMEDY in text


def test_another_version_of_the_package(fmus):
    with Host(fmus[2]) as host:
        host.edit_table("version ", "version 9.")
        text = failed_start(host)
    assert "has version" in text
    assert "was made by 9." in text


@pytest.mark.parametrize(
    ("damage", "sentence"),
    [
        (lambda table: table.unlink(), "can't be read"),
        (lambda table: table.write_text(table.read_text() + "variable Q\n"), "is not understood"),
        (lambda table: table.write_bytes(b"\x00" * 100), "no table"),
        (lambda table: table.write_text(""), "cut short"),
    ],
)
def test_a_damaged_table(fmus, damage, sentence):
    with Host(fmus[2]) as host:
        damage(host.table)
        assert sentence in failed_start(host)


def test_a_token_of_another_fmu(fmus):
    with Host(fmus[2]) as host:
        host.edit_table("token {", "token {x")
        assert "is not this FMU's" in failed_start(host)


def test_a_resource_file_that_is_missing(fmus):
    with Host(fmus[2]) as host:
        (host.folder / "resources" / "scenario.json").unlink()
        with pytest.raises(FMICallException):
            host.start()
        assert "scenario.json" in host.messages[-1][2]
        assert "export the FMU again" in host.messages[-1][2]


def test_a_run_that_cannot_go_on_ends_as_the_standard_has_it(fmus, tmp_path):
    """A wire pushed against a closed end by force of a large step: the checks end the run."""
    from gw_exudyn.fmi.export import export
    from gw_exudyn.scenario import scenario_from_dict

    jammed = scenario_from_dict(
        {
            "name": "jam",
            "wire": {"model": "amplatz-super-stiff", "segments": 12},
            "vessel": {"kind": "straight", "length": "20 mm", "diameter": "1.0 mm", "end": "dead"},
            "catheter": {"bore": "1.0 mm"},
            "contact": {"wall_stiffness": "50 N/m"},
            "drive": {"kind": "speed", "speed": "10 mm/s", "distance": "60 mm"},
        }
    )
    for fmi in (2, 3):
        with Host(export(jammed, tmp_path / f"jam{fmi}.fmu", fmi)).start() as host:
            end = host.step(5.0)
            assert end["terminate"]
            assert 1.5 < end["reached"] < 5.0
            assert host.get("status.code") != 0
            assert "trusted" in host.get("status.message")
            assert host.get("insertion.depth") == pytest.approx(0.01 * end["reached"])
            if fmi == 2:
                assert end["status"] == DISCARD
            else:
                assert end["status"] == WARNING
                assert end["early"]
            assert host.step(0.1)["status"] == ERROR
        with Host(tmp_path / f"jam{fmi}.fmu", early_return=False).start() as host:
            assert not host.step(5.0)["early"]


HOST = """
import sys, time
sys.path.insert(0, {tests!r})
from hosts import Host
host = Host({fmu!r}).start()
print(host.worker(), flush=True)
{busy}
"""


@linux
@pytest.mark.parametrize(
    "busy",
    ["time.sleep(60)", "host.step(50.0)", "import os\nif os.fork() == 0: time.sleep(3)\nhost.step(50.0)"],
    ids=["idle", "busy", "busy, with a fork that holds copies"],
)
def test_the_worker_ends_when_its_host_is_killed(fmus, busy):
    script = HOST.format(tests=str(Path(__file__).parent), fmu=str(fmus[2]), busy=busy)
    host = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    worker = int(host.stdout.readline())
    time.sleep(0.3)
    assert alive(worker)
    host.kill()
    host.wait()
    host.stdout.close()
    assert gone(worker)


@linux
def test_a_worker_outlives_the_thread_that_made_it(fmus):
    """Hosts instantiate in one thread and step in another."""
    host = Host(fmus[2])
    thread = threading.Thread(target=host.start)
    thread.start()
    thread.join()
    time.sleep(0.1)
    with host:
        assert host.step(0.05)["status"] == OK


@linux
def test_no_worker_is_left_after_the_instances_are_freed(fmu):
    before = set(children(os.getpid()))
    with Host(fmu).start(), Host(fmu).start():
        pass
    assert set(children(os.getpid())) <= before


@linux
def test_the_worker_loads_while_the_host_prepares(fmus):
    """Without any request."""
    with Host(fmus[2]).instantiate() as host:
        maps = Path(f"/proc/{host.worker()}/maps")
        until = time.monotonic() + 30
        while "exudynCPP" not in maps.read_text() and time.monotonic() < until:
            time.sleep(0.02)
        assert "exudynCPP" in maps.read_text()
        host.start()
        assert host.step(0.05)["status"] == OK


@linux
def test_ctrl_c_in_the_terminal_is_the_hosts_alone(fmus):
    with Host(fmus[2]).start() as host:
        assert os.getpgid(host.worker()) != os.getpgid(0)


def test_the_hosts_python_variables_do_not_reach_the_worker(fmus, monkeypatch):
    monkeypatch.setenv("PYTHONHOME", "/nowhere")
    monkeypatch.setenv("PYTHONSTARTUP", "/nowhere")
    monkeypatch.setenv("LD_PRELOAD", "")
    with Host(fmus[2]).start() as host:
        assert host.step(0.05)["status"] == OK


def test_what_the_model_prints_does_not_upset_the_channel(fmus, tmp_path):
    """Exudyn prints to stdout from C++; here so much that no pipe would hold it."""
    script = tmp_path / "noisy.py"
    script.write_text(
        textwrap.dedent(
            """
            import os, sys
            for _ in range(100):
                os.write(1, b"x" * 10000)
            from gw_exudyn.fmi.worker import main
            os.set_blocking(2, False)
            try:
                os.write(2, b"y" * 1000000)
            except BlockingIOError:
                pass
            main(sys.argv[1:])
            """
        )
    )
    with Host(fmus[2]) as host:
        host.edit_table("argument -m\nargument gw_exudyn.fmi.worker", f"argument {script}")
        host.start()
        assert host.step(0.05)["status"] == OK
