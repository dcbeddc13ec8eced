"""The page in a browser: it plays, scrubs, zooms and reads, by pointer, key and touch, without a complaint."""

from __future__ import annotations

import pytest
from synthetic import StandInWire, made_up_result

from gw_exudyn.report import save_report


@pytest.fixture
def page(opened, tmp_path):
    """The page of two runs."""
    runs = [made_up_result(segments=60), made_up_result("other", wire=StandInWire(0.89e-3, "amplatz-super-stiff"))]
    return opened(save_report(runs, tmp_path / "report.html", figures=False))


def clock(page):
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    return float(page.locator("#clock").inner_text().split()[0])


def pixels(page, canvas):
    return page.evaluate(f"() => document.getElementById('{canvas}').toDataURL()")


def test_a_click_in_the_curve_moves_everything(page):
    before = pixels(page, "scene")
    box = page.locator("#chart").bounding_box()
    page.mouse.click(box["x"] + 0.7 * box["width"], box["y"] + 80)
    assert clock(page) > 0
    assert pixels(page, "scene") != before
    assert page.locator("#readings th").first.inner_text() == f"at {clock(page):.2f} s"


def test_dragging_in_the_curve_scrubs(page):
    box = page.locator("#chart").bounding_box()
    page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 80)
    page.mouse.down()
    early = clock(page)
    page.mouse.move(box["x"] + 0.8 * box["width"], box["y"] + 80, steps=5)
    page.mouse.up()
    assert clock(page) > early > 0


def test_keys_step_jump_and_play(page):
    page.locator("#scene").focus()
    page.keyboard.press("ArrowRight")
    one = clock(page)
    assert one > 0
    page.keyboard.press("Shift+ArrowRight")
    assert clock(page) > 5 * one
    page.keyboard.press("End")
    end = clock(page)
    page.keyboard.press("Home")
    assert clock(page) == 0
    page.keyboard.press(" ")
    page.wait_for_function("() => parseFloat(document.getElementById('clock').textContent) > 0")
    assert page.locator("#play").inner_text() == "pause"
    page.keyboard.press(" ")
    assert page.locator("#play").inner_text() == "play"
    assert clock(page) <= end


def test_the_slider_and_the_play_button(page):
    page.locator("#scrub").evaluate("slider => { slider.value = 500; slider.dispatchEvent(new Event('input')); }")
    assert clock(page) > 0
    page.locator("#play").click()
    assert page.locator("#play").inner_text() == "pause"


def test_the_pointer_reads_the_wire(page):
    page.keyboard.press("End")
    clock(page)
    x, y = page.evaluate(
        "() => { const at = 2 * RUNS[0].nodes * (RUNS[0].time.length - 1) + 2 * (RUNS[0].nodes - 1);"
        " return scene.px(RUNS[0].course[at], RUNS[0].course[at + 1]); }"
    )
    box = page.locator("#scene").bounding_box()
    page.mouse.move(box["x"] + x + 1, box["y"] + y + 1)
    assert page.locator("#tooltip").is_visible()
    assert " mm" in page.locator("#tooltip").inner_text() or " N" in page.locator("#tooltip").inner_text()


def test_wheel_zooms_and_fit_comes_back(page):
    before = page.evaluate("() => scene.scale")
    box = page.locator("#scene").bounding_box()
    page.mouse.move(box["x"] + 100, box["y"] + 100)
    page.mouse.wheel(0, -300)
    page.wait_for_function(f"() => scene.scale > {before}")
    page.locator("#fit").click()
    assert page.evaluate("() => scene.scale") == pytest.approx(before)


def test_a_run_can_be_hidden_and_another_curve_shown(page):
    page.locator("#legend input").nth(1).uncheck()
    clock(page)
    assert page.locator("#readings th").count() == 2
    before = pixels(page, "chart")
    page.locator("#curve").select_option("wall_force_y")
    page.locator("#against").select_option("insertion_depth")
    clock(page)
    assert pixels(page, "chart") != before


def test_a_touch_in_the_curve_scrubs(page):
    box = page.locator("#chart").bounding_box()
    page.touchscreen.tap(box["x"] + 0.5 * box["width"], box["y"] + 80)
    assert clock(page) > 0


def test_a_thin_wire_is_drawn_over_a_thick_one_on_its_way(page):
    drawn = page.evaluate(
        "() => { const found = [], draw = scene.drawWire; scene.drawWire = run => found.push(run.diameter);"
        " scene.draw(0); scene.drawWire = draw; return found; }"
    )
    assert drawn == sorted(drawn, reverse=True)
    assert drawn[0] > drawn[-1]
