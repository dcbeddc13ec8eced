"""Which branch of a vessel a point lies in. Needs the scenario only: a result can be asked long after its run."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gw_exudyn.scenario.section import Section

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    import shapely
    from numpy.typing import ArrayLike, NDArray

NEAR = 0.1e-3
"""How far outside of the lumen a point may lie, m, and still count as in the nearest branch: on a wall that yields."""

WHOLE = "lumen"
"""Name of the one branch of a vessel that has no branches."""


@dataclass(frozen=True, eq=False)
class Region:
    """A branch as an area. outline : (k, 2), m, the branch for itself, reaching into its parent. centre_line : (m, 2),
    m, or None.
    """

    name: str
    outline: NDArray[np.float64]
    centre_line: NDArray[np.float64] | None = None


class Lumen(Section):
    """Base of the vessels: knows its branches by name."""

    def _regions(self) -> tuple[Region, ...]:
        """Every branch."""
        import numpy as np

        return (Region(WHOLE, np.array(self._whole())),)

    def _whole(self) -> Sequence[tuple[float, float]]:
        """The outline of the lumen, m."""
        raise NotImplementedError

    @property
    def branch_names(self) -> tuple[str, ...]:
        """Names of the branches in the order of the file; `lumen` alone for a vessel without branches."""
        return tuple(_regions_of(self))

    @property
    def has_branches(self) -> bool:
        """Whether the vessel has branches by name."""
        return self.branch_names != (WHOLE,)

    def regions(self) -> dict[str, Region]:
        """The branches by name."""
        return dict(_regions_of(self))

    def branch_at(self, points: ArrayLike) -> NDArray[np.str_]:
        """Name of the branch in which each point lies; empty outside the vessel.

        points : (..., 2), m, in the scenario's plane.

        Where branches overlap, at a bifurcation, the one that the file names first has the point: a side branch begins
        where its parent's lumen ends. A point in a rounded corner, or up to NEAR outside of the lumen, is in the
        nearest branch; one that is not finite is in none.
        """
        import numpy as np
        import shapely

        places = np.asarray(points, dtype=float)
        flat = places.reshape(-1, 2)
        dots = shapely.points(np.where(np.isfinite(flat), flat, 1e9))
        if not self.branch_names:  # no vessel at all
            return np.full(places.shape[:-1], "")
        whole, areas = _areas_of(self)
        apart = np.array([shapely.distance(area, dots) for area in areas])
        nearest = np.argmin(apart, axis=0)  # the first of equals
        names = np.array([*self.branch_names, ""])
        inside = shapely.distance(whole, dots) <= NEAR
        found: NDArray[np.str_] = names[np.where(inside, nearest, len(areas))]
        return found.reshape(places.shape[:-1])


@functools.lru_cache(maxsize=32)
def _areas_of(vessel: Lumen) -> tuple[shapely.Polygon, list[shapely.Polygon]]:
    """The lumen, and every branch for itself."""
    import shapely

    areas = [shapely.Polygon(region.outline) for region in _regions_of(vessel).values()]
    whole = shapely.Polygon(vessel._whole())
    shapely.prepare([whole, *areas])
    return whole, areas


@functools.lru_cache(maxsize=32)
def _regions_of(vessel: Lumen) -> dict[str, Region]:
    return {region.name: region for region in vessel._regions()}
