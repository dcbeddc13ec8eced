"""Energies and forces of whole insertions: the books close, friction takes and never gives, forces balance.

Each energy comes from its own forces (see `model.energy`); what is left over is the remainder. Here the drive's work
and the bending energy are worked out once more from the outputs alone. That walls never pull is asked of the contact
law itself, in `friction`.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from gw_exudyn import model
from gw_exudyn.result import Result
from gw_exudyn.scenario import list_shipped, load_scenario
from gw_exudyn.simulation import simulate
from gw_exudyn.verification.evidence import Case, Chart, Curve, Evidence, Finding
from gw_exudyn.verification.insertions import WIRES, bend60, changed, run

GROUP = "energy"

SHARE, FLOOR = 0.01, 1e-7
"""The project's bound on the remainder over the largest work, and the work, J, below which there is none to speak of:
bending the tip of a soft wire by five degrees takes as much."""

STORED = ("elastic_energy", "wall_energy", "kinetic_energy")
LOST = ("friction_loss", "damping_loss", "numerical_loss")
CATHETER = 1
BOUND = "the project's bound, one per cent of the largest work (1e-7 J at least)"


def shipped(name: str) -> Finding:
    """A shipped scenario as it is."""
    scenario = load_scenario(name)
    result = simulate(load_scenario(name, {"output.interval": scenario.solver.step}))
    work = result.values("insertion_work")
    scale = max(float(np.abs(work).max()), FLOOR)
    rows = [
        _row("largest remainder of the energies", "J", result, "energy_error", 0.0, SHARE * scale, BOUND),
        Evidence(
            "drive's work, from push force and travel of the outputs",
            "J",
            float(np.trapezoid(result.values("push_force"), result.values("insertion_depth"))),
            float(work[-1]),
            SHARE * scale,
            BOUND + "; outputs lie further apart than steps",
            "sum over the solver's steps",
        ),
        Evidence(
            "bending energy at the end, from the joints' angles",
            "J",
            _bending(result),
            float(result.values("elastic_energy")[-1]),
            1e-9 * scale,
            "rounding of sums over some hundred joints, relative 1e-16 each, with a margin",
            "kept by the solver; U = sum k (theta - theta_0)^2 / 2",
        ),
        *never(result),
    ]
    total = result.values("insertion_work") - result.values("energy_error")
    depth = result.time
    curves = [Curve("work of the drive", depth, work * 1e6, "line"), Curve("stored and lost", depth, total * 1e6)]
    for term in (*STORED, *LOST):
        if np.abs(result.values(term)).max() > 0.01 * scale:
            curves.append(Curve(term.replace("_", " "), depth, result.values(term) * 1e6, "line"))
    chart = Chart(f"energy-{name}", f"{name}: where the work goes", "time / s", "energy / uJ", tuple(curves))
    return Finding(tuple(rows), (chart,) if scale > FLOOR else ())


def _row(
    quantity: str, unit: str, result: Result, name: str, expected: float, tolerance: float, tolerance_source: str
) -> Evidence:
    """The sample of a series that is furthest from the expected number."""
    values = result.values(name)
    worst = float(values[np.abs(values - expected).argmax()])
    return Evidence(quantity, unit, worst, expected, tolerance, tolerance_source, "conservation of energy")


def _bending(result: Result) -> float:
    wire = model.build(result.scenario).wire
    bend = result.values("joint_angle")[-1] - wire.rest_angle
    return float(0.5 * wire.joint_stiffness @ bend**2)


def never(result: Result) -> list[Evidence]:
    """What no sample of any run may show: friction that gives energy, and friction beyond its cone."""
    normal = result.dataset["contact_normal_force"].values
    tangential = result.dataset["contact_tangential_force"].values
    there = np.isfinite(normal) & (normal > 0)
    contact, catheter = result.scenario.contact.friction_coefficient, result.scenario.catheter.friction_coefficient
    friction = max(contact, contact if catheter is None else catheter)
    ratio = np.abs(tangential[there]) / normal[there] if there.any() else np.zeros(1)
    gained = np.diff(result.values("friction_loss")).min(initial=0.0)
    return [
        Evidence(
            "least growth of the friction loss between two outputs",
            "J",
            float(gained),
            0.0,
            0.0,
            "no tolerance: the loss is a sum of terms that are never negative",
            "second law; Coulomb's friction opposes the slip",
            "at_least",
        ),
        Evidence(
            "largest tangential over normal force of any contact in any sample",
            "1",
            float(ratio.max()),
            friction * (1 + 1e-9),
            0.0,
            "the friction coefficient, and rounding",
            "Coulomb's cone [Sharei et al. 2019, Eq. 6]",
            "at_most",
        ),
    ]


def balance(wire: str) -> Finding:
    """While the wire slides steadily, the drive's push is what vessel and catheter take, and the catheter's friction is
    its coefficient times its normal force."""
    result = run(changed(bend60(wire), catheter={"friction_coefficient": 0.2}))
    push = result.values("push_force")
    taken = result.values("wall_force_x") + result.values("catheter_force_x")
    last = len(result.time) - 1
    contacts = result.contacts_at(last)
    inside = contacts["contact_owner"] == CATHETER
    normal, tangential = (contacts[f"contact_{name}_force"][inside] for name in ("normal", "tangential"))
    # Within the soft zone of the friction law, 0.9 to 1.1 of the limit, a contact carries 1 - over^2 / 0.4 of it.
    sliding = float(np.abs(tangential).sum() / normal.sum())
    rows = (
        Evidence(
            "force on vessel and catheter along the axis, at the end of the push",
            "N",
            float(taken[-1]),
            float(push[-1]),
            1e-3 * float(np.abs(push).max()),
            "dampers and inertia; steady motion at 2 mm/s leaves a thousandth",
            "balance of forces on the wire; a wall force is that of the wire on the wall",
        ),
        Evidence(
            "friction over normal force of all contacts with the catheter",
            "1",
            sliding,
            0.2,
            1e-3,
            "a contact slides fully from 1.1 elastic slips on, a micrometre of travel",
            "Coulomb; the catheter's own coefficient",
        ),
    )
    depth = result.values("insertion_depth") * 1e3
    curves = (
        Curve("push force", depth, push * 1e3, "line"),
        Curve("taken by vessel and catheter", depth, taken * 1e3),
        Curve("by the catheter alone", depth, result.values("catheter_force_x") * 1e3, "line"),
    )
    title = f"bend60, {wire}: what is pushed in is taken by the walls"
    return Finding(
        rows, (Chart(f"balance-{wire}", title, "insertion depth / mm", "force along the axis / mN", curves),)
    )


CASES = (
    *(Case(GROUP, name, partial(shipped, name)) for name in list_shipped()),
    *(Case(GROUP, f"balance of forces, {wire}", partial(balance, wire)) for wire in WIRES),
)
