"""What a study file holds: the keys, and which of them a mode needs and takes."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar

from pydantic import Field, field_validator

from gw_exudyn.scenario.faults import Faults, wrong
from gw_exudyn.scenario.fields import Choice, Kind, Table, Text, Whole
from gw_exudyn.scenario.schema import schema_of
from gw_exudyn.scenario.section import Section
from gw_exudyn.scenario.words import shown
from gw_exudyn.sweep.studies.axes import Axis, axis_schema
from gw_exudyn.sweep.studies.design import FOR_INDICES, METHODS, MOST_POINTS, count_of

MODES = ("grid", "zip", "list", "sample")

_NAME = re.compile(r"\w[\w.+-]{0,99}")


def folder_name(name: str | None) -> str | None:
    """The name, if it can be that of a folder. Raises what `wrong` makes."""
    if name is not None and _NAME.fullmatch(name) is None:
        allowed = "letters, digits and _ . + - are allowed, a letter or digit first, 100 in all"
        raise wrong(f"{shown(name)} cannot name a folder; {allowed}")
    return name


@dataclass(frozen=True)
class Paths(Kind):
    """A mapping of dotted paths. values : JSON schema of what may stand behind a path."""

    values: Mapping[str, Any] = field(default_factory=dict)

    def read(self, value: Any) -> dict[str, Any]:
        """The mapping, as it is."""
        if not isinstance(value, dict):
            raise wrong(f"{shown(value)} stands where dotted paths are needed: lines as 'wire.segments: ...'")
        return dict(value)

    def json(self) -> dict[str, Any]:
        """An object of such values."""
        return {"type": "object", "additionalProperties": dict(self.values)} if self.values else {"type": "object"}


class StudyForm(Section):
    """What a study file holds."""

    what: ClassVar[str] = "a study"

    name: Annotated[str | None, Text("name", optional=True)] = Field(
        default=None, description="name of the study and of its folder; the file's name if not given"
    )
    base: Annotated[str, Text("scenario")] = Field(
        description="the scenario that is varied: a file, a shipped one's name, or an FMU",
        examples=["corner90-universal"],
    )
    fixed: Annotated[dict[str, Any], Paths()] = Field(
        default_factory=dict, alias="set", description="dotted paths of the scenario: their values in all points"
    )
    vary: Annotated[dict[str, Any], Paths(axis_schema())] = Field(
        default_factory=dict, description="dotted paths of the scenario: the values they take, or their distributions"
    )
    points: Annotated[str | None, Text("name of a CSV file", optional=True)] = Field(
        default=None, description="mode list: a CSV file with a row a point, headed by dotted paths"
    )
    mode: Annotated[str, Choice(MODES)] = Field(
        default="grid",
        description="grid: all combinations; zip: first values, second values, ...; list: the rows of "
        "a CSV file; sample: drawn at random",
    )
    samples: Annotated[int | None, Whole(1, MOST_POINTS)] = Field(
        default=None, description="mode sample: how many points are drawn"
    )
    method: Annotated[str, Choice(METHODS)] = Field(
        default="latin-hypercube", description="mode sample: how points are drawn"
    )
    seed: Annotated[int, Whole(0, 2**31 - 1)] = Field(
        default=0, description="mode sample: the same seed draws the same points"
    )
    metrics: Annotated[tuple[str, ...], Table(Text("metric"), 1, 200, "metric")] = Field(
        default=("push_force_max",),
        description="what figures and indices are about; by the first, the smallest is the best",
    )

    @field_validator("name", mode="after")
    @classmethod
    def _names_a_folder(cls, name: str | None) -> str | None:
        return folder_name(name)


def study_schema() -> dict[str, Any]:
    """JSON schema of a study file."""
    return schema_of(StudyForm, "gw-exudyn study")


def check_form(form: StudyForm, axes: Sequence[Axis], faults: Faults) -> None:
    """What the mode needs and does not take."""
    if form.mode == "list":
        if form.points is None:
            faults.add(("points",), "is missing: mode list takes its points from a CSV file; points: file.csv")
        if form.vary:
            faults.add(("vary",), "stands beside mode: list, whose points come from the CSV file; remove it")
        return
    if form.points is not None:
        faults.add(("points",), f"is for mode: list; the mode is {form.mode}")
    if not form.vary:
        faults.add(("vary",), "is missing: what is varied; as contact.friction_coefficient: [0.2, 0.4]")
    if form.mode == "sample":
        _check_sample(form, faults)
        return
    if form.samples is not None:
        faults.add(("samples",), f"is for mode: sample; the mode is {form.mode}")
    for axis in axes:
        if axis.distribution is not None:
            faults.add(("vary", axis.path), f"a distribution is for mode: sample; the mode is {form.mode}")
    lengths = {axis.path: len(axis.values) for axis in axes if axis.distribution is None}
    if form.mode == "zip" and len(set(lengths.values())) > 1:
        told = ", ".join(f"{path} has {count}" for path, count in lengths.items())
        faults.add(("mode",), f"zip needs equally many values everywhere: {told}")


def _check_sample(form: StudyForm, faults: Faults) -> None:
    if form.samples is None:
        faults.add(("samples",), "is missing: how many points to draw, as samples: 64")
        return
    if form.method in ("sobol", "sobol-indices") and form.samples & (form.samples - 1):
        below = 1 << (form.samples.bit_length() - 1)
        faults.add(("samples",), f"{form.samples} is no power of 2, which Sobol's points need: {below} or {2 * below}")
    total = count_of(form.method, form.samples, len(form.vary))
    if total > MOST_POINTS:
        faults.add(("samples",), f"makes {total} points; at most {MOST_POINTS} are allowed")
    if form.method in FOR_INDICES:
        from gw_exudyn.sweep.studies.salib import missing_library

        missing = missing_library()
        if missing:
            faults.add(("method",), missing)
