"""A vessel of branches: a tree with any diameters, angles and rounded corners."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, NamedTuple, Self

from pydantic import Field, ValidationInfo, field_validator, model_validator

from gw_exudyn.scenario.faults import Faults, wrong
from gw_exudyn.scenario.fields import Choice, Number, Table, Text
from gw_exudyn.scenario.kinds import BEND_RADIUS, BRANCH_ANGLE, BRANCH_LENGTH, BRANCH_PLACE, FILLET, POINT
from gw_exudyn.scenario.section import Section
from gw_exudyn.scenario.vessels.diameter import DIAMETER, Diameters
from gw_exudyn.scenario.vessels.regions import Lumen, Region
from gw_exudyn.scenario.words import did_you_mean, shown

if TYPE_CHECKING:
    from gw_exudyn.scenario.vessels.branch_course import Course
    from gw_exudyn.scenario.vessels.lumen import Lumen as UnitedLumen

Points = tuple[tuple[float, float], ...]

MOST_BRANCHES = 200
MOST_POINTS = 10_000
_NAME = re.compile(r"[A-Za-z_][\w-]{0,59}")
_FLATTEST = math.radians(10)
"""Least angle, rad, between a branch and the axis of the one that it leaves in the middle of."""
_AT_END = 1e-6  # m

_OPENNESS = Choice(("open", "dead"), optional=True)


class BranchSpec(Section):
    """One branch: along points, or from a place on its parent at an angle.

    name : of letters, digits, - and _. points : ((x, y), ...), m, corners of the centre line; None with a parent.
    parent : name of another branch. at : m, along the parent's centre line. angle : rad, from the parent's direction
        there, positive to the left. length : m.
    diameter : m; one, (from, to), or ((place, diameter), ...) along the length.
    bend_radius : m, of the centre line at its inner points. fillet : m, radius of corners into the lumen: those of the
        branch's own bends, and those where it meets its parent or an earlier branch; None takes the parent's.
    start, end : `open`, no wall, or `dead`; None: open, unless another branch goes on there.
    """

    what: ClassVar[str] = "a branch"

    name: Annotated[str, Text("name")] = Field(description="name of the branch", examples=["main"])
    points: Annotated[Points | None, Table(POINT, 2, MOST_POINTS, "point", optional=True)] = Field(
        default=None, description="corners of the centre line", examples=["[[0 mm, 0 mm], [20 mm, 0 mm]]"]
    )
    parent: Annotated[str | None, Text("name of a branch", optional=True)] = Field(
        default=None, description="branch from which this one leaves"
    )
    at: Annotated[float | None, BRANCH_PLACE] = Field(
        default=None, description="where it leaves, along the parent's centre line"
    )
    angle: Annotated[float | None, BRANCH_ANGLE] = Field(
        default=None, description="angle from the parent's direction there, positive to the left"
    )
    length: Annotated[float | None, BRANCH_LENGTH] = Field(
        default=None, validate_default=True, description="length, from the parent's centre line"
    )
    diameter: Annotated[Diameters, DIAMETER] = Field(
        description="width of the lumen: one, [from, to], or a table [[place, diameter], ...]",
        examples=["4 mm", "[4 mm, 2 mm]"],
    )
    bend_radius: Annotated[float, BEND_RADIUS] = Field(
        default=0.0, description="radius of the centre line at its inner points; 0 leaves them sharp"
    )
    fillet: Annotated[float | None, FILLET] = Field(
        default=None,
        description="radius of corners into the lumen at bends and bifurcations; the parent's if not given",
    )
    start: Annotated[str | None, _OPENNESS] = Field(default=None, description="open or dead; of a branch with points")
    end: Annotated[str | None, _OPENNESS] = Field(
        default=None, description="open or dead; open if not given, unless another branch goes on there"
    )

    @field_validator("name", mode="after")
    @classmethod
    def _can_stand_in_a_path(cls, name: str) -> str:
        if _NAME.fullmatch(name) is None:
            raise wrong(f"{shown(name)} cannot name a branch; letters, digits, - and _ are allowed, a letter first")
        return name

    @field_validator("length", mode="after")
    @classmethod
    def _one_way(cls, length: float | None, info: ValidationInfo) -> float | None:
        given = {"points", "parent", "at", "angle"} <= info.data.keys()
        if not given:
            return length  # told already
        placed = [key for key in ("parent", "at", "angle") if info.data[key] is not None]
        placed += ["length"] if length is not None else []
        if info.data["points"] is not None:
            if placed:
                raise wrong(f"{', '.join(placed)} beside points: give points, or parent, at, angle and length")
            return length
        missing = [key for key in ("parent", "at", "angle") if info.data[key] is None]
        missing += ["length"] if length is None else []
        if missing:
            text = f"the branch lacks {', '.join(missing)}" if placed else "the branch has no course"
            raise wrong(
                f"{text}: give points, or parent, at, angle and length", missing=True, instead=(*missing, "points")
            )
        return length


class BranchesVessel(Lumen):
    """A tree of branches. Frame: x and y in metres.

    branches : the branches; parents may stand before or after their children. out_of_plane : of a 3D centre line that
        was projected: largest distance from its plane over the local radius; None for a plane one.
    """

    what: ClassVar[str] = "a vessel of branches"

    kind: Annotated[Literal["branches"], Choice(("branches",))]
    branches: tuple[BranchSpec, ...] = Field(
        description="the branches",
        examples=["[{name: main, points: [[0 mm, 0 mm], [40 mm, 0 mm]], diameter: 4 mm}]"],
    )
    out_of_plane: Annotated[float | None, Number(0.0, 1.0, optional=True)] = Field(
        default=None,
        description="of a centre line projected from 3D: its largest distance from the plane over the local radius",
    )

    @field_validator("branches", mode="after")
    @classmethod
    def _a_few(cls, branches: tuple[BranchSpec, ...]) -> tuple[BranchSpec, ...]:
        if not 1 <= len(branches) <= MOST_BRANCHES:
            raise wrong(f"has {len(branches)} branches; 1 to {MOST_BRANCHES} are needed")
        return branches

    @model_validator(mode="after")
    def _makes_a_lumen(self) -> Self:
        faults = Faults()
        _check_tree(self.branches, faults)
        faults.raise_if_any()
        found = united(self.branches)
        if isinstance(found, list):
            for fault in found:
                faults.add(fault.loc, fault.message)
        faults.raise_if_any()
        return self

    def lumen(self) -> UnitedLumen:
        """The united outline. The branches were checked, so there is one."""
        found = united(self.branches)
        if isinstance(found, list):
            raise ValueError(found)
        return found

    def _whole(self) -> Points:
        return self.lumen().points

    def _regions(self) -> tuple[Region, ...]:
        courses = placed(self.branches)
        outlines = self.lumen().regions
        return tuple(
            Region(spec.name, outline, courses[spec.name].points)
            for spec, outline in zip(self.branches, outlines, strict=True)
        )


class Wrong(NamedTuple):
    """What is wrong with branches. loc : place in the vessel. where : (x, y), m, or None."""

    loc: tuple[str | int, ...]
    message: str
    where: tuple[float, float] | None = None


Faulty = list[Wrong]


def _check_tree(branches: Sequence[BranchSpec], faults: Faults) -> None:
    """Names once each, parents there, no circle, a beginning."""
    names = [branch.name for branch in branches]
    again = [i for i, name in enumerate(names) if name in names[:i]]
    for i in again:
        faults.add(("branches", i, "name"), f"{shown(names[i])} is the name of another branch too; rename one")
    if again:
        return  # which of them is a parent is not said
    for i, branch in enumerate(branches):
        if branch.parent is not None and branch.parent not in names:
            others = [name for name in names if name != branch.name]
            allowed = f"{did_you_mean(branch.parent, others)}branches: {', '.join(others) or 'none'}"
            faults.add(("branches", i, "parent"), f"there is no branch {shown(branch.parent)}; {allowed}")
    parents = {branch.name: branch.parent for branch in branches}
    for i, branch in enumerate(branches):
        chain = [branch.name]
        while (above := parents.get(chain[-1])) is not None and above not in chain:
            chain.append(above)
        if above == branch.name:
            circle = " -> ".join([*chain, branch.name])
            text = f"the parents run in a circle, {circle}; give one of these branches points instead"
            faults.add(("branches", i, "parent"), text)
            return


@functools.lru_cache(maxsize=32)
def united(branches: tuple[BranchSpec, ...]) -> UnitedLumen | Faulty:
    """The lumen of the branches, or what is wrong with them."""
    from gw_exudyn.scenario.vessels.branch_course import CourseError
    from gw_exudyn.scenario.vessels.lumen import Branch, unite

    faults: Faulty = []
    courses = _courses(branches, faults)
    if faults:
        return faults
    by_name, index = {b.name: b for b in branches}, {b.name: i for i, b in enumerate(branches)}
    parts = []
    for spec in branches:
        side = None
        if spec.parent is not None:
            parent, at = courses[spec.parent], spec.at or 0.0
            if _AT_END < at < parent.length - _AT_END:
                side = parent.at(at)
        states = tuple(None if state is None else state == "open" for state in (spec.start, spec.end))
        parts.append(Branch(spec.name, courses[spec.name], _fillet(spec, by_name), (states[0], states[1]), side))
    for part in parts:
        try:
            part.course.quads()
        except CourseError as error:
            faults.append(Wrong(("branches", index[part.name], error.key), str(error), error.where))
    if faults:
        return faults
    found = unite(parts)
    if not isinstance(found, list):
        return found
    return [
        Wrong(
            ("branches",) if f.branch is None else tuple(k for k in ("branches", f.branch, f.key) if k != ""), f.message
        )
        for f in found
    ]


def placed(branches: tuple[BranchSpec, ...]) -> dict[str, Course]:
    """The courses of branches that are sound."""
    return _courses(branches, [])


def _fillet(spec: BranchSpec, by_name: dict[str, BranchSpec]) -> float:
    while spec.fillet is None and spec.parent is not None:
        spec = by_name[spec.parent]
    return spec.fillet or 0.0


def _courses(branches: Sequence[BranchSpec], faults: Faulty) -> dict[str, Course]:
    """Every branch's course, parents first; what is wrong goes to `faults`."""
    from gw_exudyn.scenario.vessels.branch_course import CourseError, make_course

    courses: dict[str, Course] = {}
    left = list(enumerate(branches))
    while left:
        ready = [(i, spec) for i, spec in left if spec.parent is None or spec.parent in courses]
        if not ready:
            break  # what stands on a branch that is wrong itself
        for i, spec in ready:
            try:
                points = spec.points or _ray(spec, courses[spec.parent or ""])
                courses[spec.name] = make_course(points, _table(spec.diameter), spec.bend_radius)
            except CourseError as error:
                faults.append(Wrong(("branches", i, error.key), str(error), error.where))
        left = [(i, spec) for i, spec in left if (i, spec) not in ready]
    return courses


