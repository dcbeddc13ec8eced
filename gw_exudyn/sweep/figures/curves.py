"""Forces over insertion depth, a line a point."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.plots.style import LINE_STYLES, RESULT_COLOURS, VERMILLION, axis_label, new_figure, shown, tidy
from gw_exudyn.result import Floats
from gw_exudyn.sweep.dataset import METRIC
from gw_exudyn.sweep.figures.scales import COLOUR_MAP, axis_scaled
from gw_exudyn.sweep.studies.axes import Axis
from gw_exudyn.sweep.studies.study import Study

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

QUANTITIES_DRAWN = ("push_force", "wall_force_normal")
ABSCISSA = "insertion_depth"

_MOST_LINES = 200
_MOST_STYLES = len(LINE_STYLES)


def plot_curves(study: Study, dataset: xr.Dataset) -> Figure:
    """Draw push force and normal force on the vessel over insertion depth. Colours show the parameter with the most
    values, of a sample that which goes best with the study's first metric; line styles show another one with few. Of
    many points a part is drawn, evenly chosen. Points that failed are thin and red, and have no say in the limits.
    """
    count = len(study.design)
    chosen = np.unique(np.linspace(0, count - 1, min(count, _MOST_LINES)).astype(int))
    depth = curves_of(study, dataset, ABSCISSA, chosen)
    good = np.asarray(dataset["trusted"].values).ravel()[chosen] == 1
    colours, styles, legend = _looks(study, dataset, chosen)
    if not good.all():
        legend["failed"] = True
    figure = new_figure(11.0, 5.0)
    panels = figure.subplots(1, len(QUANTITIES_DRAWN))
    for axes, name in zip(panels, QUANTITIES_DRAWN, strict=True):
        _draw(axes, name, depth, curves_of(study, dataset, name, chosen), good, list(zip(colours, styles, strict=True)))
    _explain(figure, panels, legend)
    told = "" if len(chosen) == count else f", {len(chosen)} of {count} points"
    figure.suptitle(f"{study.name}{told}", fontsize=11.5, fontweight="bold", x=0.02, ha="left")
    return figure


def curves_of(study: Study, dataset: xr.Dataset, name: str, points: Any) -> Floats:
    """(points, t) a time series of some points, in SI."""
    if not study.design.grid:
        return np.asarray(dataset[name][points].values, dtype=float)
    return np.stack([dataset[name][study.design.indices(int(point))].values for point in points])


def _draw(axes: Axes, name: str, depth: Floats, values: Floats, good: NDArray[np.bool_], looks: list[Any]) -> None:
    tidy(axes)
    x_unit, x_factor = shown(ABSCISSA, depth)
    y_unit, y_factor = shown(name, values[good] if good.any() else values)
    faint = 1.0 if len(values) <= 20 else 0.5
    axes.margins(x=0.01)
    for x, y, trusted, (colour, style) in zip(depth, values, good, looks, strict=True):
        if trusted:
            axes.plot(x * x_factor, y * y_factor, color=colour, linestyle=style, linewidth=1.3, alpha=faint)
    limits = axes.get_ylim()
    for x, y in zip(depth[~good], values[~good], strict=True):
        axes.plot(x * x_factor, y * y_factor, color=VERMILLION, linewidth=0.7)
    if good.any():
        axes.set_ylim(limits)
    axes.set_xlabel(axis_label(ABSCISSA.replace("_", " "), x_unit))
    axes.set_ylabel(axis_label(name.replace("_", " "), y_unit))


def _by_colour(study: Study, dataset: xr.Dataset, columns: dict[str, list[float | str]]) -> Axis:
    """The parameter that colours show: the one with the most values, or, of a sample, the one whose order is most that
    of the study's first metric.
    """
    axes = study.design.axes
    numeric = [axis for axis in axes if axis.unit is not None] or list(axes)
    if study.mode != "sample" or len(numeric) == 1 or numeric[0].unit is None:
        return max(numeric, key=lambda axis: len(set(columns[axis.path])))
    from scipy.stats import spearmanr

    metric = np.asarray(dataset[f"{METRIC}{study.metrics[0]}"].values, dtype=float)
    known = np.isfinite(metric) & (np.asarray(dataset["trusted"].values) == 1)
    if known.sum() < 3 or np.ptp(metric[known]) == 0:
        return numeric[0]
    rows = [study.design.labels(int(point)) for point in np.flatnonzero(known)]

    def alike(axis: Axis) -> float:
        values = np.array([row[axis.path] for row in rows], dtype=float)
        return 0.0 if np.ptp(values) == 0 else abs(float(spearmanr(values, metric[known]).statistic))

    return max(numeric, key=alike)


def _looks(study: Study, dataset: xr.Dataset, points: Any) -> tuple[list[Any], list[str], dict[str, Any]]:
    """Colour and line style of each point, and what a legend needs to explain them."""
    from matplotlib import colormaps
    from matplotlib.colors import Normalize

    axes = study.design.axes
    rows = [study.design.labels(int(point)) for point in points]
    columns = {axis.path: [row[axis.path] for row in rows] for axis in axes}
    by_colour = _by_colour(study, dataset, columns)
    few = [a for a in axes if a is not by_colour and 1 < len(set(columns[a.path])) <= _MOST_STYLES]
    by_style = few[0] if few else None
    text, values, words = axis_scaled(by_colour, columns[by_colour.path])
    legend: dict[str, Any] = {"colour": text, "styles": {}}
    if by_colour.unit is None:
        legend["words"] = _word_looks(list(dict.fromkeys(words)), by_style is None)
        looks = [legend["words"][word] for word in words]
        colours: list[Any] = [colour for colour, _ in looks]
    else:
        norm = Normalize(float(values.min()), float(values.max()))
        legend["scale"] = (norm, COLOUR_MAP)
        colours = [colormaps[COLOUR_MAP](norm(value) * 0.9) for value in values]
        looks = [(colour, "-") for colour in colours]
    if by_style is None:
        return colours, [style for _, style in looks], legend
    style_text, _, style_words = axis_scaled(by_style, columns[by_style.path])
    known = list(dict.fromkeys(style_words))
    legend["styles"] = {f"{style_text}: {word}": LINE_STYLES[i] for i, word in enumerate(known)}
    return colours, [LINE_STYLES[known.index(word)] for word in style_words], legend


def _word_looks(words: list[str], styles: bool) -> dict[str, tuple[Any, str]]:
    """Colour and line style of each word: colours that can be told apart, and where they run out other styles, if these
    say nothing else.
    """
    count = len(RESULT_COLOURS)
    return {
        word: (RESULT_COLOURS[i % count], LINE_STYLES[i // count % _MOST_STYLES] if styles else "-")
        for i, word in enumerate(words)
    }


def _explain(figure: Figure, panels: Any, legend: dict[str, Any]) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], color="#404040", linestyle=style, label=text) for text, style in legend["styles"].items()]
    looks = legend.get("words", {})
    handles += [Line2D([], [], color=colour, linestyle=style, label=word) for word, (colour, style) in looks.items()]
    if "failed" in legend:
        handles.append(Line2D([], [], color=VERMILLION, linewidth=0.7, label="failed"))
    if handles:
        figure.legend(handles=handles, loc="outside lower center", ncols=2, fontsize=9, frameon=False)
    if "scale" in legend:
        from matplotlib import colormaps

        norm, name = legend["scale"]
        used = ListedColormap(colormaps[name](np.linspace(0, 0.9, 256)))
        figure.colorbar(ScalarMappable(norm, used), ax=panels, label=legend["colour"])
