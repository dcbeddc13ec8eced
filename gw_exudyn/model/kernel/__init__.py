"""The compiled contact kernel: one small shared object a platform, called through ctypes.

A run of 20 segments spends most of its time in contact calls of a few pairs each, where numpy's overhead per operation
is the cost: about 200 microseconds a call against 3 here. The library needs no C library and is loaded in well
under a millisecond. `contact.c` says what is computed; `build.py` makes the libraries.
"""

from __future__ import annotations

import ctypes
import platform
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.errors import SolverError

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

_DOUBLES = ctypes.POINTER(ctypes.c_double)
_INTS = ctypes.POINTER(ctypes.c_int)

LIBRARY_FOLDER = Path(__file__).parent / "lib"


def library_name(system: str, machine: str) -> str:
    """File name of the library for an operating system and a machine as `platform` names them."""
    machine = {"amd64": "x86_64"}.get(machine.lower(), machine.lower())
    name, suffix = {"linux": ("linux", "so"), "windows": ("windows", "dll"), "darwin": ("macos", "dylib")}.get(
        system.lower(), (system.lower(), "so")
    )
    return f"contact-{name}-{machine}.{suffix}"


class System(ctypes.Structure):
    """`System` of contact.c."""

    _fields_ = [
        *((name, ctypes.c_int) for name in ("bodies", "walls", "corners")),
        *((name, ctypes.c_double) for name in ("radius", "stiffness", "damping", "toe", "tangential_stiffness")),
        *(
            (name, _DOUBLES)
            for name in (
                "half_length",
                "joint_blend",
                "wall_x",
                "wall_y",
                "wall_tx",
                "wall_ty",
                "wall_length",
                "wall_lo",
                "wall_hi",
                "wall_fade_lo",
                "wall_fade_hi",
                "wall_friction",
                "wire_friction",
            )
        ),
        *((name, _INTS) for name in ("wall_sharp", "wall_tube")),
        *((name, _DOUBLES) for name in ("corner_x", "corner_y", "corner_friction")),
        ("corner_tube", _INTS),
        *((name, _DOUBLES) for name in ("wall_boxes", "corner_boxes", "body_boxes")),
        ("reach", ctypes.c_double),
        ("seen", _DOUBLES),
    ]


class _Pairs(ctypes.Structure):
    _fields_ = [
        *((name, ctypes.c_int) for name in ("capacity", "count")),
        *((name, _INTS) for name in ("body", "target")),
        *(
            (name, _DOUBLES)
            for name in (
                "side",
                "start",
                "held",
                "gap",
                "normal",
                "tangential",
                "weight",
                "energy",
                "slip",
                "elastic",
                "normal_stiffness",
                "tangential_stiffness",
                "line",
                "slope",
                "was_line",
                "was_slope",
            )
        ),
        ("near_count", ctypes.c_int),
        ("near", _INTS),
    ]


class _Motion(ctypes.Structure):
    _fields_ = [
        *((name, _DOUBLES) for name in ("q", "c", "s", "v", "q0", "c0", "s0")),
        *((name, ctypes.c_int) for name in ("predicted", "followed")),
    ]


def _pointer(array: NDArray[Any]) -> Any:
    return array.ctypes.data_as(_INTS if array.dtype == np.int32 else _DOUBLES)


class Pairs:
    """A list of pairs: arrays of a fixed capacity, of which the first `count` are valid. Attributes as in contact.c."""

    body: Ints
    target: Ints
    side: Floats
    start: Floats
    held: Floats
    gap: Floats
    normal: Floats
    tangential: Floats
    weight: Floats
    energy: Floats
    slip: Floats
    elastic: Floats
    normal_stiffness: Floats
    tangential_stiffness: Floats

    def __init__(self, capacity: int) -> None:
        self._near = np.zeros(capacity, np.int32)
        names = [str(field[0]) for field in _Pairs._fields_[2:-2]]
        self._arrays: dict[str, NDArray[Any]] = {
            name: np.zeros(capacity, np.int32 if name in ("body", "target") else np.float64) for name in names
        }
        self.struct = _Pairs(capacity, 0, *map(_pointer, self._arrays.values()), -1, _pointer(self._near))
        self.address = ctypes.addressof(self.struct)
        self.show()

    @property
    def count(self) -> int:
        """Number of pairs in the list."""
        return int(self.struct.count)

    @property
    def capacity(self) -> int:
        """Largest number of pairs that fits."""
        return int(self.struct.capacity)

    def show(self) -> None:
        """Make the attributes views of the valid pairs, after their number has changed."""
        for name, array in self._arrays.items():
            setattr(self, name, array[: self.struct.count])


