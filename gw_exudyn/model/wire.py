"""The wire as a chain of rigid segments with torsional springs and dampers in its joints."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from gw_exudyn.scenario import StiffnessPiece, WireSpec
    from gw_exudyn.scenario.friction import FrictionStretch

Floats = NDArray[np.float64]

DEFAULT_IMPERFECTION = 0.04
"""Rest curvature of a wire that is called straight, 1/m (a radius of 25 m).

A perfectly straight wire pushed square against a wall has no side to buckle to. This one has; `benchmarks/` shows that
it moves a tip in a bend by less than 0.005 mm, and that a tenth or ten times of it lead to the same place.
"""


@dataclass(frozen=True)
class Wire:
    """A chain of n segments, numbered from the proximal end to the tip; joint i is at the proximal end of segment i.

    radius : m. lengths : (n,), m. mass : (n,), kg. inertia : (n,), kg m^2, about the centre.
    joint_stiffness : (n,), N m/rad. joint_damping : (n,), N m s/rad. rest_angle : (n,), rad, the angle of segment i
        against segment i - 1 (joint 0: against the catheter) without load, counter-clockwise.
    node_arc_length : (n + 1,), m, from the tip; node i is the proximal end of segment i, node n the tip.
    friction_factor : (n + 1,), at the nodes, linear in between; a wall's friction coefficient times this is that of the
        contact.
    """

    radius: float
    lengths: Floats
    mass: Floats
    inertia: Floats
    joint_stiffness: Floats
    joint_damping: Floats
    rest_angle: Floats
    node_arc_length: Floats
    friction_factor: Floats

    @property
    def segments(self) -> int:
        """Number of segments."""
        return len(self.lengths)

    @property
    def length(self) -> float:
        """Length of the wire, m."""
        return float(self.node_arc_length[0])

    @property
    def joint_arc_length(self) -> Floats:
        """(n,), m, from the tip."""
        return self.node_arc_length[:-1]


def build_wire(spec: WireSpec) -> Wire:
    """The chain for a wire of a scenario."""
    lengths = segment_lengths(spec.length, spec.segments, spec.grading)
    nodes = np.concatenate([[0.0], np.cumsum(lengths[::-1])])[::-1].copy()
    nodes[0] = spec.length  # without the sum's rounding: the clamp's stretch ends where stiffness and tip shape may
    far, near = joint_regions(nodes)
    stiffness = 1 / compliance(spec.effective_stiffness, near, far)
    radius = spec.diameter / 2
    mass = spec.density * math.pi * radius**2 * lengths
    return Wire(
        radius=radius,
        lengths=lengths,
        mass=mass,
        inertia=mass * (lengths**2 / 12 + radius**2 / 4),
        joint_stiffness=stiffness,
        joint_damping=spec.damping_time * stiffness,
        rest_angle=rest_angles(spec, near, far),
        node_arc_length=nodes,
        friction_factor=friction_factors(spec.friction, nodes),
    )


def segment_lengths(length: float, segments: int, grading: float) -> Floats:
    """(n,), m, from the proximal end: a geometric series whose first is `grading` times its last [paper, Fig. 3]."""
    lengths = np.geomspace(grading, 1.0, segments) if segments > 1 else np.ones(1)
    scaled: Floats = lengths * (length / lengths.sum())
    return scaled


def joint_regions(nodes: Floats) -> tuple[Floats, Floats]:
    """The stretch of wire whose bending each joint stands for: (n,), (n,), m from the tip, proximal and distal bound.

    nodes : (n + 1,), m from the tip, the proximal end first. A joint's stretch goes from the middle of one segment to
        the middle of the next; the clamp has half a segment only, hence 2 EI / length.
    """
    middle = (nodes[:-1] + nodes[1:]) / 2
    return np.concatenate([nodes[:1], middle[:-1]]), middle


def compliance(pieces: Sequence[StiffnessPiece], near: Floats, far: Floats) -> Floats:
    """(n,), rad/(N m): the integral of ds / EI over each stretch from `near` to `far` (m from the tip).

    Exact for piecewise linear EI, with steps.
    """
    total = np.zeros_like(near)
    for piece in pieces:
        low, high = np.clip(near, piece.start, piece.end), np.clip(far, piece.start, piece.end)
        slope = (piece.value_end - piece.value) / (piece.end - piece.start)
        at_low, at_high = piece.value + slope * (low - piece.start), piece.value + slope * (high - piece.start)
        # log1p(x)/x is 1 for x = 0; written so, a constant EI needs no case of its own.
        ratio = (at_high - at_low) / at_low
        small = np.abs(ratio) < 1e-9
        factor = np.where(small, 1.0, np.log1p(ratio) / np.where(small, 1.0, ratio))
        total += (high - low) / at_low * factor
    return total


def friction_factors(stretches: Sequence[FrictionStretch], nodes: Floats) -> Floats:
    """(n + 1,): the factor at each node, its mean over the half segments beside it, so that no stretch is lost.

    nodes : (n + 1,), m from the tip, the proximal end first.
    """
    bounds = np.concatenate([nodes[:1], (nodes[:-1] + nodes[1:]) / 2, nodes[-1:]])
    factors = np.ones(len(nodes))
    for stretch in stretches:
        covered = np.diff(np.clip(bounds, stretch.start, stretch.end)) / np.diff(bounds)
        factors += (stretch.factor - 1) * covered
    return factors


def rest_angles(spec: WireSpec, near: Floats, far: Floats) -> Floats:
    """(n,), rad: the rest curvature, its imperfection included, integrated over each joint's stretch."""
    curvature = DEFAULT_IMPERFECTION if spec.imperfection is None else spec.imperfection
    angles: Floats = curvature * (far - near)
    tip = spec.tip_shape
    if tip.kind == "arc" and tip.length and tip.angle:
        angles = angles + tip.angle / tip.length * np.clip(np.minimum(far, tip.length) - near, 0.0, None)
    if tip.kind == "bend" and tip.length is not None and tip.angle:
        here = (near < tip.length) & (tip.length <= far)
        angles = angles + np.where(here, tip.angle, 0.0)
    return angles


def mean_stiffness(pieces: Sequence[StiffnessPiece], length: float) -> float:
    """Bending stiffness, N m^2, of the distal `length` (m) as bending in series sees it (the harmonic mean)."""
    bound = min(length, pieces[-1].end)
    return float(bound / compliance(pieces, np.zeros(1), np.array([bound]))[0])
