"""Contact as a whole: apex, lip, joint, pull-back, stick and slip, signs, energy, at several numbers of segments."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scenes import bend, polygon, scenario

from gw_exudyn.result import Result, Status
from gw_exudyn.scenario import Scenario
from gw_exudyn.simulation import Simulation, simulate


def carina(offset: float) -> dict[str, Any]:
    """A trunk of 4 mm that splits at an apex `offset` m off the catheter's axis; branches at 30 degrees either way."""
    half, run, reach = 2e-3, 8e-3, 40e-3
    c, s = math.cos(math.radians(30)) * reach, math.sin(math.radians(30)) * reach
    apex = (12e-3, offset)
    points = [
        (0.0, -half),
        (run, -half),
        (run + c, -half - s),
        (apex[0] + c, apex[1] - s),
        apex,
        (apex[0] + c, apex[1] + s),
        (run + c, half + s),
        (run, half),
        (0.0, half),
    ]
    return polygon(points, open_edges=(2, 5, 8))


def assert_trusted(result: Result) -> None:
    assert result.status.status is Status.COMPLETED, result.status.sentence()


def test_a_tip_head_on_on_an_apex_goes_one_way_and_stays_there() -> None:
    """The apex on the axis: the tip's disc meets it, is turned aside by the rest curvature, and does not pass
    through."""
    result = simulate(
        scenario(
            vessel=carina(0.0),
            catheter={"exit": [2e-3, 0.0], "bore": 0.4e-3},
            drive={"kind": "speed", "speed": 2e-3, "distance": 0.020},
            solver={"step": 0.01},
            output={"interval": 0.01},
        )
    )
    assert_trusted(result)
    kinds = result.dataset["contact_kind"].values
    assert (kinds == 2).any(), "the tip's disc never touched the apex"
    # Curved to the left, it goes left, and the apex stays on its right: at the end the wire beside the apex is above
    # it.
    assert result.values("tip_y")[-1] > 2e-3
    x, y = result.values("node_x")[-1], result.values("node_y")[-1]
    assert np.interp(12e-3, x, y) > 0.0


@pytest.mark.parametrize("segments", [20, 40, 120])
@pytest.mark.parametrize("side", [1, -1])
def test_the_branch_is_the_side_of_the_apex_on_which_the_tip_passes(segments: int, side: int) -> None:
    """The apex 0.6 mm off the axis: the wire takes the wider side, at every number of segments."""
    vessel = carina(-0.6e-3 * side)
    result = simulate(
        scenario(vessel=vessel, wire={"segments": segments}, drive={"kind": "speed", "speed": 2e-3, "distance": 0.026})
    )
    assert_trusted(result)
    assert side * result.values("tip_y")[-1] > 2e-3


def test_pulled_back_over_an_apex_the_wire_may_take_the_other_branch() -> None:
    """The side is undone when the tip comes back: pushed again with the other curvature, the same corner is passed
    anew."""
    phases = [
        {"speed": 2e-3, "distance": 0.022},
        {"speed": -2e-3, "distance": 0.016},
        {"speed": 2e-3, "distance": 0.016},
    ]
    result = simulate(scenario(vessel=carina(-0.3e-3), drive={"kind": "speed", "phases": phases}))
    assert_trusted(result)
    first, last = np.searchsorted(result.time, 11.0), -1
    assert result.values("tip_x")[np.searchsorted(result.time, 19.0)] < 12e-3
    # What was there before it was pulled back is reached again (friction leaves no trace once contact is lost).
    assert result.values("tip_y")[last] == pytest.approx(result.values("tip_y")[first], abs=20e-6)


@pytest.mark.parametrize("segments", [20, 40, 120])
def test_a_corner_passed_and_passed_again_on_pull_back(segments: int) -> None:
    """In and out round a corner of 60 degrees: no tunnelling, the push turns into a pull, and the end is the start."""
    phases = [{"speed": 2e-3, "distance": 0.030}, {"speed": 0.0, "duration": 1.0}, {"speed": -2e-3, "distance": 0.030}]
    result = simulate(scenario(vessel=bend(60), wire={"segments": segments}, drive={"kind": "speed", "phases": phases}))
    assert_trusted(result)
    push, wall_x = result.values("push_force"), result.values("wall_force_x")
    going_in, holding, coming_out = (np.searchsorted(result.time, t) for t in (14.5, 15.9, 17.0))
    assert push[going_in] > 0 > push[coming_out]
    # While held, friction keeps a part of the push.
    assert push[coming_out] < push[holding] < push[going_in]
    # Pushed, the wire presses the outer wall forwards; what the drive gives, vessel and catheter take (it is quasi-
    # static).
    taken = wall_x + result.values("catheter_force_x")
    # Only in a snap does the wire's inertia show.
    assert np.quantile(np.abs(taken - push), 0.9) < 1e-3 * np.abs(push).max()
    assert result.values("tip_x")[-1] == pytest.approx(0.0, abs=10e-6)
    assert result.values("wall_force_normal")[-1] == 0.0


