"""The calibration file: what it gives, and everything that is wrong with it at once, by line."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from calibration_cases import BASE, FILE, FRICTION, TIP

from gw_exudyn.calibration import load_calibration
from gw_exudyn.errors import ScenarioError


def problems(path: Path) -> list[str]:
    with pytest.raises(ScenarioError) as caught:
        load_calibration(path)
    return [str(problem) for problem in caught.value.problems]


def test_a_good_file_gives_parameters_noise_and_scenarios(write):
    text = FILE.replace("low: 0.05", "low: 0.1") + "  catheter.direction: {start: 5 deg, low: -10 deg, high: 10 deg}\n"
    found = load_calibration(write(text))
    assert (found.name, found.base, found.align) == ("fit", BASE, False)
    assert [one.path for one in found.parameters] == [FRICTION, TIP, "catheter.direction"]
    turn = found.parameters[2]
    assert (turn.unit, turn.told, turn.text(turn.start)) == ("rad", "deg", "5 deg")
    assert turn.high == pytest.approx(math.radians(10))
    assert found.noise == {"tip": pytest.approx(0.1e-3), "push_force": pytest.approx(0.1e-3)}
    scenario = found.scenario(found.start())
    assert scenario.contact.friction_coefficient == pytest.approx(0.3, rel=1e-12)
    assert scenario.wire.segments == 20
    # The ends are hit to the last digit, whatever the rounding of the range.
    assert found.values([1.0, 1.0, 1.0])[:2] == [0.6, 2.0]


def test_all_mistakes_are_told_at_once_with_their_lines(write):
    told = problems(
        write(
            """base: corner90-universal
measured: [camera.csv, nothing.csv]
noise: {tip: 0.2 s, push_forc: 2 mN}
fit:
  contact.friction: {start: 0.3, low: 0, high: 1}
  wire.segments: {start: 20, low: 10, high: 30}
  wire.model: {start: 20, low: 10, high: 30}
  wire.diameter: {start: 0.36 mm, low: 0.5 mm, high: 0.4 mm}
  wire.stiffness_factor.tip: {start: 3, low: 1, high: 2, hihg: 2}
  catheter.bore: 3
  contact.friction_coefficient: {start: 0.3, low: -1, high: 1}
algin: true
"""
        )
    )
    text = "\n".join(told)
    for line, words in {
        2: "there is no such file; give a CSV file",
        3: "noise.push_forc: is no quantity; did you mean 'push_force' or",
        5: "fit.contact.friction: no scenario has this value; did you mean",
        6: "fit.wire.segments: takes whole numbers; what is fitted has to be a real number",
        7: "fit.wire.model: takes no number",
        8: "fit.wire.diameter: low '0.5 mm' is not below high '0.4 mm'",
        9: "fit.wire.stiffness_factor.tip.hihg: unknown key; did you mean 'high'?",
        10: "fit.catheter.bore: 3 stands where {start: ..., low: ..., high: ...} is needed",
        11: "contact.friction_coefficient: -1.0 is out of range; allowed: 0 to 2",
        12: "algin: unknown key; did you mean 'align'?",
    }.items():
        (found,) = [one for one in told if words in one]
        assert found.startswith(f"fit.yaml:{line}: "), text
    assert "fit.yaml:3: noise.tip: '0.2 s' is a time, not a length" in text
    assert len(told) == 11, text


def test_noise_has_to_fit_what_is_measured(write):
    told = problems(write(FILE.replace("{tip: 0.1 mm, push_force: 0.1 mN}", "{tip: 0.1 mm, tip_force: 1 mN}")))
    assert told == [
        "fit.yaml:4: noise: push_force is measured, and its noise is missing: a standard deviation, or off to leave "
        "it out",
        "fit.yaml:4: noise.tip_force: is measured by no file; measured: push_force, tip",
    ]
    assert load_calibration(write(FILE.replace("0.1 mm", "off"))).noise == {"push_force": pytest.approx(0.1e-3)}
    told = problems(write(FILE.replace("0.1 mm", "off").replace("0.1 mN", "off")))
    assert told == ["fit.yaml:4: noise: everything is off, so there is nothing to fit to"]
    told = problems(write(FILE.replace("0.1 mm", "off") + "align: true\n"))
    assert told == ["fit.yaml:8: align: turns measured paths, and no path is fitted to; remove it"]


def test_what_lacks_and_what_is_given_twice(write):
    assert [one.partition(": ")[2].partition(":")[0] for one in problems(write("base: straight\n"))] == [
        "measured",
        "noise",
        "fit",
    ]
    (told,) = problems(write(FILE.replace("set: {", f"set: {{{FRICTION}: 0.2, ")))
    assert told == f"fit.yaml:2: {FRICTION}: is fitted as well; set it or fit it"
    (told,) = problems(write(FILE.replace("arc90", "arc9")))
    assert "fit.yaml:1: base: arc9: there is no such file" in told
    with pytest.raises(ScenarioError, match=r"set wire.segments: wire.segments: 'many'"):
        load_calibration(write(), ["wire.segments=many"])


def test_a_scenario_that_cannot_start_is_told(write):
    (told,) = problems(write(FILE.replace("drive.distance: 45 mm", "drive.distance: 300 mm")))
    assert "arc90.yaml:21: drive: pushes 300 mm of a wire of 150 mm" in told
    assert told.endswith(f"; first at point 0 ({FRICTION} 0.3, {TIP} 1.0)")
