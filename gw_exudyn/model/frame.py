"""The frame in which the model works: origin at the catheter's exit, x along its axis into the vessel."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Frame:
    """Turn and shift between the scenario's plane and the catheter's frame.

    origin : (x, y), m, in the plane. angle : rad, of the catheter's axis in the plane.
    """

    origin: tuple[float, float]
    angle: float

    def _rotation(self) -> Floats:
        c, s = math.cos(self.angle), math.sin(self.angle)
        return np.array([[c, -s], [s, c]])

    def points_in(self, points: ArrayLike) -> Floats:
        """(..., 2) points of the plane, seen in the catheter's frame."""
        local: Floats = (np.asarray(points, dtype=float) - self.origin) @ self._rotation()
        return local

    def points_out(self, points: ArrayLike) -> Floats:
        """(..., 2) points of the catheter's frame, in the plane."""
        plane: Floats = np.asarray(points, dtype=float) @ self._rotation().T + self.origin
        return plane

    def vectors_in(self, vectors: ArrayLike) -> Floats:
        """(..., 2) vectors (forces) of the plane, in the catheter's frame."""
        local: Floats = np.asarray(vectors, dtype=float) @ self._rotation()
        return local

    def vectors_out(self, vectors: ArrayLike) -> Floats:
        """(..., 2) vectors (forces) of the catheter's frame, in the plane."""
        plane: Floats = np.asarray(vectors, dtype=float) @ self._rotation().T
        return plane
