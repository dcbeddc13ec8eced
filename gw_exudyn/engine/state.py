"""The whole state of a run between two steps, and its exact form in bytes."""

from __future__ import annotations

import json
import struct
import zlib
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.errors import UsageError
from gw_exudyn.model.contact import ContactMemory
from gw_exudyn.model.energy import Energies
from gw_exudyn.model.hub import HubEnergies

Floats = NDArray[np.float64]

_MAGIC = b"GWEX"
_VERSION = 3


@dataclass(frozen=True)
class State:
    """Everything that the further course depends on, and the sums kept so far.

    time : s. q, q_t, q_tt, algorithmic : (3 n + 3,), Exudyn's coordinates, rates, accelerations, and the integrator's
        own accelerations. multipliers : constraint forces. contact : its memory. energies, hub : sums since the start.
    control : what the drive's controller remembers; empty where it has none.
    """

    time: float
    q: Floats
    q_t: Floats
    q_tt: Floats
    algorithmic: Floats
    multipliers: Floats
    contact: ContactMemory
    energies: Energies
    hub: HubEnergies
    control: Floats


_ARRAYS = ("q", "q_t", "q_tt", "algorithmic", "multipliers", "control")


def to_arrays(state: State) -> dict[str, NDArray[np.generic]]:
    """The state as named arrays."""
    arrays: dict[str, NDArray[np.generic]] = {name: getattr(state, name) for name in _ARRAYS}
    arrays["time"] = np.array([state.time])
    arrays["energies"] = np.array([getattr(state.energies, f.name) for f in fields(Energies)])
    arrays["hub"] = np.array([getattr(state.hub, f.name) for f in fields(HubEnergies)])
    arrays |= {f"contact.{f.name}": getattr(state.contact, f.name) for f in fields(ContactMemory)}
    return arrays


def from_arrays(arrays: dict[str, NDArray[np.generic]]) -> State:
    """The state again."""
    energies = Energies(*(float(x) for x in arrays["energies"]))
    contact = ContactMemory(**{f.name: arrays[f"contact.{f.name}"] for f in fields(ContactMemory)})  # type: ignore[arg-type]
    hub = HubEnergies(*(float(x) for x in arrays["hub"]))
    plain = {name: arrays[name] for name in _ARRAYS}
    return State(time=float(arrays["time"][0]), contact=contact, energies=energies, hub=hub, **plain)  # type: ignore[arg-type]


def pack(arrays: dict[str, NDArray[np.generic]], fingerprint: str) -> bytes:
    """Arrays as bytes: magic, version, length and check sum of what follows, a JSON table of contents, the data.

    fingerprint : names the scenario that the state belongs to.
    """
    contents = [[name, array.dtype.str, list(array.shape)] for name, array in arrays.items()]
    table = json.dumps({"fingerprint": fingerprint, "arrays": contents}).encode()
    body = struct.pack("<I", len(table)) + table + b"".join(np.ascontiguousarray(a).tobytes() for a in arrays.values())
    return _MAGIC + struct.pack("<HQI", _VERSION, len(body), zlib.crc32(body)) + body


def unpack(data: bytes, fingerprint: str) -> dict[str, NDArray[np.generic]]:
    """The arrays again. Raises UsageError for bytes that are no state, damaged, or of another scenario."""
    head = len(_MAGIC) + 14
    if not isinstance(data, bytes | bytearray | memoryview):
        raise UsageError(f"these are no bytes but {type(data).__name__}: no saved state of a simulation")
    data = bytes(data)
    if len(data) < head or data[:4] != _MAGIC:
        raise UsageError("these bytes are no saved state of a simulation")
    version, length, check = struct.unpack("<HQI", data[4:head])
    if version != _VERSION:
        raise UsageError(f"the saved state has version {version}, this program reads {_VERSION}; save it again")
    body = data[head:]
    if len(body) != length or zlib.crc32(body) != check:
        raise UsageError("the saved state is damaged or cut short")
    size = struct.unpack("<I", body[:4])[0]
    table = json.loads(body[4 : 4 + size])
    if table["fingerprint"] != fingerprint:
        raise UsageError("the saved state belongs to another scenario; restore it into a simulation of the same one")
    arrays, place = {}, 4 + size
    for name, kind, shape in table["arrays"]:
        count = int(np.prod(shape, dtype=np.int64)) * np.dtype(kind).itemsize
        arrays[name] = np.frombuffer(body[place : place + count], kind).reshape(shape).copy()
        place += count
    return arrays
