"""The vessel of a scenario. Frame: x and y in metres; the lumen is where the wire may be."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, NoReturn, Self

from pydantic import Discriminator, Field, Tag, ValidationInfo, field_validator, model_validator

from gw_exudyn.scenario.faults import Faults, wrong
from gw_exudyn.scenario.fields import Choice, Table, Text, Whole
from gw_exudyn.scenario.kinds import (
    ANGLE,
    ARC_RADIUS,
    DRAWING_LENGTH,
    LEAD_LENGTH,
    POINT,
    VESSEL_DIAMETER,
    VESSEL_LENGTH,
)
from gw_exudyn.scenario.section import KIND_TAG, Form, Section, check_kind, kind_tag
from gw_exudyn.scenario.vessels.branches import BranchesVessel
from gw_exudyn.scenario.vessels.centreline import CentrelineForm
from gw_exudyn.scenario.vessels.outline import (
    MOST_POINTS,
    Outline,
    Points,
    check_outline,
    closed,
    counter_clockwise,
)
from gw_exudyn.scenario.vessels.regions import Lumen, Region

VESSEL_KINDS = Choice(("straight", "arc", "branches", "centreline", "polygon", "file", "none"))
_STEEPEST_FACET = math.radians(45)

_END = Field(default="open", description="open: the far end is no wall; dead: it is closed")


class NoVessel(Lumen):
    """No vessel: nothing stands in the wire's way."""

    what: ClassVar[str] = "no vessel"

    kind: Annotated[Literal["none"], Choice(("none",))]

    def _regions(self) -> tuple[Region, ...]:
        return ()


class StraightVessel(Lumen):
    """A straight channel: its lumen is 0 <= x <= length, abs(y) <= diameter / 2.

    length, diameter : m. end : `open`, no wall at x = length, or `dead`.
    """

    what: ClassVar[str] = "a straight vessel"

    kind: Annotated[Literal["straight"], Choice(("straight",))]
    length: Annotated[float, VESSEL_LENGTH] = Field(description="length along x", examples=["100 mm"])
    diameter: Annotated[float, VESSEL_DIAMETER] = Field(description="width of the lumen", examples=["4 mm"])
    end: Annotated[str, Choice(("open", "dead"))] = _END

    def _whole(self) -> list[tuple[float, float]]:
        half = self.diameter / 2
        return [(0.0, -half), (self.length, -half), (self.length, half), (0.0, half)]


