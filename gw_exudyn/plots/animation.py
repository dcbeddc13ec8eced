"""The insertion as a moving picture: the wire in the vessel with its contact forces, and the forces over time.

GIF needs nothing but Pillow, which comes with matplotlib; MP4 needs ffmpeg on the path.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gw_exudyn.errors import StorageError, UsageError
from gw_exudyn.plots.arrows import BUNDLE, LONGEST_ARROW, bundles, draw_arrows, round_down
from gw_exudyn.plots.contact_vectors import vessel_contacts
from gw_exudyn.plots.scene import beyond_exit, centreline, draw_vessel, panel_size, set_view, view, wire_area
from gw_exudyn.plots.style import (
    BLACK,
    BLUE,
    FORCE_COLOUR,
    axis_label,
    label_places,
    new_figure,
    place_factor,
    points_from_axes,
    set_title,
    shown,
    tidy,
    warn_untrusted,
    wire_words,
)
from gw_exudyn.quantities import display

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    from gw_exudyn.result import Floats, Result

FORMATS = (".gif", ".mp4")
_RESOLUTION = 100


class Film:
    """A figure of a run that can be set to any output instant.

    figure : matplotlib's. The walls and the curves are drawn once; `show(instant)` moves the rest.
    """

    def __init__(self, result: Result) -> None:
        self._result = result
        instants = np.unique(np.linspace(0, len(result.time) - 1, 9).astype(int))
        limits = view(result, np.concatenate([beyond_exit(result, int(i)) for i in instants]))
        width, height = panel_size(limits)
        self.figure: Figure = new_figure(width + 0.9, height + 3.2)
        above, below = self.figure.subplots(2, 1, height_ratios=(height + 0.6, 1.9))
        self._size = float(np.diff(limits, axis=0).max())
        self._per_newton = _arrow_length(result, self._size)
        self._axes: Axes = above
        self._draw_scene(above, limits)
        self._cursor = self._draw_curves(below)
        self._moving: list[Any] = []

    def show(self, instant: int) -> None:
        """Set wire, forces and cursor to an output instant (an index)."""
        for artist in self._moving:
            artist.remove()
        self._moving = [*self._wire(instant), *self._arrows(instant)]
        time, unit_time = self._result.time[instant], shown("time", self._result.time)
        self._cursor.set_xdata([time * unit_time[1]] * 2)
        depth = display("insertion_depth", float(self._result.values("insertion_depth")[instant]))
        push = display("push_force", float(self._result.values("push_force")[instant]))
        self._words.set_text(f"{display('time', float(time))}, {depth} in, push force {push}")

    def _draw_scene(self, axes: Axes, limits: Floats) -> None:
        tidy(axes)
        draw_vessel(axes, self._result)
        set_view(axes, limits)
        label_places(axes)
        set_title(axes, self._result, wire_words(self._result), " ")
        self._words = axes.annotate(
            "", (0.0, 1.0), xytext=(0.0, 5.0), xycoords="axes fraction", textcoords="offset points", fontsize=9.5
        )
        warn_untrusted(axes, self._result)
        if self._per_newton > 0:
            force = round_down(self._size * LONGEST_ARROW / self._per_newton)
            self._key(axes, limits, force)

    def _key(self, axes: Axes, limits: Floats, force: float) -> None:
        """A bar as long as the arrow of a round force, above the upper right corner."""
        above = points_from_axes(axes, 0.0, 9.0, data_x=True)
        right = float(limits[1, 0]) * place_factor()
        ends = [right - force * self._per_newton * place_factor(), right]
        axes.plot(ends, [1.0, 1.0], color=FORCE_COLOUR, linewidth=2.5, transform=above, clip_on=False)
        words = f"{display('push_force', force)} on the wall"
        above = points_from_axes(axes, 0.0, 14.0, data_x=True)
        axes.text(right, 1.0, words, transform=above, ha="right", va="bottom", fontsize=8.5)

    def _draw_curves(self, axes: Axes) -> Line2D:
        tidy(axes)
        result = self._result
        vessel = np.hypot(result.values("wall_force_x"), result.values("wall_force_y"))
        unit, factor = shown("push_force", result.values("push_force"), vessel)
        time_unit, seconds = shown("time", result.time)
        axes.plot(result.time * seconds, result.values("push_force") * factor, color=BLUE, label="push force")
        axes.plot(
            result.time * seconds, vessel * factor, color=FORCE_COLOUR, linestyle="--", label="resultant on the vessel"
        )
        axes.set_ylabel(axis_label("force", unit))
        axes.set_xlabel(axis_label("time", time_unit))
        axes.margins(x=0.01)
        axes.legend(loc="upper left", fontsize=8.5, framealpha=0.9)
        return axes.axvline(0.0, color=BLACK, linewidth=1.0)

    def _wire(self, instant: int) -> list[Any]:
        area = wire_area(centreline(self._result, instant), self._result.scenario.wire.diameter)
        if area is None:
            return []
        return self._axes.fill(*(area * place_factor()).T, facecolor=BLUE, edgecolor=BLUE, linewidth=0.8, zorder=5)

    def _arrows(self, instant: int) -> list[Any]:
        points, forces = _forces(self._result, instant, self._size)
        kept = np.linalg.norm(forces, axis=1) * self._per_newton > 0.005 * self._size
        return draw_arrows(self._axes, points[kept], self._per_newton * forces[kept], FORCE_COLOUR, 7.0)


def save_animation(
    result: Result,
    path: str | Path,
    *,
    frames: int = 120,
    rate: float = 15.0,
    progress: Callable[[int, int], None] | None = None,
) -> Path:
    """Write a run as `path`, a `.gif` or an `.mp4`, of so many frames at most, `rate` a second; return the path.

    The frames are evenly spread over the outputs. The file appears whole or not at all.
    Raises UsageError for another ending, StorageError where ffmpeg is missing or the disk refuses.
    """
    target = Path(path)
    kind = target.suffix.lower()
    if kind not in FORMATS:
        raise UsageError(f"{target}: an animation ends in {' or '.join(FORMATS)}")
    if kind == ".mp4" and shutil.which("ffmpeg") is None:
        raise StorageError(f"{target}: ffmpeg is not there, and MP4 needs it; take a name that ends in .gif")
    instants = np.unique(np.linspace(0, len(result.time) - 1, max(2, frames)).round().astype(int))
    unfinished = target.with_name(f".{target.stem}.{os.getpid()}{kind}")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        _write(Film(result), [int(i) for i in instants], unfinished, rate, progress)
        unfinished.replace(target)
    except OSError as error:
        raise StorageError(f"{target}: can't be written: {error.strerror or error}; name another place") from error
    finally:
        with suppress(OSError):
            unfinished.unlink(missing_ok=True)
    return target


def _write(
    film: Film, instants: list[int], path: Path, rate: float, progress: Callable[[int, int], None] | None
) -> None:
    from matplotlib.animation import FFMpegWriter, PillowWriter

    writer = (FFMpegWriter if path.suffix == ".mp4" else PillowWriter)(fps=max(1, round(rate)))
    film.show(instants[0])
    film.figure.set_dpi(_RESOLUTION)
    film.figure.draw_without_rendering()
    film.figure.set_layout_engine("none")  # the layout stays that of the first frame
    with writer.saving(film.figure, str(path), _RESOLUTION):
        for number, instant in enumerate(instants):
            film.show(instant)
            writer.grab_frame()
            if progress is not None:
                progress(number + 1, len(instants))


def _forces(result: Result, instant: int, size: float) -> tuple[Floats, Floats]:
    """Points and forces, both (k, 2), on the vessel at an instant, close neighbours put together."""
    return bundles(*vessel_contacts(result, instant), size * BUNDLE)


def _arrow_length(result: Result, size: float) -> float:
    """Length of arrow, m, per newton: one scale for the whole run; 0 where nothing touches."""
    largest = max(
        (float(np.linalg.norm(_forces(result, i, size)[1], axis=1).max(initial=0.0)) for i in range(len(result.time))),
        default=0.0,
    )
    return LONGEST_ARROW * size / largest if largest > 0 else 0.0
