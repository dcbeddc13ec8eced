"""Friction that differs along the wire and along the walls."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from model_cases import LAW, RADIUS, at_rest, bare_walls, chain, force_at, plain_wire, scenario

from gw_exudyn.errors import ScenarioError
from gw_exudyn.model import build
from gw_exudyn.model.patches import Patch, divided, friction_at
from gw_exudyn.model.wire import friction_factors
from gw_exudyn.scenario.friction import FrictionStretch
from gw_exudyn.simulation import simulate

MM = 1e-3
MU = 0.4
BEND = {"kind": "arc", "radius": 0.01, "angle": 1.2, "diameter": 4e-3, "facets": 8, "lead_in": 6e-3, "lead_out": 0.08}


def bent(**changes):
    """A short insertion into a bend, the wire of two segments a facet."""
    changes["wire"] = {"segments": 60, "imperfection": 0.5} | changes.pop("wire", {})
    drive = {"kind": "speed", "speed": 4e-3, "distance": 0.03}
    return scenario(vessel=BEND, drive=drive, output={"interval": 0.5}, **changes)


# --- along the wire


def test_a_stretch_counts_by_what_it_covers_about_a_node():
    """Nodes 10 mm apart stand for 5 mm on either side: the stretches cover 3 of 5 mm at the tip, 4 of 10 mm."""
    nodes = np.array([40, 30, 20, 10, 0]) * MM
    stretches = [stretch(0, 3, 0.5), stretch(21, 25, 2.0)]
    assert friction_factors(stretches, nodes) == pytest.approx([1.0, 1.0, 1.4, 1.0, 0.7])


def stretch(start, end, factor):
    return FrictionStretch.model_validate({"from": start * MM, "to": end * MM, "factor": factor})


def test_a_wire_of_two_frictions_slides_at_the_sum():
    wire = replace(plain_wire(np.full(4, 2 * MM)), friction_factor=np.array([1.0, 1.0, 1.0, 0.25, 0.25]))
    q = chain(wire, (1 * MM, RADIUS - 2 * LAW.toe), 0.0)
    contact = at_rest(wire, bare_walls(((0, 0), (60 * MM, 0)), friction=MU), q)
    normal = 2 * LAW.toe * LAW.stiffness
    force = force_at(contact, q + [1e-4, 0, 0])
    assert force[:, 0] == pytest.approx(-MU * normal * np.array([1.0, 1.0, 0.25, 0.25]))


def test_at_a_corner_the_factor_is_that_of_the_place_that_touches():
    wire = replace(plain_wire(np.full(3, 2 * MM)), friction_factor=np.array([1.0, 1.0, 0.2, 0.2]))
    q = chain(wire, (0.0, 0.0), 0.0)
    for x, factor in ((2.3, 0.88), (3.0, 0.6), (3.5, 0.4), (5.0, 0.2)):
        contact = at_rest(wire, bare_walls(corners=[(x * MM, RADIUS - 2 * LAW.toe)], friction=MU), q)
        back = q - [1e-9, 0, 0]
        contact.motion.set(back - [1e-4, 0, 0], np.zeros_like(q))
        contact.start_step()
        along, across, _ = force_at(contact, q).sum(axis=0)
        assert abs(along / across) == pytest.approx(MU * factor)


def test_half_the_factor_on_the_whole_wire_is_half_the_friction_everywhere():
    """To the bit, catheter and vessel."""
    whole = [{"from": 0.0, "to": 0.1, "factor": 0.5}]
    plain = simulate(bent(contact={"friction_coefficient": 0.2}))
    coated = simulate(bent(contact={"friction_coefficient": 0.4}, wire={"friction": whole}))
    rough = simulate(bent(contact={"friction_coefficient": 0.4}))
    assert plain.dataset["push_force"].equals(coated.dataset["push_force"])
    assert float(rough.dataset["push_force"][-1]) > 1.1 * float(coated.dataset["push_force"][-1])


# --- along the walls


def test_a_patch_over_the_vessel_is_the_vessels_friction():
    """To the bit; the catheter keeps its own."""
    everywhere = {"from": [0.0, 0.0], "to": [0.02, 0.02], "within": 0.5, "friction_coefficient": 0.2}
    plain = simulate(bent(contact={"friction_coefficient": 0.2}, catheter={"friction_coefficient": 0.1}))
    patched = simulate(bent(contact={"patches": [everywhere]}, catheter={"friction_coefficient": 0.1}))
    assert plain.dataset["push_force"].equals(patched.dataset["push_force"])


def test_contacts_slide_at_the_friction_of_their_wall_times_that_of_the_wire():
    """A coated tip in a bend that is rough beyond its end: no contact carries more, and most carry just that."""
    contact = {
        "friction_coefficient": 0.2,
        "patches": [{"from": [0.0153, 0.0064], "to": [0.044, 0.081], "within": 0.004, "friction_coefficient": 0.6}],
    }
    coat = [{"from": 0.0, "to": 0.008, "factor": 0.5}]
    coated = bent(contact=contact, wire={"friction": coat})
    run, wire = simulate(coated).dataset, build(coated).wire
    x, y = run["contact_x"].to_numpy(), run["contact_y"].to_numpy()
    vessel = run["contact_owner"].to_numpy() == 0
    places = np.column_stack([x[vessel], y[vessel]])
    patch = Patch(np.array([0.0153, 0.0064]), np.array([0.044, 0.081]), 0.004, 0.6)
    wall = friction_at(places, [patch], 0.2)
    from_tip = run["contact_arc_length"].to_numpy()[vessel]
    factor = np.interp(from_tip, wire.node_arc_length[::-1], wire.friction_factor[::-1])
    normal, tangential = (run[f"contact_{name}_force"].to_numpy()[vessel] for name in ("normal", "tangential"))
    used = abs(tangential) / (wall * factor * normal)
    assert set(wall) == {0.2, 0.6}
    assert used.max() < 1 + 1e-9
    assert (used > 0.999).mean() > 0.7


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        ((-20, 1), (40, 1), (-1.732050808, 11.732050808)),  # past both round ends
        ((5, -20), (5, 20), (-2, 2)),  # across
        ((5, 0), (40, 0), (12,)),  # from inside
        ((-20, 3), (40, 3), ()),  # beside
        ((2, 0), (8, 1), ()),  # within
    ],
)
def test_where_an_edge_enters_and_leaves_a_patch(a, b, expected):
    """A patch of 2 mm about the line from (0, 0) to (10, 0) mm; the coordinate that moves, at the borders."""
    patch = Patch(np.zeros(2), np.array([10 * MM, 0.0]), 2 * MM, 0.6)
    a, b = np.array(a) * MM, np.array(b) * MM
    found = np.array([a + t * (b - a) for t in sorted(patch.borders(a, b))]).reshape(-1, 2) / MM
    moving = 0 if a[0] != b[0] else 1
    assert found[:, moving] == pytest.approx(np.array(expected))


def test_an_edge_is_divided_where_a_patch_begins_but_not_into_crumbs():
    square = np.array([(0, 0), (40, 0), (40, 40), (0, 40)]) * MM
    patch = Patch(np.array([10, 0]) * MM, np.array([20, 0]) * MM, 2 * MM, 0.6)
    points = divided(square, [patch], 0.1 * MM, closed=True) / MM
    assert points.tolist() == pytest.approx(np.array([(0, 0), (8, 0), (22, 0), (40, 0), (40, 40), (0, 40)]))
    assert len(divided(square, [patch], 9 * MM, closed=True)) == 5


def test_the_last_patch_counts():
    patches = [Patch(np.zeros(2), np.zeros(2), within, mu) for within, mu in ((3 * MM, 0.1), (1 * MM, 0.9))]
    places = np.array([(0.5, 0), (2, 0), (5, 0)]) * MM
    assert friction_at(places, patches, 0.4).tolist() == [0.9, 0.1, 0.4]


def test_a_patch_off_the_walls_is_told_of():
    patches = [
        {"from": [0.01, 0.0], "to": [0.02, 0.0], "within": 1e-3, "friction_coefficient": 0.6},
        {"from": [0.01, 0.0], "to": [0.02, 0.0], "within": 3e-3, "friction_coefficient": 0.6},
    ]
    told = [text for text in build(scenario(contact={"patches": patches})).warnings if "patches" in text]
    assert told == ["contact.patches.0: no wall of the vessel lies within 1 mm of its line; it changes nothing"]


# --- in the file


@pytest.mark.parametrize(
    ("section", "content", "message"),
    [
        (
            "wire",
            {"friction": [{"from": 0.0, "to": 0.2, "factor": 0.5}]},
            "200 mm is beyond the end of the wire, 100 mm",
        ),
        ("wire", {"friction": [{"from": 0.02, "to": 0.01, "factor": 0.5}]}, "10 mm is not beyond from, 20 mm"),
        (
            "wire",
            {"friction": [{"from": 0.0, "to": 0.02, "factor": 0.5}, {"from": 0.01, "to": 0.03, "factor": 1.5}]},
            "the stretch overlaps another, 0 mm to 20 mm",
        ),
        ("wire", {"friction": [{"from": 0.0, "to": 0.02}]}, "factor: is missing"),
        ("wire", {"friction": 0.5}, "0.5 is no list"),
        ("contact", {"patches": [{"from": [0.0, 0.0], "to": [0.0, 0.0], "within": 1e-3}]}, "friction_coefficient"),
        (
            "contact",
            {"patches": [{"from": [0.0], "to": [0.0, 0.0], "within": 1e-3, "friction_coefficient": 0.1}]},
            "[x, y] is needed",
        ),
    ],
)
def test_what_is_wrong_is_told(section, content, message):
    with pytest.raises(ScenarioError) as caught:
        scenario(**{section: content})
    assert message in str(caught.value)


def test_a_scenario_with_both_survives_being_written_and_read():
    patch = {"from": [0.01, 0.0], "to": [0.02, 0.0], "within": 3e-3, "friction_coefficient": 0.6}
    first = scenario(wire={"friction": [{"from": 0.0, "to": 0.02, "factor": 0.5}]}, contact={"patches": [patch]})
    content = first.to_dict()
    assert content["contact"]["patches"] == [patch]
    again = scenario(wire=content["wire"], contact=content["contact"])
    assert again.wire == first.wire
    assert again.contact == first.contact