class ArcVessel(Lumen):
    """A channel whose centreline runs `lead_in` along +x from the origin, turns on an arc, and goes straight on.

    radius : m, of the centreline. angle : rad, positive to the left. diameter, lead_in, lead_out : m, lead_out
        follows the arc. facets :
        straight wall pieces that make up each side of the arc. end : `open` or `dead`.
    """

    what: ClassVar[str] = "an arc vessel"

    kind: Annotated[Literal["arc"], Choice(("arc",))]
    diameter: Annotated[float, VESSEL_DIAMETER] = Field(description="width of the lumen", examples=["4 mm"])
    radius: Annotated[float, ARC_RADIUS] = Field(description="radius of the centreline", examples=["15 mm"])
    angle: Annotated[float, ANGLE] = Field(description="angle of the turn, positive to the left", examples=["90 deg"])
    facets: Annotated[int, Whole(1, 5000)] = Field(
        default=24, description="straight wall pieces on each side of the arc"
    )
    lead_in: Annotated[float, LEAD_LENGTH] = Field(
        default=0.0, description="straight part before the arc, along +x from the origin"
    )
    lead_out: Annotated[float, LEAD_LENGTH] = Field(default=0.0, description="straight part after the arc")
    end: Annotated[str, Choice(("open", "dead"))] = _END

    @field_validator("radius", mode="after")
    @classmethod
    def _beyond_half_the_lumen(cls, radius: float, info: ValidationInfo) -> float:
        diameter = info.data.get("diameter")
        if diameter is not None and radius <= diameter / 2:
            half = f"half the diameter, {diameter * 500:.6g} mm"
            raise wrong(f"{radius * 1e3:.6g} mm is not beyond {half}: the inner wall would vanish")
        return radius

    @field_validator("angle", mode="after")
    @classmethod
    def _turns(cls, angle: float) -> float:
        if angle == 0:
            raise wrong("0 deg is no turn; take kind: straight")
        return angle

    @field_validator("facets", mode="after")
    @classmethod
    def _not_too_steep(cls, facets: int, info: ValidationInfo) -> int:
        angle = abs(info.data.get("angle", 0.0))
        if angle / facets > _STEEPEST_FACET * (1 + 1e-9):
            fewest = math.ceil(angle / _STEEPEST_FACET * (1 - 1e-9))
            raise wrong(
                f"{facets} facets turn {math.degrees(angle / facets):.4g} deg each, at most 45; take {fewest} or more"
            )
        return facets

    @model_validator(mode="after")
    def _keeps_clear_of_itself(self) -> Self:
        import shapely

        if not shapely.Polygon(self._whole()).is_valid:
            faults = Faults()
            faults.add(
                ("angle",),
                "the arc's end runs across its beginning; take a smaller angle, a shorter lead_out, or a larger radius",
            )
            faults.raise_if_any()
        return self

    def _whole(self) -> list[tuple[float, float]]:
        """Points of the right wall, then of the left wall back, m."""
        side = math.copysign(1.0, self.angle)
        course = [(0.0, 0.0, 0.0)] if self.lead_in > 0 else []
        for i in range(self.facets + 1):
            turn = self.angle * i / self.facets
            x, y = self.radius * side * math.sin(turn), self.radius * side * (1 - math.cos(turn))
            course.append((self.lead_in + x, y, turn))
        if self.lead_out > 0:
            x, y, turn = course[-1]
            course.append((x + self.lead_out * math.cos(turn), y + self.lead_out * math.sin(turn), turn))
        half = self.diameter / 2
        right = [(x + half * math.sin(turn), y - half * math.cos(turn)) for x, y, turn in course]
        left = [(x - half * math.sin(turn), y + half * math.cos(turn)) for x, y, turn in course]
        # Rounded, so that a full turn closes on itself whatever the last digit of its sine.
        return [(round(x, 14), round(y, 14)) for x, y in right + left[::-1]]


class PolygonVessel(Lumen):
    """A lumen with a closed outline.

    points : ((x, y), ...), m, counter-clockwise, the first not repeated at the end. open_edges : indices of the edges
        (point i to point i + 1) that are open ends rather than walls, rising.
    """

    kind: Literal["polygon"] = "polygon"
    points: Points
    open_edges: tuple[int, ...] = ()

    def _whole(self) -> Points:
        return self.points


