"""The catalogue of wires: what is known of each by name, with source and confidence. The table is `catalogue.yaml`."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from types import MappingProxyType
from typing import Annotated

from pydantic import Field, ValidationError

from gw_exudyn.errors import ScenarioError
from gw_exudyn.scenario.fields import Choice, Section, Text
from gw_exudyn.scenario.kinds import ARC_LENGTH, BENDING_STIFFNESS, DENSITY, WIRE_DIAMETER, WIRE_LENGTH
from gw_exudyn.scenario.problems import problems_of
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
    m^2.
    """

    start: Annotated[float, ARC_LENGTH] = Field(alias="from")
    end: Annotated[float, ARC_LENGTH] = Field(alias="to")
    value: Annotated[float, BENDING_STIFFNESS]
    low: Annotated[float, BENDING_STIFFNESS]
    high: Annotated[float, BENDING_STIFFNESS]


class SourcedStiffness(_Sourced):
    """Bending stiffness along the wire, in pieces from the tip."""

    pieces: tuple[SourcedPiece, ...]


class CatalogueWire(Section):
    """One wire of the catalogue."""

    title: Annotated[str, Text("title")]
    diameter: SourcedDiameter
    length: SourcedLength
    density: SourcedDensity
    bending_stiffness: SourcedStiffness

    def stiffness_pieces(self, bound: str = "value") -> tuple[StiffnessPiece, ...]:
        """The bending stiffness in pieces from the tip: the `value`, or the `low` or `high` bound of what to sweep."""
        pieces = []
        for piece in self.bending_stiffness.pieces:
            value: float = {"value": piece.value, "low": piece.low, "high": piece.high}[bound]
            pieces.append(StiffnessPiece(start=piece.start, end=piece.end, value=value, value_end=value))
        return tuple(pieces)


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
