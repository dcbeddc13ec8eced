"""Arrows that show forces: how long they are, which share one, how they are drawn."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np

from gw_exudyn.plots.style import place_factor

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from gw_exudyn.result import Floats

LONGEST_ARROW = 0.15
"""Length of the longest arrow over the longer side of the view."""

BUNDLE = 0.015
"""Contacts closer to each other than this part of the view share one arrow, their resultant."""

# Where the largest forces of two panels differ by more than this, one scale would leave one of them without arrows.
_WIDEST_COMMON_RANGE = 5.0

ForceScale = Literal["auto", "common", "own"]


def arrow_lengths(forces: Sequence[float], longest: float, force_scale: ForceScale) -> list[float]:
    """Length of arrow (m) per newton for each panel; zero where no force is shown."""
    positive = [force for force in forces if force > 0]
    apart = bool(positive) and max(positive) > _WIDEST_COMMON_RANGE * min(positive)
    if force_scale == "own" or (force_scale == "auto" and apart):
        return [longest / force if force > 0 else 0.0 for force in forces]
    return [longest / max(positive) if positive else 0.0] * len(forces)


def bundles(points: Floats, forces: Floats, spacing: float) -> tuple[Floats, Floats]:
    """Points and forces, both (b, 2): resultants of bundles of contacts, each at the middle of its forces.

    A contact joins the first bundle whose first contact is nearer than `spacing` and whose force points the same way
    (to within 60 degrees), so that forces on opposite walls never cancel.
    """
    heads: list[int] = []
    members: list[list[int]] = []
    sizes = np.linalg.norm(forces, axis=1)
    for i in range(len(points)):
        near = [
            b
            for b, head in enumerate(heads)
            if np.hypot(*(points[i] - points[head])) < spacing
            and forces[i] @ forces[head] > 0.5 * sizes[i] * sizes[head]
        ]
        if near:
            members[near[0]].append(i)
        else:
            heads.append(i)
            members.append([i])
    weights = np.maximum(sizes, 1e-300)
    middles = [np.average(points[bundle], axis=0, weights=weights[bundle]) for bundle in members]
    return np.array(middles).reshape(-1, 2), np.array([forces[bundle].sum(axis=0) for bundle in members]).reshape(-1, 2)


def draw_arrows(
    axes: Axes, points: Floats, lengths: Floats, colour: tuple[float, ...] | str, zorder: float
) -> list[Artist]:
    """Draw arrows from the points (k, 2), m, along `lengths` (k, 2), m; what was drawn."""
    if not len(points):
        return []
    scale = place_factor()
    return [
        axes.quiver(
            *(points * scale).T,
            *(lengths * scale).T,
            angles="xy",
            scale_units="xy",
            scale=1.0,
            units="inches",
            width=1.5 / 72,
            headwidth=4.0,
            headlength=5.0,
            headaxislength=4.5,
            minlength=0.5,
            color=colour,
            zorder=zorder,
        )
    ]


def round_down(value: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is not above the value."""
    power = 10.0 ** math.floor(math.log10(value))
    return max(step * power for step in (1, 2, 5) if step * power <= value * (1 + 1e-9))
