"""What has led such solvers astray: a corner that the wire tunnels through, folds, dead ends, branches too narrow.

Whether the wire is in a wall is measured here on the wire's axis and the walls' outlines with a geometry library, not
with the distances that the contact law uses.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from gw_exudyn.result import Result, Status
from gw_exudyn.trust import DEEPEST
from gw_exudyn.verification.evidence import Case, Chart, Curve, Evidence, Finding, Floats
from gw_exudyn.verification.insertions import SPEED, WIRES, push_curve, run

GROUP = "traps"

SEGMENT_COUNTS = (20, 32, 50, 80, 130, 200, 400)
STALL = 0.3e-3  # m
INNER_CORNER = np.array([13e-3, 2e-3])
TRUSTED = "a run in which a wire is deeper ends with the status TOO_DEEP"


def scene(
    vessel: dict[str, Any], wire: str, depth: float, *, segments: int = 60, friction: float = 0.4, bore: float = 1.2e-3
) -> dict[str, Any]:
    """A wire of the catalogue pushed `depth` (m) into a vessel that begins at the origin."""
    return {
        "name": "trap",
        "wire": {"model": wire, "segments": segments},
        "vessel": vessel,
        "catheter": {"exit": [0.0, 0.0], "bore": bore},
        "contact": {"friction_coefficient": friction},
        "drive": {"kind": "speed", "speed": SPEED, "distance": depth},
    }


def polygon(points_in_mm: Sequence[tuple[float, float]], open_edges: Sequence[int]) -> dict[str, Any]:
    """A polygon vessel."""
    return {"kind": "polygon", "points": [[x * 1e-3, y * 1e-3] for x, y in points_in_mm], "open_edges": [*open_edges]}


RIGHT_ANGLE = polygon([(0, -2), (17, -2), (17, 40), (13, 40), (13, 2), (0, 2)], (2, 5))
"""A channel of 4 mm with a sharp corner of 90 degrees."""


def tunnelling(wire: str) -> Finding:
    """Round a sharp corner with little friction, with few long segments to many short ones."""
    rows, curves = [], []
    for count in SEGMENT_COUNTS:
        result = run(scene(RIGHT_ANGLE, wire, 0.024, segments=count, friction=0.1))
        rows.append(_ended(result, f"{count} segments"))
        rows.append(
            Evidence(
                f"{count} segments: least distance of the corner to the left of the wire's axis, over the radius",
                "1",
                min(_left_of(nodes, INNER_CORNER) for nodes in wires(result)) / (result.scenario.wire.diameter / 2),
                1 - DEEPEST,
                0.0,
                f"one radius, less the trusted penetration; {TRUSTED}",
                "the inner corner lies to the left of a wire that goes round it",
                "at_least",
            )
        )
        curves.append(push_curve(f"{count} segments", result, line=True))
    title = f"{wire} round a corner of 90 degrees: no push force of a wire that has gone through it"
    chart = Chart(f"tunnelling-{wire}", title, "insertion depth / mm", "push force / mN", tuple(curves))
    return Finding(tuple(rows), (chart,))


def _left_of(nodes: Floats, corner: Floats) -> float:
    """Distance, m, of a corner from the wire's axis, positive to its left; far where the tip has not passed it yet."""
    a, d = nodes[:-1], np.diff(nodes, axis=0)
    part = np.clip(((corner - a) * d).sum(axis=1) / (d * d).sum(axis=1), 0.0, 1.0)
    away = corner - a - part[:, None] * d
    distance = np.hypot(*away.T)
    nearest = int(distance.argmin())
    if nearest == len(a) - 1 and part[nearest] >= 1.0:
        return float(distance[nearest])
    left = d[nearest, 0] * away[nearest, 1] - d[nearest, 1] * away[nearest, 0]
    return float(np.copysign(distance[nearest], left))


