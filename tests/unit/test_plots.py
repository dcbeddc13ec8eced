"""Figures: they can be drawn from any result, say what they show with units, and put forces where they act."""

from __future__ import annotations

import dataclasses
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from synthetic import StandInWire, corner_walls, made_up_result, sample

from gw_exudyn.errors import StorageError
from gw_exudyn.plots import (
    FIGURES,
    plot_contact_map,
    plot_energy,
    plot_forces,
    plot_insertion,
    plot_tip_path,
    save_figure,
    save_figures,
)
from gw_exudyn.plots.arrows import bundles, round_down
from gw_exudyn.plots.branch_names import draw_branch_names
from gw_exudyn.plots.contact_vectors import contact_vectors
from gw_exudyn.plots.save import render
from gw_exudyn.plots.scene import enclosed, view
from gw_exudyn.plots.style import new_figure
from gw_exudyn.plots.tip_path import _round_step
from gw_exudyn.quantities import CONTACT_FIELDS
from gw_exudyn.result import Result, Status, StatusReport
from gw_exudyn.scenario.vessels.branches import BranchesVessel


@pytest.fixture(scope="module")
def universal():
    return made_up_result(segments=60)


@pytest.fixture(scope="module")
def branched():
    """The made-up course in a vessel of two branches that are named."""
    branches = [
        {"name": "along", "points": [[0.0, 0.0], [30e-3, 0.0]], "diameter": 6e-3},
        {"name": "up", "points": [[30e-3, 0.0], [30e-3, 60e-3]], "diameter": 6e-3},
    ]
    vessel = BranchesVessel.model_validate({"kind": "branches", "branches": branches})
    result = made_up_result(segments=60)
    return dataclasses.replace(result, scenario=dataclasses.replace(result.scenario, vessel=vessel))


@pytest.fixture(scope="module")
def amplatz():
    return made_up_result("corner90-amplatz", scale=1.0, wire=StandInWire(0.89e-3, "amplatz-super-stiff"))


def with_series(samples, like, **further):
    return Result.from_samples(
        samples,
        scenario=like.scenario,
        status=like.status,
        node_arc_length=like.values("node_arc_length"),
        joint_arc_length=like.values("joint_arc_length"),
        **further,
    )


def texts(figure):
    """Every text that is to be seen in the figure."""
    from matplotlib.text import Text

    return [text.get_text() for text in figure.findobj(Text) if text.get_visible() and text.get_text()]


def visible_boxes(figure, wanted):
    from matplotlib.text import Text

    figure.draw_without_rendering()
    found = [text for text in figure.findobj(Text) if any(word in text.get_text() for word in wanted)]
    return {text.get_text(): text.get_window_extent() for text in found}


# ---- every figure


@pytest.mark.parametrize("name", FIGURES)
def test_each_axis_has_a_name_and_a_unit(name, universal):
    figure = FIGURES[name](universal)
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            shared = axis is axes.xaxis and name == "energy" and axes is figure.axes[0]
            colour_bar = axis is axes.xaxis and axes.get_label() == "<colorbar>"
            if not shared and not colour_bar:
                assert "[" in axis.label.get_text(), (name, axis.label.get_text())


@pytest.mark.parametrize("name", FIGURES)
def test_each_figure_names_scenario_and_wire(name, universal):
    shown = "\n".join(texts(FIGURES[name](universal)))
    assert "corner90-universal" in shown
    assert "universal-ii, 0.36 mm" in shown


@pytest.mark.parametrize("name", FIGURES)
def test_a_run_that_can_not_be_trusted_says_so_on_each_figure(name):
    broken = made_up_result(segments=20, instants=5, status=StatusReport(Status.TOO_DEEP, 31.2))
    assert any("NOT TO BE TRUSTED at t = 31.2 s: too deep" in text for text in texts(FIGURES[name](broken)))
    assert not any("TRUSTED" in text for text in texts(FIGURES[name](made_up_result(segments=20, instants=5))))


def only_the_start(like):
    return with_series([sample(0.0, 0.0, 0.02, like.values("node_arc_length"))], like)


def nothing_finite(like):
    samples = []
    for time in (0.0, 1.0):
        one = sample(time, 0.08, 0.02, like.values("node_arc_length"))
        samples.append(
            {
                name: np.full(np.shape(value), np.nan)
                if isinstance(value, float | np.ndarray) and name not in ("time", *CONTACT_FIELDS[6:])
                else value
                for name, value in one.items()
            }
        )
    return with_series(samples, like)


