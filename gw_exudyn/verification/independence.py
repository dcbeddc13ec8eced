"""What the model adds for the sake of the computation does not show in the results.

The walls' stiffness, the tangential spring of a stuck contact, the wire's small mass, the dampers in its joints and
the solver's step are no properties of the problem. Each is changed tenfold on insertions of a soft and a stiff wire,
and the tip and the push force stay where they were.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np

from gw_exudyn import model
from gw_exudyn.result import Result
from gw_exudyn.scenario import scenario_from_dict
from gw_exudyn.verification.evidence import Case, Chart, Curve, Evidence, Finding
from gw_exudyn.verification.insertions import (
    LUMEN,
    SPEED,
    WIRES,
    bend60,
    changed,
    corner90,
    push_curve,
    run,
    tip,
)

GROUP = "independence"
SCENES = {"bend60": bend60, "corner90": corner90}

TIP_BOUND, FORCE_BOUND = 2e-5, 0.02
"""The project's bounds on what discretisation may do to the tip, m, and to the push force, relative."""

WALL_BOUND = {
    ("bend60", "universal-ii"): 1e-5,
    ("bend60", "amplatz-super-stiff"): 5e-5,
    ("corner90", "universal-ii"): 2e-5,
    ("corner90", "amplatz-super-stiff"): 5e-5,
}
"""How far the tip may move, m, when the walls get stiffer. A wire sinks in by 2 % of its radius, 4 and 9 um, at the
estimated peak force; the lever from the corner to the tip, 15 mm in bend60 and 30 mm in corner90, enlarges that. So the
soft wire's tip, which is to stay within 0.01 mm, does so in bend60; in corner90 it moves by as much, and is held to
twice that."""

STEP = 0.1  # s

SHORT_BACK = 2e-4
"""Pull-back, m, on which one contact after another lets go, turns round and slides back."""

LAGGING = "the damper's moment over the spring's: change of the damping time x speed / width of the lumen"


def insertion(scene: str, wire: str) -> Finding:
    """One insertion, and the same with walls, mass, damping and step changed."""
    base = changed(SCENES[scene](wire), solver={"step": STEP})
    law = model.build(scenario_from_dict(base)).law
    spec = scenario_from_dict(base).wire
    changes: dict[str, dict[str, Any]] = {
        # The tangential spring is kept, which would else follow the walls'.
        "wall stiffness x 10": {
            "contact": {"wall_stiffness": 10 * law.stiffness, "tangential_stiffness": law.tangential_stiffness}
        },
        "density / 10": {"wire": {"density": spec.density / 10}},
        "joint damping / 10": {"wire": {"damping_time": spec.damping_time / 10}},
        "joint damping x 10": {"wire": {"damping_time": spec.damping_time * 10}},
        "solver step / 10": {"solver": {"step": STEP / 10}},
    }
    before = run(base)
    after = {name: run(changed(base, **sections)) for name, sections in changes.items()}
    rows: list[Evidence] = []
    for name, result in after.items():
        rows += _rows(name, WALL_BOUND[scene, wire], spec.damping_time, before, result)
    curves: list[Curve] = [push_curve("as it is", before, line=True)]
    curves += [push_curve(name, result) for name, result in after.items()]
    title = f"{scene}, {wire}: what the model adds, changed tenfold"
    chart = Chart(f"independence-{scene}-{wire}", title, "insertion depth / mm", "push force / mN", tuple(curves))
    return Finding(tuple(rows), (chart,))


def _rows(name: str, wall_bound: float, damping_time: float, before: Result, after: Result) -> Iterator[Evidence]:
    """The rows of one change, at the end of the push: on the way the wire slips from one shape to the next within
    milliseconds, and two runs a millisecond apart are different there."""
    moved = float(np.hypot(*(tip(after)[-1] - tip(before)[-1])))
    bound, source = TIP_BOUND, "the project's bound on what discretisation does to the tip"
    if name.startswith("wall"):
        bound = wall_bound
        source = "penetration of 2 % of the radius, times the lever from corner to tip, twice as long in corner90"
    elif name == "joint damping x 10":
        bound, source = 5e-5, "a third of the radius of the soft wire; real wires are damped far less"
    yield Evidence(
        f"{name}: distance the tip moves", "m", _if_whole(after, moved), 0.0, bound, source, "the same scene, unchanged"
    )
    change = _if_whole(after, float(after.values("push_force")[-1] / before.values("push_force")[-1]) - 1)
    if name.startswith("joint"):
        factor = 10.0 if name.endswith("x 10") else 0.1
        yield _force_row(name, change, abs(factor - 1) * damping_time * SPEED / LUMEN, LAGGING)
    elif not name.startswith("wall"):
        yield _force_row(name, change, FORCE_BOUND, "the project's bound on what discretisation does to forces")


def _if_whole(result: Result, value: float) -> float:
    """The value; not a number where the run has not reached its end."""
    return value if result.status.status.ok else float("nan")


def _force_row(name: str, change: float, allowed: float, source: str) -> Evidence:
    quantity = f"{name}: relative change of the push force at the end"
    return Evidence(quantity, "1", change, 0.0, allowed, source, "the same scene, unchanged")


def sticking(wire: str) -> Finding:
    """Pushed in and pulled back a little, so that contacts stick and then turn round, with other tangential springs."""
    phases = [{"speed": SPEED, "distance": 0.020}, {"speed": -SPEED / 10, "distance": SHORT_BACK}]
    base = changed(bend60(wire), output={"interval": 0.05})
    base["drive"] = {"kind": "speed", "phases": phases}
    law = model.build(scenario_from_dict(base)).law
    before = run(base)
    rows, curves = [], [push_curve("as it is", before, line=True)]
    for name, factor in (("x 10", 10.0), ("/ 10", 0.1)):
        after = run(changed(base, contact={"tangential_stiffness": factor * law.tangential_stiffness}))
        back = before.time >= 10.0
        moved = _if_whole(after, float(np.hypot(*(tip(after) - tip(before))[back].T).max()))
        rows.append(
            Evidence(
                f"tangential stiffness {name}: largest distance the tip moves while it turns round",
                "m",
                moved,
                0.0,
                TIP_BOUND,
                "the project's bound; the elastic slip mu N / k_t of a contact is 0.2 to 10 um",
                "the same scene, unchanged",
            )
        )
        change = float(after.values("push_force")[-1] / before.values("push_force")[-1] - 1)
        rows.append(_force_row(f"tangential stiffness {name}", change, FORCE_BOUND, "the project's bound on forces"))
        curves.append(push_curve(f"tangential stiffness {name}", after))
    title = f"bend60, {wire}: pushed and pulled with other tangential springs"
    chart = Chart(f"sticking-{wire}", title, "insertion depth / mm", "push force / mN", tuple(curves))
    return Finding(tuple(rows), (chart,))


CASES = (
    *(Case(GROUP, f"{scene}, {wire}", partial(insertion, scene, wire)) for scene in SCENES for wire in WIRES),
    *(Case(GROUP, f"push and pull, {wire}", partial(sticking, wire)) for wire in WIRES),
)
