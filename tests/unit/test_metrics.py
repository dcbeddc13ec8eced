"""Metrics: numbers that can be checked by hand on a small result."""

from __future__ import annotations

import numpy as np
import pytest
from synthetic import FROM_TIP, StandInScenario, made_up_result, sample

from gw_exudyn.metrics import LEAST_WORK, metrics
from gw_exudyn.quantities import CONTACT_FIELDS
from gw_exudyn.result import Result, SnapEvent, Status, StatusReport
from gw_exudyn.scenario.stop import StopSpec
from gw_exudyn.scenario.vessels.branches import BranchesVessel
from gw_exudyn.trust import ENERGY_FLOOR


def small(snaps=(), peaks=None, scenario=None, **series):
    """A result of as many instants, one second apart, as each given series has values."""
    count = len(next(iter(series.values())))
    samples = [
        sample(float(i), 0.0, 0.0, FROM_TIP) | {name: row[i] for name, row in series.items()} for i in range(count)
    ]
    return Result.from_samples(
        samples,
        scenario=scenario or StandInScenario(),
        status=StatusReport(Status.COMPLETED),
        node_arc_length=FROM_TIP,
        joint_arc_length=FROM_TIP[:-1],
        snaps=snaps,
        peaks=peaks,
    )


def values(result):
    return {name: metric.value for name, metric in metrics(result).items()}


def test_the_path_of_the_tip_counts_there_and_back():
    found = values(small(tip_x=[0.0, 3e-3, 3e-3, 0.0], tip_y=[0.0, 0.0, 4e-3, 0.0]))
    assert found["tip_path_length"] == pytest.approx(12e-3)
    assert found["final_tip_x"] == 0.0


def test_peaks_come_with_their_times():
    found = values(small(push_force=[0.0, 0.5, -0.7, 0.1], wall_force_x=[0, 3.0, 0, 0], wall_force_y=[0, -4.0, 0, 4.5]))
    assert (found["push_force_max"], found["push_force_max_time"]) == (0.5, 1.0)
    assert (found["pull_force_max"], found["pull_force_max_time"]) == (0.7, 2.0)
    assert (found["wall_force_resultant_max"], found["wall_force_resultant_max_time"]) == (pytest.approx(5.0), 1.0)


def test_peaks_over_all_steps_go_before_those_at_the_outputs():
    kept = {
        "push_force": (0.9, 0.4),
        "pull_force": (0.8, 1.4),
        "wall_force_max": (0.7, 0.5),
        "penetration_max": (3e-6, 0.6),
    }
    found = metrics(small(peaks=kept, push_force=[0.0, 0.5, -0.7], penetration_max=[0.0, 1e-6, 0.0]))
    for name, (value, time) in kept.items():
        name = name.removesuffix("_max") + "_max"
        assert (found[name].value, found[f"{name}_time"].value) == (value, time)
        assert "over all steps" in found[name].meaning
        assert found[f"{name}_time"].meaning.startswith("time of the ")
        assert "over all steps" in found[f"{name}_time"].meaning
    assert "at the outputs" in found["tip_force_max"].meaning


def test_without_peaks_the_outputs_count_and_the_meaning_says_so():
    found = metrics(
        small(peaks={"push_force": (np.nan, np.nan)}, push_force=[0.0, 0.5, -0.7], penetration_max=[0.0, 1e-6, 0.0])
    )
    assert (found["push_force_max"].value, found["push_force_max_time"].value) == (0.5, 1.0)
    assert (found["penetration_max"].value, found["penetration_max_time"].value) == (1e-6, 1.0)
    for name in ("push_force_max", "pull_force_max", "wall_force_max", "penetration_max"):
        assert "at the outputs" in found[name].meaning
        assert "over all steps" not in found[name].meaning


def test_depth_is_the_deepest_and_the_last():
    found = values(small(insertion_depth=[0.0, 0.08, 0.02]))
    assert (found["insertion_depth_max"], found["final_insertion_depth"]) == (0.08, 0.02)


def test_the_energy_error_is_measured_on_the_largest_work():
    found = values(small(energy_error=[0.0, -2e-6, 1e-6], insertion_work=[0.0, 1e-3, -4e-3]))
    assert found["energy_error_max"] == pytest.approx(2e-6)
    assert found["energy_error_relative"] == pytest.approx(5e-4)


def test_without_work_there_is_no_relative_energy_error():
    assert np.isnan(values(small(energy_error=[0.0, 0.0]))["energy_error_relative"])


