"""The scenario: what a file may say, checked and resolved into frozen objects in SI.

A scenario is read by pydantic, which gathers everything that is wrong. What is the same in the file and in the
program is one class; where the file has several forms (drive, polygon, bending stiffness) they are resolved while
reading.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from pydantic import Field, PrivateAttr, ValidationInfo, field_validator

from gw_exudyn.errors import Problem
from gw_exudyn.scenario.drives.drive import Drive
from gw_exudyn.scenario.faults import refuse, wrong
from gw_exudyn.scenario.fields import Text
from gw_exudyn.scenario.friction import FrictionPatch
from gw_exudyn.scenario.kinds import (
    ANGLE,
    BORE,
    FRICTION,
    FRICTION_OR_NONE,
    OUTPUT_INTERVAL,
    POINT,
    RESIDUAL,
    SMALLEST_STEP,
    SOLVER_STEP,
    TOLERANCE,
    WALL_DAMPING,
    WALL_STIFFNESS,
)
from gw_exudyn.scenario.loads import DiscSpec, NoseSpec, TipSpec
from gw_exudyn.scenario.problems import place_of
from gw_exudyn.scenario.section import Section
from gw_exudyn.scenario.stop import StopSpec, check_target
from gw_exudyn.scenario.vessels.vessel import Vessel
from gw_exudyn.scenario.wire import WireSpec
from gw_exudyn.scenario.words import shown
from gw_exudyn.scenario.yaml_source import Place

MOST_OUTPUTS = 1_000_000
MOST_SUPPORTS = 100
_NAME = re.compile(r"\w[\w.+-]{0,99}")


class CatheterSpec(Section):
    """The straight, fixed tube that holds the proximal part of the wire; the tip starts at its exit.

    exit : (x, y), m. direction : rad, of the axis, pointing into the vessel, from +x to the left. bore : m, inner
        diameter; 0 (`sleeve`) for a frictionless one without play; None where there is no tube and only the drive holds
        the wire.
    friction_coefficient : None takes the contact's.
    """

    what: ClassVar[str] = "the catheter"

    exit: Annotated[tuple[float, float], POINT] = Field(
        default=(0.0, 0.0), description="middle of the exit, where the tip starts"
    )
    direction: Annotated[float, ANGLE] = Field(
        default=0.0, description="direction of the axis into the vessel, from +x to the left"
    )
    bore: Annotated[float | None, BORE] = Field(
        default=None,
        description="inner diameter; sleeve: no play and no friction, the wire inside is straight; may be left out "
        "where the vessel is none: there is no tube then",
        examples=["1.2 mm"],
    )
    friction_coefficient: Annotated[float | None, FRICTION_OR_NONE] = Field(
        default=None, description="friction in it; the contact's if not given"
    )

    @property
    def is_sleeve(self) -> bool:
        """It holds the wire without play and without friction."""
        return self.bore == 0

    @field_validator("friction_coefficient", mode="after")
    @classmethod
    def _none_in_a_sleeve(cls, friction: float | None, info: ValidationInfo) -> float | None:
        if friction and info.data.get("bore") == 0:
            raise wrong("a sleeve has no friction; leave it out, or give a bore in which the wire has some play")
        return friction


class ContactSpec(Section):
    """Contact of the wire with walls.

    friction_coefficient : Coulomb, of all walls but the patches'; the wire's own `friction` multiplies it. patches :
        walls of the vessel with a friction coefficient of their own.
    wall_stiffness : N/m, per contact; None is chosen by the model. wall_damping : N
        s/m, at a penetration of 2 % of the wire's radius; None is chosen. tangential_stiffness : N/m, while sticking;
        None is the wall stiffness.
    """

    what: ClassVar[str] = "the contact"

    friction_coefficient: Annotated[float, FRICTION] = Field(
        default=0.4, description="Coulomb friction between wire and wall"
    )
    wall_stiffness: Annotated[float | None, WALL_STIFFNESS] = Field(
        default=None, description="normal stiffness of one contact"
    )
    wall_damping: Annotated[float | None, WALL_DAMPING] = Field(
        default=None, description="normal damping of one contact at a penetration of 2 % of the wire's radius"
    )
    tangential_stiffness: Annotated[float | None, WALL_STIFFNESS] = Field(
        default=None, description="tangential stiffness while the wire sticks; auto is the wall stiffness"
    )
    patches: tuple[FrictionPatch, ...] = Field(
        default=(), max_length=10_000, description="walls of the vessel whose friction differs; the last one counts"
    )


class SolverSpec(Section):
    """Steps of the solver. step, minimum_step : s, nominal and smallest. tolerance : relative, of the Newton
    iteration; absolute_tolerance : N, a residual that is good enough whatever it was at first.
    """

    what: ClassVar[str] = "the solver"

    step: Annotated[float, SOLVER_STEP] = Field(default=0.05, description="nominal step")
    tolerance: Annotated[float, TOLERANCE] = Field(
        default=1e-6, description="relative tolerance of the Newton iteration"
    )
    absolute_tolerance: Annotated[float, RESIDUAL] = Field(
        default=1e-7, description="residual of the Newton iteration that is good enough whatever it was at first"
    )
    minimum_step: Annotated[float, SMALLEST_STEP] = Field(
        default=1e-6, description="smallest step to which it is cut back"
    )

    @field_validator("minimum_step", mode="after")
    @classmethod
    def _below_step(cls, smallest: float, info: ValidationInfo) -> float:
        step = info.data.get("step")
        if step is not None and smallest > step:
            raise wrong(f"{smallest:.6g} s is larger than the step, {step:.6g} s")
        return smallest


class OutputSpec(Section):
    """What is kept. interval : s, between two outputs."""

    what: ClassVar[str] = "the output"

    interval: Annotated[float, OUTPUT_INTERVAL] = Field(default=0.1, description="time between two outputs")


class Scenario(Section):
    """A guidewire, a vessel, and how the one is pushed into the other. Frozen; SI throughout, angles in rad."""

    what: ClassVar[str] = "a scenario"

    name: Annotated[str, Text("name")] = Field(
        default="scenario", description="name, also of the folder of results; the file's if not given"
    )
    wire: WireSpec = Field(description="the wire", examples=["{model: universal-ii}"])
    vessel: Vessel = Field(description="the vessel", examples=["{kind: straight, length: 100 mm, diameter: 4 mm}"])
    catheter: CatheterSpec = Field(
        description="the catheter that holds the wire",
        examples=["{exit: [0 mm, 0 mm], direction: 0 deg, bore: 1.2 mm}"],
    )
    contact: ContactSpec = Field(default=ContactSpec(), description="contact and friction")
    drive: Drive = Field(description="what moves the wire", examples=["{kind: speed, speed: 2 mm/s, distance: 60 mm}"])
    tip: TipSpec = Field(default=TipSpec(), description="what holds the tip, and the loads on it")
    supports: tuple[DiscSpec, ...] = Field(
        default=(), description="fixed discs on which the wire lies", examples=["[{at: [20 mm, -2 mm], radius: 1 mm}]"]
    )
    nose: NoseSpec | None = Field(default=None, description="a moving disc that presses on the wire")
    stop: StopSpec = Field(default=StopSpec(), description="what ends the run before the drive does")
    solver: SolverSpec = Field(default=SolverSpec(), description="steps of the solver")
    output: OutputSpec = Field(default=OutputSpec(), validate_default=True, description="what is kept")

    _places: dict[str, Place] = PrivateAttr(default_factory=dict)

    @field_validator("name", mode="after")
    @classmethod
    def _names_a_folder(cls, name: str) -> str:
        if _NAME.fullmatch(name) is None:
            allowed = "letters, digits and _ . + - are allowed, a letter or digit first, 100 in all"
            raise wrong(f"{shown(name)} cannot name a folder; {allowed}")
        return name

    @field_validator("catheter", mode="after")
    @classmethod
    def _has_a_bore(cls, catheter: CatheterSpec, info: ValidationInfo) -> CatheterSpec:
        vessel = info.data.get("vessel")
        if catheter.bore is None and vessel is not None and vessel.kind != "none":
            refuse(("bore",), wrong("is missing: inner diameter; for example bore: 1.2 mm", missing=True))
        return catheter

    @field_validator("drive", mode="after")
    @classmethod
    def _held_by_one(cls, drive: Drive, info: ValidationInfo) -> Drive:
        catheter = info.data.get("catheter")
        if catheter is not None and catheter.is_sleeve and drive.hold != "clamped":
            text = f"an end that is {drive.hold} cannot be in a sleeve, which holds its direction; "
            refuse(("hold",), f"{text}leave it out, or give catheter.bore as a length")
        return drive

    @field_validator("tip", mode="after")
    @classmethod
    def _free_to_be_driven(cls, tip: TipSpec, info: ValidationInfo) -> TipSpec:
        drive = info.data.get("drive")
        if drive is not None and drive.kind == "tip_speed" and tip.hold != "free" and tip.slides != "along":
            text = f"a tip that is {tip.hold} here cannot have the speed that a drive of kind tip_speed wants; "
            refuse(("hold",), f"{text}let it be free or slide along, or take a drive of kind speed or force")
        return tip

    @field_validator("supports", mode="before")
    @classmethod
    def _not_too_many_supports(cls, supports: Any) -> Any:
        if isinstance(supports, list | tuple) and len(supports) > MOST_SUPPORTS:
            raise wrong(f"has {len(supports)} items; at most {MOST_SUPPORTS} are allowed")
        return () if supports is None else supports

    @field_validator("contact", "tip", "stop", "solver", "output", mode="before")
    @classmethod
    def _empty_is_default(cls, value: Any) -> Any:
        return {} if value is None else value  # a section whose lines are all commented out

    @field_validator("stop", mode="after")
    @classmethod
    def _target_is_there(cls, stop: StopSpec, info: ValidationInfo) -> StopSpec:
        if "vessel" in info.data:
            check_target(stop.target, info.data["vessel"])
        return stop

    @field_validator("output", mode="after")
    @classmethod
    def _not_too_many(cls, output: OutputSpec, info: ValidationInfo) -> OutputSpec:
        drive = info.data.get("drive")
        if drive is not None and drive.duration / output.interval > MOST_OUTPUTS:
            count, fewest = drive.duration / output.interval, drive.duration / MOST_OUTPUTS
            remedy = f"take an interval of {fewest:.3g} s or more"
            raise wrong(f"makes {count:.3g} outputs, at most {MOST_OUTPUTS} are kept; {remedy}")
        return output

    def locate(self, path: str) -> Place | None:
        """File and line of the value of a dotted path, or of the nearest thing above it that the file has; None
        without a file.
        """
        return place_of(path, self._places)

    def problem(self, path: str, message: str) -> Problem:
        """A problem with the value of a dotted path, at its place in the file."""
        file, line = self.locate(path) or (None, None)
        return Problem(path, message, file, line)

    def to_dict(self) -> dict[str, Any]:
        """The resolved scenario as plain SI data, fit for JSON and for `scenario_from_dict`, which gives an equal
        scenario.
        """
        return self.to_plain()

    def __eq__(self, other: object) -> bool:
        """Equal values; where they were read does not count."""
        if not isinstance(other, Scenario):
            return NotImplemented
        return all(getattr(self, name) == getattr(other, name) for name in type(self).model_fields)

    def __hash__(self) -> int:
        """Hash of the values."""
        return hash(tuple(getattr(self, name) for name in type(self).model_fields))


def with_places(scenario: Scenario, places: Mapping[str, Place]) -> Scenario:
    """The scenario, knowing where its values were read. For the loader, which has just made it and shares it with
    nobody.
    """
    scenario._places.update(places)
    return scenario


def json_schema() -> dict[str, Any]:
    """JSON schema of a scenario file: quantities may be numbers in SI or text with a unit."""
    return schema_of(Scenario, "gw-exudyn scenario")


def schema_of(section: type[Section], title: str) -> dict[str, Any]:
    """JSON schema of a file that a section describes."""
    schema = section.model_json_schema(mode="validation")
    described = {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": title}
    _strip_docstring_sections(described)
    return described


def _strip_docstring_sections(node: Any) -> None:
    """Keep the first paragraph of the classes' docstrings; the rest tells of the program's attributes, not of the
    file.
    """
    if isinstance(node, dict):
        if isinstance(node.get("description"), str):
            node["description"] = " ".join(node["description"].split("\n\n")[0].split())
        for value in node.values():
            _strip_docstring_sections(value)
    elif isinstance(node, list):
        for value in node:
            _strip_docstring_sections(value)
