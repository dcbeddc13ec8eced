"""`check --draw`: the picture is written, shows what it should, and only where it may."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gw_exudyn import model
from gw_exudyn.cli.draw import _drawing
from gw_exudyn.plots.drawing import plot_drawing
from gw_exudyn.scenario import list_shipped, load_scenario


@pytest.mark.parametrize(("given", "file"), [([], "phantom-universal.png"), (["phantom.pdf"], "phantom.pdf")])
def test_a_picture_is_written_where_asked(gw, given, file):
    outcome = gw("check", "phantom-universal", "--draw", *given)
    assert outcome.code == 0
    assert outcome.err == f"drawn: {file}\n"
    assert Path(file).read_bytes()[:4] in (b"\x89PNG", b"%PDF")


def test_a_name_that_is_no_picture_is_refused_before_anything_is_written(gw):
    outcome = gw("check", "straight", "--draw", "straight.yaml")
    assert outcome.code == 2
    assert ".png, .pdf, .svg" in outcome.err
    assert not list(Path().iterdir())


@pytest.mark.parametrize("name", list_shipped())
def test_the_picture_holds_everything(name):
    built = model.build(load_scenario(name))
    drawing = _drawing(built)
    texts = {text.get_text() for text in plot_drawing(drawing).axes[0].texts}
    legend = {text.get_text() for text in plot_drawing(drawing).legends[0].get_texts()}
    branches = set(built.scenario.vessel.branch_names) - {"lumen"}
    assert branches <= texts
    assert {"wall", "corner", "open end", "catheter", "wire at its start"} == legend


def test_places_are_those_of_the_scenario():
    built = model.build(
        load_scenario("phantom-universal", {"catheter.exit": [1e-3, 1.5e-3], "catheter.direction": 0.1})
    )
    drawing = _drawing(built)
    # The tip at the exit, the wire behind it against the catheter's direction.
    assert drawing.wire[-1] == pytest.approx([1e-3, 1.5e-3])
    assert drawing.wire[0] == pytest.approx(np.array([1e-3, 1.5e-3]) - 0.15 * np.array([np.cos(0.1), np.sin(0.1)]))
    # The trunk's inlet, 8 mm wide, across the origin; three open ends beyond.
    inlet = next(end for end in drawing.open_ends if np.abs(end[:, 0]).max() < 1e-9)
    assert sorted(inlet[:, 1]) == pytest.approx([-4e-3, 4e-3])
    assert len(drawing.open_ends) == 4