def test_works_too_small_for_the_trust_check_give_no_relative_energy_error():
    assert LEAST_WORK == ENERGY_FLOOR
    metric = metrics(small(energy_error=[0.0, 9e-8], insertion_work=[0.0, 0.9e-7]))["energy_error_relative"]
    assert np.isnan(metric.value)
    assert "none where that is below 1e-07 J" in metric.meaning
    assert values(small(energy_error=[0.0, 1e-8], insertion_work=[0.0, -1e-7]))["energy_error_relative"] == (
        pytest.approx(0.1)
    )


def test_snaps_are_counted_and_the_largest_named():
    found = values(small(snaps=(SnapEvent(1.0, 2e-6), SnapEvent(2.0, 5e-6)), tip_x=[0.0, 0.0]))
    assert (found["snaps"], found["snap_energy_max"]) == (2.0, 5e-6)
    assert values(small(tip_x=[0.0]))["snap_energy_max"] == 0.0


def test_iterations_per_step():
    found = values(small(solver_steps=[0, 10, 20], newton_iterations=[0, 45, 70]))
    assert found["newton_iterations_per_step"] == 3.5
    assert np.isnan(values(small(solver_steps=[0], newton_iterations=[0]))["newton_iterations_per_step"])


def test_values_that_are_not_finite_do_not_hide_the_others():
    found = values(small(push_force=[0.0, 0.5, np.nan], wall_force_max=[np.nan, np.nan, np.nan]))
    assert (found["push_force_max"], found["push_force_max_time"]) == (0.5, 1.0)
    assert np.isnan(found["wall_force_max"])


def test_each_metric_has_a_unit_and_a_meaning():
    for name, metric in metrics(made_up_result()).items():
        assert isinstance(metric.value, float), name
        assert metric.unit, name
        assert len(metric.meaning.split()) > 2, name
    units = {name: metric.unit for name, metric in metrics(made_up_result()).items()}
    assert (units["push_force_max"], units["push_force_max_time"], units["tip_path_length"]) == ("N", "s", "m")


class TestGuidance:
    def test_a_tip_that_follows_has_a_trackability_of_one(self):
        found = values(small(tip_x=[0.0, 2e-3, 4e-3], tip_angle=[0.0] * 3, insertion_depth=[0.0, 2e-3, 4e-3]))
        assert (found["trackability"], found["tip_retreat_max"], found["prolapse"]) == (pytest.approx(1), 0, 0)
        assert np.isnan(found["pushability"])

    def test_pulling_back_counts_for_nothing(self):
        depth, x = [0.0, 4e-3, 1e-3], [0.0, 2e-3, -5e-3]
        found = values(small(tip_x=x, tip_angle=[0.0] * 3, insertion_depth=depth))
        assert (found["trackability"], found["tip_retreat_max"]) == (pytest.approx(0.5), 0)

    @pytest.mark.parametrize(("back", "prolapsed"), [(0.2e-3, 0.0), (0.5e-3, 1.0)])
    def test_a_tip_that_goes_back_while_pushed_prolapses(self, back, prolapsed):
        """The wire of the stand-in has a diameter of 0.36 mm; the tip points along y."""
        y = [0.0, 3e-3, 3e-3 - back, 4e-3]
        found = values(small(tip_y=y, tip_angle=[np.pi / 2] * 4, insertion_depth=[0.0, 2e-3, 4e-3, 6e-3]))
        assert found["tip_retreat_max"] == pytest.approx(back)
        assert found["prolapse"] == prolapsed

    def test_pushability_is_the_slope_at_a_blocked_tip(self):
        """The tip stands from the third output on; before, tip and push force have nothing to do with each other."""
        found = values(
            small(
                tip_x=[0.0, 2e-3, 4e-3, 4e-3, 4e-3, 4e-3],
                tip_angle=[0.0] * 6,
                insertion_depth=[0.0, 2e-3, 4e-3, 6e-3, 8e-3, 10e-3],
                push_force=[0.5, 0.1, 0.2, 0.3, 0.5, 0.9],
                tip_force=[0.0, 0.3, 0.1, 0.13, 0.19, 0.31],
            )
        )
        assert found["pushability"] == pytest.approx(0.3)


def test_where_the_vessel_was_pressed_hardest():
    result = made_up_result()
    force = np.hypot(result.values("contact_normal_force"), result.values("contact_tangential_force"))
    force = np.where(result.values("contact_owner") == 0, force, np.nan)
    at = np.unravel_index(np.nanargmax(force), force.shape)
    found = values(result)
    assert found["wall_force_max_x"] == result.values("contact_x")[at]
    assert found["wall_force_max_arc_length"] == result.values("contact_arc_length")[at]
    assert np.isnan(values(small(tip_x=[0.0, 1e-3]))["wall_force_max_x"])