def test_the_force_of_a_corner_does_not_jump_as_joints_slide_past_it() -> None:
    """Round a corner, frictionless: force changes from step to step stay small although a joint passes every 0.75 mm.

    Without a hand-over between neighbours the corner's force would drop to nothing at each joint.
    """
    result = simulate(
        scenario(
            vessel=bend(60),
            wire={"segments": 80},
            contact={"friction_coefficient": 0.0},
            drive={"kind": "speed", "speed": 2e-3, "distance": 0.032},
            solver={"step": 0.01},
            output={"interval": 0.01},
        )
    )
    assert_trusted(result)
    kind, force = result.dataset["contact_kind"].values, result.dataset["contact_normal_force"].values
    owner = result.dataset["contact_owner"].values
    corner = np.where((kind == 1) & (owner == 0), force, 0.0).sum(axis=1)
    settled = corner[np.searchsorted(result.time, 13.0) :]
    assert settled.min() > 0
    # 0.02 mm a step, 38 steps a joint: measured 3 %; a dropped joint would be 100 %.
    assert np.abs(np.diff(settled)).max() < 0.1 * settled.mean()


@pytest.mark.parametrize("segments", [20, 60])
def test_the_lip_of_the_catheter_carries_a_wire_that_bends_over_it(segments: int) -> None:
    """A catheter that ends close before a sharp turn: its inner lip is a corner to the wire, counted to the
    catheter."""
    vessel = bend(90, run_in=4e-3)
    result = simulate(
        scenario(
            vessel=vessel,
            wire={"segments": segments},
            contact={"friction_coefficient": 0.1},
            catheter={"exit": [1e-3, -1.2e-3], "direction": math.radians(8), "bore": 0.5e-3},
            drive={"kind": "speed", "speed": 2e-3, "distance": 0.024},
        )
    )
    assert_trusted(result)
    kind, owner = result.dataset["contact_kind"].values, result.dataset["contact_owner"].values
    assert ((kind == 1) & (owner == 1))[-1].any(), "no lip contact"
    assert result.values("catheter_force_normal")[-1] > 0


def stuck_wire(tilt: float, friction: float, **changes: Any) -> Scenario:
    """A curved tip pressed on the wall of a straight channel, then held."""
    return scenario(
        wire={"tip_shape": {"kind": "arc", "length": 10e-3, "angle": tilt}},
        vessel={"kind": "straight", "length": 50e-3, "diameter": 3e-3},
        contact={"friction_coefficient": friction},
        drive={"kind": "speed", "phases": [{"speed": 2e-3, "distance": 0.020}, {"speed": 0.0, "duration": 10.0}]},
        **changes,
    )


def test_a_stuck_wire_does_not_creep() -> None:
    """Held for 10 s with friction, the tip stays within a nanometre and the push does not leak away.

    Regularised friction with 0.05 mm/s would creep hundreds of micrometres.
    """
    result = simulate(stuck_wire(math.radians(60), 0.5))
    assert_trusted(result)
    tip, push = result.values("tip_x"), result.values("push_force")
    settled = np.searchsorted(result.time, 11.0)
    assert result.values("wall_force_normal")[-1] > 1e-5
    assert np.ptp(tip[settled:]) < 1e-9
    assert push[-1] == pytest.approx(push[settled], rel=1e-3)
    assert push[-1] > 0


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_sliding_friction_is_coulombs(friction: float) -> None:
    """While it slides straight on, every contact drags with mu times its normal force, against the motion."""
    result = simulate(stuck_wire(math.radians(60), friction))
    instant = np.searchsorted(result.time, 9.5)
    contacts = result.contacts_at(int(instant))
    normal, tangential = contacts["contact_normal_force"], contacts["contact_tangential_force"]
    pressing = normal > 0.01 * normal.max()
    # On the wall and towards the tip: the wire drags the wall along. Fully sliding is 1.1 elastic slips, hence the
    # tolerance.
    assert tangential[pressing] == pytest.approx(friction * normal[pressing], rel=1e-6, abs=1e-12)


def test_more_friction_more_push_and_the_stiffer_wire_pushes_harder() -> None:
    pushes = []
    for friction in (0.0, 0.2, 0.4):
        result = simulate(scenario(vessel=bend(60), contact={"friction_coefficient": friction}))
        assert_trusted(result)
        pushes.append(result.values("push_force").max())
    assert pushes[0] < pushes[1] < pushes[2]
    stiff = simulate(scenario(vessel=bend(60), wire={"bending_stiffness": 5e-6}))
    soft = simulate(scenario(vessel=bend(60)))
    # Quasi-static forces scale with EI where the path is the same; the path differs a little.
    ratio = stiff.values("wall_force_normal").max() / soft.values("wall_force_normal").max()
    assert 3.5 < ratio < 6.5


