"""A scenario before it is run: lumen, walls, open ends, corners, branches, the catheter and the wire at its start."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.plots.scene import panel_size, set_view, wire_area
from gw_exudyn.plots.style import (
    BLUE,
    CATHETER_COLOUR,
    GREEN,
    LUMEN_COLOUR,
    NOTE_COLOUR,
    VERMILLION,
    WALL_COLOUR,
    label_places,
    new_figure,
    place_factor,
    tidy,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Drawing:
    """What is drawn, in the scenario's plane, m.

    lumen : (k, 2) outline. walls, catheter : polylines. open_ends : (2, 2) each. corners : (k, 2), those that the
        wire can turn round. branches : centre line by name. wire : (n + 1, 2) nodes at the start. diameter : m, of the
        wire.
    """

    title: str
    lumen: Floats
    walls: Sequence[Floats]
    open_ends: Sequence[Floats]
    corners: Floats
    catheter: Sequence[Floats]
    branches: Mapping[str, Floats]
    wire: Floats
    diameter: float


def plot_drawing(drawing: Drawing) -> Figure:
    """The figure, with equal scales and a legend."""
    low, high = drawing.lumen.min(axis=0), drawing.lumen.max(axis=0)
    margin = 0.08 * float((high - low).max())
    limits = np.array([low - margin, high + margin])
    width, height = panel_size(limits)
    figure = new_figure(width + 1.0, height + 1.4)
    axes = figure.subplots()
    _draw(axes, drawing)
    set_view(axes, limits)
    label_places(axes)
    tidy(axes)
    axes.set_title(drawing.title, loc="left", fontsize=11.5, fontweight="bold")
    figure.legend(loc="outside lower center", ncols=4, frameon=False, fontsize=9)
    return figure


def _draw(axes: Axes, drawing: Drawing) -> None:
    scale = place_factor()
    axes.fill(*(drawing.lumen * scale).T, facecolor=LUMEN_COLOUR, edgecolor="none", zorder=0)
    for i, line in enumerate(drawing.walls):
        axes.plot(*(line * scale).T, color=WALL_COLOUR, linewidth=1.4, zorder=2, label=_once("wall", i))
    for i, line in enumerate(drawing.open_ends):
        label = _once("open end", i)
        axes.plot(*(line * scale).T, color=GREEN, linewidth=2.0, linestyle=":", zorder=3, label=label)
    if len(drawing.corners):
        x, y = (drawing.corners * scale).T
        axes.plot(x, y, linestyle="none", marker="o", markersize=3.5, color=VERMILLION, zorder=4, label="corner")
    for i, line in enumerate(drawing.catheter):
        axes.plot(*(line * scale).T, color=CATHETER_COLOUR, linewidth=2.0, zorder=3, label=_once("catheter", i))
    area = wire_area(drawing.wire, drawing.diameter)
    if area is not None:
        axes.fill(*(area * scale).T, facecolor=BLUE, edgecolor=BLUE, linewidth=0.5, zorder=5, label="wire at its start")
    for name, line in drawing.branches.items():
        x, y = _label_place(line) * scale
        box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "boxstyle": "round,pad=0.15"}
        axes.annotate(name, (x, y), ha="center", va="center", fontsize=9, color=NOTE_COLOUR, zorder=6, bbox=box)


def _once(label: str, i: int) -> str:
    """A label that the legend shows for the first of many."""
    return label if i == 0 else "_" + label


def _label_place(line: Floats) -> Floats:
    """A place two thirds along a centre line, away from where branches meet."""
    places = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    return np.array([np.interp(0.65 * places[-1], places, line[:, k]) for k in range(2)])
