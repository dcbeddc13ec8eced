"""`gw-exudyn animate`: a moving picture, whole or not at all."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from PIL import Image


@pytest.fixture
def run(gw, solver) -> str:
    return gw("run", "arc90", "-q", "--no-figures").out.strip()


def test_a_gif_of_as_many_frames_as_there_are_outputs(gw, run):
    outcome = gw("animate", run)
    file = Path(run, "figures", "animation.gif")
    assert (outcome.code, outcome.out.strip()) == (0, str(file))
    with Image.open(file) as picture:
        assert picture.n_frames == 5
        first = picture.convert("RGB").tobytes()
        picture.seek(4)
        assert picture.convert("RGB").tobytes() != first
    assert [path.name for path in file.parent.iterdir()] == ["animation.gif"]


def test_fewer_frames(gw, run):
    gw("animate", run, "-o", "short.gif", "--frames", "3")
    with Image.open("short.gif") as picture:
        assert picture.n_frames == 3


@pytest.mark.parametrize(
    ("name", "code", "sentence"), [("a.avi", 2, ".gif or .mp4"), ("taken/a.gif", 7, "name another place")]
)
def test_a_file_that_cannot_be_made(gw, run, name, code, sentence):
    Path("taken").touch()
    outcome = gw("animate", run, "-o", name)
    assert outcome.code == code
    assert sentence in outcome.err


def test_mp4_needs_ffmpeg(gw, run, monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda name: None)
    outcome = gw("animate", run, "-o", "a.mp4")
    assert outcome.code == 7
    assert "ffmpeg is not there" in outcome.err