def test_the_wall_force_rises_where_the_wire_meets_the_corner() -> None:
    result = simulate(scenario(vessel=bend(60, run_in=15e-3)))
    reach = np.searchsorted(result.values("tip_x"), 13e-3)
    assert result.values("wall_force_normal")[:reach].max() == 0.0
    assert result.values("wall_force_normal")[reach:].max() > 1e-3


@pytest.mark.parametrize("heading", [0.0, 90.0, -135.0])
def test_a_turned_scene_gives_turned_results(heading: float) -> None:
    """The same vessel and catheter, turned in the plane: same push, forces and places turned. To rounding, amplified
    by the iterations' tolerance of 1e-6."""
    straight = simulate(scenario(vessel=bend(60)))
    a = math.radians(heading)
    turn = np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]])
    outline = bend(60)
    outline["points"] = (np.array(outline["points"]) @ turn.T).tolist()
    turned = simulate(scenario(vessel=outline, catheter={"direction": a}))
    tip = np.column_stack([straight.values("tip_x"), straight.values("tip_y")]) @ turn.T
    force = np.column_stack([straight.values("wall_force_x"), straight.values("wall_force_y")]) @ turn.T
    scale = np.abs(force).max()
    assert turned.values("tip_x") == pytest.approx(tip[:, 0], abs=1e-7)
    assert turned.values("tip_y") == pytest.approx(tip[:, 1], abs=1e-7)
    assert turned.values("wall_force_y") == pytest.approx(force[:, 1], abs=1e-3 * scale)


def test_a_mirrored_scene_gives_mirrored_results() -> None:
    outline = bend(60)
    mirrored = polygon([(x, -y) for x, y in outline["points"]], open_edges=(2, 5))
    up = simulate(scenario(vessel=outline, wire={"imperfection": 0.04}))
    down = simulate(scenario(vessel=mirrored, wire={"imperfection": -0.04}))
    assert down.values("tip_y") == pytest.approx(-up.values("tip_y"), abs=1e-7)
    assert down.values("push_force") == pytest.approx(up.values("push_force"), abs=1e-3 * up.values("push_force").max())


@pytest.mark.parametrize("segments", [20, 100, 400])
def test_the_corner_stays_on_its_side_of_the_wire(segments: int) -> None:
    """No tunnelling: at every step the inner corner of a right angle lies left of the wire that goes round it."""
    simulation = Simulation(
        scenario(vessel=bend(90, run_in=15e-3), wire={"segments": segments}, contact={"friction_coefficient": 0.1})
    )
    corner = np.array([13e-3, 2e-3])
    while simulation.time < simulation.duration - 1e-9:
        assert simulation.advance(simulation.time + 0.1), simulation.status.sentence()
        outputs = simulation.outputs
        nodes = np.column_stack([outputs["node_x"], outputs["node_y"]])
        a, d = nodes[:-1], np.diff(nodes, axis=0)
        part = np.clip(((corner - a) * d).sum(axis=1) / (d * d).sum(axis=1), 0, 1)
        offset = corner - a - part[:, None] * d
        nearest = int(np.hypot(*offset.T).argmin())
        if 0 < part[nearest] < 1:
            assert d[nearest, 0] * offset[nearest, 1] - d[nearest, 1] * offset[nearest, 0] > 0
    assert simulation.outputs["tip_y"] > 5e-3


def test_energy_closes_and_losses_only_grow() -> None:
    """Pushed square against a wall it buckles; what the drive gave is found again, term by term, and losses never
    fall."""
    result = simulate(scenario())
    assert_trusted(result)
    work = result.values("insertion_work")
    assert np.abs(result.values("energy_error")).max() < 0.01 * np.abs(work).max()
    for loss in ("friction_loss", "damping_loss"):
        assert np.diff(result.values(loss)).min() > -1e-12 * work.max() - 1e-15, loss
    assert result.values("friction_loss")[-1] > 0
    # The integrator's own loss is no dustbin: most of the work is in the terms that mean something.
    assert abs(result.values("numerical_loss")[-1]) < 0.2 * work.max()


