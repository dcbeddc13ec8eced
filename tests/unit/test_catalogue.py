"""The catalogue of wires: complete, with sources, and what it does to a scenario."""

from __future__ import annotations

import math
from typing import Any

import pytest

from gw_exudyn.errors import ScenarioError
from gw_exudyn.model import build
from gw_exudyn.scenario.catalogue import catalogue_names, load_catalogue
from gw_exudyn.scenario.loading import scenario_from_dict
from gw_exudyn.scenario.stiffness import StiffnessPiece, clipped

PAPERS = ("amplatz-super-stiff", "universal-ii")

REST: dict[str, Any] = {
    "vessel": {"kind": "straight", "length": 0.1, "diameter": 0.004},
    "catheter": {"bore": 0.0012},
    "drive": {"kind": "speed", "speed": 0.002, "duration": 1},
}


def test_the_papers_two_wires_are_in_it() -> None:
    assert set(PAPERS) <= set(catalogue_names())
    assert all(name in PAPERS or name.endswith("-shaft") for name in catalogue_names())


@pytest.mark.parametrize(
    ("name", "diameter", "density", "tip", "stiffness"),
    [
        ("universal-ii", 0.36e-3, 6450.0, 0.045, (1e-6, 7e-6)),
        ("amplatz-super-stiff", 0.89e-3, 7900.0, 0.070, (5e-6, 75e-6)),
    ],
)
def test_their_numbers(name: str, diameter: float, density: float, tip: float, stiffness: tuple[float, float]) -> None:
    """Diameter, length and flexible tip are Sharei et al. 2019, Table 1; the stiffness is our estimate."""
    wire = load_catalogue()[name]
    assert (wire.diameter.value, wire.length.value, wire.density.value) == (diameter, 0.15, density)
    pieces = [(piece.start, piece.end, piece.value) for piece in wire.stiffness_pieces()]
    assert pieces == [(0.0, tip, stiffness[0]), (tip, 0.15, stiffness[1])]


@pytest.mark.parametrize("name", PAPERS)
def test_the_papers_wires_have_source_and_grade(name: str) -> None:
    wire = load_catalogue()[name]
    assert (wire.diameter.confidence, wire.length.confidence, wire.density.confidence) == ("A", "A", "C")
    assert wire.bending_stiffness.confidence == "D"
    assert "never the paper's own value" in wire.bending_stiffness.note
    assert all(part.source for part in (wire.diameter, wire.length, wire.density, wire.bending_stiffness))
    for piece in wire.bending_stiffness.pieces:
        assert piece.low is not None
        assert piece.value is not None
        assert piece.high is not None
        assert piece.low < piece.value < piece.high


@pytest.mark.parametrize(
    ("name", "modulus"),
    [
        ("amplatz-super-stiff-shaft", (60.3, 59.4, 61.2)),
        ("amplatz-bard-shaft", (9.5, 8.9, 10.1)),
        ("amplatz-stiff-cook-shaft", (17.0, None, None)),
        ("amplatz-extra-stiff-cook-shaft", (29.2, None, None)),
        ("amplatz-ultra-stiff-cook-shaft", (65.4, None, None)),
        ("heavy-duty-shaft", (None, 11.4, 14.5)),
        ("backup-meier-shaft", (139.6, None, None)),
        ("lunderquist-extra-stiff-shaft", (158.4, None, None)),
    ],
)
def test_shafts_are_the_moduli_of_harrison_2011(name: str, modulus: tuple[float | None, ...]) -> None:
    """Flexural modulus, GPa, times pi d^4 / 64 with the nominal diameter of 0.035 in."""
    wire = load_catalogue()[name]
    assert (wire.part, wire.diameter.value, wire.bending_stiffness.confidence) == ("shaft", 0.035 * 25.4e-3, "B")
    assert "600 mm from the tip" in wire.bending_stiffness.note
    (piece,) = wire.bending_stiffness.pieces
    for found, known in zip((piece.value, piece.low, piece.high), modulus, strict=True):
        assert (found is None) == (known is None)
        if known is not None:
            assert found == pytest.approx(known * 1e9 * math.pi / 64 * wire.diameter.value**4, rel=2e-3)


def test_a_range_without_a_best_runs_with_its_middle() -> None:
    wire = scenario_from_dict({"wire": {"model": "heavy-duty-shaft"}, **REST}).wire
    assert wire.bending_stiffness[0].value == pytest.approx((350e-6 + 445e-6) / 2)


