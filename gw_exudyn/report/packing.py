"""Arrays as the scripts of a page read them: base64, little-endian."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from gw_exudyn.result import Floats


def base64_text(values: Any, kind: str) -> str:
    """The array as numpy's `kind`, in base64."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode("ascii")


def floats(values: Floats) -> str:
    """As 32-bit floats: seven digits."""
    return base64_text(values, "<f4")


def spread(count: int, most: int) -> Floats:
    """Indices of at most `most` of `count`, evenly, first and last among them."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
