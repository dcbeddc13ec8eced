"""How long, and over which length, the wire touches each branch, and which branch is pressed hardest."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.metrics.forces import VESSEL, hardest_contact
from gw_exudyn.metrics.metric import Metric
from gw_exudyn.quantities import QUANTITIES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from gw_exudyn.result import Floats, Result


def branches(result: Result) -> dict[str, Metric]:
    """The branches' metrics; none where the vessel has no branches by name."""
    vessel = result.scenario.vessel
    if not vessel.has_branches:
        return {}
    names = _branch_of_contacts(result)
    found = _hardest(result, names)
    for name in vessel.branch_names:
        found |= _touched(result, name, _length_in_contact(result, names == name))
    return found


def _branch_of_contacts(result: Result) -> NDArray[np.str_]:
    """(t, c) name of the branch on whose wall each contact is; empty where there is none, or with the catheter."""
    places = np.stack([result.values("contact_x"), result.values("contact_y")], axis=-1)
    of_vessel = result.values("contact_owner") == VESSEL
    found = result.scenario.vessel.branch_at(places[of_vessel])
    names = np.full(of_vessel.shape, "", dtype=found.dtype)
    names[of_vessel] = found
    return names


def _hardest(result: Result, names: NDArray[np.str_]) -> dict[str, Metric]:
    known = result.scenario.vessel.branch_names
    where = hardest_contact(result)
    name = "" if where is None else str(names[where])
    table = ", ".join(f"{i} {branch}" for i, branch in enumerate(known))
    return {
        "wall_force_max_branch": Metric(
            float(known.index(name)) if name in known else float("nan"),
            "1",
            f"branch of the largest force of a single contact, at the outputs: {table}",
            label=name,
        )
    }


def _length_in_contact(result: Result, contacts: NDArray[np.bool_]) -> Floats:
    """(t,), m. A node that touches counts with half of either segment beside it; a wall's corner that touches the wire
    between two nodes counts for the nearer one. contacts : (t, c), which of the contacts count.
    """
    from_tip = result.values("node_arc_length")[::-1]
    half = np.diff(from_tip) / 2
    stretch = np.concatenate([half, [0.0]]) + np.concatenate([[0.0], half])
    instant, contact = np.nonzero(contacts)
    places = result.values("contact_arc_length")[instant, contact]
    touching = np.zeros((len(result.time), len(from_tip)), dtype=bool)
    touching[instant, np.searchsorted(from_tip[:-1] + half, places)] = True
    lengths: Floats = touching @ stretch
    return lengths


def _touched(result: Result, name: str, length: Floats) -> dict[str, Metric]:
    """length : (t,), m, of wire in contact with the branch `name`."""
    shares = _time_shares(result.time)
    time = float(shares[length > 0].sum())
    unit = QUANTITIES["node_arc_length"].unit
    counted = f"length of wire in contact with the walls of {name}, to half a segment"
    return {
        f"contact_time_{name}": Metric(
            time,
            QUANTITIES["time"].unit,
            f"time during which the wire touches the walls of {name}, half an output interval to either side of each "
            "output",
        ),
        f"contact_length_mean_{name}": Metric(
            float(shares @ length) / time if time > 0 else float("nan"),
            unit,
            f"mean {counted}, over the time of contact; none where there is no contact",
        ),
        f"contact_length_max_{name}": Metric(float(length.max()), unit, f"largest {counted}, at the outputs"),
    }


def _time_shares(time: Floats) -> Floats:
    """(t,), s. The time that each output stands for: half of the way to its neighbours."""
    half = np.diff(time) / 2
    shares: Floats = np.concatenate([half, [0.0]]) + np.concatenate([[0.0], half])
    return shares
