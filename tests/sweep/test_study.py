"""Study files: what they may say, and how everything that is wrong is told at once."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

from gw_exudyn.errors import ScenarioError, UsageError
from gw_exudyn.sweep.identity import PARTS, Maker, this_maker
from gw_exudyn.sweep.plan import Options, make_plan
from gw_exudyn.sweep.studies.loading import load_study

MAKER = Maker("runner", {"exudyn": "1"}, "abc")


def problems_of(file, *overrides: str) -> list[str]:
    with pytest.raises(ScenarioError) as caught:
        load_study(file, overrides)
    return [str(problem).replace(f"{file}:", "") for problem in caught.value.problems]


def column(study, path: str) -> list[float | str]:
    return [study.design.labels(point)[path] for point in range(len(study))]


def test_a_grid_is_all_combinations_the_last_parameter_fastest(study):
    found = study("contact.friction_coefficient: [0.1, 0.2]\nwire.diameter: [0.3 mm, 0.36 mm, 0.0004]")
    assert found.design.shape == (2, 3)
    assert column(found, "contact.friction_coefficient") == [0.1] * 3 + [0.2] * 3
    assert column(found, "wire.diameter") == [0.3e-3, 0.36e-3, 0.4e-3] * 2
    assert [axis.unit for axis in found.design.axes] == ["1", "m"]
    assert found.scenario(4).wire.diameter == 0.36e-3
    assert found.scenario(4).contact.friction_coefficient == 0.2
    assert found.scenario(4).wire.segments == 5


def test_spaced_values_have_the_parameters_unit_and_kind(study):
    vary = "wire.damping_time: {logspace: [1 ms, 100 ms, 3]}\nwire.segments: {linspace: [5, 11, 4]}"
    found = study(vary, set="{solver.step: 0.5 s, drive.distance: 4 mm}")
    assert column(found, "wire.damping_time")[::4] == pytest.approx([1e-3, 1e-2, 1e-1])
    assert [found.scenario(point).wire.segments for point in range(4)] == [5, 7, 9, 11]


def test_linspace_gives_the_numbers_that_a_person_would_write(study):
    found = study("contact.friction_coefficient: {linspace: [0.1, 0.5, 5]}")
    assert column(found, "contact.friction_coefficient") == [0.1, 0.2, 0.3, 0.4, 0.5]


def test_branches_are_varied_by_name(study):
    vary = "vessel.branches.left.angle: [50 deg, 60 deg]"
    found = study(vary, base="phantom-universal", set="{wire.segments: 50}")
    assert found.design.axes[0].unit == "rad"
    angles = [found.scenario(point).vessel.branches[1].angle for point in (0, 1)]
    assert angles == pytest.approx(np.deg2rad([50, 60]))


def test_what_is_wrong_with_branches_is_told_beside_the_rest(write_study):
    vary = (
        "vessel.branches.leff.angle: [50 deg]\n"
        "vessel.branches.left.angle: [7 N]\n"
        "vessel.branches.left.angel: [1]\n"
        "vessel.branches.angle: [1]\n"
        "contact.friction_coefficient: []"
    )
    told = problems_of(write_study(vary, base="phantom-universal", set="{wire.segments: 50}"))
    assert [line.partition(":")[0] for line in told] == ["4", "5", "6", "7", "8"]
    assert "by name trunk, left, right, target, upper" in told[0]
    assert "is a force, not an angle" in told[1]
    assert "did you mean 'angle'?" in told[2]


def test_a_mode_that_does_not_exist_is_told_alone(write_study):
    vary = "wire.segments: [5, 6]\ncontact.friction_coefficient: {uniform: [0.1, 0.2]}"
    told = problems_of(write_study(vary, mode="sampel", samples=12, set="{}"))
    assert len(told) == 1
    assert told[0].startswith("3: mode: 'sampel' is not known here; did you mean 'sample'?")


def test_wires_of_the_catalogue_and_labelled_parts_of_a_scenario(study):
    tips = "wire.tip_shape:\n  values: [{kind: straight}, {kind: arc, length: 5 mm, angle: 30 deg}]\n"
    found = study(f"wire.model: catalogue\n{tips}  labels: [straight, curved]")
    assert "universal-ii" in column(found, "wire.model")
    assert column(found, "wire.tip_shape")[:2] == ["straight", "curved"]
    assert found.scenario(1).wire.tip_shape.kind == "arc"


def test_zip_goes_along_all_parameters_at_once(study):
    found = study("contact.friction_coefficient: [0.1, 0.2]\nwire.diameter: [0.3 mm, 0.36 mm]", mode="zip")
    assert len(found) == 2
    assert found.scenario(1).wire.diameter == 0.36e-3


def test_points_from_a_csv_file(study, tmp_path):
    (tmp_path / "points.csv").write_text("wire.model,wire.diameter [mm]\nuniversal-ii,0.3\n\nuniversal-ii, 0.36\n")
    found = study("", mode="list", points="points.csv")
    assert column(found, "wire.diameter") == [0.3e-3, 0.36e-3]


def test_a_bad_row_is_told_with_its_line_beside_the_bad_values(write_study, tmp_path):
    (tmp_path / "points.csv").write_text("wire.diameter [mm],wire.segments\n0.36\nx,5\n0.36,5\n40,5\n")
    told = problems_of(write_study("", mode="list", points="points.csv"))
    assert [problem.partition("points.csv:")[2] for problem in told] == [
        "2: has 1 values, the first line 2",
        "3: wire.diameter: 'x' is no number; write it as 2.5 or 1e-3",
        "5: wire.diameter: 40 mm is outside the plausible 0.05 mm to 5 mm",
    ]


@pytest.mark.parametrize("method", ["latin-hypercube", "sobol", "sobol-indices", "morris"])
def test_a_sample_repeats_with_its_seed_and_changes_with_another(study, method):
    vary = "contact.friction_coefficient: {uniform: [0.1, 0.4]}\nwire.diameter: {normal: [0.36 mm, 0.01 mm]}"

    def drawn(seed: int) -> list[float | str]:
        return column(study(vary, mode="sample", samples=8, method=method, seed=seed), "wire.diameter")

    assert drawn(1) == drawn(1)
    assert drawn(1) != drawn(2)
    assert len(drawn(1)) == {"sobol-indices": 32, "morris": 24}.get(method, 8)


def test_samples_have_the_distributions_that_were_asked_for(study):
    vary = (
        "contact.friction_coefficient: {triangular: [0.1, 0.1, 0.4]}\n"
        "wire.diameter: {lognormal: [0.36 mm, 0.1], low: 0.3 mm, high: 0.5 mm}\n"
        "wire.segments: {uniform: [4, 9]}\n"
        "wire.model: [universal-ii, amplatz-super-stiff]"
    )
    found = study(vary, mode="sample", samples=512, method="sobol", set="{}")
    friction, diameter, segments = (
        np.array(column(found, path)) for path in ("contact.friction_coefficient", "wire.diameter", "wire.segments")
    )
    assert friction.mean() == pytest.approx(0.2, abs=1e-3)  # (a + b + c) / 3
    assert np.log(diameter / 0.36e-3).std() == pytest.approx(0.1, abs=0.01)
    assert diameter.min() >= 0.3e-3
    assert diameter.max() <= 0.5e-3
    assert set(segments) == {4, 5, 6, 7, 8, 9}
    assert column(found, "wire.model").count("universal-ii") == 256


def test_everything_wrong_with_a_study_is_told_at_once(write_study):
    vary = (
        "contact.frictoin: [1]\n"
        "wire.diameter: {linspace: [0.3 mm, 0.4 s, 3]}\n"
        "wire.damping_time: {uniform: [9 ms, 5 ms]}\n"
        "contact.friction_coefficient: [0.1, 5]\n"
        "wire.grading: [1, 2, -3]"
    )
    told = problems_of(write_study(vary, mode="gird", sett=3, metrics="[push_force_mx]"))
    expected = [
        "3: mode: 'gird' is not known here; did you mean 'grid'?",
        "4: sett: unknown key; did you mean 'set'?",
        "5: metrics.0: 'push_force_mx' is no metric of a run; did you mean 'push_force_max'",
        "7: vary.contact.frictoin: no scenario has this value; allowed there: friction_coefficient",
        "8: vary.wire.diameter.linspace.1: '0.4 s' is a time, not a length",
        "9: vary.wire.damping_time.uniform: low, 0.009, is not below high, 0.005",
        "10: contact.friction_coefficient: 5 is out of range; allowed: 0 to 2",
        "11: wire.grading: -3 is out of range; allowed: 0.05 to 50",
    ]
    assert [line[: len(start)] for line, start in zip(told, expected, strict=True)] == expected


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"mode": "sample"}, "samples: is missing"),
        ({"name": "../../etc"}, "name: '../../etc' cannot name a folder"),
        (
            {"mode": "sample", "samples": 12, "method": "sobol"},
            "12 is no power of 2, which Sobol's points need: 8 or 16",
        ),
        ({"samples": 4}, "samples: is for mode: sample; the mode is grid"),
        ({"vary": "wire.diameter: {normal: [0.3 mm, 0.1 mm]}"}, "a distribution is for mode: sample; the mode is grid"),
        (
            {"vary": "wire.diameter: [0.3 mm]\nwire.segments: [4, 5]", "mode": "zip"},
            "wire.diameter has 1, wire.segments has 2",
        ),
        ({"vary": "wire.segments: [4, 5]"}, "wire.segments: is varied as well; set it or vary it"),
        ({"vary": "", "mode": "list"}, "points: is missing"),
        ({"vary": ""}, "vary: is missing"),
        (
            {"base": "strait"},
            "base: strait: there is no such file, and no shipped scenario of that name; nearest: straight",
        ),
        ({"vary": "wire.model: {linspace: [1, 2, 3]}"}, "wire.model is no number; give a list of values"),
        ({"vary": "wire.diameter: 3"}, "3 is neither a list of values nor one of [value, ...]"),
        ({"vary": "wire.diameter: {linspace: [1 mm, 2 mm]}"}, "[first, last, count] is needed"),
        ({"vary": "wire.diameter: {logspace: [-1 mm, 2 mm, 3]}"}, "both ends must be positive"),
        ({"vary": "wire: [{model: universal-ii}]\nwire.diameter: [1 mm]"}, "a part of it is varied by another path"),
    ],
)
def test_what_a_study_needs_and_does_not_take(write_study, given, told):
    assert any(told in problem for problem in problems_of(write_study(**given)))


def test_overrides_are_for_all_points_and_not_for_what_is_varied(write_study):
    file = write_study()
    assert load_study(file, ["wire.segments=7"]).scenario(0).wire.segments == 7
    assert "is varied as well" in problems_of(file, "contact.friction_coefficient=0.3")[0]
    with pytest.raises(UsageError, match="is no override"):
        load_study(file, ["nonsense"])


def test_points_that_cannot_start_are_refused_with_the_line_of_their_value(study, tmp_path):
    found = study("wire.diameter: [0.36 mm, 1.5 mm]\ncontact.friction_coefficient: [0.1, 0.2]")
    with pytest.raises(
        ScenarioError, match=r"straight.yaml:\d+: catheter.bore: .*; first at point 2 \(wire.diameter 0.0015"
    ) as caught:
        make_plan(found, tmp_path / "out", Options())
    assert len(caught.value.problems) == 1  # the same for both frictions
    assert not (tmp_path / "out").exists()


def test_a_point_is_known_by_its_scenario_and_what_runs_it(study):
    one = study().scenario(0)
    mine = MAKER.point_id(one.to_dict())
    assert mine == MAKER.point_id(one.model_copy(update={"name": "another"}).to_dict())
    assert mine != MAKER.point_id(study().scenario(1).to_dict())
    assert mine != Maker("runner", {"exudyn": "2"}, "abc").point_id(one.to_dict())
    assert mine != Maker("runner", {"exudyn": "1"}, "abd").point_id(one.to_dict())
    assert mine != Maker("fmu", {"exudyn": "1"}, "abc").point_id(one.to_dict())
    assert this_maker("runner") == this_maker("runner")


def test_equal_points_are_one(study, tmp_path):
    plan = make_plan(study("wire.diameter: [0.36 mm, 0.00036]"), tmp_path / "out", Options())
    assert len(plan.ids) == 2
    assert plan.missing == (0,)


def test_the_shipped_study_is_sound(tmp_path):
    found = load_study("friction-and-wire")
    assert found.design.shape == (3, 4)
    assert len(make_plan(found, tmp_path / "out", Options()).missing) == 12
    with pytest.raises(ScenarioError, match="no shipped study of that name; nearest: friction-and-wire"):
        load_study("friction-and-wires")


def test_metrics_of_a_target_and_of_branches_are_those_of_the_base(tmp_path):
    (tmp_path / "study.yaml").write_text(
        "base: phantom-universal\nset: {wire.segments: 20, stop.target: {branch: target}}\n"
        "vary: {contact.friction_coefficient: [0.1, 0.2]}\nmetrics: [target_reached, contact_time_left]\n"
    )
    study = load_study(tmp_path / "study.yaml")
    assert study.metrics[0] in study.metric_table
    (tmp_path / "plain.yaml").write_text(
        "base: straight\nvary: {contact.friction_coefficient: [0.1, 0.2]}\nmetrics: [target_reached]\n"
    )
    with pytest.raises(ScenarioError, match=r"plain.yaml:3: metrics.0: 'target_reached' is no metric of a run"):
        load_study(tmp_path / "plain.yaml")


def test_all_that_a_run_imports_counts_for_its_id():
    done = subprocess.run(
        [sys.executable, "-c", _IMPORTED],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    counted = {part.removesuffix(".py") for part in PARTS}
    # What hands a point on, writes it down or words a mistake; a change there changes no number.
    others = {"__init__", "errors", "native", "sweep", "storage", "plots"}
    imported = set(done.stdout.split())
    assert {"engine", "metrics", "events"} <= imported
    assert imported <= counted | others


_IMPORTED = """
import sys
from gw_exudyn.scenario import load_scenario
from gw_exudyn.sweep.runner import SIMULATION, Task, make_runner
scenario = load_scenario("straight", ["wire.segments=5", "drive.distance=1 mm"]).to_dict()
assert make_runner(SIMULATION).run(Task("id", scenario)).trusted
print(*{name.split(".")[1] for name in sys.modules if name.startswith("gw_exudyn.")})
"""
