"""A second model of an insertion, for comparison only: a bending cable of ANCF elements in a smooth channel.

It shares nothing with the wire of rigid segments but the engine: cubic elements with bending and axial stiffness
[Gerstmayr and Irschik 2008] instead of rigid ones with springs in between, a static solution for each place of the
drive instead of steps in time, a bend that is a true arc instead of facets, and a contact of its own, without friction.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gw_exudyn.engine.library import exudyn
from gw_exudyn.errors import SolverError

Floats = NDArray[np.float64]

_COORDINATES = 4
"""Of a node: place (x, y) and slope (x, y)."""


@dataclass(frozen=True)
class SmoothBend:
    """A channel whose centreline runs along the x axis to x = `lead_in`, turns left on an arc and goes straight on.

    radius : m, of the centreline. angle : rad, under pi. width : m, of the lumen.
    """

    lead_in: float
    radius: float
    angle: float
    width: float

    def offset(self, points: Floats) -> tuple[Floats, Floats, Floats]:
        """Of points (n, 2), m: the distance left of the centreline (n,), m; its gradient (n, 2); its curvature (n,),
        1/m, the second derivative across the gradient."""
        from_centre = points - [self.lead_in, self.radius]
        turned = np.arctan2(from_centre[:, 0], -from_centre[:, 1])
        far = np.where(turned < self.angle / 2 - np.pi, turned + 2 * np.pi, turned)
        angle = np.clip(far, 0.0, self.angle)
        normal = np.column_stack([-np.sin(angle), np.cos(angle)])
        straight = angle != far
        distance = np.hypot(*from_centre.T)
        offset = np.where(straight, (from_centre * normal).sum(axis=1), -distance) + self.radius
        return offset, normal, np.where(straight, 0.0, -1 / distance)


@dataclass(frozen=True)
class Cable:
    """A cable. length, radius : m. stiffness : (n,), N m^2, of its elements from the proximal end; all are of the same
    length."""

    length: float
    radius: float
    stiffness: Floats


@dataclass(frozen=True)
class Inserted:
    """x, y : (n + 1,), m, of the nodes, the proximal end first. push_force : N."""

    x: Floats
    y: Floats
    push_force: float


def insert(cable: Cable, bend: SmoothBend, travels: Floats, wall_stiffness: float, start: float) -> list[Inserted]:
    """Push a cable, straight at first with its tip at x = `start`, into a bend; its proximal end keeps to the x axis.

    travels : m, rising, at each of which equilibrium is sought. wall_stiffness : N/m, of each node's contact.
    Raises SolverError where none is found.
    """
    system = _System(cable, bend, wall_stiffness, start)
    return [system.at(float(travel)) for travel in travels]


class _System:
    def __init__(self, cable: Cable, bend: SmoothBend, wall_stiffness: float, start: float) -> None:
        import exudyn.itemInterface as items  # noqa: N813

        self._bend, self._room = bend, bend.width / 2 - cable.radius
        self._wall_stiffness, self._onset = wall_stiffness, 0.01 * cable.radius
        count = len(cable.stiffness)
        x = np.linspace(start - cable.length, start, count + 1)
        self._reference = np.column_stack([x, np.zeros_like(x)])
        self._container = exudyn().SystemContainer()
        self._mbs = mbs = self._container.AddSystem()
        node: Any = items.NodePoint2DSlope1
        nodes = [mbs.AddNode(node(referenceCoordinates=[float(place), 0.0, 1.0, 0.0])) for place in x]
        for i, stiffness in enumerate(cable.stiffness):
            mbs.AddObject(
                items.ObjectANCFCable2D(
                    nodeNumbers=[nodes[i], nodes[i + 1]],
                    length=cable.length / count,
                    massPerLength=0.0,
                    bendingStiffness=float(stiffness),
                    axialStiffness=float(4 * stiffness / cable.radius**2),  # of a full round section
                )
            )
        self._hold(items, nodes[0])
        self._touch(items, nodes)
        mbs.Assemble()
        self._settings = _static_settings()

    def _hold(self, items: Any, node: int) -> None:
        """Hold the proximal end on the axis without turning; its first coordinate is driven."""
        mbs = self._mbs
        ground = mbs.AddMarker(
            items.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(items.NodePointGround()), coordinate=0)
        )
        markers = [mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=c)) for c in (0, 1, 3)]
        held = [mbs.AddObject(items.CoordinateConstraint(markerNumbers=[ground, marker])) for marker in markers]
        self._drive = held[0]

    def _touch(self, items: Any, nodes: list[int]) -> None:
        size = _COORDINATES * len(nodes)
        empty = exudyn().MatrixContainer()
        empty.SetWithSparseMatrix(np.zeros((1, 3)), size, size)
        self._mbs.AddObject(
            items.ObjectGenericODE2(
                nodeNumbers=nodes,
                massMatrix=empty,
                stiffnessMatrix=empty,
                dampingMatrix=empty,
                forceVector=np.zeros(size),
                forceUserFunction=self._force,
                jacobianUserFunction=self._tangent,
            )
        )

    def _contact(self, q: Any) -> tuple[Floats, Floats, Floats, Floats]:
        """Force (n,), N, on each node away from the wall that it is nearer to, its slope, N/m, and the wall's normal
        and curvature there."""
        points = self._reference + np.asarray(q).reshape(-1, _COORDINATES)[:, :2]
        offset, gradient, curvature = self._bend.offset(points)
        side = np.sign(offset)
        depth = side * offset - self._room
        # A force that sets in smoothly: ln(1 + exp(x)), which goes from nothing over to x.
        scaled = depth / self._onset
        force = self._wall_stiffness * self._onset * np.logaddexp(0.0, scaled)
        slope = self._wall_stiffness / (1 + np.exp(-np.clip(scaled, -700.0, 700.0)))
        return force, slope, side[:, None] * gradient, side * curvature

    def _force(self, _mbs: Any, _t: float, _item: int, q: Any, _q_t: Any) -> Floats:
        force, _, normal, _ = self._contact(q)
        full = np.zeros((len(force), _COORDINATES))
        full[:, :2] = -force[:, None] * normal
        return full.ravel()

    def _tangent(self, _mbs: Any, _t: float, _item: int, q: Any, _q_t: Any, factor: float, _factor_t: float) -> Any:
        force, slope, normal, curvature = self._contact(q)
        along = np.column_stack([normal[:, 1], -normal[:, 0]])
        blocks = slope[:, None, None] * normal[:, :, None] * normal[:, None, :]
        blocks += (force * curvature)[:, None, None] * along[:, :, None] * along[:, None, :]
        first = _COORDINATES * np.arange(len(force))
        rows = first[:, None] + np.repeat(np.arange(2), 2)
        columns = first[:, None] + np.tile(np.arange(2), 2)
        size = _COORDINATES * len(force)
        matrix = exudyn().MatrixContainer()
        matrix.SetWithSparseMatrix(
            np.column_stack([rows.ravel(), columns.ravel(), factor * blocks.ravel()]).astype(float), size, size
        )
        return matrix

    def at(self, travel: float) -> Inserted:
        """Equilibrium at a place of the drive, from the one before."""
        mbs, exu = self._mbs, exudyn()
        mbs.SetObjectParameter(self._drive, "offset", travel)
        try:
            mbs.SolveStatic(self._settings, updateInitialValues=True)
        except exu.SolverError as error:
            raise SolverError(f"the cable finds no equilibrium at a travel of {travel * 1e3:.6g} mm") from error
        data = mbs.systemData
        places = self._reference + np.asarray(data.GetODE2Coordinates()).reshape(-1, _COORDINATES)[:, :2]
        return Inserted(places[:, 0], places[:, 1], float(data.GetAECoordinates()[0]))


def _static_settings() -> Any:
    settings = exudyn().SimulationSettings()
    static = settings.staticSolver
    static.numberOfLoadSteps = 1
    static.verboseMode = 0
    static.newton.relativeTolerance = 1e-8
    static.newton.absoluteTolerance = 1e-9
    static.newton.maxIterations = 40
    static.discontinuous.maxIterations = 1
    settings.linearSolver.solverType = exudyn().LinearSolverType.EigenSparse
    settings.solution.file.write = False
    settings.parallel.numberOfThreads = 1
    return settings
