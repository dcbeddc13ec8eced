"""A scene that is moved as a whole, or mirrored, gives the same forces; the same scenario gives the same bits."""

from __future__ import annotations

import copy
import hashlib
import json
import math
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from gw_exudyn.result import Result
from gw_exudyn.verification.evidence import Case, Chart, Curve, Evidence, Finding, Floats
from gw_exudyn.verification.insertions import WIRES, bend60, run, tip

GROUP = "invariance"

NEWTON_TOLERANCE = 1e-6
"""Relative, of the solver's default settings."""

FORCES = ("push_force", "wall_force_normal", "wall_force_max", "catheter_force_normal", "tip_force")


@dataclass(frozen=True)
class Motion:
    """A mirror image about the x axis (or none), then a turn about the origin, rad, then a shift, m."""

    turn: float
    shift: tuple[float, float]
    mirror: bool = False

    def vectors(self, plane: Any) -> Floats:
        """(..., 2) vectors after the motion."""
        c, s = math.cos(self.turn), math.sin(self.turn)
        flipped = np.asarray(plane, float) * [1.0, -1.0 if self.mirror else 1.0]
        moved: Floats = flipped @ np.array([[c, -s], [s, c]]).T
        return moved

    def points(self, plane: Any) -> Floats:
        """(..., 2) points after the motion."""
        return self.vectors(plane) + self.shift


MOTIONS = {
    "turned by 40 degrees": Motion(math.radians(40), (0.0, 0.0)),
    "turned by -140 degrees and shifted": Motion(math.radians(-140), (0.03, -0.02)),
    "shifted": Motion(0.0, (-0.1, 0.25)),
    "mirrored": Motion(0.0, (0.0, 0.0), mirror=True),
    "mirrored, turned and shifted": Motion(math.radians(100), (0.01, 0.04), mirror=True),
}


def moved(scene: Mapping[str, Any], motion: Motion) -> dict[str, Any]:
    """A scene with a polygon vessel and a stated imperfection, moved as a whole: vessel, catheter and rest shape."""
    new = copy.deepcopy(dict(scene))
    new["vessel"]["points"] = motion.points(new["vessel"]["points"]).tolist()
    new["catheter"]["exit"] = motion.points(new["catheter"]["exit"]).tolist()
    sign = -1.0 if motion.mirror else 1.0
    new["catheter"]["direction"] = sign * new["catheter"].get("direction", 0.0) + motion.turn
    new["wire"]["imperfection"] *= sign
    return new


def differences(before: Result, after: Result, motion: Motion) -> dict[str, float]:
    """Largest differences at any output: each force over its largest value, the wall force's direction and the tip's
    place brought back into the frame of the scene before. NaN where a run is not whole."""
    if not (before.status.status.ok and after.status.status.ok):
        return dict.fromkeys([*FORCES, "wall force vector", "tip"], float("nan"))
    found = {name: _relative(before.values(name), after.values(name)) for name in FORCES}
    force = [np.column_stack([r.values("wall_force_x"), r.values("wall_force_y")]) for r in (before, after)]
    found["wall force vector"] = _relative(motion.vectors(force[0]), force[1])
    found["tip"] = float(np.abs(motion.points(tip(before)) - tip(after)).max())
    return found


def _relative(before: Floats, after: Floats) -> float:
    return float(np.abs(after - before).max() / np.abs(before).max())


def rigid_motion(wire: str) -> Finding:
    """One insertion, moved in several ways."""
    scene = bend60(wire)
    before = run(scene)
    rows, path = [], tip(before) * 1e3
    curves = [Curve("as it is", path[:, 0], path[:, 1], "line")]
    for name, motion in MOTIONS.items():
        after = run(moved(scene, motion))
        found = differences(before, after, motion)
        worst = max((found[force] for force in found if force != "tip"), key=lambda x: math.inf if x != x else x)
        rows.append(
            Evidence(
                f"{name}: largest relative difference of any force at any output",
                "1",
                worst,
                0.0,
                10 * NEWTON_TOLERANCE,
                "ten times the Newton tolerance",
                "forces do not depend on the frame",
            )
        )
        rows.append(
            Evidence(
                f"{name}: largest difference of the tip's place, moved back",
                "m",
                found["tip"],
                0.0,
                10 * NEWTON_TOLERANCE * 1e-3,
                "ten times the Newton tolerance of the wire's smallest radius of bending, a millimetre",
                "places move with the frame",
            )
        )
        back = (tip(after) - motion.shift) @ motion.vectors(np.eye(2)).T * 1e3
        curves.append(Curve(name, back[:, 0], back[:, 1]))
    title = f"bend60, {wire}: path of the tip, moved back"
    return Finding(tuple(rows), (Chart(f"motion-{wire}", title, "tip x / mm", "tip y / mm", tuple(curves)),))


def digest(result: Result) -> str:
    """SHA-256 of every number of a result, in the order of the table of quantities."""
    total = hashlib.sha256()
    for name in sorted(str(name) for name in result.dataset.variables):
        total.update(name.encode())
        total.update(np.ascontiguousarray(result.dataset[name].values).tobytes())
    return total.hexdigest()


_ELSEWHERE = """
import json, sys
from gw_exudyn.verification.insertions import run
from gw_exudyn.verification.invariance import digest
sys.stdout.write(digest(run(json.load(sys.stdin))))
"""


def same_bits(wire: str) -> Finding:
    """The same scenario twice here, and once in another process."""
    scene = bend60(wire)
    first = digest(run(scene))
    done = subprocess.run(
        [sys.executable, "-c", _ELSEWHERE], input=json.dumps(scene), capture_output=True, text=True, check=True
    )
    others = {"run again": digest(run(scene)), "run in another process": done.stdout}
    return Finding(
        tuple(
            Evidence(
                f"{name}: digests of all results that differ",
                "1",
                float(other != first),
                0.0,
                0.0,
                "no tolerance: the same operations in the same order",
                "arithmetic after IEEE 754 is deterministic",
            )
            for name, other in others.items()
        )
    )


CASES = (
    *(Case(GROUP, f"rigid motion and mirror image, {wire}", partial(rigid_motion, wire)) for wire in WIRES),
    *(Case(GROUP, f"same bits, {wire}", partial(same_bits, wire)) for wire in WIRES[:1]),
)
