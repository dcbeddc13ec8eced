"""Where the folder of an unpacked FMU forbids running: on a real mount with noexec, in a namespace of its own."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from gw_exudyn.errors import StorageError

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="mount namespaces are Linux's")

BOX = ("unshare", "--user", "--map-root-user", "--mount")
MOUNT = 'mount -t tmpfs -o noexec tmpfs "$0" && exec "$@"'

WORKER = """
import json, shutil, sys
from pathlib import Path
sys.path.insert(0, TESTS)
from hosts import Host
with Host(Path(FMU)) as host:
    host.edit_table("remedy ", "program worker\\nremedy ")
    resources = host.folder / "resources"
    shutil.copytree(resources, FORBIDDEN + "/resources")
    shutil.copy(shutil.which("true"), FORBIDDEN + "/resources/worker")
    shutil.rmtree(resources)
    resources.symlink_to(FORBIDDEN + "/resources")
    try:
        host.instantiate()
    except Exception:
        print(json.dumps(host.messages))
    else:
        print(json.dumps("an instance"))
"""


@pytest.fixture
def forbidden(tmp_path) -> Path:
    """An empty folder to mount on; skips where that is not allowed."""
    folder = tmp_path / "forbidden"
    folder.mkdir()
    if shutil.which("unshare") is None or shutil.which("mount") is None:
        pytest.skip("there is no unshare or mount here")
    tried = subprocess.run([*BOX, "sh", "-c", MOUNT, folder, "true"], capture_output=True, text=True, check=False)
    if tried.returncode != 0:
        pytest.skip(f"nothing may be mounted here: {tried.stderr.strip()}")
    return folder


def inside(folder: Path, *command: object, **environment: object) -> subprocess.CompletedProcess[str]:
    """A Python process that sees the folder without the permission to run."""
    variables = {**os.environ, **{name: str(value) for name, value in environment.items()}}
    whole = [*BOX, "sh", "-c", MOUNT, str(folder), sys.executable, *map(str, command)]
    return subprocess.run(whole, capture_output=True, text=True, timeout=300, env=variables, check=False)


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_worker_that_may_not_be_run_is_an_error_with_the_remedy(fmi, fmus, forbidden):
    names = {"TESTS": str(Path(__file__).parent), "FMU": str(fmus[fmi]), "FORBIDDEN": str(forbidden)}
    run = inside(forbidden, "-c", "".join(f"{name} = {value!r}\n" for name, value in names.items()) + WORKER)
    assert run.returncode == 0, run.stderr
    status, category, message = json.loads(run.stdout)[-1]
    assert (status, category) == (3, "logStatusError")
    assert "may not be run there (Permission denied): the folder forbids it (mount option noexec)" in message
    assert "TMPDIR" in message


def test_a_cache_that_forbids_running_is_left_alone(fmus, forbidden, tmp_path):
    out = tmp_path / "out"
    command = ("-m", "gw_exudyn", "fmu", "run", fmus[2], "--stop", "0.1", "--out", out)
    run = inside(forbidden, *command, XDG_CACHE_HOME=forbidden)
    assert run.returncode == 0, run.stderr
    assert (out / "outputs.csv").exists()


def test_where_nothing_may_run_the_remedy_is_told(fmus, forbidden, tmp_path):
    command = ("-m", "gw_exudyn", "fmu", "run", fmus[2], "--stop", "0.1", "--out", tmp_path / "out")
    run = inside(forbidden, *command, XDG_CACHE_HOME=forbidden, TMPDIR=forbidden)
    assert run.returncode == StorageError.exit_code, run.stderr
    assert f"{forbidden} forbids running what is in it (mount option noexec)" in run.stderr.replace("\n", " ")
    assert "TMPDIR" in run.stderr
    assert "Traceback" not in run.stderr
