"""The outline of each kind of vessel: the closed lumen, and which of its edges are open ends."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from gw_exudyn.scenario import ArcVessel, BranchesVessel, NoVessel, PolygonVessel, StraightVessel

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Outline:
    """A closed outline with the lumen on its left.

    points : (m, 2), m, counter-clockwise, the first not repeated; none at all without a vessel. open_edges : indices
        of the edges (point i to i + 1) that are open ends and no walls.
    """

    points: Floats
    open_edges: frozenset[int]


def build_outline(vessel: StraightVessel | ArcVessel | BranchesVessel | PolygonVessel | NoVessel) -> Outline:
    """The outline of a vessel of a scenario, in the scenario's plane. The inlet of a channel is open."""
    if vessel.kind == "none":
        return Outline(np.zeros((0, 2)), frozenset())
    if vessel.kind == "polygon":
        return _without_straight_corners(Outline(np.array(vessel.points), frozenset(vessel.open_edges)))
    if vessel.kind == "branches":
        lumen = vessel.lumen()
        return _without_straight_corners(Outline(np.array(lumen.points), frozenset(lumen.open_edges)))
    if vessel.kind == "arc":
        centreline, headings = _arc_centreline(vessel)
    else:
        centreline, headings = np.array([[0.0, 0.0], [vessel.length, 0.0]]), np.zeros(2)
    return _channel(centreline, headings, vessel.diameter, dead_end=vessel.end == "dead")


def _arc_centreline(vessel: ArcVessel) -> tuple[Floats, Floats]:
    """Points of the centreline and the headings (rad) across which the walls are set off there.

    The corners of both walls lie on circles about the arc's centre, so the facets are chords: the lumen is narrower
    by the sagitta on the outside and wider on the inside.
    """
    turn = np.linspace(0.0, vessel.angle, vessel.facets + 1)
    side = math.copysign(1.0, vessel.angle)
    x = vessel.lead_in + vessel.radius * side * np.sin(turn)
    y = side * vessel.radius * (1 - np.cos(turn))
    points, headings = [np.column_stack([x, y])], [turn]
    if vessel.lead_in > 0:
        points.insert(0, np.zeros((1, 2)))
        headings.insert(0, np.zeros(1))
    if vessel.lead_out > 0:
        end = points[-1][-1] + vessel.lead_out * np.array([math.cos(vessel.angle), math.sin(vessel.angle)])
        points.append(end[None])
        headings.append(np.array([vessel.angle]))
    return np.concatenate(points), np.concatenate(headings)


def _channel(centreline: Floats, headings: Floats, diameter: float, *, dead_end: bool) -> Outline:
    across = diameter / 2 * np.column_stack([-np.sin(headings), np.cos(headings)])
    points = np.concatenate([centreline - across, (centreline + across)[::-1]])
    count = len(centreline)
    open_edges = {2 * count - 1} | (set() if dead_end else {count - 1})
    return _without_straight_corners(Outline(points, frozenset(open_edges)))


def _without_straight_corners(outline: Outline) -> Outline:
    """The outline without corners at which it goes straight on (unless an open end begins or ends there)."""
    points, count = outline.points, len(outline.points)
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    sine = (before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]) / (np.hypot(*before.T) * np.hypot(*after.T))
    ahead = (before * after).sum(axis=1) > 0
    is_open = np.array([i in outline.open_edges for i in range(count)])
    kept = ~((np.abs(sine) < 1e-7) & ahead & (is_open == np.roll(is_open, 1)))
    opened = np.flatnonzero(is_open[kept])
    return Outline(points[kept], frozenset(int(i) for i in opened))
