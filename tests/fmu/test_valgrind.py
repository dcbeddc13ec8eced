"""Hosts in C with the wrapper as it is shipped, under valgrind: no access that is wrong, no leak, no file left open."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest
import standin as stand

from gw_exudyn.fmi.wrapper.build import fmi_headers

ROUNDS = 9  # each way in which the stand-in ends a step


@pytest.fixture(scope="module")
def life(tmp_path_factory) -> Path:
    source = Path(__file__).with_name("life.c")
    return stand.compile_c(source, tmp_path_factory.mktemp("life") / "life", f"-I{fmi_headers()}", "-ldl", "-g")


@pytest.mark.parametrize("version", [2, 3])
def test_a_whole_life_is_clean(life, native, standin, version):
    if shutil.which("valgrind") is None:
        pytest.skip("valgrind is not installed")
    check = ["valgrind", "--error-exitcode=9", "--leak-check=full", "--errors-for-leak-kinds=all", "--track-fds=yes"]
    check += ["--show-leak-kinds=all", "--trace-children=no"]
    command = [*check, life, str(version), native, f"{standin}/", stand.TOKEN, str(ROUNDS)]
    run = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stderr[-4000:]
    assert "ERROR SUMMARY: 0 errors" in run.stderr
    # Those of the host itself: the three standard streams, and what it inherited.
    left = re.findall(r"Open (AF_UNIX socket|file descriptor)[^\n]*\n(?!\s+<inherited)", run.stderr)
    assert [kind for kind in left if "socket" in kind] == [], run.stderr[-4000:]
