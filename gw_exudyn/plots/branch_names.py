"""Names of the vessel's branches beside their walls, small, and out of the way of what is drawn over them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.plots.style import NOTE_COLOUR, place_factor

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from gw_exudyn.result import Floats, Result
    from gw_exudyn.scenario.vessels.regions import Region

_PLACES = (0.7, 0.55, 0.85, 0.4)
"""Where along a branch its name may stand, best first; away from where branches meet."""
_STEEP = 0.4
"""Share of a direction from which it counts as sideways, or as up or down."""


def draw_branch_names(axes: Axes, result: Result, limits: Floats, busy: Floats) -> None:
    """Write the names of the branches in view beside them; nothing where the vessel has none.

    limits : [[x0, y0], [x1, y1]], m, of the view. busy : (k, 2), m, points to keep away from, such as arrows.
    """
    vessel = result.scenario.vessel
    if not vessel.has_branches:
        return
    clear = 0.08 * float(np.diff(limits, axis=0).max())
    margin = 0.06 * np.diff(limits, axis=0)[0]
    for name, region in vessel.regions().items():
        spots = [
            (point, away)
            for point, away in _spots(region)
            if (point > limits[0] + margin).all() and (point < limits[1] - margin).all()
        ]
        if spots:
            _write(axes, name, *min(spots, key=lambda spot: _crowd(spot[0] + clear / 2 * spot[1], busy, clear)))


def _spots(region: Region) -> Iterator[tuple[Floats, Floats]]:
    """Points on the branch's walls, (2,), m, with the direction out of the lumen there."""
    import shapely

    line = region.centre_line
    if line is None:
        return
    edge, course = shapely.LinearRing(region.outline), shapely.LineString(line)
    for share in _PLACES:
        middle, further = (
            np.array(course.interpolate(part, normalized=True).coords[0]) for part in (share, share + 0.01)
        )
        along = (further - middle) / np.hypot(*(further - middle))
        for away in (np.array([-along[1], along[0]]), np.array([along[1], -along[0]])):
            yield middle + away * edge.distance(shapely.Point(middle)), away


def _crowd(point: Floats, busy: Floats, clear: float) -> float:
    """How much a place is in the way: 0 for one that is clear of all, so that the first of those is taken."""
    near = np.hypot(*(busy - point).T).min(initial=np.inf)
    return max(0.0, clear - float(near))


def _write(axes: Axes, name: str, point: Floats, away: Floats) -> None:
    axes.annotate(
        name,
        tuple(point * place_factor()),
        xytext=tuple(4.0 * away),
        textcoords="offset points",
        ha="center" if abs(away[0]) < _STEEP else "left" if away[0] > 0 else "right",
        va="center" if abs(away[1]) < _STEEP else "bottom" if away[1] > 0 else "top",
        fontsize=8,
        fontstyle="italic",
        color=NOTE_COLOUR,
        zorder=4,
    )
