"""The wire of a scenario: from the catalogue, given inline, or the one with some values of the other."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from pydantic import Field, ValidationInfo, WithJsonSchema, field_validator

from gw_exudyn.scenario.catalogue import CatalogueWire, catalogue_names, load_catalogue
from gw_exudyn.scenario.fields import Choice, Number, Section, Text, Whole, wrong
from gw_exudyn.scenario.friction import FrictionStretch, check_stretches
from gw_exudyn.scenario.kinds import (
    DAMPING_TIME,
    DENSITY,
    REST_CURVATURE,
    TIP_ANGLE,
    TIP_LENGTH,
    WIRE_DIAMETER,
    WIRE_LENGTH,
)
from gw_exudyn.scenario.stiffness import StiffnessPiece, clipped, read_stiffness, stiffness_json
from gw_exudyn.scenario.units import format_quantity
from gw_exudyn.scenario.words import did_you_mean, shown

MOST_SEGMENTS = 5000


class TipShape(Section):
    """The shape of the tip at rest.

    kind : `straight`; `arc`, the distal `length` has the constant curvature angle/length; `bend`, a kink of `angle`
        at `length` from the tip.
    length : m, from the tip; None for a straight tip. angle : rad, positive to the left (counter-clockwise) on the
        way to the tip; None for a straight tip.
    """

    what: ClassVar[str] = "the shape of the tip"

    kind: Annotated[str, Choice(("straight", "arc", "bend"))] = Field(
        description="shape of the tip at rest", examples=["straight"]
    )
    length: Annotated[float | None, TIP_LENGTH] = Field(
        default=None,
        validate_default=True,
        description="arc: the distal part that is curved; bend: distance of the kink from the tip",
    )
    angle: Annotated[float | None, TIP_ANGLE] = Field(
        default=None, validate_default=True, description="angle by which the tip is turned, positive to the left"
    )

    @field_validator("length", "angle", mode="after")
    @classmethod
    def _as_the_kind_needs(cls, value: float | None, info: ValidationInfo) -> float | None:
        kind = info.data.get("kind")
        if kind in ("arc", "bend") and value is None:
            example = "10 mm" if info.field_name == "length" else "45 deg"
            raise wrong(f"is missing: the kind {kind} needs it; for example {info.field_name}: {example}", missing=True)
        if kind == "straight" and value is not None:
            raise wrong("a straight tip has none; remove it, or take kind: arc or bend")
        return value


class WireSpec(Section):
    """The wire, complete and in SI.

    model : name in the catalogue from which values were taken that the file does not give; None if all are given.
    diameter, length : m. bending_stiffness : pieces that cover 0 to length, from the tip. density : kg/m^3.
    damping_time : s, joint damping over joint stiffness. segments : number of rigid bodies.
    grading : length of the proximal over that of the distal segment. imperfection : 1/m, rest curvature; None takes
        the model's default. friction : stretches on which the walls' friction coefficient is multiplied by a factor; 1
        elsewhere.
    """

    what: ClassVar[str] = "the wire"

    model: Annotated[str | None, Text("name of a wire", optional=True)] = Field(
        default=None,
        description="name of a wire of the catalogue; values given beside it win",
        examples=["universal-ii"],
    )
    diameter: Annotated[float, WIRE_DIAMETER] = Field(
        default=None, validate_default=True, description="outer diameter", examples=["0.36 mm"]
    )
    length: Annotated[float, WIRE_LENGTH] = Field(
        default=None, validate_default=True, description="length that is simulated, from the tip", examples=["150 mm"]
    )
    bending_stiffness: Annotated[tuple[StiffnessPiece, ...], WithJsonSchema(stiffness_json())] = Field(
        default=None,
        validate_default=True,
        description="bending stiffness EI: one value, pieces {from, to, value} from the tip, or a table of [s, EI]",
        examples=["[{from: 0 mm, to: 150 mm, value: 7 N*mm^2}]"],
    )
    density: Annotated[float, DENSITY] = Field(
        default=None, validate_default=True, description="mean density", examples=["6450 kg/m^3"]
    )
    damping_time: Annotated[float, DAMPING_TIME] = Field(
        default=0.02, description="damping over stiffness in every joint"
    )
    segments: Annotated[int, Whole(1, MOST_SEGMENTS)] = Field(default=200, description="number of rigid segments")
    grading: Annotated[float, Number(0.05, 50.0)] = Field(
        default=1.0, description="length of the proximal over that of the distal segment"
    )
    tip_shape: TipShape = Field(default=TipShape(kind="straight"), description="shape of the tip at rest")
    imperfection: Annotated[float | None, REST_CURVATURE] = Field(
        default=None, description="rest curvature of the whole wire"
    )
    friction: tuple[FrictionStretch, ...] = Field(
        default=(), max_length=10_000, description="stretches whose friction differs, as under a coating"
    )

    @field_validator("model", mode="after")
    @classmethod
    def _in_catalogue(cls, name: str | None) -> str | None:
        if name is not None and name not in (known := catalogue_names()):
            raise wrong(f"{shown(name)} is not in the catalogue; {did_you_mean(name, known)}known: {', '.join(known)}")
        return name

    @field_validator("diameter", "length", "density", mode="after")
    @classmethod
    def _from_catalogue(cls, value: float | None, info: ValidationInfo) -> float | None:
        if value is None and (known := _known_wire(cls, info)) is not None:
            return float(getattr(known, str(info.field_name)).value)
        return value

    @field_validator("bending_stiffness", mode="before")
    @classmethod
    def _in_pieces(cls, raw: Any, info: ValidationInfo) -> tuple[StiffnessPiece, ...]:
        length: float | None = info.data.get("length")
        if raw is not None:
            return read_stiffness(raw, length)
        known = _known_wire(cls, info)
        pieces = known.stiffness_pieces() if known is not None else ()
        if known is None or length is None:
            return pieces
        if length > pieces[-1].end * (1 + 1e-9):
            end = format_quantity(pieces[-1].end, "mm")
            wanted = format_quantity(length, "mm")
            remedy = "give bending_stiffness, or a shorter length"
            raise wrong(f"is known to {end} from the tip, and the wire is {wanted} long; {remedy}")
        return clipped(pieces, length)

    @field_validator("tip_shape", mode="after")
    @classmethod
    def _within_wire(cls, shape: TipShape, info: ValidationInfo) -> TipShape:
        length = info.data.get("length")
        if shape.length is not None and length is not None and shape.length > length:
            wanted, allowed = format_quantity(shape.length, "mm"), format_quantity(length, "mm")
            raise wrong(f"is {wanted} long, the wire only {allowed}")
        return shape

    @field_validator("friction", mode="after")
    @classmethod
    def _on_the_wire(cls, stretches: tuple[FrictionStretch, ...], info: ValidationInfo) -> tuple[FrictionStretch, ...]:
        check_stretches(stretches, info.data.get("length"))
        return stretches


def _known_wire(cls: type[WireSpec], info: ValidationInfo) -> CatalogueWire | None:
    """The wire that fills a value which the file does not give; None if `model` is wrong itself, which is told
    already.
    """
    if "model" not in info.data:
        return None
    if info.data["model"] is None:
        field = cls.model_fields[str(info.field_name)]
        names = ", ".join(catalogue_names())
        example = f"{info.field_name}: {(field.examples or [''])[0]}"
        text = f"is missing: {field.description}; write {example}, or take a wire of the catalogue by model: {names}"
        raise wrong(text, missing=True, instead=("model",))
    return load_catalogue()[info.data["model"]]
