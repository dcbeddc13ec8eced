"""Whether a balance under loads is stable. The kernel's own check knows of walls only, and is used without loads."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.model.kernel import Motion
from gw_exudyn.model.wire import Wire

Floats = NDArray[np.float64]


def negative_pivots(
    wire: Wire,
    motion: Motion,
    blocks: Floats,
    joint_stiffness: Floats,
    *,
    base_moves: bool,
) -> int:
    """How many pivots are negative where the chain's angles are eliminated from the tip to the drive.

    Of a symmetric stiffness that is the number of directions in which the potential has a maximum (Sylvester's law of
    inertia); of an unsymmetric one its parity is the sign of the determinant.

    blocks : (n, 3, 3), minus the derivative of the force on each body, its joints' forces (which turn with it) and
        inertia included. joint_stiffness : (n,), N m/rad, of the joint proximal to each body.
    base_moves : the proximal end is free to move across the catheter's axis.
    """
    # Stiffness of the part beyond a joint, by the joint's place and the angle of the segment before it.
    xx = xy = yx = yy = xa = ya = ax = ay = aa = 0.0
    own = _about_proximal_end(wire, motion, blocks).reshape(-1, 9).tolist()
    levers = (wire.lengths[:, None] * np.column_stack([-motion.s, motion.c])).tolist()
    springs = joint_stiffness.tolist()
    negative = 0
    for body in range(wire.segments - 1, -1, -1):
        (dx, dy), spring = levers[body], springs[body]
        oxx, oxy, oxa, oyx, oyy, oya, oax, oay, oaa = own[body]
        # Moved from the distal to the proximal joint, and the segment's own part added.
        turn_x, turn_y, turn_a = xx * dx + xy * dy + xa, yx * dx + yy * dy + ya, ax * dx + ay * dy + aa
        back_x, back_y = dx * xx + dy * yx + ax + oax, dx * xy + dy * yy + ay + oay
        pivot = dx * turn_x + dy * turn_y + turn_a + oaa + spring
        turn_x, turn_y = turn_x + oxa, turn_y + oya
        negative += pivot <= 0
        inverse = 1 / pivot if pivot else 0.0
        # Without the angle, whose joint leads on to the angle before.
        xx, xy = xx + oxx - turn_x * back_x * inverse, xy + oxy - turn_x * back_y * inverse
        yx, yy = yx + oyx - turn_y * back_x * inverse, yy + oyy - turn_y * back_y * inverse
        xa, ya = turn_x * spring * inverse, turn_y * spring * inverse
        ax, ay = spring * back_x * inverse, spring * back_y * inverse
        aa = spring - spring * spring * inverse
    return negative + (base_moves and yy <= 0)


def _about_proximal_end(wire: Wire, motion: Motion, blocks: Floats) -> Floats:
    """(n, 3, 3): the blocks by the place of each segment's proximal end and its angle."""
    moves = np.zeros_like(blocks)
    moves[:] = np.eye(3)
    moves[:, 0, 2] = -wire.lengths / 2 * motion.s
    moves[:, 1, 2] = wire.lengths / 2 * motion.c
    return np.asarray(moves.transpose(0, 2, 1) @ blocks @ moves)
