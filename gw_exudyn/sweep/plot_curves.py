"""Forces over insertion depth, a line a point."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gw_exudyn.plots.style import LINE_STYLES, RESULT_COLOURS, axis_label, new_figure, shown, tidy
from gw_exudyn.result import Floats
from gw_exudyn.sweep.plot_scales import COLOUR_MAP, axis_scaled
from gw_exudyn.sweep.study import Study

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
    values, line styles another one with few. Of many points a part is drawn, evenly chosen.
    """
    count = len(study.design)
    chosen = np.unique(np.linspace(0, count - 1, min(count, _MOST_LINES)).astype(int))
    depth = curves_of(study, dataset, ABSCISSA, chosen)
    colours, styles, legend = _looks(study, chosen)
    figure = new_figure(11.0, 5.0)
    panels = figure.subplots(1, len(QUANTITIES_DRAWN))
    for axes, name in zip(panels, QUANTITIES_DRAWN, strict=True):
        _draw(axes, name, depth, curves_of(study, dataset, name, chosen), colours, styles)
    _explain(figure, panels, legend)
    told = "" if len(chosen) == count else f", {len(chosen)} of {count} points"
    figure.suptitle(f"{study.name}{told}", fontsize=11.5, fontweight="bold", x=0.02, ha="left")
    return figure


def curves_of(study: Study, dataset: xr.Dataset, name: str, points: Any) -> Floats:
    """(points, t) a time series of some points, in SI."""
    if not study.design.grid:
        return np.asarray(dataset[name][points].values, dtype=float)
    return np.stack([dataset[name][study.design.indices(int(point))].values for point in points])


def _draw(axes: Axes, name: str, depth: Floats, values: Floats, colours: list[Any], styles: list[str]) -> None:
    tidy(axes)
    x_unit, x_factor = shown(ABSCISSA, depth)
    y_unit, y_factor = shown(name, values)
    faint = 1.0 if len(values) <= 20 else 0.5
    for x, y, colour, style in zip(depth, values, colours, styles, strict=True):
        axes.plot(x * x_factor, y * y_factor, color=colour, linestyle=style, linewidth=1.3, alpha=faint)
    axes.set_xlabel(axis_label(ABSCISSA.replace("_", " "), x_unit))
    axes.set_ylabel(axis_label(name.replace("_", " "), y_unit))
    axes.margins(x=0.01)


def _looks(study: Study, points: Any) -> tuple[list[Any], list[str], dict[str, Any]]:
    """Colour and line style of each point, and what a legend needs to explain them."""
    from matplotlib import colormaps
    from matplotlib.colors import Normalize

    axes = study.design.axes
    rows = [study.design.labels(int(point)) for point in points]
    columns = {axis.path: [row[axis.path] for row in rows] for axis in axes}
    numeric = [axis for axis in axes if axis.unit is not None]
    by_colour = max(numeric or axes, key=lambda axis: len(set(columns[axis.path])))
    few = [a for a in axes if a is not by_colour and 1 < len(set(columns[a.path])) <= _MOST_STYLES]
    by_style = few[0] if few else None
    text, values, words = axis_scaled(by_colour, columns[by_colour.path])
    legend: dict[str, Any] = {"colour": text, "styles": {}}
    if by_colour.unit is None:
        known = list(dict.fromkeys(words))
        few_words = len(known) <= len(RESULT_COLOURS)
        palette = RESULT_COLOURS if few_words else [colormaps["tab20"](i) for i in range(20)]
        legend["words"] = {word: palette[i % len(palette)] for i, word in enumerate(known)}
        colours: list[Any] = [legend["words"][word] for word in words]
    else:
        norm = Normalize(float(values.min()), float(values.max()))
        legend["scale"] = (norm, COLOUR_MAP)
        colours = [colormaps[COLOUR_MAP](norm(value) * 0.9) for value in values]
    if by_style is None:
        return colours, ["-"] * len(rows), legend
    style_text, _, style_words = axis_scaled(by_style, columns[by_style.path])
    known = list(dict.fromkeys(style_words))
    legend["styles"] = {f"{style_text}: {word}": LINE_STYLES[i] for i, word in enumerate(known)}
    return colours, [LINE_STYLES[known.index(word)] for word in style_words], legend


def _explain(figure: Figure, panels: Any, legend: dict[str, Any]) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], color="#404040", linestyle=style, label=text) for text, style in legend["styles"].items()]
    handles += [Line2D([], [], color=colour, label=word) for word, colour in legend.get("words", {}).items()]
    if handles:
        figure.legend(handles=handles, loc="outside lower center", ncols=2, fontsize=9, frameon=False)
    if "scale" in legend:
        from matplotlib import colormaps

        norm, name = legend["scale"]
        used = ListedColormap(colormaps[name](np.linspace(0, 0.9, 256)))
        figure.colorbar(ScalarMappable(norm, used), ax=panels, label=legend["colour"])
