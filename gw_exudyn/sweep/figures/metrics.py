"""Metrics over the parameters: a line for one parameter, a heat map for two, a matrix for more and for samples."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gw_exudyn.plots.style import BLUE, NOTE_COLOUR, VERMILLION, new_figure, tidy
from gw_exudyn.result import Floats
from gw_exudyn.sweep.figures.scales import COLOUR_MAP, axis_scaled, metric_scaled, short
from gw_exudyn.sweep.studies.axes import Axis
from gw_exudyn.sweep.studies.study import Study
from gw_exudyn.sweep.table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST_PANELS = 4
_MOST_PARAMETERS = 8
_MOST_TEXTS = 100  # cells of a heat map that get their number written in
_FAR = 200  # ratio of largest to smallest value from which an axis is logarithmic
_FAILED = "failed"


def good_values(study: Study, table: Table, name: str) -> Floats:
    """(points,) a metric in SI, NaN where the point failed."""
    return np.where(table.good, table.metrics[name], np.nan)


def plot_response(study: Study, table: Table) -> Figure:
    """Draw the study's metrics over its one parameter; failed points are marked at the bottom."""
    metrics, axis = study.metrics[:_MOST_PANELS], study.design.axes[0]
    labels = [study.design.labels(point)[axis.path] for point in range(len(study))]
    text, x, words = axis_scaled(axis, labels)
    figure = new_figure(5.2, 0.8 + 2.8 * len(metrics))
    panels = figure.subplots(len(metrics), 1, sharex=True, squeeze=False)[:, 0]
    order = np.argsort(x, kind="stable")
    for axes, name in zip(panels, metrics, strict=True):
        tidy(axes)
        label, values = metric_scaled(study, name, good_values(study, table, name))
        line = "o" if study.mode == "sample" or axis.unit is None else "o-"
        axes.plot(x[order], values[order], line, color=BLUE, markersize=4, linewidth=1.3)
        if _far_apart(values):
            axes.set_yscale("log")
        _mark_failed(axes, x[~table.good])
        axes.set_ylabel(label)
    panels[-1].set_xlabel(text)
    if axis.unit is None:
        panels[-1].set_xticks(np.unique(x), list(dict.fromkeys(words)), rotation=20, ha="right")
    _title(figure, study)
    return figure


def _far_apart(values: Floats) -> bool:
    """Whether the smaller values would all lie on the axis."""
    known = values[np.isfinite(values)]
    return bool(len(known) and known.min() > 0 and known.max() > _FAR * known.min())


def _mark_failed(axes: Axes, x: Floats) -> None:
    if len(x):
        bottom = axes.get_xaxis_transform()
        axes.plot(x, np.full(len(x), 0.02), "x", color=VERMILLION, transform=bottom, label=_FAILED, clip_on=False)
        axes.legend(fontsize=9, frameon=False)


def plot_map(study: Study, table: Table) -> Figure:
    """Draw a heat map of each of the study's metrics over two parameters; failed points are crossed out."""
    metrics, design = study.metrics[:_MOST_PANELS], study.design
    up, right = design.axes
    y_text, _, y_words = axis_scaled(up, list(up.labels))
    x_text, _, x_words = axis_scaled(right, list(right.labels))
    wide = float(np.clip(1.2 + 0.55 * len(x_words), 4.6, 9.0))  # so that the numbers find room in their cells
    figure = new_figure(1.0 + wide * len(metrics), 1.6 + min(6.0, 0.55 * len(y_words) + 1.5))
    panels = figure.subplots(1, len(metrics), sharey=True, squeeze=False)[0]
    for axes, name in zip(panels, metrics, strict=True):
        label, values = metric_scaled(study, name, good_values(study, table, name).reshape(design.shape))
        image = axes.imshow(np.ma.masked_invalid(values), cmap=COLOUR_MAP, origin="lower", aspect="auto")
        figure.colorbar(image, ax=axes, label=label)
        _write_cells(axes, values, image)
        _ticks(axes, x_words, y_words)
        axes.set_xlabel(x_text)
    panels[0].set_ylabel(y_text)
    _title(figure, study)
    return figure


