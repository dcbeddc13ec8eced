"""The wire of a scenario: from the catalogue, given inline, or the one with some values of the other."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from pydantic import Field, ValidationInfo, WithJsonSchema, field_validator

from gw_exudyn.scenario.catalogue import CatalogueWire, catalogue_names, load_catalogue
from gw_exudyn.scenario.faults import wrong
from gw_exudyn.scenario.fields import Choice, Number, Text, Whole
from gw_exudyn.scenario.friction import FrictionStretch, check_stretches
from gw_exudyn.scenario.kinds import (
    BENDING_STIFFNESS,
    DAMPING_TIME,
    DENSITY,
    FLOPPY_LENGTH,
    REST_CURVATURE,
    STIFFNESS_FACTOR,
    TIP_ANGLE,
    TIP_LENGTH,
    WIRE_DIAMETER,
    WIRE_LENGTH,
)
from gw_exudyn.scenario.section import Section
from gw_exudyn.scenario.stiffness import (
    StiffnessPiece,
    clipped,
    pieces_before_step,
    read_stiffness,
    stiffness_json,
    with_floppy_tip,
)
from gw_exudyn.scenario.units import format_quantity
from gw_exudyn.scenario.words import did_you_mean, shown

MOST_SEGMENTS = 5000
_ALL_WIRES = "all of them: gw-exudyn list wires"
ESTIMATES = ("best", "low", "high")


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


class StiffnessFactor(Section):
    """What the bending stiffness is multiplied by, for studies and fits: `tip` from the tip to the first step of
    the bending stiffness, `shaft` behind it.
    """

    what: ClassVar[str] = "the factors of the bending stiffness"

    tip: Annotated[float, STIFFNESS_FACTOR] = Field(
        default=1.0, description="factor from the tip to the first step of the bending stiffness"
    )
    shaft: Annotated[float, STIFFNESS_FACTOR] = Field(default=1.0, description="factor behind that step")


class FloppyTip(Section):
    """A soft distal part laid over a wire of which only the shaft is known.

    length, taper : m. bending_stiffness : N m^2, of the distal `length`; over the `taper` behind it the bending
        stiffness rises linearly to the wire's own.
    """

    what: ClassVar[str] = "the floppy tip"

    length: Annotated[float, FLOPPY_LENGTH] = Field(description="length of the soft part", examples=["70 mm"])
    bending_stiffness: Annotated[float, BENDING_STIFFNESS] = Field(
        description="its bending stiffness EI", examples=["5 N*mm^2"]
    )
    taper: Annotated[float, FLOPPY_LENGTH] = Field(
        default=0.0, description="length behind it over which the stiffness rises to the wire's own"
    )


class WireSpec(Section):
    """The wire, complete and in SI.

    model : name in the catalogue from which values were taken that the file does not give; None if all are given.
    diameter, length : m. bending_stiffness : pieces that cover 0 to length, from the tip, the floppy tip laid over,
        the factors not applied (see `effective_stiffness`). density : kg/m^3.
    estimate : which of the catalogue's values was taken.
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
    estimate: Annotated[str, Choice(ESTIMATES)] = Field(
        default="best",
        description="which value of the catalogue's bending stiffness: the best, or a bound of its range",
    )
    floppy_tip: FloppyTip | None = Field(
        default=None, description="a soft distal part, laid over a wire of which only the shaft is known"
    )
    bending_stiffness: Annotated[tuple[StiffnessPiece, ...], WithJsonSchema(stiffness_json())] = Field(
        default=None,
        validate_default=True,
        description="bending stiffness EI: one value; pieces {from, to, value}, or {from, to, core, modulus} of a "
        "round core, from the tip; or a table of [s, EI]",
        examples=["[{from: 0 mm, to: 150 mm, value: 7 N*mm^2}]"],
    )
    stiffness_factor: StiffnessFactor = Field(
        default=StiffnessFactor(), description="what the bending stiffness is multiplied by"
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
            raise wrong(f"{shown(name)} is not in the catalogue; {did_you_mean(name, known)}{_ALL_WIRES}")
        return name

    @field_validator("diameter", "length", "density", mode="after")
    @classmethod
    def _from_catalogue(cls, value: float | None, info: ValidationInfo) -> float | None:
        if value is None and (known := _known_wire(cls, info)) is not None:
            return float(getattr(known, str(info.field_name)).value)
        return value

    @field_validator("estimate", mode="after")
    @classmethod
    def _of_the_catalogue(cls, estimate: str, info: ValidationInfo) -> str:
        if estimate != "best" and info.data.get("model", "") is None:
            raise wrong(f"{shown(estimate)} is a bound of a wire of the catalogue; name one by model, or remove it")
        return estimate

    @field_validator("floppy_tip", mode="after")
    @classmethod
    def _shorter_than_wire(cls, tip: FloppyTip | None, info: ValidationInfo) -> FloppyTip | None:
        length = info.data.get("length")
        if tip is not None and length is not None and tip.length + tip.taper > length * (1 + 1e-9):
            wanted, allowed = format_quantity(tip.length + tip.taper, "mm"), format_quantity(length, "mm")
            raise wrong(f"is {wanted} long with its taper, the wire only {allowed}")
        return tip

    @field_validator("bending_stiffness", mode="before")
    @classmethod
    def _in_pieces(cls, raw: Any, info: ValidationInfo) -> tuple[StiffnessPiece, ...]:
        length: float | None = info.data.get("length")
        pieces = read_stiffness(raw, length) if raw is not None else cls._pieces_of_catalogue(length, info)
        tip: FloppyTip | None = info.data.get("floppy_tip")
        if tip is None or not pieces:
            return pieces
        return with_floppy_tip(pieces, tip.length, tip.bending_stiffness, tip.taper)

    @classmethod
    def _pieces_of_catalogue(cls, length: float | None, info: ValidationInfo) -> tuple[StiffnessPiece, ...]:
        known = _known_wire(cls, info)
        pieces = known.stiffness_pieces(info.data.get("estimate", "best")) if known is not None else ()
        if known is None or length is None:
            return pieces
        if length > pieces[-1].end * (1 + 1e-9):
            end = format_quantity(pieces[-1].end, "mm")
            wanted = format_quantity(length, "mm")
            remedy = "give bending_stiffness, or a shorter length"
            raise wrong(f"is known to {end} from the tip, and the wire is {wanted} long; {remedy}")
        return clipped(pieces, length)

    @field_validator("stiffness_factor", mode="after")
    @classmethod
    def _has_a_shaft(cls, factor: StiffnessFactor, info: ValidationInfo) -> StiffnessFactor:
        pieces = info.data.get("bending_stiffness")
        if factor.shaft != 1 and pieces and pieces_before_step(pieces) == len(pieces):
            raise wrong("shaft has nothing to act on: the bending stiffness has no step; give tip alone")
        return factor

    @property
    def effective_stiffness(self) -> tuple[StiffnessPiece, ...]:
        """The bending stiffness with its factors, in pieces from the tip: what the model bends."""
        tip = pieces_before_step(self.bending_stiffness)
        factors = [self.stiffness_factor.tip] * tip + [self.stiffness_factor.shaft] * (
            len(self.bending_stiffness) - tip
        )
        return tuple(piece.times(factor) for piece, factor in zip(self.bending_stiffness, factors, strict=True))

    @property
    def shaft_alone(self) -> bool:
        """A wire of the catalogue of which only the shaft is known, with no tip given to it."""
        known = load_catalogue().get(self.model or "")
        return (
            known is not None
            and known.part == "shaft"
            and self.floppy_tip is None
            and self.bending_stiffness == clipped(known.stiffness_pieces(self.estimate), self.length)
        )

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
        example = f"{info.field_name}: {(field.examples or [''])[0]}"
        text = (
            f"is missing: {field.description}; write {example}, or name a wire of the catalogue by model; {_ALL_WIRES}"
        )
        raise wrong(text, missing=True, instead=("model",))
    return load_catalogue()[info.data["model"]]
