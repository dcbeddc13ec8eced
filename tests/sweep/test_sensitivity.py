"""Sensitivity indices against functions whose indices are known, and bands against quantiles that are known."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from gw_exudyn.sweep.bands import band
from gw_exudyn.sweep.figures.drawing import wanted
from gw_exudyn.sweep.plan import Options
from gw_exudyn.sweep.run import run_sweep
from gw_exudyn.sweep.sensitivity import indices
from gw_exudyn.sweep.table import Table

PATHS = ("contact.friction_coefficient", "wire.grading", "wire.damping_time")
VARY = f"{PATHS[0]}: {{uniform: [0, 1]}}\n{PATHS[1]}: {{uniform: [1, 2]}}\n{PATHS[2]}: {{normal: [1 s, 0.1 s]}}"
METRIC = "push_force_max"


def table(study, function, failed: tuple[int, ...] = ()) -> Table:
    """A table as if the metric were a function of the parameters."""
    rows = [[study.design.labels(point)[path] for path in PATHS] for point in range(len(study))]
    values = np.array([function(*row) for row in rows])
    status = tuple("crashed" if point in failed else "completed" for point in range(len(study)))
    values[list(failed)] = np.nan
    good = np.array([one == "completed" for one in status])
    return Table(status, good, values, {METRIC: values}, (np.zeros(1),))


def test_sobol_indices_of_a_sum_and_of_a_product(study):
    found = study(VARY, mode="sample", method="sobol-indices", samples=512)
    # Variances of a: 1/12, of 2 b: 4/12, so shares of 0.2 and 0.8; the third parameter does nothing.
    named, left_out = indices(found, table(found, lambda a, b, c: a + 2 * b), METRIC, "N")
    value = {(one.path, one.name): one for one in named}
    for path, share in zip(PATHS, (0.2, 0.8, 0.0), strict=True):
        for name in ("S1", "ST"):
            # Of 512 samples; the error of such an estimate is about 1/sqrt(512).
            assert value[path, name].value == pytest.approx(share, abs=0.05)
            assert abs(value[path, name].value - share) <= max(1.5 * value[path, name].confidence, 1e-12)
            assert value[path, name].unit == "1"
    assert left_out == 0
    # (a - 1/2)(b - 3/2): neither does anything alone, both together all.
    named, _ = indices(found, table(found, lambda a, b, c: (a - 0.5) * (b - 1.5)), METRIC, "N")
    value = {(one.path, one.name): one for one in named}
    assert value[PATHS[0], "S1"].value == pytest.approx(0.0, abs=0.1)
    assert value[PATHS[0], "ST"].value == pytest.approx(1.0, abs=0.1)


def test_base_samples_with_a_failed_point_are_left_out_whole(study):
    found = study(VARY, mode="sample", method="sobol-indices", samples=512)
    named, left_out = indices(found, table(found, lambda a, b, c: a + 2 * b, failed=(3, 7, 8)), METRIC, "N")
    assert left_out == 2  # five points make a base sample: 0 to 4, 5 to 9
    assert next(one.value for one in named if one.path == PATHS[1]) == pytest.approx(0.8, abs=0.05)
    with pytest.raises(ValueError, match="3 of 512 base samples came out whole"):
        indices(found, table(found, lambda a, b, c: a, failed=tuple(range(509 * 5))), METRIC, "N")
    with pytest.raises(ValueError, match="the same at all points"):
        indices(found, table(found, lambda a, b, c: 1.0), METRIC, "N")


def test_morris_finds_the_slope_over_the_whole_range(study):
    found = study(VARY, mode="sample", method="morris", samples=8)
    named, _ = indices(found, table(found, lambda a, b, c: 3 * a - 2 * b), METRIC, "N")
    value = {(one.path, one.name): one for one in named}
    for path, slope in zip(PATHS, (3.0, 2.0, 0.0), strict=True):
        assert value[path, "mu_star"].value == pytest.approx(slope, abs=1e-9)
        assert value[path, "sigma"].value == pytest.approx(0.0, abs=1e-9)
        assert value[path, "mu_star"].unit == "N"


def test_a_band_holds_the_quantiles_of_the_points_that_get_there(study):
    found = study(VARY, mode="sample", samples=101)
    depth = np.tile([0.0, 1.0, 2.0], (101, 1))
    force = np.arange(101.0)[:, None] * np.array([0.0, 1.0, 2.0])
    depth[90:, 2] = force[90:, 2] = np.nan  # they ended early
    dims = ("point", "time")
    data = xr.Dataset({"insertion_depth": (dims, depth), "push_force": (dims, force)}, {"time": [0.0, 1.0, 2.0]})
    data["trusted"] = ("point", [1] * 101)
    one = band(found, data, "push_force")
    assert one.abscissa == "insertion_depth"
    assert (one.low[1], one.median[1], one.high[1]) == (5.0, 50.0, 95.0)
    assert one.median[2] == 89.0
    assert one.count.tolist() == [101, 101, 90]


def test_a_band_over_different_depths_compares_equal_depths(study):
    found = study(VARY, mode="sample", samples=2)
    depth = np.array([[0.0, 1.0, 2.0], [0.0, 2.0, 4.0]])
    dims = ("point", "time")
    data = xr.Dataset({"insertion_depth": (dims, depth), "push_force": (dims, 3 * depth)}, {"time": [0.0, 1.0, 2.0]})
    data["trusted"] = ("point", [1] * 2)
    one = band(found, data, "push_force")
    assert one.x.max() == pytest.approx(2.0, abs=0.03)  # only one gets further
    assert one.median == pytest.approx(3 * one.x)


def test_a_study_of_sensitivity_leaves_its_indices_and_figures(study, tmp_path):
    vary = "contact.friction_coefficient: {uniform: [0.1, 0.4]}\nwire.imperfection: {uniform: [0.01 1/m, 0.1 1/m]}"
    found = study(vary, mode="sample", method="morris", samples=4, metrics="[push_force_max, snaps]")
    summary = run_sweep(found, tmp_path / "out", Options(jobs=1, figures=False))
    lines = (tmp_path / "out" / "sensitivity.csv").read_text().splitlines()
    assert lines[0] == "metric,parameter,index,value,confidence_95,unit,meaning"
    assert len(lines) == 5  # two parameters, mu_star and sigma
    assert summary.notes == ["no sensitivity of snaps: it is the same at all points"]
    with xr.open_dataset(tmp_path / "out" / "sweep.nc") as data:
        values = table_of(found, data)
        figures = {name: draw() for name, draw in wanted(found, values, {}, data).items()}
    assert set(figures) == {"curves", "matrix", "bands", "sensitivity"}
    labels = {axes.get_xlabel() for figure in figures.values() for axes in figure.axes}
    assert {"insertion depth [mm]", "push force max [mN]", "wire: imperfection [1/m]"} <= labels
    for figure in figures.values():
        figure.draw_without_rendering()


def table_of(study, data) -> Table:
    names = [name for name in data if str(name).startswith("metric_")]
    found = {str(name).removeprefix("metric_"): data[name].values for name in names}
    return Table(
        tuple(data["status"].values),
        data["trusted"].values == 1,
        data["wall_time"].values,
        found,
        (data["time"].values,),
    )