def _write_cells(axes: Axes, values: Floats, image: Any) -> None:
    """The numbers in the cells where there is room; a cross where a point failed."""
    for (row, column), value in np.ndenumerate(values):
        if not np.isfinite(value):
            axes.plot(column, row, "x", color=VERMILLION, markersize=11, markeredgewidth=2.5)
        elif values.size <= _MOST_TEXTS:
            dark = image.norm(value) < 0.5
            axes.text(
                column, row, short(value), color="white" if dark else "black", ha="center", va="center", fontsize=8
            )
    if not np.isfinite(values).all():
        axes.set_title("x: failed", fontsize=9, color=NOTE_COLOUR, loc="right")


def _ticks(axes: Axes, x_words: list[str], y_words: list[str]) -> None:
    for words, put, along in ((x_words, axes.set_xticks, "x"), (y_words, axes.set_yticks, "y")):
        step = max(1, len(words) // 12)
        long = along == "x" and max(map(len, words)) > 6
        turned: dict[str, Any] = {"rotation": 25, "ha": "right"} if long else {}
        put(range(0, len(words), step), words[::step], fontsize=8.5, **turned)


def plot_matrix(study: Study, table: Table) -> Figure:
    """Draw every parameter against every other, points coloured by the study's first metric; on the diagonal the
    metric over the parameter. Failed points are crosses.
    """
    axes_drawn, name = study.design.axes[:_MOST_PARAMETERS], study.metrics[0]
    count = len(axes_drawn)
    rows = [study.design.labels(point) for point in range(len(study))]
    columns = [axis_scaled(axis, [row[axis.path] for row in rows]) for axis in axes_drawn]
    label, values = metric_scaled(study, name, good_values(study, table, name))
    figure = new_figure(1.6 + 2.5 * count, 1.0 + 2.3 * count)
    panels = figure.subplots(count, count, squeeze=False)
    size = float(np.clip(3000 / max(len(study), 1), 3, 25))
    image = None
    for row in range(count):
        for column in range(count):
            axes = panels[row, column]
            if column > row:
                axes.set_visible(False)
                continue
            tidy(axes)
            x, y = columns[column][1], values if row == column else columns[row][1]
            drawn = axes.scatter(x[table.good], y[table.good], c=values[table.good], cmap=COLOUR_MAP, s=size)
            image = image or drawn
            if row != column:
                axes.scatter(x[~table.good], y[~table.good], marker="x", color=VERMILLION, s=size)
            _label_panel(axes, columns, axes_drawn, label, row, column)
    if image is not None:
        figure.colorbar(image, ax=panels, label=label, shrink=0.6)
    _title(figure, study, "x: failed" if not table.good.all() else "")
    return figure


def _label_panel(
    axes: Axes, columns: list[Any], parameters: Sequence[Axis], metric: str, row: int, column: int
) -> None:
    named = [parameter.unit is None for parameter in parameters]
    x_text, y_text = columns[column][0], columns[row][0] if row != column else metric
    if row == len(columns) - 1:
        axes.set_xlabel(x_text, fontsize=8)
    if column == 0 or row == column:
        axes.set_ylabel(y_text, fontsize=8)
    axes.tick_params(labelsize=7)
    if named[column]:
        _words_at_ticks(axes.set_xticks, columns[column], rotation=20, ha="right")
    if named[row] and row != column:
        _words_at_ticks(axes.set_yticks, columns[row])


def _words_at_ticks(put: Any, column: Any, **turned: Any) -> None:
    """The words of a parameter that is no number at its ticks."""
    known = dict(zip(column[1], column[2], strict=True))
    put(list(known), list(known.values()), fontsize=7, **turned)


def _title(figure: Figure, study: Study, further: str = "") -> None:
    text = f"{study.name}{f'   {further}' if further else ''}"
    figure.suptitle(text, fontsize=11.5, fontweight="bold", x=0.02, ha="left")
