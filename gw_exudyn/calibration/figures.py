"""The figures of a calibration: residuals over time, measured over fitted, and the confidence ellipses."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.calibration.report import Report
from gw_exudyn.calibration.statistics import CONFIDENCE
from gw_exudyn.errors import StorageError
from gw_exudyn.plots.style import (
    BLACK,
    BLUE,
    NOTE_COLOUR,
    RESULT_COLOURS,
    VERMILLION,
    axis_label,
    new_figure,
    shown,
    tidy,
)
from gw_exudyn.result import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FIGURES = "figures"
_MOST_PANELS = 8


def write_figures(report: Report, folder: Path) -> list[Path]:
    """Draw and write all. A figure that can't be drawn is a warning."""
    from gw_exudyn.plots.save import save_figure

    drawn: Mapping[str, Callable[[Report], Figure]] = {
        "residuals": plot_residuals,
        "measured_and_fitted": plot_measured,
        "confidence": plot_confidence,
    }
    files = []
    for name, draw in drawn.items():
        try:
            files += save_figure(draw(report), folder / FIGURES / name)
        except StorageError:
            raise
        except Exception as error:  # an hour of computing is not given up for a picture
            told = f"the figure {name} could not be drawn ({type(error).__name__}: {error}); the data is complete"
            warnings.warn(told, RuntimeWarning, stacklevel=2)
    return files


def plot_residuals(report: Report) -> Figure:
    """Draw the residuals of each quantity over time, in units of the noise, with their 95 % band."""
    figure, panels = _panels(report)
    for axes, quantity in panels.items():
        for i, channel in enumerate(one for one in report.channels if one.quantity == quantity):
            colour = RESULT_COLOURS[i % len(RESULT_COLOURS)]
            axes.plot(channel.time, channel.residuals, ".", markersize=3, color=colour, label=channel.file)
        axes.axhline(0, color=BLACK, linewidth=0.8)
        axes.axhspan(-1.96, 1.96, color=NOTE_COLOUR, alpha=0.12, linewidth=0)
        axes.set_ylabel(f"{_words(quantity)}\nresidual / noise", fontsize=9)
    _finish(figure, panels, f"{report.calibration.name}: residuals, reduced chi square {report.statistics.reduced:.3g}")
    return figure


def plot_measured(report: Report) -> Figure:
    """Draw what was measured (dots) over the fitted simulation (lines); a path that was aligned as it was aligned."""
    figure, panels = _panels(report)
    for axes, quantity in panels.items():
        channels = [one for one in report.channels if one.quantity == quantity]
        course = report.fit.course
        until = course.time <= report.observations.end + 1e-9
        unit, factor = shown(quantity, course.values[quantity][until], *(one.measured for one in channels))
        for i, channel in enumerate(channels):
            colour = RESULT_COLOURS[(i + 1) % len(RESULT_COLOURS)]
            axes.plot(channel.time, channel.measured * factor, ".", markersize=3, color=colour, label=channel.file)
        axes.plot(
            course.time[until], course.values[quantity][until] * factor, color=BLUE, linewidth=1.3, label="fitted"
        )
        axes.set_ylabel(axis_label(_words(quantity), unit), fontsize=9)
    _finish(figure, panels, f"{report.calibration.name}: measured and fitted")
    return figure


def plot_confidence(report: Report) -> Figure:
    """Draw the 95 % intervals (diagonal) and the joint 95 % ellipses of every two parameters, in the units of the
    file; limits of the fit that are near are dashed.
    """
    estimates, found = report.estimates, report.statistics
    count = len(estimates)
    factors = np.array([one.parameter.in_told(1.0) for one in estimates])
    ranges = np.array([one.parameter.range for one in estimates]) * factors
    figure = new_figure(1.6 + 2.6 * count, 1.0 + 2.4 * count)
    panels = figure.subplots(count, count, squeeze=False)
    for row in range(count):
        for column in range(count):
            axes = panels[row, column]
            if column > row:
                axes.set_visible(False)
                continue
            tidy(axes)
            if row == column:
                _draw_interval(axes, report, row)
            else:
                pair = [column, row]
                shape = found.covariance[np.ix_(pair, pair)] * np.outer(ranges[pair], ranges[pair])
                centre = np.array([estimates[i].value for i in pair]) * factors[pair]
                axes.plot(*_ellipse(centre, shape, found.degrees), color=BLUE, linewidth=1.3)
                axes.plot(*centre, "o", color=VERMILLION, markersize=4)
                axes.set_title(f"correlation {found.correlation[row, column]:+.2f}", fontsize=8, color=NOTE_COLOUR)
            if row == count - 1:
                axes.set_xlabel(estimates[column].parameter.label, fontsize=8)
            if column == 0 and row > 0:
                axes.set_ylabel(estimates[row].parameter.label, fontsize=8)
            axes.tick_params(labelsize=7)
    _title(figure, f"{report.calibration.name}: {CONFIDENCE:.0%} confidence")
    return figure


def _draw_interval(axes: Axes, report: Report, i: int) -> None:
    one = report.estimates[i]
    value, half, low, high = (
        one.parameter.in_told(x) for x in (one.value, one.half_width, one.parameter.low, one.parameter.high)
    )
    axes.errorbar([value], [0.5], xerr=[half], fmt="o", color=VERMILLION, ecolor=BLUE, capsize=4, markersize=4)
    if low > value - 2 * half:
        axes.axvline(low, color=BLACK, linestyle="--", linewidth=0.8)
    if high < value + 2 * half:
        axes.axvline(high, color=BLACK, linestyle="--", linewidth=0.8)
    axes.set_ylim(0, 1)
    axes.set_yticks([])
    mark = " (not identified)" if one.doubts else ""
    axes.set_title(f"{value:.4g} +- {half:.2g}{mark}", fontsize=8, color=NOTE_COLOUR)


def _ellipse(centre: Floats, covariance: Floats, degrees: int) -> Floats:
    """(2, k) The joint confidence region of two parameters, by the F distribution."""
    from scipy.stats import f

    radius = np.sqrt(2 * f.ppf(CONFIDENCE, 2, degrees))
    values, vectors = np.linalg.eigh(covariance)
    angle = np.linspace(0, 2 * np.pi, 181)
    circle = np.stack([np.cos(angle), np.sin(angle)])
    line: Floats = centre[:, None] + radius * (vectors * np.sqrt(np.maximum(values, 0))) @ circle
    return line


def _panels(report: Report) -> tuple[Figure, dict[Axes, str]]:
    quantities = list(dict.fromkeys(channel.quantity for channel in report.channels))[:_MOST_PANELS]
    figure = new_figure(8.0, 0.9 + 1.9 * len(quantities))
    axes = figure.subplots(len(quantities), 1, sharex=True, squeeze=False)[:, 0]
    return figure, dict(zip(axes, quantities, strict=True))


def _finish(figure: Figure, panels: Mapping[Axes, str], title: str) -> None:
    for axes in panels:
        tidy(axes)
    first, last = next(iter(panels)), list(panels)[-1]
    first.legend(fontsize=8, frameon=False)
    last.set_xlabel(axis_label("time", "s"))
    _title(figure, title)


def _title(figure: Figure, text: str) -> None:
    figure.suptitle(text, fontsize=11.5, fontweight="bold", x=0.02, ha="left")


def _words(quantity: str) -> str:
    return quantity.replace("_", " ")