class Summary(ctypes.Structure):
    """`Summary` of contact.c: what the last `evaluate` found, all pairs together.

    deepest : m, of `body` in the wall, or the corner, `target`; 0 and -1 where nothing is inside. largest : N, of one
    contact with the vessel, normal and tangential together. energy : J, in the springs. friction, damping : J, lost
    since the start of the step.
    """

    _fields_ = [
        *((name, ctypes.c_double) for name in ("deepest", "largest", "energy", "friction", "damping")),
        *((name, ctypes.c_int) for name in ("body", "target", "corner")),
    ]


class Motion:
    """Motion of the bodies, in arrays that the kernel reads in place.

    q : (n, 3), place of the centre (m) and angle (rad). v : (n, 3), its rate. q0 : (n, 3), at the start of the step.
    c, s, c0, s0 : (n,), cosine and sine of the angles of q and q0.
    """

    def __init__(self, bodies: int) -> None:
        self.q, self.v, self.q0 = (np.zeros((bodies, 3)) for _ in range(3))
        self.c, self.s, self.c0, self.s0 = (np.zeros(bodies) for _ in range(4))
        self.struct = _Motion(*map(_pointer, (self.q, self.c, self.s, self.v, self.q0, self.c0, self.s0)), 0, 0)
        self.address = ctypes.addressof(self.struct)

    def set(self, q: Floats, v: Floats) -> None:
        """Take over a place and a rate, both (n, 3)."""
        self.q[:] = q
        self.v[:] = v
        np.cos(self.q[:, 2], out=self.c)
        np.sin(self.q[:, 2], out=self.s)

    def take(self, other: Motion) -> None:
        """Take over the place of another motion of as many bodies."""
        self.q[:], self.c[:], self.s[:] = other.q, other.c, other.s

    def start_step(self) -> None:
        """Make the present place that of the step's start."""
        self.q0[:] = self.q
        self.c0[:] = self.c
        self.s0[:] = self.s


