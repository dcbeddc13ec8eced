"""Wires described by their core, and the factors of the bending stiffness."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gw_exudyn.errors import ScenarioError
from gw_exudyn.model.wire import build_wire, compliance
from gw_exudyn.scenario.loading import scenario_from_dict
from gw_exudyn.scenario.stiffness import pieces_before_step

OWN: dict[str, Any] = {"diameter": "0.36 mm", "length": "100 mm", "density": 6450}


def wire(**given: Any):
    rest = {
        "vessel": {"kind": "straight", "length": 0.15, "diameter": 0.004},
        "catheter": {"bore": 0.0012},
        "drive": {"kind": "speed", "speed": 0.002, "duration": 1},
    }
    return scenario_from_dict({"wire": OWN | given, **rest}).wire


TAPER = [
    {"from": "0 mm", "to": "40 mm", "core": ["0.08 mm", "0.3 mm"], "modulus": "60 GPa"},
    {"from": "40 mm", "to": "100 mm", "core": "0.3 mm", "modulus": "60 GPa"},
]


def test_a_tapered_core_bends_as_its_diameter_to_the_fourth():
    """Compliance of the taper, integral of 64 ds / (E pi d^4), is 64 L / (3 E pi (d2 - d1)) (1/d1^3 - 1/d2^3)."""
    pieces = wire(bending_stiffness=TAPER).bending_stiffness
    (found,) = compliance(pieces, np.array([0.0]), np.array([0.04]))
    thin, thick, modulus = 0.08e-3, 0.3e-3, 60e9
    exact = 64 * 0.04 / (3 * modulus * math.pi * (thick - thin)) * (1 / thin**3 - 1 / thick**3)
    assert found == pytest.approx(exact, rel=1e-3)
    assert pieces[-1].value == pytest.approx(modulus * math.pi / 64 * thick**4)
    assert pieces_before_step(pieces) == len(pieces)


@pytest.mark.parametrize("place", [0.001, 0.013, 0.033])
def test_between_its_rows_a_taper_is_off_by_less_than_a_thousandth(place):
    pieces = wire(bending_stiffness=TAPER).bending_stiffness
    (piece,) = [p for p in pieces if p.start < place <= p.end]
    core = 0.08e-3 + place / 0.04 * 0.22e-3
    assert piece.value_at(place) == pytest.approx(60e9 * math.pi / 64 * core**4, rel=1e-3)


def test_factors_act_before_and_behind_the_first_step():
    steps = [{"from": 0, "to": 0.04, "value": 1e-6}, {"from": 0.04, "to": 0.1, "value": 7e-6}]
    plain, changed = (
        wire(bending_stiffness=steps, **more) for more in ({}, {"stiffness_factor": {"tip": 0.5, "shaft": 2}})
    )
    assert [p.value for p in changed.effective_stiffness] == [0.5e-6, 14e-6]
    ratio = build_wire(changed).joint_stiffness / build_wire(plain).joint_stiffness
    assert (ratio[0], ratio[-1]) == (pytest.approx(2), pytest.approx(0.5))


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"bending_stiffness": [{"from": 0, "to": 0.1, "core": 1e-4}]}, "has only a core; give value"),
        ({"bending_stiffness": [{"from": 0, "to": 0.1, "modulus": 1e9}]}, "has only a modulus"),
        ({"bending_stiffness": [{"from": 0, "to": 0.1}]}, "has no bending stiffness"),
        ({"bending_stiffness": [{"from": 0, "to": 0.1, "value": 1e-6, "core": 1e-4}]}, "has a value and a core"),
        ({"bending_stiffness": 1e-6, "stiffness_factor": {"shaft": 2}}, "has no step; give tip alone"),
        ({"bending_stiffness": 1e-6, "stiffness_factor": {"tip": 0}}, "out of range"),
        ({"bending_stiffness": 1e-6, "floppy_tip": {"length": 0.08, "bending_stiffness": 1e-7, "taper": 0.03}}, "110"),
    ],
)
def test_what_is_wrong_is_told(given, sentence):
    with pytest.raises(ScenarioError, match=sentence):
        wire(**given)
