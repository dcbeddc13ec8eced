"""Small studies, and the environment in which children find the runners of the tests."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

import gw_exudyn
from gw_exudyn.sweep.studies.loading import load_study
from gw_exudyn.sweep.studies.study import Study

HERE = Path(__file__).parent
PATHS = os.pathsep.join([str(Path(gw_exudyn.__file__).parents[1]), str(HERE)])
TRIVIAL = "{wire.segments: 5, solver.step: 0.5 s, output.interval: 0.5 s, drive.distance: 4 mm}"


@pytest.fixture(autouse=True)
def _own_world(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", PATHS)


@pytest.fixture
def write_study(tmp_path) -> Callable[..., Path]:
    """Write a study of trivial points: `write_study(vary="...", mode="grid")`."""

    def write(
        vary: str = "contact.friction_coefficient: [0.1, 0.2]", base: str = "straight", **further: object
    ) -> Path:
        given = {"base": base, "set": TRIVIAL, **further}
        lines = [f"{key}: {value}" for key, value in given.items()]
        if vary:
            lines += ["vary:", *(f"  {line}" for line in vary.splitlines())]
        file = tmp_path / "study.yaml"
        file.write_text("\n".join(lines) + "\n")
        return file

    return write


@pytest.fixture
def study(write_study) -> Callable[..., Study]:
    """Write a study and load it."""
    return lambda *args, **given: load_study(write_study(*args, **given))
