"""The page of a run: complete in itself, small, and what it holds is what the run holds."""

from __future__ import annotations

import base64
import dataclasses
import json
import re

import numpy as np
import pytest
from synthetic import StandInWire, made_up_result

from gw_exudyn.errors import UsageError
from gw_exudyn.report import MOST_RUNS, report_page
from gw_exudyn.report.pack import packed_run
from gw_exudyn.scenario.vessels.branches import BranchesVessel


@pytest.fixture(scope="module")
def result():
    return made_up_result(segments=60)


def data_of(page):
    return json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', page, re.DOTALL)[1])


def test_it_needs_nothing_else(result):
    page = report_page([result], figures=False)
    assert not re.findall(r"""(?:src|href)=["'](?!data:)""", page)
    assert "http" not in page
    assert "<!--" not in page


def test_the_motion_survives_its_packing(result):
    run = packed_run(result)
    packed = np.frombuffer(base64.b64decode(run["course"]), "<u2").reshape(len(result.time), run["nodes"], 2)
    low, high = np.array(run["box"][:2]), np.array(run["box"][2:])
    course = low + packed / 65534 * (high - low)
    true = np.stack([result.values("node_x"), result.values("node_y")], axis=-1) * 1e3
    assert np.abs(course - true).max() < 5e-3
    forces = np.frombuffer(base64.b64decode(run["contacts"]), "<f4").reshape(-1, 5)
    first = slice(run["starts"][-2], run["starts"][-1])
    contacts = result.contacts_at(len(result.time) - 1)
    size = np.hypot(contacts["contact_normal_force"], contacts["contact_tangential_force"])
    assert np.hypot(*forces[first, 2:4].T) == pytest.approx(size, rel=1e-5)


def test_a_long_run_of_many_segments_stays_small():
    long = made_up_result(segments=400, instants=900)
    run = packed_run(long)
    assert len(json.dumps(run)) < 2e6
    assert len(base64.b64decode(run["time"])) == 4 * 600
    assert run["nodes"] == 201


def test_names_cannot_break_the_page(result):
    page = report_page([result], title="</script><b>", figures=False)
    assert "</script><b>" not in page
    assert data_of(page)["runs"][0]["name"] == result.scenario.name


def test_runs_of_one_name_are_numbered_and_differences_told(result):
    other = made_up_result(segments=60, wire=StandInWire(0.89e-3, "amplatz-super-stiff"))
    page = report_page([result, other], figures=False)
    assert [run["name"] for run in data_of(page)["runs"]] == ["corner90-universal (1)", "corner90-universal (2)"]
    assert "<td>wire.model</td><td>universal-ii</td><td>amplatz-super-stiff</td>" in page


def test_more_runs_than_fit_are_refused(result):
    with pytest.raises(UsageError, match=f"1 to {MOST_RUNS} runs"):
        report_page([result] * (MOST_RUNS + 1))
    with pytest.raises(UsageError):
        report_page([])


def test_numbers_that_are_not_finite_leave_valid_data(result):
    broken = result.dataset.copy(deep=True)
    broken["node_x"][3, 2] = np.nan
    broken["push_force"][3] = np.inf
    page = report_page([type(result)(**{**result.__dict__, "dataset": broken})], figures=False)
    assert data_of(page)["runs"][0]["nodes"] == 61


def test_runs_in_different_vessels_tell_the_metrics_of_both(result):
    branch = {"name": "along", "points": [[0.0, 0.0], [60e-3, 0.0]], "diameter": 6e-3}
    vessel = BranchesVessel.model_validate({"kind": "branches", "branches": [branch]})
    other = dataclasses.replace(result, scenario=dataclasses.replace(result.scenario, vessel=vessel))
    for pair in ([result, other], [other, result]):
        (row,) = re.findall(
            r"<tr>(?:(?!</tr>).)*contact_time_along.*?</tr>", report_page(pair, figures=False), re.DOTALL
        )
        cells = re.findall(r"<td[^>]*>(.*?)</td>", row)
        assert (cells[1 + pair.index(result)], cells[1 + pair.index(other)][-1:]) == ("", "s")
