"""What a person should know of how wire, vessel and catheter lie together before the run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.model.law import Surroundings
from gw_exudyn.model.outline import Outline
from gw_exudyn.model.walls import Tube

if TYPE_CHECKING:
    from gw_exudyn.scenario import Scenario

_WIDE = 100.0
"""Lumens from this many wire diameters on are more likely a slip of units than a vessel."""

_AT_EXIT = 1e-6
"""m: an entrance this near to the catheter's exit is where the catheter comes in."""


def placing_warnings(scenario: Scenario, outline: Outline, tube: Tube, around: Surroundings) -> list[str]:
    """Sentences for the user. outline : in the catheter's frame, where its axis is x and its exit the origin."""
    if not len(outline.points):
        return []
    # Across the lumen instead of along it, the catheter would take the lumen's length for its width.
    return _through_a_wall(scenario, outline, tube) or _too_wide(scenario, around)


def _through_a_wall(scenario: Scenario, outline: Outline, tube: Tube) -> list[str]:
    """Where the catheter's axis, behind the exit, crosses an edge that is no open end."""
    a, b = outline.points, np.roll(outline.points, -1, axis=0)
    wall = np.array([i not in outline.open_edges for i in range(len(a))])
    crosses = wall & ((a[:, 1] > 0) != (b[:, 1] > 0))
    rise = np.where(crosses, b[:, 1] - a[:, 1], 1.0)
    at = a[:, 0] - a[:, 1] / rise * (b[:, 0] - a[:, 0])
    found = at[crosses & (at < _AT_EXIT) & (at > -tube.length)]
    if not len(found):
        return []
    turn, behind = scenario.catheter.direction, float(found.max())
    x, y = np.array(scenario.catheter.exit) + behind * np.array([np.cos(turn), np.sin(turn)])
    return [
        f"the catheter comes in through a wall of the vessel, at ({x * 1e3:.4g}, {y * 1e3:.4g}) mm; if the vessel is "
        "open there, mark that edge as open (open_edges, or the column open of a CSV file), else move the catheter"
    ]


def _too_wide(scenario: Scenario, around: Surroundings) -> list[str]:
    times = around.width / scenario.wire.diameter
    if times < _WIDE:
        return []
    return [
        f"the lumen at the exit is {around.width * 1e3:.4g} mm wide, {times:.0f} times as wide as the wire; see "
        "whether the vessel's unit of length is right"
    ]
