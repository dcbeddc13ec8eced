"""The icon of every FMU, a wire in the bend of a vessel, drawn from one list of lines as PNG and as SVG."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

SIZE = 128
"""Width and height of the drawing; the PNG has twice as many pixels."""

_WALL, _LUMEN, _TUBE, _BORE, _WIRE, _TIP = "#a83f39", "#f9dcd6", "#66707a", "#dfe3e6", "#1f4e79", "#e07b00"


@dataclass(frozen=True)
class Line:
    """A line with round ends. points : (n, 2), x to the right, y down. width : of the line."""

    points: NDArray[np.float64]
    width: float
    colour: str


_CENTRE, _RADIUS = (58.0, 54.0), 38.0
"""Of the bend, and of the vessel's axis in it."""


def _arc(radius: float, first: float, last: float) -> NDArray[np.float64]:
    """Round the bend, by the angle of the turn in degrees."""
    angle = np.radians(np.linspace(first, last, 19))
    return np.column_stack([_CENTRE[0] + radius * np.sin(angle), _CENTRE[1] + radius * np.cos(angle)])


def lines() -> list[Line]:
    """The icon, from the back to the front."""
    axis, exit_ = _CENTRE[1] + _RADIUS, 24.0
    vessel = np.vstack([[exit_, axis], _arc(_RADIUS, 0, 90), [_CENTRE[0] + _RADIUS, -30]])
    tube = np.array([[-30.0, axis], [exit_, axis]])
    # Along the catheter's axis, over the lumen to the outer wall, along it round the bend, and off it again.
    along = _arc(_RADIUS + 12, 8, 78)
    start, reach = np.array([exit_, axis]), along[0, 0] - exit_
    u = np.linspace(0, 1, 12)[:, None]
    over = start + [reach, 0] * u + (along[0] - start - [reach, 0]) * u**2 * (3 - 2 * u)
    wire = np.vstack([[-30.0, axis], over, along[1:], along[-1] + [[0, -12], [-3, -26]]])
    return [
        Line(vessel, 40, _WALL),
        Line(vessel, 33, _LUMEN),
        Line(tube, 24, _TUBE),
        Line(tube, 15, _BORE),
        Line(wire, 5, _WIRE),
        Line(wire[-1:], 10, _TIP),
    ]


def svg() -> bytes:
    """The icon as SVG."""
    shapes = "\n".join(
        f'<polyline points="{" ".join(f"{x:.2f},{y:.2f}" for x, y in (*line.points, line.points[-1]))}" '
        f'stroke="{line.colour}" stroke-width="{line.width:g}"/>'
        for line in lines()
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{SIZE}" height="{SIZE}" viewBox="0 0 {SIZE} {SIZE}">\n'
        f'<g fill="none" stroke-linecap="round" stroke-linejoin="round">\n{shapes}\n</g>\n</svg>\n'
    ).encode()


def png() -> bytes:
    """The icon as PNG, with what is no line transparent."""
    image = np.zeros((2 * SIZE, 2 * SIZE, 4))
    place = (np.arange(2 * SIZE) + 0.5) / 2
    x, y = np.meshgrid(place, place)
    for line in lines():
        # Half a pixel of the drawing's, two of the PNG's, from full colour to none.
        cover = np.clip((line.width / 2 - _distance(line.points, x, y)) * 2 + 0.5, 0, 1)[..., None]
        colour = np.array([int(line.colour[i : i + 2], 16) for i in (1, 3, 5)] + [255.0]) / 255
        below = image[..., 3:] * (1 - cover)
        alpha = cover + below
        image[..., :3] = (cover * colour[:3] + below * image[..., :3]) / np.where(alpha > 0, alpha, 1)
        image[..., 3:] = alpha
    return _packed(np.rint(image * 255).astype(np.uint8))


def _distance(points: NDArray[np.float64], x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of every place to the nearest point of a line."""
    nearest: NDArray[np.float64] = np.hypot(x - points[0, 0], y - points[0, 1])
    for a, b in pairwise(points):
        along = b - a
        part = np.clip(((x - a[0]) * along[0] + (y - a[1]) * along[1]) / (along @ along), 0, 1)
        nearest = np.minimum(nearest, np.hypot(x - a[0] - part * along[0], y - a[1] - part * along[1]))
    return nearest


def _packed(pixels: NDArray[np.uint8]) -> bytes:
    """Pixels, (height, width, 4), as a PNG file; each row as its difference to the one above, which packs well."""
    height, width, _ = pixels.shape
    above = np.vstack([np.zeros_like(pixels[:1]), pixels[:-1]])
    rows = (pixels - above).reshape(height, -1)
    data = b"".join(b"\2" + row.tobytes() for row in rows)
    head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    parts = ((b"IHDR", head), (b"IDAT", zlib.compress(data, 9)), (b"IEND", b""))
    chunks = (struct.pack(">I", len(c)) + kind + c + struct.pack(">I", zlib.crc32(kind + c)) for kind, c in parts)
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


if __name__ == "__main__":
    import sys
    from pathlib import Path

    for file, content in (("icon.png", png()), ("icon.svg", svg())):
        Path(sys.argv[1] if len(sys.argv) > 1 else ".", file).write_bytes(content)