def test_a_wire_that_buckles_is_listed_as_a_snap_through() -> None:
    """Pushed square against a wall the wire buckles and slips: the energy it sets free is listed at that time. Round
    a gentle bend nothing snaps."""
    snapped = simulate(scenario())
    assert snapped.snaps
    meets = snapped.time[np.argmax(snapped.values("wall_force_normal") > 0)]
    assert all(event.time >= meets for event in snapped.snaps)
    released = sum(event.released_energy for event in snapped.snaps)
    assert 0 < released < np.abs(snapped.values("insertion_work")).max()
    gentle = {"kind": "arc", "radius": 0.03, "angle": 0.5, "diameter": 4e-3, "lead_in": 5e-3, "lead_out": 0.05}
    assert simulate(scenario(vessel=gentle)).snaps == ()


def test_time_step_and_tolerance_hardly_move_the_tip() -> None:
    """Steps of 0.1 and 0.025 s round a corner: 0.02 mm is the project's bound on the tip."""
    coarse, fine = (simulate(scenario(vessel=bend(60), solver={"step": h})) for h in (0.1, 0.025))
    for name in ("tip_x", "tip_y"):
        assert coarse.values(name)[-1] == pytest.approx(fine.values(name)[-1], abs=0.02e-3)
    assert coarse.values("push_force")[-1] == pytest.approx(fine.values("push_force")[-1], rel=0.02)


def test_a_snug_wire_is_not_squeezed() -> None:
    """2.5 um of room on either side in bore and lumen: a straight wire slides in with next to no push."""
    snug = {"kind": "straight", "length": 80e-3, "diameter": 0.365e-3}
    result = simulate(scenario(vessel=snug, catheter={"bore": 0.365e-3}, wire={"imperfection": 0.0}))
    assert_trusted(result)
    assert np.abs(result.values("push_force")).max() < 1e-3


def test_a_curved_tip_that_leaves_an_open_end_hooks_its_edge_and_comes_back() -> None:
    """The wall's end at an open end is a corner: a curved tip leaves round it, drags over it, and is pulled in
    again."""
    phases = [{"speed": 2e-3, "distance": 0.030}, {"speed": -2e-3, "distance": 0.024}]
    result = simulate(
        scenario(
            wire={"tip_shape": {"kind": "arc", "length": 10e-3, "angle": math.radians(60)}, "segments": 60},
            vessel={"kind": "straight", "length": 15e-3, "diameter": 4e-3},
            drive={"kind": "speed", "phases": phases},
        )
    )
    assert_trusted(result)
    assert result.values("tip_y").max() > 2e-3
    kind, x = result.dataset["contact_kind"].values, result.dataset["contact_x"].values
    assert ((kind == 1) & (np.abs(x - 15e-3) < 1e-6)).any(), "nothing touched the edge"
    assert result.values("tip_x")[-1] < 7e-3


@pytest.mark.parametrize("angle", [90.0, 180.0])
def test_a_strongly_curved_tip_stays_in_its_catheter(angle: float) -> None:
    """A J straightened in the bore presses hard on it; the automatic stiffness of the walls allows for that."""
    result = simulate(
        scenario(
            wire={"tip_shape": {"kind": "arc", "length": 6e-3, "angle": math.radians(angle)}, "segments": 120},
            vessel={"kind": "straight", "length": 60e-3, "diameter": 12e-3},
            drive={"kind": "speed", "speed": 2e-3, "distance": 0.02},
        )
    )
    assert_trusted(result)


def test_a_fold_of_wire_meets_a_corner_on_the_side_where_it_passes() -> None:
    """A J in a wide vessel folds back beside the catheter's lip: the lip's side is that of the wire that comes out of
    it."""
    result = simulate(
        scenario(
            wire={"tip_shape": {"kind": "arc", "length": 12e-3, "angle": math.radians(270)}, "segments": 120},
            vessel={"kind": "straight", "length": 60e-3, "diameter": 14e-3},
            drive={"kind": "speed", "speed": 2e-3, "distance": 0.026},
        )
    )
    assert_trusted(result)
    assert result.values("penetration_max").max() < 0.3 * 0.18e-3


def test_peaks_do_not_depend_on_the_outputs() -> None:
    fine, coarse = (simulate(scenario(output={"interval": dt})) for dt in (0.1, 3.0))
    assert coarse.peaks == fine.peaks
    assert coarse.peaks["push_force"][0] >= fine.values("push_force").max()


def test_a_speed_peak_inside_a_step_is_followed() -> None:
    """A drive that rushes and rests within one long step ends where it would have ended in short steps."""
    table = [[0.0, 0.0], [0.5, 0.02], [1.0, 0.0], [2.0, 0.0]]
    long, short = (
        simulate(scenario(vessel=bend(60), drive={"kind": "speed", "table": table}, solver={"step": h}))
        for h in (1.0, 0.05)
    )
    assert_trusted(long)
    assert long.values("tip_x")[-1] == pytest.approx(short.values("tip_x")[-1], abs=20e-6)
