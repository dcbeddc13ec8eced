"""Charts of cases as figures: theory as lines, what was measured as points."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING

from gw_exudyn.plots.save import render
from gw_exudyn.plots.style import LINE_STYLES, RESULT_COLOURS, WALL_COLOUR, new_figure, tidy
from gw_exudyn.verification.evidence import Chart

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WIDTH, HEIGHT = 7.2, 4.4  # inches
_MARKERS = "os^vDPX*<>"


def png(chart: Chart) -> bytes:
    """The chart as a PNG; the same chart gives the same bytes."""
    return render(figure(chart), "png")


def figure(chart: Chart) -> Figure:
    """The chart as a figure. Charts whose axes are both places in a plane are drawn true to scale."""
    drawn = new_figure(WIDTH, HEIGHT)
    axes = drawn.subplots()
    colours, markers, styles = cycle(RESULT_COLOURS), cycle(_MARKERS), cycle(LINE_STYLES)
    for curve in chart.curves:
        if curve.label == "walls" or not curve.label:
            axes.plot(curve.x, curve.y, "-", color=WALL_COLOUR, linewidth=1.4, label=curve.label or None)
        elif curve.style == "line":
            axes.plot(curve.x, curve.y, next(styles), color=next(colours), linewidth=1.4, label=curve.label)
        else:
            # Some sixty points a curve; more would hide one another.
            shown = slice(None, None, max(1, len(curve.x) // 60))
            axes.plot(
                curve.x[shown],
                curve.y[shown],
                linestyle="",
                color=next(colours),
                label=curve.label,
                marker=next(markers),
                markersize=4.0,
                markerfacecolor="none",
                markeredgewidth=0.9,
            )
    if chart.scales == "log":
        axes.set_xscale("log")
        axes.set_yscale("log")
    if chart.x_label.endswith("x / mm") and chart.y_label.endswith("y / mm"):
        axes.set_aspect("equal", adjustable="datalim")
    axes.set_title(chart.title, fontsize=10.5, loc="left")
    axes.set_xlabel(chart.x_label)
    axes.set_ylabel(chart.y_label)
    tidy(axes)
    axes.legend(fontsize=8, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return drawn
