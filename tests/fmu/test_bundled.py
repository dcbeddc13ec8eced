"""The FMU with its own Python: the same numbers where there is neither Python nor libGL nor X11 nor an environment."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import zipfile
from importlib.util import find_spec
from pathlib import Path

import pytest
from fmpy.validation import validate_fmu
from hosts import OK, WARNING, Host
from standin import sanitizers
from test_hosts import BARE, NAMES, STEP, STEPS, build

from gw_exudyn.errors import UsageError
from gw_exudyn.fmi import bundle
from gw_exudyn.fmi.export import export
from gw_exudyn.scenario import list_shipped

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="FMUs are bundled on Linux alone")


@pytest.fixture(scope="module")
def bundled(scenario, tmp_path_factory) -> Path:
    if find_spec("PyInstaller") is None:
        pytest.skip("PyInstaller (extra bundle) is not installed")
    return export(scenario, tmp_path_factory.mktemp("bundled") / "own.fmu", 3, bundled=True)


def test_it_runs_in_a_root_with_nothing_but_the_c_library(bundled, fmus, tmp_path):
    from gw_exudyn.fmi.wrapper.build import fmi_headers

    if sanitizers():
        pytest.skip("`make sanitize`: the sanitizers' libraries are not in the box")
    if shutil.which("bwrap") is None:
        pytest.skip("bubblewrap is not installed")
    with Host(fmus[3]).start() as host:
        for _ in range(STEPS):
            host.step(STEP)
        values = {name: host.get(name) for name in NAMES}
    program = build(BARE, tmp_path, f"-I{fmi_headers()}", f"-DSTEPS={STEPS}", "-ldl")
    # As a host's unzip leaves it: nothing may be run.
    with zipfile.ZipFile(bundled) as archive:
        archive.extractall(tmp_path / "fmu")
    linked = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
    libc = Path(re.search(r"=> (\S+/libc\.so\.6)", linked)[1]).parent
    loader = re.search(r"(/lib\S*/ld-linux\S+)", linked)[1]
    binds = [item for name in ("libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "librt.so.1", "libutil.so.1")
             for item in ("--ro-bind", str(libc / name), str(libc / name)) if (libc / name).exists()]  # fmt: skip
    box = ["bwrap", "--unshare-all", "--die-with-parent", "--clearenv", "--dev", "/dev", "--proc", "/proc"]
    box += ["--ro-bind", loader, loader, *binds, "--bind", str(tmp_path), "/own"]
    if subprocess.run([*box, "/own/host"], capture_output=True, check=False).returncode != 2:
        pytest.skip("bubblewrap may not be used here")
    with Host(bundled) as host:
        library = next((tmp_path / "fmu" / "binaries").rglob("*.so")).relative_to(tmp_path)
        references = [str(host.variables[name].valueReference) for name in NAMES]
        token = host.description.guid
    command = [*box, "/own/host", f"/own/{library}", "/own/fmu/resources/", token, *references]
    run = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert run.returncode == 0, run.stderr[-2000:]
    assert [float(line) for line in run.stdout.split()] == pytest.approx(list(values.values()), rel=1e-9)


def test_what_it_holds(bundled):
    assert bundled.stat().st_size < 50e6
    assert validate_fmu(str(bundled)) == []
    with zipfile.ZipFile(bundled) as archive:
        names = archive.namelist()
        text = archive.read(bundle.LICENCES).decode()
    assert [name for name in names if name.startswith("binaries/")] == [f"binaries/{bundle.this_platform()}/arc90.so"]
    assert not [name for name in names if "readline" in name]
    for part in ("exudyn", "numpy", "shapely", "Python 3", "libstdc++"):
        assert f"\n{part}" in text


DRAWN = """
name: drawn
wire: {model: universal-ii, segments: 20}
vessel: {kind: polygon, file: lumen.svg, length: 120 mm}
catheter: {exit: [1 mm, 2 mm], direction: 0 deg, bore: 1.2 mm}
contact: {friction_coefficient: 0.4}
drive: {kind: speed, speed: 2 mm/s, distance: 10 mm}
"""


def test_every_shipped_scenario_runs_in_it_and_one_with_a_drawing(bundled, tmp_path):
    """What is left out of it is needed by none."""
    (tmp_path / "drawn.yaml").write_text(DRAWN)
    path = '<path d="M 0 80 L 32 80 V 20 h -4 v 56 H 0 Z"/>'
    (tmp_path / "lumen.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 120 80">{path}</svg>')
    with Host(bundled).instantiate() as host:
        for name in (*list_shipped(), str(tmp_path / "drawn.yaml")):
            host.start({"scenarioFile": name})
            end = host.step(0.05)
            assert end["status"] in (OK, WARNING), (name, host.messages)
            assert host.get("solver.steps") > 0
            host.calls.reset()


def test_a_system_that_is_too_old_is_told_what_it_needs(bundled):
    with Host(bundled) as host:
        assert host.description.coSimulation.needsExecutionTool is False
        need = re.search(r"^glibc (2\.\d+)$", host.table.read_text(), re.MULTILINE)[1]
        host.edit_table(f"glibc {need}", "glibc 2.999")
        with pytest.raises(Exception, match="nstan"):
            host.instantiate()
        assert "needs glibc 2.999 or newer, and this system has 2." in host.messages[-1][2]


def test_a_folder_that_forbids_running_is_told(fmus):
    with Host(fmus[2]) as host:
        # A folder can't be run either: the system answers as on a mount without the permission.
        (host.folder / "resources" / "worker").mkdir()
        host.edit_table("remedy ", "program worker\nremedy ")
        with pytest.raises(Exception, match="nstan"):
            host.instantiate()
        assert "the folder forbids it" in host.messages[-1][2]
        assert "TMPDIR" in host.messages[-1][2]


def test_without_the_packager_it_is_told(scenario, tmp_path, monkeypatch):
    monkeypatch.setattr(bundle, "find_spec", lambda name: None)
    with pytest.raises(UsageError, match=r"pip install '\.\[bundle\]'` in the checkout"):
        export(scenario, tmp_path / "a.fmu", bundled=True)
