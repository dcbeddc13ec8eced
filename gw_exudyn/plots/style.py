"""What all figures share: colours, sizes, axis labels from the table of quantities, titles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.quantities import QUANTITIES, display, display_unit, plain
from gw_exudyn.result import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.transforms import Transform

    from gw_exudyn.result import Floats

# Okabe and Ito's palette, told apart with any colour vision (Color Universal Design, 2008).
BLACK = "#000000"
ORANGE = "#E69F00"
SKY_BLUE = "#56B4E9"
GREEN = "#009E73"
YELLOW = "#F0E442"
BLUE = "#0072B2"
VERMILLION = "#D55E00"
PURPLE = "#CC79A7"

RESULT_COLOURS = (BLUE, ORANGE, GREEN, PURPLE, SKY_BLUE, BLACK)
FORCE_COLOUR = VERMILLION
WALL_COLOUR = "#4D4D4D"
LUMEN_COLOUR = "#F3EFE9"
CATHETER_COLOUR = "#9DB4C0"
NOTE_COLOUR = "#595959"
LINE_STYLES = ("-", "--", "-.", ":")


def new_figure(width: float, height: float) -> Figure:
    """A figure of so many inches, without pyplot."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained", facecolor="white")


def tidy(axes: Axes) -> None:
    """The look of an axis: open at the top and right, a faint grid behind."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(True, color="#E3E3E3", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=9, color="#808080")


def axis_label(text: str, unit: str) -> str:
    """Text and unit as an axis shows them; a pure number shows no unit."""
    return text if unit == "1" else f"{text} [{plain(unit)}]"


def label_places(axes: Axes, x: bool = True, y: bool = True) -> None:
    """Label axes that show the plane of the vessel, in the display unit of lengths."""
    unit = plain(QUANTITIES["node_x"].display_unit)
    if x:
        axes.set_xlabel(f"x [{unit}]")
    if y:
        axes.set_ylabel(f"y [{unit}]")


def place_factor() -> float:
    """Factor from metres to the unit in which the plane of the vessel is drawn."""
    return display_unit("node_x")[1]


def shown(name: str, *values: Floats) -> tuple[str, float]:
    """Display unit and factor for the quantity `name` that fit all the values."""
    finite = [abs(array[np.isfinite(array)]).max(initial=0.0) for array in values]
    return display_unit(name, max(finite, default=0.0))


def points_from_axes(axes: Axes, right: float, up: float, *, data_x: bool = False) -> Transform:
    """Transform of fractions of the axes, shifted by typographic points; with `data_x`, x is in data coordinates
    instead.
    """
    from matplotlib.transforms import ScaledTranslation, blended_transform_factory

    base = blended_transform_factory(axes.transData, axes.transAxes) if data_x else axes.transAxes
    return base + ScaledTranslation(right / 72.0, up / 72.0, axes.figure.dpi_scale_trans)


def as_results(results: Result | Sequence[Result]) -> list[Result]:
    """One result or several as a list. Raises ValueError where there is none."""
    found = [results] if isinstance(results, Result) else list(results)
    if not found:
        raise ValueError("nothing to draw: give at least one result")
    return found


def wire_words(result: Result) -> str:
    """The wire in words: its model, if it has one, and its diameter."""
    model = getattr(result.scenario.wire, "model", None)
    return f"{model or 'wire'}, {display('node_x', result.scenario.wire.diameter)}"


def set_title(axes: Axes, result: Result, *further: str) -> None:
    """Scenario in bold above the plain lines: the wire, `further`, and a warning where the run can't be trusted."""
    axes.set_title("\n".join(further), fontsize=9.5, loc="left", color="#202020", linespacing=1.35)
    lines = len(further)
    axes.annotate(
        result.scenario.name,
        (0.0, 1.0),
        xytext=(0.0, 6.0 + 12.8 * lines),
        xycoords="axes fraction",
        textcoords="offset points",
        fontsize=11.5,
        fontweight="bold",
        va="bottom",
        annotation_clip=False,
    )


def warn_untrusted(axes: Axes, result: Result) -> None:
    """Say on the axes that the run can't be trusted, and why; nothing where it can."""
    if result.status.status.trusted:
        return
    when = "" if result.status.time is None else f" at t = {result.status.time:.4g} s"
    axes.annotate(
        f"NOT TO BE TRUSTED{when}: {result.status.status.name.lower().replace('_', ' ')}",
        (0.5, 0.985),
        xycoords="axes fraction",
        ha="center",
        va="top",
        fontsize=9,
        fontweight="bold",
        color="white",
        bbox={"facecolor": VERMILLION, "edgecolor": "none", "boxstyle": "round,pad=0.35"},
        zorder=20,
    )
