"""Figures of sweeps from made-up tables: what failed is told apart, names and numbers can be read."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_hex

from gw_exudyn.plots.style import VERMILLION
from gw_exudyn.sweep.figures.curves import plot_curves
from gw_exudyn.sweep.figures.extremes import LETTERS, title_of
from gw_exudyn.sweep.figures.indices import plot_indices
from gw_exudyn.sweep.figures.metrics import plot_map, plot_response
from gw_exudyn.sweep.figures.scales import short
from gw_exudyn.sweep.table import Table


def table(study, values, failed=()):
    """A table in which the first metric has these values, SI."""
    good = np.ones(len(study), dtype=bool)
    good[list(failed)] = False
    metrics = {name: np.zeros(len(study)) for name in study.metric_table}
    metrics[study.metrics[0]] = np.asarray(values, dtype=float)
    status = tuple("completed" if one else "too_deep" for one in good)
    return Table(status, good, np.ones(len(study)), metrics, (np.arange(3.0),))


def dataset(study, forces, failed=()):
    """Curves that rise to these forces, N, over 10 mm."""
    forces = np.asarray(forces, dtype=float)
    curves = forces[:, None] * np.linspace(0.0, 1.0, 5)
    shape, dims = study.design.shape, ("a", "b", "c")[: len(study.design.shape)]
    known = {"push_force": curves, "wall_force_normal": curves, "insertion_depth": np.full_like(curves, 1e-2).cumsum(1)}
    data = {name: ((*dims, "time"), values.reshape(*shape, -1)) for name, values in known.items()}
    good = np.array([row not in failed for row in range(len(forces))])
    data["trusted"] = dims, good.astype(int).reshape(shape)
    data["metric_push_force_max"] = dims, forces.reshape(shape)
    return xr.Dataset(data)


def test_numbers_have_no_exponent_where_digits_do(study):
    assert [short(number) for number in (2550.0, 999.6, 0.0123, 12345.0)] == ["2550", "1000", "0.0123", "12345"]
    found = study("contact.friction_coefficient: [0.1, 0.2]\nwire.diameter: [0.3 mm, 0.4 mm]")
    figure = plot_map(found, table(found, [1.0, 2.55, 3.0, 4.0]))
    assert "2550" in [text.get_text() for axes in figure.axes for text in axes.texts]


def test_an_axis_is_logarithmic_where_small_values_would_vanish(study):
    found = study("contact.friction_coefficient: [0.1, 0.2, 0.3]")
    for values, scale in (([0.1, 20.0, 400.0], "log"), ([1.0, 2.0, 3.0], "linear"), ([0.0, 2.0, 900.0], "linear")):
        assert plot_response(found, table(found, values)).axes[0].get_yscale() == scale


def test_curves_of_failed_points_are_told_apart_and_set_no_limit(study):
    found = study("contact.friction_coefficient: [0.1, 0.2, 0.3]")
    figure = plot_curves(found, dataset(found, [0.1, 0.2, 50.0], failed=[2]))
    colours = [to_hex(line.get_color()).upper() for line in figure.axes[0].lines]
    assert colours.count(VERMILLION) == 1
    assert colours[-1] == VERMILLION
    assert figure.axes[0].get_ylim()[1] < 300  # mN
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["failed"]


def test_curves_of_a_sample_show_the_parameter_that_matters(study):
    vary = "contact.friction_coefficient: {uniform: [0.1, 0.6]}\nwire.diameter: {uniform: [0.3 mm, 0.4 mm]}"
    found = study(vary, mode="sample", samples=16)
    for path in ("contact.friction_coefficient", "wire.diameter"):
        forces = [found.design.labels(point)[path] for point in range(16)]
        labels = [axes.get_ylabel() for axes in plot_curves(found, dataset(found, forces)).axes]
        assert labels[-1].startswith(path.replace(".", ": ").replace("_", " "))


def test_more_words_than_colours_differ_in_their_lines(study):
    found = study("wire.model: catalogue")
    figure = plot_curves(found, dataset(found, np.arange(1.0, len(found) + 1)))
    looks = {(to_hex(line.get_color()), line.get_linestyle()) for line in figure.axes[0].lines}
    assert len(looks) == len(found)


def test_bars_stand_in_the_order_of_their_legend(study):
    pytest.importorskip("SALib")
    vary = "contact.friction_coefficient: {uniform: [0.1, 0.6]}\nwire.diameter: {uniform: [0.3 mm, 0.4 mm]}"
    found = study(vary, mode="sample", method="sobol-indices", samples=16)
    frictions = [found.design.labels(point)["contact.friction_coefficient"] for point in range(len(found))]
    axes = plot_indices(found, table(found, frictions)).axes[0]
    first, total = (bars.patches[0].get_y() for bars in axes.containers if hasattr(bars, "patches") and bars.patches)
    assert first < total  # and the axis points down
    assert axes.yaxis_inverted()
    assert axes.get_yticklabels()[0].get_text() == "contact: friction coefficient"


def test_a_title_of_many_parameters_is_broken_between_them(study):
    vary = "\n".join(f"{path}: [1.234e-3]" for path in ("wire.diameter", "drive.distance", "output.interval"))
    found = study(vary, set="{wire.segments: 5}")
    lines = title_of("best", 0.5, found.design.labels(0), found).splitlines()
    assert lines[0] == "best: push force max 500 mN"
    assert max(map(len, lines)) <= LETTERS
    assert any("interval\u00a00.00123\u00a0s" in line for line in lines)
