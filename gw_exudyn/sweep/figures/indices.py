"""Sensitivity indices as bars with their confidence intervals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gw_exudyn.plots.style import BLUE, ORANGE, new_figure, tidy
from gw_exudyn.sweep.figures.scales import axis_name, scaled
from gw_exudyn.sweep.sensitivity import Index, indices
from gw_exudyn.sweep.studies.axes import Axis
from gw_exudyn.sweep.studies.study import Study
from gw_exudyn.sweep.table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MOST_PANELS = 4
_WORDS = {
    "S1": "first order, S1",
    "ST": "total, ST",
    "mu_star": "mean absolute effect, mu*",
    "sigma": "spread of effects, sigma",
}


def plot_indices(study: Study, table: Table) -> Figure | None:
    """Draw the indices of the study's metrics, a panel each; None where none could be computed."""
    found: dict[str, list[Index]] = {}
    for metric in study.metrics[:_MOST_PANELS]:
        try:
            found[metric], _ = indices(study, table, metric, study.metric_table[metric].unit)
        except ValueError:
            continue  # told already, when they were written
    if not found:
        return None
    figure = new_figure(2.2 + 4.2 * len(found), 1.6 + 0.7 * len(study.design.axes))
    panels = figure.subplots(1, len(found), sharey=True, squeeze=False)[0]
    panels[0].invert_yaxis()  # for all panels: they share the axis
    for axes, (metric, several) in zip(panels, found.items(), strict=True):
        _bars(axes, metric, several, study.design.axes)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize=9, frameon=False)
    title = f"{study.name}: sensitivity, bars of 95 % confidence"
    figure.suptitle(title, fontsize=11.5, fontweight="bold", x=0.02, ha="left")
    return figure


def _bars(axes: Any, metric: str, several: list[Index], parameters: Sequence[Axis]) -> None:
    tidy(axes)
    paths = [parameter.path for parameter in parameters]
    names = list(dict.fromkeys(one.name for one in several))
    text, values = scaled(metric.replace("_", " "), several[0].unit, np.array([one.value for one in several]))
    factor = values / np.array([one.value or 1.0 for one in several])
    for number, name in enumerate(names):
        mine = {one.path: (one, k) for one, k in zip(several, factor, strict=True) if one.name == name}
        place = np.arange(len(paths)) - 0.2 + 0.4 * number  # the axis points down: the first lies above
        size = [mine[path][0].value * (mine[path][1] or 1.0) for path in paths]
        halves = [mine[path][0].confidence * (mine[path][1] or 1.0) for path in paths]
        bars = None if np.isnan(halves).all() else halves
        colour = (BLUE, ORANGE)[number]
        axes.barh(
            place, size, 0.38, xerr=bars, color=colour, label=_WORDS[name], error_kw={"linewidth": 1, "capsize": 3}
        )
    axes.set_yticks(range(len(paths)), [axis_name(parameter) for parameter in parameters], fontsize=9)
    axes.axvline(0.0, color="black", linewidth=0.6)
    axes.set_xlabel(f"share of the variance of {text}" if "S1" in names else text)