def never_touching(like):
    return made_up_result(segments=20, instants=5, deepest=0.015)


def pulled_back(like):
    return made_up_result(segments=20, instants=9, pull_back=True)


@pytest.mark.parametrize("make", [only_the_start, nothing_finite, never_touching, pulled_back])
@pytest.mark.parametrize("name", FIGURES)
def test_odd_results_are_drawn_too(name, make, universal):
    assert render(FIGURES[name](make(universal)), "png").startswith(b"\x89PNG")


@pytest.mark.parametrize("draw", [plot_insertion, plot_forces, plot_tip_path])
def test_no_results_are_refused(draw):
    with pytest.raises(ValueError, match="at least one result"):
        draw([])


def test_drawing_leaves_pyplot_and_the_settings_of_matplotlib_alone():
    here = Path(__file__).parent
    code = f"""
        import sys; sys.path[:0] = [{str(here.parents[1])!r}, {str(here)!r}]
        import matplotlib
        before = matplotlib.rcParams.copy()
        from synthetic import made_up_result
        from gw_exudyn.plots.save import render_figures
        render_figures(made_up_result(segments=10, instants=5), formats=("pdf",))
        assert "matplotlib.pyplot" not in sys.modules
        assert matplotlib.rcParams.copy() == before
    """
    script = "\n".join(line.strip() for line in code.splitlines())
    done = subprocess.run([sys.executable, "-B", "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


# ---- contact forces


def test_forces_point_from_the_wire_into_the_wall(universal):
    """On the outer wall at the right the normal force points to +x, the friction of a push to +y, where the tip is."""
    instant = len(universal.time) - 1
    points, forces, owners = contact_vectors(universal, instant)
    at_right = (points[:, 0] > 0.0329) & (owners == 0)
    contacts = universal.contacts_at(instant)
    assert at_right.sum() > 3
    # The made-up wire runs upwards there but for its first, still slightly bent segment.
    assert forces[at_right, 0] == pytest.approx(contacts["contact_normal_force"][at_right], rel=0.02)
    assert forces[at_right, 1] == pytest.approx(contacts["contact_tangential_force"][at_right], rel=0.1)
    assert np.hypot(*forces.T) == pytest.approx(
        np.hypot(contacts["contact_normal_force"], contacts["contact_tangential_force"])
    )


def test_the_vectors_add_up_on_a_wire_that_lies_on_a_floor(universal):
    from_tip = universal.values("node_arc_length")
    one = sample(0.0, 0.0, 0.02, from_tip)
    one.update(node_x=-from_tip, node_y=0 * from_tip)
    count, radius = 4, 0.18e-3
    place = np.array([0.0, 0.01, 0.0234, 0.149])
    one.update(
        contact_x=-place,
        contact_y=np.full(count, -radius),
        contact_arc_length=place,
        contact_normal_force=np.arange(1.0, 5.0),
        contact_tangential_force=np.array([0.1, -0.2, 0.3, 0.0]),
        contact_gap=np.zeros(count),
        contact_kind=np.array([2, 0, 1, 0]),
        contact_owner=np.zeros(count),
    )
    _, forces, _ = contact_vectors(with_series([one], universal), 0)
    assert forces[:, 0] == pytest.approx([0.1, -0.2, 0.3, 0.0], abs=1e-12)
    assert forces[:, 1] == pytest.approx([-1.0, -2.0, -3.0, -4.0])


def test_bundles_keep_the_resultant_and_never_mix_opposite_walls():
    points = np.array([[0.0, 0.0], [0.1, 0.0], [0.2, 0.0], [0.0, 0.1], [5.0, 0.0]])
    forces = np.array([[0.0, -1.0], [0.0, -3.0], [0.1, -1.0], [0.0, 2.0], [0.0, -1.0]])
    middles, sums = bundles(points, forces, 0.5)
    assert sums == pytest.approx(np.array([[0.1, -5.0], [0.0, 2.0], [0.0, -1.0]]))
    assert middles[0] == pytest.approx([0.1, 0.0], abs=2e-3)
    assert len(bundles(points[:0], forces[:0], 0.5)[0]) == 0


@pytest.mark.parametrize(("value", "key"), [(0.0238, 0.02), (1.0, 1.0), (0.99, 0.5), (7e-3, 5e-3), (5e-3, 5e-3)])
def test_the_key_shows_a_round_force(value, key):
    assert round_down(value) == pytest.approx(key)


@pytest.mark.parametrize(("length", "step"), [(0.01, 0.01), (0.0101, 0.02), (0.006, 0.01), (0.0, 1e-3)])
def test_marks_come_at_round_depths(length, step):
    assert _round_step(length) == pytest.approx(step)


# ---- the main figure


def test_the_main_figure_shows_four_depths_and_the_largest_force(universal):
    shown = texts(plot_insertion(universal))
    assert {"20 mm", "40 mm", "60 mm", "80 mm"} <= set(shown)
    assert any("largest contact force 23.8 mN, at 80 mm" in text for text in shown)
    assert any("mN on the wall" in text for text in shown)


def test_depths_can_be_named_and_those_never_reached_are_left_out(universal):
    assert {"10 mm", "30 mm"} <= set(texts(plot_insertion(universal, depths=[0.03, 0.01, 0.5])))
    assert "80 mm" in texts(plot_insertion(universal, depths=1))


def test_after_a_pull_back_depths_are_those_of_the_way_in():
    assert {"40 mm", "80 mm"} <= set(texts(plot_insertion(pulled_back(None), depths=2)))


def test_panels_have_one_scale_of_length(universal, amplatz):
    first, second = plot_insertion([universal, amplatz]).axes
    for axes in (first, second):
        assert axes.get_aspect() == 1.0
    assert np.ptp(first.get_xlim()) == pytest.approx(np.ptp(second.get_xlim()))
    assert np.ptp(first.get_ylim()) == pytest.approx(np.ptp(second.get_ylim()))


@pytest.mark.parametrize(("force_scale", "own"), [("auto", True), ("own", True), ("common", False)])
def test_the_key_says_where_panels_have_their_own_scale_of_force(universal, amplatz, force_scale, own):
    shown = texts(plot_insertion([universal, amplatz], force_scale=force_scale))
    assert any("own scale" in text for text in shown) == own


def test_forces_of_like_size_share_a_scale(universal):
    similar = made_up_result("other", scale=0.04)
    assert not any("own scale" in text for text in texts(plot_insertion([universal, similar])))


def test_no_text_of_the_main_figure_lies_on_another(universal, amplatz):
    figure = plot_insertion([universal, amplatz])
    boxes = list(
        visible_boxes(figure, ["corner90", "largest contact", "insertion depth", "on the wall", "x [mm]"]).items()
    )
    for number, (name, box) in enumerate(boxes):
        for other_name, other in boxes[number + 1 :]:
            assert not box.overlaps(other), (name, other_name)


@pytest.mark.parametrize("arrows", ["each", "last", "none"])
def test_arrows_are_drawn_where_asked(universal, arrows):
    from matplotlib.quiver import Quiver

    drawn = len(plot_insertion(universal, arrows=arrows).findobj(Quiver))
    assert drawn == {"each": 3, "last": 1, "none": 0}[arrows]  # nothing touches the vessel at 20 mm


def test_all_of_wire_vessel_and_arrows_is_in_view(universal):
    from matplotlib.quiver import Quiver

    figure = plot_insertion(universal)
    axes = figure.axes[0]
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    for arrows in figure.findobj(Quiver):
        ends = np.asarray(arrows.get_offsets()) + np.column_stack([arrows.U, arrows.V])
        assert ((ends > [x0, y0]) & (ends < [x1, y1])).all()
    walls = np.concatenate(corner_walls()) * 1e3
    assert ((walls > [x0, y0]) & (walls < [x1, y1])).all()


def test_a_long_vessel_is_cut_to_where_the_wire_is(universal):
    far = type(universal)(
        universal.dataset,
        universal.status,
        universal.scenario,
        vessel_outline=(np.array([[0.0, -3e-3], [2.0, -3e-3]]), np.array([[2.0, 3e-3], [0.0, 3e-3]])),
    )
    limits = view(far, np.array([[0.0, 0.0], [0.05, 0.0]]))
    assert limits[1, 0] < 0.1
    assert limits[0, 1] < -3e-3
    assert limits[1, 1] > 3e-3


# ---- the lumen


def test_walls_in_any_order_and_direction_enclose_the_lumen():
    outer, inner = corner_walls()
    area = 6e-3 * 33e-3 + 6e-3 * 57e-3
    for lines in ((outer, inner), (inner, outer), (outer[::-1], inner), (outer, inner[::-1])):
        x, y = enclosed(lines).T
        assert abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) / 2 == pytest.approx(area)


def test_walls_that_enclose_nothing_are_not_tinted():
    assert enclosed([]) is None
    assert enclosed([np.array([[0.0, 0.0], [1.0, 0.0]])]) is None
    assert enclosed([np.array([[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]])]) is None


# ---- the others


def test_forces_are_drawn_over_depth_and_time_with_one_scale(universal, amplatz):
    figure = plot_forces([universal, amplatz])
    assert [axes.get_xlabel() for axes in figure.axes] == ["insertion depth [mm]"] * 2 + ["time [s]"] * 2
    assert len({axes.get_ylim() for axes in figure.axes}) == 1
    assert {"push force", "resultant force on the vessel", "largest single contact", "snap-through"} <= set(
        texts(figure)
    )


def test_tip_paths_in_one_vessel_share_a_panel(universal, amplatz):
    assert len(plot_tip_path([universal, amplatz]).axes) == 1
    elsewhere = type(amplatz)(amplatz.dataset, amplatz.status, amplatz.scenario)
    assert len(plot_tip_path([universal, elsewhere]).axes) == 2


def test_stacked_energies_reach_the_work_less_the_error(universal):
    axes = plot_energy(universal).axes[0]
    tops = max(path.vertices[:, 1].max() for fill in axes.collections for path in fill.get_paths())
    expected = (universal.values("insertion_work") - universal.values("energy_error"))[-1] * 1e6
    assert tops == pytest.approx(expected)


def test_the_contact_map_has_a_dot_for_each_contact_of_the_vessel(universal):
    dots = plot_contact_map(universal).axes[0].collections[0]
    assert len(dots.get_offsets()) == int((universal.dataset["contact_owner"].values == 0).sum())


# ---- files


def test_figures_are_files_and_the_same_run_gives_the_same_bytes(universal, tmp_path):
    first = save_figures(universal, tmp_path / "one", names=["insertion", "energy"])
    second = save_figures(universal, tmp_path / "two", names=["insertion", "energy"])
    assert [path.name for path in first] == ["insertion.png", "insertion.pdf", "energy.png", "energy.pdf"]
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in second]