def fold(wire: str, width: float) -> Finding:
    """A wire pushed on against a closed end, in a space where it buckles and folds back on itself.

    Its tip stays, so that the run would end before the fold if it were not told to go on.
    """
    vessel = {"kind": "straight", "length": 30e-3, "diameter": width, "end": "dead"}
    result = run({**scene(vessel, wire, 0.080, friction=0.1), "stop": {"tip_stall": "off"}})
    nodes = wires(result)
    steps = np.diff(nodes[-1], axis=0)
    backwards = float((steps[:, 0] / np.hypot(*steps.T)).min())
    rows = (
        Evidence(
            "least cosine of a segment with the catheter's axis at the end",
            "1",
            backwards,
            0.0,
            0.0,
            "a right angle: from there on it runs back",
            "the wire has folded back, else the case shows nothing",
            "at_most",
        ),
        *_inside_or_said(result),
    )
    chart = _shape(f"fold-{wire}-{width * 1e3:g}mm", f"{wire} against a closed end, {width * 1e3:g} mm wide", result)
    return Finding(rows, (chart,))


def dead_end(wire: str, width: float) -> Finding:
    """A wire pushed on into a narrow dead end, where it cannot buckle aside: the force grows, the tip stalls.

    As little as STALL is pushed in before it is called that: a wire that has no room to buckle into is jammed before
    the model's own stall travel, and the run then ends TOO_DEEP.
    """
    vessel = {"kind": "straight", "length": 10e-3, "diameter": width, "end": "dead"}
    fine = {"stop": {"tip_stall": STALL}, "solver": {"step": 0.01}, "output": {"interval": 0.01}}
    result = run({**scene(vessel, wire, 0.020, bore=width), **fine})
    push = result.values("push_force")
    pushing = push[push > 1e-2 * float(push.max())]
    rows = (
        Evidence(
            "push force at the end over the largest of the first half of the push at the dead end",
            "1",
            float(pushing[-1] / pushing[: len(pushing) // 2].max()),
            1.0,
            0.0,
            "no tolerance; in between it falls where the wire buckles from one shape to the next",
            "what is pushed against a wall pushes back the harder, the further",
            "at_least",
        ),
        Evidence(
            "largest push force at the dead end over that of the wire before it",
            "1",
            float(push.max() / np.abs(push[result.values("tip_x") < 9e-3]).max()),
            100.0,
            0.0,
            "a free wire in a straight channel meets next to no force",
            "the dead end is felt",
            "at_least",
        ),
        _stopped(result, Status.TIP_STALLED),
        *_inside_or_said(result),
    )
    chart = Chart(
        f"dead-end-{wire}",
        f"{wire} in a dead end, {width * 1e3:g} mm wide: {result.status.status.name}",
        "insertion depth / mm",
        "push force / N",
        (Curve("push force", result.values("insertion_depth") * 1e3, push, "line"),),
    )
    return Finding(rows, (chart,))


NARROW = {
    "funnel": polygon([(0, -2), (15, -2), (25, -0.1), (45, -0.1), (45, 0.1), (25, 0.1), (15, 2), (0, 2)], (3, 7)),
    "step": polygon([(0, -2), (15, -2), (15, -0.1), (45, -0.1), (45, 0.1), (15, 0.1), (15, 2), (0, 2)], (3, 7)),
}
"""Channels of 4 mm that narrow to 0.2 mm, less than either wire's diameter."""


def narrow(shape: str, wire: str, status: Status) -> Finding:
    """A wire pushed into a branch narrower than itself: it starts, gets stuck, and the run says so.

    status : with which it must end.
    """
    result = run(scene(NARROW[shape], wire, 0.040))
    half = result.scenario.wire.diameter / 2
    # Where the lumen is as wide as the wire less the trusted penetration on either side.
    fits = 15e-3 + (2e-3 - (1 - DEEPEST) * half) / 1.9e-3 * 10e-3 if shape == "funnel" else 15e-3
    rows = (
        Evidence(
            "furthest place of the tip's centre",
            "m",
            float(result.values("tip_x").max()),
            fits,
            0.0,
            f"where the lumen is narrower than the wire less the trusted penetration; {TRUSTED}",
            "a rigid wire does not fit in there",
            "at_most",
        ),
        _stopped(result, status),
        *_inside_or_said(result),
    )
    return Finding(rows, (_shape(f"narrow-{shape}-{wire}", f"{wire}, {shape} down to 0.2 mm", result),))


def wires(result: Result) -> Floats:
    """(t, n + 1, 2), m: the wire's nodes at every output."""
    return np.stack([result.values("node_x"), result.values("node_y")], axis=-1)


def deepest(result: Result) -> Floats:
    """(t,), over the radius: how deep the wire's surface lies in the vessel's walls at each output, 1 where its axis
    touches or crosses one. By shapely, from the axis and the walls' outlines."""
    import shapely

    walls = shapely.MultiLineString([line.tolist() for line in result.vessel_outline])
    radius = result.scenario.wire.diameter / 2
    axes = shapely.linestrings(wires(result))
    return np.asarray(1 - shapely.distance(axes, walls) / radius, dtype=np.float64)


def _ended(result: Result, name: str) -> Evidence:
    return Evidence(
        f"{name}: runs that did not complete",
        "1",
        float(not result.status.status.ok),
        0.0,
        0.0,
        "no tolerance",
        "status of the run",
    )


def _stopped(result: Result, status: Status) -> Evidence:
    """It must have ended with that status and no other."""
    found = result.status.status
    return Evidence(
        f"runs that ended {found.name} and not {status.name}"
        if found is not status
        else f"runs that ended {found.name}",
        "1",
        float(found is status),
        1.0,
        0.0,
        "no tolerance",
        "a wire that cannot go on is no completed run",
    )


def _inside_or_said(result: Result) -> tuple[Evidence, ...]:
    """While the run went on the wire was in the lumen; where it came out, the status says so."""
    depth = deepest(result)
    going_on = depth if result.status.status.trusted else depth[:-1]
    name = result.status.status.name
    return (
        Evidence(
            f"deepest place of the wire in a wall over its radius, before the run's end ({name})",
            "1",
            float(going_on.max(initial=0.0)),
            DEEPEST,
            0.0,
            f"the trusted penetration; {TRUSTED}",
            "distance of axis and walls, by a geometry library",
            "at_most",
        ),
    )


def _shape(name: str, title: str, result: Result) -> Chart:
    """The walls, and the wire at the end."""
    walls = [
        Curve("walls" if i == 0 else "", line[:, 0] * 1e3, line[:, 1] * 1e3, "line")
        for i, line in enumerate(result.vessel_outline)
    ]
    nodes = wires(result)[-1]
    nodes = nodes[nodes[:, 0] > -5e-3] * 1e3
    wire = Curve("wire at the end", nodes[:, 0], nodes[:, 1])
    return Chart(name, f"{title}: {result.status.status.name}", "x / mm", "y / mm", (*walls, wire))


_NARROW_END = {("funnel", WIRES[1]): Status.TOO_DEEP}
"""The stiff wire wedges in the funnel: before its tip is known to have stalled it is too deep in the walls."""

CASES = (
    *(Case(GROUP, f"tunnelling, {wire}", partial(tunnelling, wire)) for wire in WIRES),
    *(Case(GROUP, f"fold, {wire}, {w * 1e3:g} mm", partial(fold, wire, w)) for wire in WIRES for w in (10e-3, 20e-3)),
    Case(GROUP, f"dead end, {WIRES[0]}", partial(dead_end, WIRES[0], 0.8e-3)),
    Case(GROUP, f"dead end, {WIRES[1]}", partial(dead_end, WIRES[1], 1.2e-3)),
    *(
        Case(
            GROUP,
            f"narrow {shape}, {wire}",
            partial(narrow, shape, wire, _NARROW_END.get((shape, wire), Status.TIP_STALLED)),
        )
        for shape in NARROW
        for wire in WIRES
    ),
)