def tee(**stop):
    """Two branches: along x to 40 mm, and up from its middle."""
    branches = [
        {"name": "along", "points": [[0.0, 0.0], [40e-3, 0.0]], "diameter": 4e-3},
        {"name": "up", "parent": "along", "at": 20e-3, "angle": np.pi / 2, "length": 30e-3, "diameter": 4e-3},
    ]
    vessel = BranchesVessel.model_validate({"kind": "branches", "branches": branches})
    return StandInScenario(vessel=vessel, stop=StopSpec.model_validate(stop))


def contacts(*rows):
    """Contact fields of one instant: x, y, arc length (m), normal force (N), owner."""
    table = np.array(rows, dtype=float).reshape(-1, 5)
    fields = dict.fromkeys(CONTACT_FIELDS, np.zeros(len(table)))
    given = dict(zip(("x", "y", "arc_length", "normal_force", "owner"), table.T, strict=True))
    return fields | {f"contact_{name}": column for name, column in given.items()}


def touching(*instants, **series):
    """A result in the tee whose instants, a second apart, have these contacts."""
    samples = [sample(float(i), 0.0, 0.0, FROM_TIP) | contacts(*rows) for i, rows in enumerate(instants)]
    return small(scenario=tee(), **{name: [one[name] for one in samples] for name in CONTACT_FIELDS}, **series)


class TestTarget:
    def test_without_a_target_there_are_no_metrics_of_it(self):
        assert not [name for name in values(small(tip_x=[0.0])) if name.startswith("target")]

    def test_time_and_depth_are_those_of_the_first_output_near_the_point(self):
        scenario = tee(target={"at": [10e-3, 0.0], "within": 1.5e-3})
        depth = [0.0, 4e-3, 9e-3, 12e-3]
        found = values(small(scenario=scenario, tip_x=[0.0, 4e-3, 9e-3, 10e-3], insertion_depth=depth))
        assert (found["target_reached"], found["target_time"], found["target_insertion_depth"]) == (1.0, 2.0, 9e-3)

    def test_a_branch_is_reached_where_its_parent_s_lumen_ends(self):
        scenario = tee(target={"branch": "up"})
        found = values(small(scenario=scenario, tip_x=[20e-3] * 4, tip_y=[0.0, 1.9e-3, 2.1e-3, 5e-3]))
        assert (found["target_reached"], found["target_time"]) == (1.0, 2.0)

    def test_a_target_that_was_never_reached_says_so(self):
        found = values(small(scenario=tee(target={"branch": "up"}), tip_x=[10e-3, np.nan]))
        assert found["target_reached"] == 0.0
        assert np.isnan(found["target_time"])
        assert np.isnan(found["target_insertion_depth"])


class TestBranches:
    """The nodes of the wire are 15 mm apart: each stands for 15 mm, the tip for half of that."""

    def test_a_vessel_without_names_has_no_metrics_of_branches(self):
        assert not [name for name in values(made_up_result()) if "contact_time" in name or name.endswith("branch")]

    def test_length_and_time_are_counted_by_branch_and_not_for_the_catheter(self):
        along, up = (10e-3, -2e-3), (22e-3, 20e-3)
        found = values(
            touching(
                [(*along, 30e-3, 1.0, 0), (*along, 45e-3, 1.0, 0), (*up, 0.0, 0.5, 0)],
                [(*along, 30e-3, 1.0, 0), (*along, 75e-3, 1.0, 1)],
                [(*along, 31e-3, 1.0, 0), (*along, 29e-3, 1.0, 0)],
                [],
            )
        )
        # The first output stands for half a second, the others up to the third for one each.
        assert found["contact_time_along"] == pytest.approx(2.5)
        assert found["contact_length_max_along"] == pytest.approx(30e-3)
        # Two contacts beside one node count it once.
        assert found["contact_length_mean_along"] == pytest.approx((0.5 * 30e-3 + 15e-3 + 15e-3) / 2.5)
        assert found["contact_time_up"] == pytest.approx(0.5)
        assert found["contact_length_max_up"] == pytest.approx(7.5e-3)

    def test_where_there_is_no_contact_there_is_no_mean(self):
        found = values(touching([], []))
        assert (found["contact_time_up"], found["contact_length_max_up"]) == (0.0, 0.0)
        assert np.isnan(found["contact_length_mean_up"])
        assert np.isnan(found["wall_force_max_branch"])

    def test_the_branch_of_the_largest_force_has_its_number_and_its_name(self):
        result = touching([(10e-3, 2e-3, 0.0, 1.0, 0)], [(22e-3, 20e-3, 0.0, 3.0, 0), (0.0, 0.0, 0.0, 9.0, 1)])
        metric = metrics(result)["wall_force_max_branch"]
        assert (metric.value, metric.label) == (1.0, "up")
        assert "0 along, 1 up" in metric.meaning
