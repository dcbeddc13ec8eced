"""The page of a study in a browser: it sorts, filters and finds points; failed ones are told apart; it stays light."""

from __future__ import annotations

import shlex

import pytest
from studies import FAILED, NOT_RUN, made_up_study

from gw_exudyn.report.parts import save_page
from gw_exudyn.report.study_page import study_page


@pytest.fixture
def page(opened, tmp_path):
    return opened(save_page(study_page(made_up_study()), tmp_path / "study.html"))


def frames(page):
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


def column(page, label):
    """Texts of a column, as they stand."""
    frames(page)
    heads = page.locator("#points thead th").all_inner_texts()
    place = next(i for i, head in enumerate(heads) if head.startswith(label))
    return page.locator(f"#points tbody tr[data-row] td:nth-child({place + 1})").all_inner_texts()


def head(page, label):
    return page.locator("#points thead button", has_text=label).first


def put(page, label, text):
    page.get_by_label(f"filter {label}", exact=True).fill(text)
    frames(page)


def place(page, row):
    """Where the mark of a row is on the screen."""
    frames(page)
    x, y = page.evaluate(f"() => [scatter.place.px[{row}], scatter.place.py[{row}]]")
    box = page.locator("#scatter").bounding_box()
    return box["x"] + x, box["y"] + y


def test_it_needs_nothing_else():
    page = study_page(made_up_study())
    assert "http" not in page
    assert "<!--" not in page


def test_a_head_sorts_up_down_and_back(page):
    first = column(page, "point")
    head(page, "push force max [mN]").click()
    up = [float(text) for text in column(page, "push force max [mN]")[:10]]
    assert up == sorted(up)
    head(page, "push force max [mN]").click()
    down = column(page, "push force max [mN]")
    # What failed stands behind the rest in both directions, with its 5 N; what has no number last.
    assert [float(text) for text in down[:10]] == up[::-1]
    assert down[10:] == ["5000", "-"]
    assert head(page, "push force max [mN]").locator("..").get_attribute("aria-sort") == "descending"
    head(page, "push force max [mN]").click()
    assert column(page, "point") == first


def test_numbers_are_filtered_in_the_unit_on_show(page):
    found = {"> 110": 2, ">=110": 3, "> 20 < 40": 1, "20..50": 3, "20 to 50": 3, "20": 1, "none": 1, "": 12}
    for text, rows in found.items():
        put(page, "push force max [mN]", text)
        assert len(column(page, "point")) == rows, text
        assert page.locator(".counted").inner_text() == ("12 rows" if rows == 12 else f"{rows} of 12 rows")


def test_words_are_filtered(page):
    for text, rows in {"amplatz": 6, "!amplatz": 6, "amp|uni": 12, "=universal": 0}.items():
        put(page, "wire.model", text)
        assert page.locator("#points tbody tr[data-row]").count() == rows, text


def test_filters_add_up_a_wrong_one_is_marked_and_all_can_be_cleared(page):
    put(page, "wire.model", "amplatz")
    put(page, "status", "=completed")
    assert column(page, "point") == ["1", "7", "9", "11"]
    put(page, "push force max [mN]", "> a")
    assert page.get_by_label("filter push force max [mN]").get_attribute("aria-invalid") == "true"
    page.get_by_role("button", name="clear filters").click()
    assert len(column(page, "point")) == 12


def test_a_click_in_the_chart_chooses_the_point(page):
    page.mouse.click(*place(page, 8))
    assert page.locator("#chosen").inner_text() == "point 8"
    assert page.locator("#points tr[aria-selected=true] td").first.inner_text() == "8"
    assert "90 mN" in page.locator("#values").inner_text()


def test_a_row_that_is_filtered_out_cannot_be_hit_in_the_chart(page):
    put(page, "point", "< 8")
    page.mouse.click(*place(page, 8))
    assert page.locator("#chosen").inner_text() == "point 0"


def test_a_touch_in_the_chart_and_the_buttons_choose(page):
    page.touchscreen.tap(*place(page, 2))
    assert page.locator("#chosen").inner_text() == "point 2"
    page.locator("#after").tap()
    assert page.locator("#chosen").inner_text() == f"point {FAILED}"


def test_the_pointer_reads_a_point(page):
    page.mouse.move(*place(page, 4))
    assert "push force max 50 mN" in page.locator("#mark").inner_text()


