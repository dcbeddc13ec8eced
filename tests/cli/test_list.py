"""What `gw-exudyn list` tells."""

from __future__ import annotations

import json

from gw_exudyn.scenario.catalogue import catalogue_names
from gw_exudyn.scenario.shipped import list_shipped


def test_wires_with_range_and_grade(gw):
    code, out, _ = gw("list", "wires")
    assert code == 0
    lines = {line.split()[0]: line for line in out.splitlines() if not line.startswith(" ")}
    assert set(lines) == set(catalogue_names())
    assert "EI 350 to 445 N*mm^2" in lines["heavy-duty-shaft"]
    assert "EI 1 N*mm^2 (0.8 to 1.5 N*mm^2) to 45 mm" in lines["universal-ii"]
    assert "grade D" in lines["universal-ii"]


def test_json_has_the_sources(gw):
    code, out, _ = gw("list", "wires", "--json")
    wires = json.loads(out)
    assert code == 0
    assert "Harrison" in wires["backup-meier-shaft"]["bending_stiffness"]["source"]
    assert wires["universal-ii"]["diameter"]["value"] == 0.36e-3


def test_scenarios(gw):
    assert [line.split()[0] for line in gw("list", "scenarios").out.splitlines()] == list(list_shipped())
    assert set(json.loads(gw("list", "scenarios", "--json").out)) == set(list_shipped())


def test_another_word_is_wrong_use(gw):
    code, _, err = gw("list", "vessels")
    assert code == 2
    assert "wires" in err