def _ray(spec: BranchSpec, parent: Course) -> Points:
    """Both ends of a branch that leaves its parent."""
    from gw_exudyn.scenario.vessels.branch_course import CourseError

    at, angle, length = spec.at or 0.0, spec.angle or 0.0, spec.length or 0.0
    if at > parent.length + _AT_END:
        text = f"{at * 1e3:.6g} mm is beyond the end of {spec.parent!r}, which is {parent.length * 1e3:.6g} mm long"
        raise CourseError("at", f"{text}; take 0 to {parent.length * 1e3:.6g} mm")
    inside = _AT_END < at < parent.length - _AT_END
    if inside and abs(math.sin(angle)) < math.sin(_FLATTEST):
        text = f"{math.degrees(angle):.4g} deg runs along the parent"
        raise CourseError("angle", f"{text}; take at least 10 deg, or put it at the parent's end")
    (x, y), heading, _ = parent.at(at)
    turn = heading + angle
    return (float(x), float(y)), (float(x) + length * math.cos(turn), float(y) + length * math.sin(turn))


def _table(diameter: Diameters) -> Any:
    from gw_exudyn.scenario.vessels.branch_course import DiameterTable

    if not isinstance(diameter, tuple):
        return DiameterTable(((0.0, diameter),), relative=True)
    if isinstance(diameter[0], tuple):
        return DiameterTable(diameter, relative=False)
    return DiameterTable(((0.0, diameter[0]), (1.0, float(diameter[1]))), relative=True)
