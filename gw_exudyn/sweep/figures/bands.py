"""Median and the band from 5 to 95 % of curves over the points of a sample."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gw_exudyn.plots.style import BLUE, axis_label, new_figure, shown, tidy
from gw_exudyn.sweep.bands import band
from gw_exudyn.sweep.figures.curves import QUANTITIES_DRAWN
from gw_exudyn.sweep.studies.study import Study

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


def plot_bands(study: Study, dataset: xr.Dataset) -> Figure:
    """Draw the bands of push force and normal force on the vessel."""
    figure = new_figure(11.0, 4.6)
    for axes, name in zip(figure.subplots(1, len(QUANTITIES_DRAWN)), QUANTITIES_DRAWN, strict=True):
        found = band(study, dataset, name)
        tidy(axes)
        x_unit, x_factor = shown(found.abscissa, found.x)
        y_unit, y_factor = shown(name, found.high)
        x = found.x * x_factor
        axes.fill_between(
            x, found.low * y_factor, found.high * y_factor, color=BLUE, alpha=0.25, linewidth=0, label="5 to 95 %"
        )
        axes.plot(x, found.median * y_factor, color=BLUE, linewidth=1.6, label="median")
        axes.set_xlabel(axis_label(found.abscissa.replace("_", " "), x_unit))
        axes.set_ylabel(axis_label(name.replace("_", " "), y_unit))
        axes.legend(fontsize=9, frameon=False)
        axes.margins(x=0.01)
    figure.suptitle(f"{study.name}, {len(study)} points", fontsize=11.5, fontweight="bold", x=0.02, ha="left")
    return figure