def test_a_dot_in_the_name_of_a_figure_is_no_suffix(universal, tmp_path):
    (path,) = save_figure(plot_energy(universal), tmp_path / "friction-0.6", formats=["png"])
    assert path.name == "friction-0.6.png"


def test_figures_that_can_not_be_written_are_a_storage_error(universal, tmp_path):
    (tmp_path / "figures").write_text("a file")
    with pytest.raises(StorageError, match="figures can't be written"):
        save_figures(universal, tmp_path / "figures", names=["energy"], formats=["png"])


@pytest.mark.parametrize("plot", [plot_insertion, plot_tip_path])
def test_branches_are_named_beside_their_walls_in_view(plot, branched, universal):
    (axes,) = plot(branched).axes
    named = {one.get_text(): one for one in axes.texts if one.get_text() in ("along", "up")}
    assert set(named) == {"along", "up"}
    for name, text in named.items():
        x, y = (part * 1e-3 for part in text.xy)
        assert axes.get_xlim()[0] < text.xy[0] < axes.get_xlim()[1]
        assert axes.get_ylim()[0] < text.xy[1] < axes.get_ylim()[1]
        # On the wall: half of the width off the centre line.
        assert abs(y) == pytest.approx(3e-3, abs=1e-4) if name == "along" else abs(x - 30e-3) == pytest.approx(3e-3)
    assert not [text for text in plot(universal).axes[0].texts if text.get_text() == "lumen"]


def test_a_branch_s_name_keeps_away_from_the_arrows(branched):
    spots = [np.array([[x, 3e-3]]) for x in (10e-3, 20e-3)]
    figure = new_figure(4, 4)
    for busy in spots:
        axes = figure.add_subplot()
        limits = np.array([[-10e-3, -10e-3], [60e-3, 60e-3]])
        draw_branch_names(axes, branched, limits, busy)
        (text,) = [text for text in axes.texts if text.get_text() == "along"]
        assert np.hypot(*(np.array(text.xy) * 1e-3 - busy[0])) > 4e-3
