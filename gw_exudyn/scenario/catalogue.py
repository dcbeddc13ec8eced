"""The catalogue of wires: what is known of each by name, with source and confidence. The table is `catalogue.yaml`."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from types import MappingProxyType
from typing import Annotated

from pydantic import Field, ValidationError

from gw_exudyn.errors import ScenarioError
from gw_exudyn.scenario.fields import Choice, Text
from gw_exudyn.scenario.kinds import ARC_LENGTH, BENDING_STIFFNESS_OR_NONE, DENSITY, WIRE_DIAMETER, WIRE_LENGTH
from gw_exudyn.scenario.problems import problems_of
from gw_exudyn.scenario.section import Section
from gw_exudyn.scenario.stiffness import StiffnessPiece
from gw_exudyn.scenario.yaml_source import parse_yaml

_GRADE = Choice(("A", "B", "C", "D"))


class _Sourced(Section):
    """What every number of the catalogue stands with."""

    source: Annotated[str, Text("source")]
    confidence: Annotated[str, _GRADE]
    """A in the paper's text, B primary source or maker, C secondary or handbook, D our inference."""
    note: Annotated[str, Text("note")] = ""


class SourcedDiameter(_Sourced):
    """Outer diameter. value : m."""

    value: Annotated[float, WIRE_DIAMETER]


class SourcedLength(_Sourced):
    """Length of the part that is simulated, from the tip. value : m."""

    value: Annotated[float, WIRE_LENGTH]


class SourcedDensity(_Sourced):
    """Mean density. value : kg/m^3."""

    value: Annotated[float, DENSITY]


class SourcedPiece(Section):
    """Bending stiffness of one stretch: start, end in m from the tip; value, and low and high of what to sweep, in N
    m^2. Where only a range is known, value is None; where no spread is known, low and high are.
    """

    start: Annotated[float, ARC_LENGTH] = Field(alias="from")
    end: Annotated[float, ARC_LENGTH] = Field(alias="to")
    value: Annotated[float | None, BENDING_STIFFNESS_OR_NONE] = None
    low: Annotated[float | None, BENDING_STIFFNESS_OR_NONE] = None
    high: Annotated[float | None, BENDING_STIFFNESS_OR_NONE] = None

    def at(self, estimate: str) -> float:
        """The `best`, `low` or `high` bending stiffness, N m^2: the middle of a range that has no best; the best where
        no spread is known."""
        best = self.value if self.value is not None else (self.low + self.high) / 2  # type: ignore[operator]
        given = {"best": self.value, "low": self.low, "high": self.high}[estimate]
        return best if given is None else given


class SourcedStiffness(_Sourced):
    """Bending stiffness along the wire, in pieces from the tip."""

    pieces: tuple[SourcedPiece, ...]


class CatalogueWire(Section):
    """One wire of the catalogue."""

    title: Annotated[str, Text("title")]
    part: Annotated[str, Choice(("whole", "shaft"))] = "whole"
    """`shaft`: the stiff part alone, whose tip is not known."""
    diameter: SourcedDiameter
    length: SourcedLength
    density: SourcedDensity
    bending_stiffness: SourcedStiffness

    def stiffness_pieces(self, estimate: str = "best") -> tuple[StiffnessPiece, ...]:
        """The bending stiffness in pieces from the tip: the `best` estimate, or the `low` or `high` bound of what to
        sweep.
        """
        return tuple(
            StiffnessPiece(start=piece.start, end=piece.end, value=piece.at(estimate), value_end=piece.at(estimate))
            for piece in self.bending_stiffness.pieces
        )


class _Catalogue(Section):
    wires: dict[str, CatalogueWire]


@cache  # the table of a package does not change, and a sweep asks for it at every point
def load_catalogue() -> Mapping[str, CatalogueWire]:
    """All wires of the catalogue by name, read-only."""
    text = files("gw_exudyn.scenario").joinpath("catalogue.yaml").read_text(encoding="utf-8")
    source = parse_yaml(text, "catalogue.yaml")
    try:
        wires = _Catalogue.model_validate({"wires": source.data}).wires
    except ValidationError as error:
        raise ScenarioError(problems_of(error, source.places, prefix=1)) from None
    return MappingProxyType(wires)


def catalogue_names() -> tuple[str, ...]:
    """Names of the wires, sorted."""
    return tuple(sorted(load_catalogue()))
