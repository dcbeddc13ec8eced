"""What cannot start: each problem with its place and its sentence, and all of them at once."""

from __future__ import annotations

import pytest
from model_cases import scenario

from gw_exudyn.errors import ScenarioError
from gw_exudyn.model import build


def problems(**changes):
    """(path, sentence) of all that keeps the scenario from starting."""
    with pytest.raises(ScenarioError) as caught:
        build(scenario(**changes))
    return [(problem.path, problem.message) for problem in caught.value.problems]


def test_the_plain_scenario_starts():
    build(scenario())


def test_a_wire_that_does_not_fit_the_bore():
    ((path, text),) = problems(catheter={"bore": 0.36e-3})
    assert path == "catheter.bore"
    assert text == (
        "0.36 mm is no wider than the wire, 0.36 mm; take a wider bore or a thinner wire (wire.diameter, wire.model)"
    )


@pytest.mark.parametrize("catheter", [{"exit": [-0.05, 0.0]}, {"exit": [0.05, 0.01]}, {"direction": 3.1}])
def test_an_exit_outside_the_lumen(catheter):
    ((path, text),) = problems(catheter=catheter)
    assert path == "catheter.exit"
    assert "is outside the lumen; move it inside, or turn catheter.direction" in text


def test_an_exit_that_looks_out_of_the_far_end():
    ((path, text),) = problems(catheter={"exit": [0.1, 0.0]})
    assert path == "catheter.exit"
    assert text.startswith("(100 mm, 0 mm) is outside the lumen")


def test_an_exit_too_near_a_wall():
    ((path, text),) = problems(catheter={"exit": [0.01, 1.9e-3], "bore": 0.5e-3})
    assert path == "catheter.exit"
    assert text == (
        "leaves 0.1 mm to the nearest wall of the vessel, less than the wire's radius 0.18 mm; "
        "move it away from the wall, or take a thinner wire"
    )


def test_a_bore_wider_than_the_lumen():
    ((path, text),) = problems(catheter={"bore": 4.1e-3})
    assert path == "catheter.bore"
    assert text == (
        "4.1 mm is wider than the lumen at the exit, where a wall of the vessel stands 2 mm from the catheter's axis; "
        "take a narrower bore, or move catheter.exit further into the lumen"
    )
    build(scenario(catheter={"bore": 4e-3}))
    build(scenario(catheter={"bore": 4e-3 + 1e-8}))  # rounded drawings


def test_a_slanted_wall_in_the_mouth():
    """The catheter comes through the lower wall at 45 degrees; its exit must be far enough in for all of its mouth."""
    assert problems(catheter={"exit": [0.05, -1.5e-3], "direction": 0.785, "bore": 1.5e-3})[0][0] == "catheter.bore"
    build(scenario(catheter={"exit": [0.05, -1.4e-3], "direction": 0.785, "bore": 1.5e-3}))


def test_a_wire_that_would_leave_the_catheter():
    ((path, text),) = problems(drive={"kind": "speed", "speed": 2e-3, "distance": 0.11})
    assert path == "drive"
    assert text == (
        "pushes 110 mm of a wire of 100 mm: its end would leave the catheter; "
        "push less far, or take a longer wire (wire.length)"
    )


def test_it_is_the_furthest_travel_that_counts():
    there_and_back = [{"speed": 2e-3, "distance": 0.12}, {"speed": -2e-3, "distance": 0.1}]
    assert problems(drive={"kind": "speed", "phases": there_and_back})[0][0] == "drive"
    build(scenario(drive={"kind": "speed", "phases": [{"speed": 2e-3, "distance": 0.09}] + there_and_back[1:]}))


def test_all_problems_come_at_once():
    found = problems(
        catheter={"exit": [-0.05, 0.0], "bore": 0.3e-3}, drive={"kind": "speed", "speed": 2e-3, "distance": 0.2}
    )
    assert [path for path, _ in found] == ["catheter.bore", "catheter.exit", "drive"]


def test_a_problem_knows_its_line(tmp_path):
    from gw_exudyn.scenario import load_scenario

    file = tmp_path / "tight.yaml"
    file.write_text(
        "wire: {model: universal-ii}\n"
        "vessel: {kind: straight, length: 100 mm, diameter: 4 mm}\n"
        "catheter:\n"
        "  bore: 0.3 mm\n"
        "drive: {kind: speed, speed: 2 mm/s, distance: 60 mm}\n"
    )
    with pytest.raises(ScenarioError) as caught:
        build(load_scenario(str(file)))
    (problem,) = caught.value.problems
    assert problem.line == 4
    assert str(problem).startswith(f"{file}:4: catheter.bore: 0.3 mm is no wider")