class PolygonForm(Section):
    """A lumen with a closed outline, from a CSV, WKT, GeoJSON or SVG file, or a list of points."""

    what: ClassVar[str] = "a polygon vessel"

    kind: Annotated[Literal["polygon"], Choice(("polygon",))]
    unit: Annotated[str | None, Text("unit", optional=True)] = Field(
        default=None, description="unit of the coordinates in a WKT or GeoJSON file", examples=["mm"]
    )
    length: Annotated[float | None, DRAWING_LENGTH] = Field(
        default=None,
        description="width of the viewBox of an SVG file; the drawing's own width, if in mm, cm or in, if not given",
        examples=["120 mm"],
    )
    id: Annotated[str | None, Text("id", optional=True)] = Field(
        default=None, description="id of the lumen's path in an SVG file that has several"
    )
    file: Annotated[Outline | None, Text("file name", optional=True)] = Field(
        default=None,
        description="CSV, WKT, GeoJSON or SVG file, relative to this; CSV: header x,y (metres) or x [mm],y [mm], "
        "and a column open that marks open ends",
    )
    points: Annotated[Points | None, Table(POINT, 3, MOST_POINTS, "point", optional=True)] = Field(
        default=None, validate_default=True, description="corners of the outline in order"
    )
    open_edges: Annotated[tuple[int, ...], Table(Whole(0, MOST_POINTS), 0, MOST_POINTS, "edge")] = Field(
        default=(), description="edges that are open ends: edge i goes from point i to point i + 1"
    )

    @field_validator("file", mode="after")
    @classmethod
    def _read(cls, name: Any, info: ValidationInfo) -> Outline | None:
        from gw_exudyn.scenario.vessels.outline_files import read_any_outline

        if name is None:
            return None
        if not {"unit", "length", "id"} <= info.data.keys():
            return None  # one of them is wrong itself, which is told already
        path = Path((info.context or {}).get("folder", "."), str(name))
        outline = read_any_outline(path, info.data["unit"], info.data["length"], info.data["id"])
        check_outline(outline)
        return outline

    @field_validator("points", mode="after")
    @classmethod
    def _either(cls, points: Points | None, info: ValidationInfo) -> Points | None:
        if "file" not in info.data:
            return points  # the file is wrong itself, which is told already
        if (points is None) == (info.data["file"] is None):
            if points is None:
                raise wrong(
                    "is missing: give file: outline.csv, or points: [[0 mm, 0 mm], ...]",
                    missing=True,
                    instead=("file",),
                )
            raise wrong("stands beside file; give one of the two")
        if points is not None:
            points = closed(Outline(points)).points
            check_outline(Outline(points))
        return points

    @field_validator("open_edges", mode="after")
    @classmethod
    def _edges_exist(cls, edges: tuple[int, ...], info: ValidationInfo) -> tuple[int, ...]:
        outline, points = info.data.get("file"), info.data.get("points")
        if edges and outline is not None and outline.open_edges:
            raise wrong("stands beside the column 'open' of the file; give one of the two")
        count = outline.edges if outline is not None else len(points or ())
        faults = Faults()
        for i, edge in enumerate(edges):
            if count and edge >= count:
                faults.add((i,), f"there is no edge {edge}; the outline has {count}, 0 to {count - 1}")
            elif edge in edges[:i]:
                faults.add((i,), f"edge {edge} is given twice")
        faults.raise_if_any()
        return edges

    def resolve(self) -> PolygonVessel:
        """The outline, counter-clockwise."""
        given = self.file or Outline(self.points or (), self.open_edges)
        points, edges = counter_clockwise(given.points, given.open_edges or given.among_points(self.open_edges))
        return PolygonVessel(points=points, open_edges=edges)


class VesselFile(Section):
    """A vessel in a file of its own, which holds what would stand here. The loader puts it in this place."""

    what: ClassVar[str] = "the file of a vessel"

    kind: Annotated[Literal["file"], Choice(("file",))]
    file: Annotated[str, Text("file name")] = Field(
        description="YAML file, relative to this, with the keys of a vessel", examples=["vessels/phantom.yaml"]
    )

    def resolve(self) -> NoReturn:
        """Not reached where a scenario is loaded."""
        raise wrong(
            "a vessel's file is read by load_scenario and scenario_from_dict only; load the scenario with these"
        )


VesselForm = Annotated[
    Annotated[StraightVessel, Tag(f"{KIND_TAG}straight")]
    | Annotated[ArcVessel, Tag(f"{KIND_TAG}arc")]
    | Annotated[BranchesVessel, Tag(f"{KIND_TAG}branches")]
    | Annotated[CentrelineForm, Tag(f"{KIND_TAG}centreline")]
    | Annotated[VesselFile, Tag(f"{KIND_TAG}file")]
    | Annotated[PolygonForm, Tag(f"{KIND_TAG}polygon")]
    | Annotated[NoVessel, Tag(f"{KIND_TAG}none")],
    Discriminator(kind_tag),
]
"""What a file may hold."""


Vessel = Annotated[
    StraightVessel | ArcVessel | BranchesVessel | PolygonVessel | NoVessel,
    Form(
        VesselForm,
        (StraightVessel, ArcVessel, BranchesVessel, PolygonVessel, NoVessel),
        check=partial(check_kind, kinds=VESSEL_KINDS, what="vessel"),
    ),
]
"""The vessel as the program sees it, read from any of the forms."""
