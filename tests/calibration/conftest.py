"""Calibration files, and the environment in which children find the package."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from calibration_cases import FILE

import gw_exudyn


@pytest.fixture(autouse=True)
def _own_world(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(Path(gw_exudyn.__file__).parents[1]))


@pytest.fixture
def write() -> Callable[..., Path]:
    """Write measured files of a line that nothing but their reader understands, and a calibration file."""

    def made(text: str = FILE) -> Path:
        Path("camera.csv").write_text("time [s],tip_x [mm],tip_y [mm]\n0,0,0\n1,2,0\n2,4,0\n3,6,0\n")
        Path("cell.csv").write_text("time [s],push_force [mN]\n0,0\n1,0.1\n2,0.3\n")
        Path("fit.yaml").write_text(text)
        return Path("fit.yaml")

    return made