def test_keys_move_through_table_and_chart_and_leave_the_filters_alone(page):
    page.locator("#points .port").focus()
    page.keyboard.press("ArrowDown")
    page.keyboard.press("ArrowDown")
    assert page.locator("#chosen").inner_text() == "point 2"
    page.keyboard.press("End")
    assert page.locator("#chosen").inner_text() == "point 11"
    page.locator("#scatter").focus()
    page.keyboard.press("ArrowLeft")
    assert page.locator("#chosen").inner_text() == "point 10"
    page.keyboard.press("Home")
    assert page.locator("#chosen").inner_text() == "point 0"
    box = page.get_by_label("filter wire.model")
    box.focus()
    page.keyboard.type("a 0")
    assert box.input_value() == "a 0"
    assert page.locator("#play").inner_text() == "play"


def test_the_other_axes_draw_another_chart(page):
    frames(page)
    before = page.evaluate("() => $('scatter').toDataURL()")
    for name in ("x", "y", "colour"):
        page.locator(f"#{name}").select_option(label="push force max time [s]" if name == "y" else "wire.model")
    frames(page)
    assert page.evaluate("() => $('scatter').toDataURL()") != before


def test_a_failed_point_is_told_apart_everywhere(page):
    assert "10 came out well, 1 failed or can't be trusted, 1 not run" in page.locator("header").inner_text()
    assert page.locator("#points tr.bad").count() == 1
    assert page.locator("#points tr.waiting").count() == 1
    # It does not stretch the axis: 5 N where the others reach 120 mN.
    x, y = place(page, FAILED)
    assert page.evaluate("() => scatter.place.up.high") == pytest.approx(124.4, abs=1)
    page.mouse.click(x, y)
    assert page.locator("#outcome").inner_text() == "too_deep (not to be trusted) Pressed into a wall"
    assert "not to be trusted" in page.locator("#legend").inner_text()
    # Without a number it lies in a strip of its own.
    page.locator("#y").select_option(label="push force max time [s]")
    frames(page)
    assert page.evaluate(f"() => scatter.place.py[{FAILED}] > scatter.place.bottom")


def test_a_point_that_was_not_run_has_nothing_to_show(page):
    page.locator(f"#points tr[data-row='{NOT_RUN}']").click()
    assert page.locator("#player").is_hidden()
    assert page.locator("#without").is_visible()
    assert "Nothing" in page.locator("#kept").inner_text()


def test_the_command_runs_the_point_again_to_the_last_digit(page):
    page.locator("#points tr[data-row='1']").click()
    words = shlex.split(page.locator("#command").inner_text())
    assert words[:5] == ["gw-exudyn", "run", "straight", "--set", "output.interval=0.5 s"]
    given = dict(word.split("=", 1) for word in words[6::2])
    assert float(given["contact.friction_coefficient"]) == 0.1 + 1e-7 * 1.5
    assert given["drive.distance"] == "2.0e-7"  # as YAML needs it to be a number
    assert given["wire.model"] == "amplatz-super-stiff"


def test_a_study_that_no_command_runs_again_has_none(opened, tmp_path):
    page = opened(save_page(study_page(made_up_study(command=())), tmp_path / "study.html"))
    assert page.locator("#again").is_hidden()


def test_curves_of_points_that_are_held_stay_on_show(page):
    for row in (1, 2):
        page.locator(f"#points tr[data-row='{row}']").click()
        page.locator("#hold").click()
    page.locator("#points tr[data-row='7']").click()
    assert page.locator("#legend label").all_inner_texts() == ["point 7", "point 1", "point 2"]
    page.locator("#player #chart").focus()
    page.keyboard.press("End")
    frames(page)
    # 1 mN a row at the end, in 16 bits.
    readings = page.locator("[data-reading=push_force]").all_inner_texts()
    assert readings == ["8 mN", "2 mN", "3 mN"]


def test_columns_can_be_added(opened, tmp_path):
    page = opened(save_page(study_page(made_up_study(metrics=4)), tmp_path / "study.html"))
    before = page.locator("#points thead th").count()
    page.locator(".chooser summary").click()
    page.get_by_role("checkbox", name="further 1").check()
    assert page.locator("#points thead th").count() == before + 1


def test_ten_thousand_points_keep_few_rows_in_the_document(opened, tmp_path):
    file = save_page(study_page(made_up_study(10_000, metrics=45, instants=80)), tmp_path / "study.html")
    assert file.stat().st_size < 5e6
    page = opened(file, 390, 844)
    frames(page)
    assert page.locator("tr").count() < 150
    head(page, "push force max [N]").click()
    page.locator("#points .port").evaluate("port => { port.scrollTop = port.scrollHeight; }")
    frames(page)
    assert page.locator("tr").count() < 150
    assert column(page, "point")[-2:] == [str(FAILED), str(NOT_RUN)]
    # No wider than a telephone.
    assert page.evaluate("() => document.documentElement.scrollWidth") <= 390