def test_a_shaft_alone_is_warned_about_and_a_floppy_tip_settles_it() -> None:
    alone = scenario_from_dict({"wire": {"model": "backup-meier-shaft"}, **REST})
    assert any("shaft alone" in warning for warning in build(alone).warnings)
    tip = {"length": "40 mm", "bending_stiffness": "5 N*mm^2", "taper": "30 mm"}
    tipped = scenario_from_dict({"wire": {"model": "backup-meier-shaft", "floppy_tip": tip}, **REST})
    assert not any("shaft alone" in warning for warning in build(tipped).warnings)
    assert [(p.start, p.end, p.value, p.value_end) for p in tipped.wire.bending_stiffness] == [
        (0.0, 0.04, 5e-6, 5e-6),
        (0.04, 0.07, 5e-6, 4280e-6),
        (0.07, 0.15, 4280e-6, 4280e-6),
    ]
    assert scenario_from_dict(tipped.to_dict()) == tipped


def test_the_low_and_high_estimate_are_asked_for_by_name() -> None:
    low, high = (
        scenario_from_dict({"wire": {"model": "universal-ii", "estimate": estimate}, **REST}).wire.bending_stiffness
        for estimate in ("low", "high")
    )
    assert ([p.value for p in low], [p.value for p in high]) == ([0.8e-6, 5e-6], [1.5e-6, 15e-6])
    with pytest.raises(ScenarioError, match="name one by model"):
        scenario_from_dict(
            {
                "wire": {
                    "diameter": 4e-4,
                    "length": 0.1,
                    "density": 7000,
                    "bending_stiffness": 1e-6,
                    "estimate": "low",
                },
                **REST,
            }
        )


@pytest.mark.parametrize("name", catalogue_names())
@pytest.mark.parametrize("bound", ["low", "best", "high"])
def test_every_wire_and_its_bounds_make_a_scenario(name: str, bound: str) -> None:
    pieces = [piece.to_plain() for piece in load_catalogue()[name].stiffness_pieces(bound)]
    scenario = scenario_from_dict({"wire": {"model": name, "bending_stiffness": pieces}, **REST})
    assert scenario.wire.bending_stiffness == load_catalogue()[name].stiffness_pieces(bound)


def test_values_beside_the_model_win() -> None:
    wire = scenario_from_dict({"wire": {"model": "universal-ii", "diameter": "0.4 mm"}, **REST}).wire
    assert (wire.diameter, wire.density) == (0.0004, 6450.0)


def test_a_shorter_wire_is_the_distal_part() -> None:
    wire = scenario_from_dict({"wire": {"model": "universal-ii", "length": "100 mm"}, **REST}).wire
    assert [(piece.start, piece.end, piece.value) for piece in wire.bending_stiffness] == [
        (0.0, 0.045, 1e-6),
        (0.045, 0.1, 7e-6),
    ]
    (tip,) = scenario_from_dict({"wire": {"model": "universal-ii", "length": "45 mm"}, **REST}).wire.bending_stiffness
    assert (tip.end, tip.value_end) == (0.045, 1e-6)


def test_a_sloping_piece_is_cut_on_its_slope() -> None:
    pieces = (
        StiffnessPiece(start=0.0, end=0.1, value=1e-6, value_end=3e-6),
        StiffnessPiece(start=0.1, end=0.2, value=9e-6, value_end=9e-6),
    )
    (kept,) = clipped(pieces, 0.05)
    assert (kept.start, kept.end, kept.value) == (0.0, 0.05, 1e-6)
    assert kept.value_end == pytest.approx(2e-6, rel=1e-12)
    assert clipped(pieces, 0.1) == pieces[:1]
    assert clipped(pieces, 0.2) == pieces


def test_a_longer_wire_is_not_known() -> None:
    with pytest.raises(ScenarioError) as caught:
        scenario_from_dict({"wire": {"model": "universal-ii", "length": "200 mm"}, **REST})
    assert str(caught.value) == (
        "wire.bending_stiffness: is known to 150 mm from the tip, and the wire is 200 mm long; "
        "give bending_stiffness, or a shorter length"
    )


def test_the_catalogue_is_read_only() -> None:
    with pytest.raises(TypeError):
        load_catalogue()["mine"] = load_catalogue()["universal-ii"]  # type: ignore[index]