class Kernel:
    """The functions of the library, on one system.

    arrays : by the names of `System`; kept, and read in place. numbers : the rest of `System`.
    force : (3n,), tangent : (9n,), results of the last `evaluate`.
    """

    def __init__(self, arrays: dict[str, NDArray[Any]], numbers: dict[str, float]) -> None:
        integer = ("wall_sharp", "wall_tube", "corner_tube")
        self._arrays = {
            name: np.ascontiguousarray(array, np.int32 if name in integer else np.float64)
            for name, array in arrays.items()
        }
        counts = {
            "bodies": len(arrays["half_length"]),
            "walls": len(arrays["wall_x"]),
            "corners": len(arrays["corner_x"]),
        }
        self._library = _load()
        for name, count in counts.items():
            boxes = {"bodies": "body_boxes", "walls": "wall_boxes", "corners": "corner_boxes"}[name]
            self._arrays[boxes] = np.zeros(4 * int(self._library.gw_contact_boxes(count)))
        self._arrays["seen"] = np.zeros(3 * counts["bodies"])
        pointers = {name: _pointer(array) for name, array in self._arrays.items()}
        self._system = System(**counts, **numbers, **pointers)
        self._address = ctypes.addressof(self._system)
        self._library.gw_contact_index(self._address)
        self.bodies = counts["bodies"]
        self.force = np.zeros(3 * self.bodies)
        self.tangent = np.zeros(9 * self.bodies)
        self._outputs = self.force.ctypes.data, self.tangent.ctypes.data

    def evaluate(self, motion: Motion, nodes: Pairs, corners: Pairs, position: float, velocity: float) -> None:
        """Fill `force` and `tangent` (3 x 3 blocks by rows): `position` d force/dq + `velocity` d force/dq_t."""
        self._library.gw_contact_evaluate(
            self._address, motion.address, nodes.address, corners.address, position, velocity, *self._outputs
        )

    def step_on(self, nodes: Pairs, corners: Pairs) -> None:
        """Newton steps on from the place of the last `evaluate`."""
        self._library.gw_contact_step_on(nodes.address, corners.address)

    def candidates(
        self,
        motion: Motion,
        sides: Floats,
        nearest: Ints,
        first: int,
        reach: float,
        nodes: Pairs,
        corners: Pairs,
    ) -> bool:
        """Fill the lists with the pairs that can touch within `reach` (m) of travel; False when a list is too short.

        sides, nearest : (k,), of the corners: the side decided for each, and its nearest body.
        """
        self._system.reach = reach
        complete = self._library.gw_contact_candidates(
            self._address,
            motion.address,
            sides.ctypes.data,
            nearest.ctypes.data,
            first,
            nodes.address,
            corners.address,
        )
        nodes.show()
        corners.show()
        return bool(complete)

    def nearest(self, motion: Motion, first: int, corners: int) -> tuple[Ints, Ints, Floats]:
        """For each corner the nearest body (-1: none), 1 where it is ahead of the tip, its offset, m (left: +)."""
        body, ahead, offset = np.full(corners, -1, np.int32), np.zeros(corners, np.int32), np.zeros(corners)
        self._library.gw_contact_nearest(
            self._address, motion.address, first, body.ctypes.data, ahead.ctypes.data, offset.ctypes.data
        )
        return body, ahead, offset

    def add_turning(self, motion: Motion, tangent: Floats, reaction: Floats, *, stiffening: bool) -> None:
        """Add to a tangent (9 n,) how the joints' forces, minus `reaction` (2 n,), N, turn the segments as they
        turn."""
        self._library.gw_contact_turning(
            self._address, motion.address, reaction.ctypes.data, stiffening, tangent.ctypes.data
        )

    def share_to_touch(self, before: Motion, nodes: Pairs, corners: Pairs) -> float:
        """Share of the way from the place of `before` to the last evaluated one where the first contact closes."""
        return float(
            self._library.gw_contact_share_to_touch(self._address, before.address, nodes.address, corners.address)
        )

    def summary(self, motion: Motion, nodes: Pairs, corners: Pairs) -> Summary:
        """All pairs together, at the place of the last `evaluate`."""
        found = Summary()
        self._library.gw_contact_summary(
            self._address, motion.address, nodes.address, corners.address, ctypes.byref(found)
        )
        return found

    def unstable(self, motion: Motion, nodes: Pairs, corners: Pairs, joint_stiffness: Floats) -> int:
        """Number of directions in which the step's incremental potential has a maximum at the present place."""
        return int(
            self._library.gw_contact_unstable(
                self._address, motion.address, nodes.address, corners.address, joint_stiffness.ctypes.data
            )
        )

    def crossing(self, motion: Motion, first: int) -> tuple[int, int] | None:
        """(body, wall) of the first wire segment that crosses a wall of the vessel, or None."""
        wall = ctypes.c_int(-1)
        body = int(self._library.gw_contact_crossing(self._address, motion.address, first, ctypes.byref(wall)))
        return None if body < 0 else (body, wall.value)


@cache
def _load() -> ctypes.CDLL:
    """The library for this machine. Raises SolverError where there is none, or it cannot be loaded."""
    path = LIBRARY_FOLDER / library_name(platform.system(), platform.machine())
    if not path.exists():
        raise SolverError(
            f"there is no contact kernel for this machine ({path.name}); with the package ziglang or a C compiler at "
            "hand, python -m gw_exudyn.model.kernel.build makes it"
        )
    try:
        library = ctypes.CDLL(str(path))
    except OSError as error:
        raise SolverError(f"the contact kernel {path} cannot be loaded ({error}); install the package again") from error
    pointer, real, integer = ctypes.c_void_p, ctypes.c_double, ctypes.c_int
    signatures: dict[str, tuple[list[Any], Any]] = {
        "gw_contact_evaluate": ([pointer] * 4 + [real] * 2 + [pointer] * 2, None),
        "gw_contact_step_on": ([pointer] * 2, None),
        "gw_contact_boxes": ([integer], integer),
        "gw_contact_index": ([pointer], None),
        "gw_contact_candidates": ([pointer] * 4 + [integer] + [pointer] * 2, integer),
        "gw_contact_nearest": ([pointer] * 2 + [integer] + [pointer] * 3, None),
        "gw_contact_turning": ([pointer] * 3 + [integer, pointer], None),
        "gw_contact_share_to_touch": ([pointer] * 4, real),
        "gw_contact_summary": ([pointer] * 5, None),
        "gw_contact_unstable": ([pointer] * 5, integer),
        "gw_contact_crossing": ([pointer] * 2 + [integer, pointer], integer),
    }
    for name, (arguments, result) in signatures.items():
        function = getattr(library, name)
        function.argtypes, function.restype = arguments, result
    return library
