"""Results: samples become labelled arrays, and a status says what happened and what to change."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from synthetic import FROM_TIP, StandInScenario, made_up_result, sample

import gw_exudyn
from gw_exudyn.quantities import CONTACT_FIELDS, QUANTITIES, SCALARS
from gw_exudyn.result import Result, Status, StatusReport, software_versions


def result_of(samples, **further):
    given = {"node_arc_length": FROM_TIP, "joint_arc_length": FROM_TIP[:-1], "status": StatusReport(Status.COMPLETED)}
    return Result.from_samples(samples, scenario=StandInScenario(), **(given | further))


def samples_at(*depths):
    return [sample(depth / 2e-3, depth, 0.02, FROM_TIP) for depth in depths]


def test_every_variable_has_its_unit_meaning_place_and_kind():
    dataset = made_up_result().dataset
    for name in (*SCALARS, *CONTACT_FIELDS, "node_x", "joint_torque", "time", "node_arc_length"):
        variable, quantity = dataset[name], QUANTITIES[name]
        assert variable.attrs["units"] == quantity.unit
        assert variable.attrs["long_name"] == quantity.long_name
        assert variable.dims == quantity.dims
        assert np.issubdtype(variable.dtype, np.integer) == quantity.integer


def test_nodes_are_one_more_than_joints_and_the_tip_is_last():
    dataset = made_up_result(segments=30).dataset
    assert dataset.sizes["node"] == 31
    assert dataset.sizes["joint"] == 30
    assert dataset["node_arc_length"].values[-1] == 0
    assert dataset["node_x"].values[:, -1] == pytest.approx(dataset["tip_x"].values)


def test_contacts_are_padded_and_come_back_without_the_padding():
    samples = samples_at(0.0, 0.025, 0.08)
    result = result_of(samples)
    assert result.dataset.sizes["contact"] == max(len(one["contact_x"]) for one in samples)
    for instant, one in enumerate(samples):
        there = result.contacts_at(instant)
        for name in CONTACT_FIELDS:
            assert there[name] == pytest.approx(one[name])
    assert np.isnan(result.dataset["contact_gap"].values[0]).all()
    assert (result.dataset["contact_kind"].values[0] == -1).all()


def test_a_run_without_any_contact_still_has_a_column_of_padding():
    result = result_of(samples_at(0.0, 0.001))
    assert result.dataset.sizes["contact"] == 1
    assert result.contacts_at(1)["contact_x"].size == 0


def test_of_two_samples_at_one_time_the_later_counts():
    first, second, third = samples_at(0.0, 0.01, 0.02)
    repeated = dict(second, push_force=7.0)
    result = result_of([first, second, repeated, third])
    assert result.time.tolist() == [0.0, 5.0, 10.0]
    assert result.values("push_force")[1] == 7.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda one: one.pop("tip_x"), r"sample 1: missing: tip_x"),
        (lambda one: one.update(tip_z=0.0), r"sample 1: unknown: tip_z"),
        (lambda one: one.update(time=-1.0), r"sample 1: time -1.0 s does not follow on 0.0 s"),
        (lambda one: one.update(time=np.nan), r"sample 1: time nan s does not follow"),
        (lambda one: one.update(node_x=np.zeros(3)), r"sample 1: node_x has shape \(3,\), expected \(11,\)"),
        (lambda one: one.update(push_force=[1.0]), r"sample 1: push_force has shape \(1,\), expected \(\)"),
        (
            lambda one: one.update(contact_gap=np.zeros(99)),
            r"contact_gap has shape \(99,\), expected .* like contact_x",
        ),
    ],
)
def test_wrong_samples_are_refused(change, message):
    samples = samples_at(0.0, 0.08)
    change(samples[1])
    with pytest.raises(ValueError, match=message):
        result_of(samples)


def test_a_result_without_samples_is_refused():
    with pytest.raises(ValueError, match="at least one sample"):
        result_of([])


def test_walls_must_be_polylines():
    with pytest.raises(ValueError, match=r"wall polyline 0 has shape \(2, 3\)"):
        result_of(samples_at(0.0), vessel_outline=[np.zeros((2, 3))])


def test_peaks_are_plain_numbers_and_none_by_default():
    assert result_of(samples_at(0.0)).peaks == {}
    peaks = result_of(samples_at(0.0), peaks={"push_force": (np.float64(0.5), 3)}).peaks
    assert peaks == {"push_force": (0.5, 3.0)}
    assert {type(number) for number in peaks["push_force"]} == {float}


def test_the_version_of_the_package_is_its_own_word(monkeypatch):
    monkeypatch.setattr(gw_exudyn, "__version__", "9.8.7")
    assert software_versions()["gw-exudyn"] == "9.8.7"


def test_a_result_survives_the_way_to_another_process():
    result = made_up_result()
    again = pickle.loads(pickle.dumps(result))
    assert again.dataset.identical(result.dataset)
    assert again.status == result.status


@pytest.mark.parametrize("status", Status)
def test_each_status_says_what_happened_and_what_to_change(status):
    assert status.problem[0].isupper()
    assert not status.problem.endswith(".")
    assert status.value in (f"{status.problem}. {status.remedy}", f"{status.problem}.")
    assert (status.remedy == "") == status.ok
    assert status.trusted or not status.ok


def test_only_a_finished_a_stopped_or_a_run_that_an_event_ended_is_trusted():
    events = {Status.TIP_STALLED, Status.FORCE_LIMIT, Status.TARGET_REACHED, Status.END_OF_TRAVEL}
    assert {status for status in Status if status.is_event} == events
    assert {status for status in Status if status.trusted} == {Status.COMPLETED, Status.STOPPED} | events
    assert {status for status in Status if status.ok} == {Status.COMPLETED}


def test_the_sentence_names_when_where_how_much_and_the_remedy():
    report = StatusReport(Status.TOO_DEEP, 3.2, "node 117", "61 µm, allowed are 54 µm")
    assert report.sentence() == (
        "The wire was pressed into a wall by more than 0.3 of its radius, so neither its path nor its forces can be "
        "trusted (t = 3.2 s; node 117; 61 µm, allowed are 54 µm). If the push force has shot up, the wire is jammed: "
        "lower the friction, use more segments (wire.segments), or push less far; else raise contact.wall_stiffness, "
        "or leave it at auto."
    )
    assert StatusReport(Status.COMPLETED).sentence() == "The run reached its end and passed every check."
