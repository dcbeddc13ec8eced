"""A page of sections in a browser: tables open, sort and filter; rows that can't be trusted are told apart."""

from __future__ import annotations

import matplotlib.image
import numpy as np
import pytest

from gw_exudyn.report import Section, Sheet, document_page, save_page
from gw_exudyn.report.document import inline

ROWS = [
    {
        "wire": f"wire {row}",
        "force_y [mN]": "" if row == 1 else f"{row * 10}",
        "status": "too_deep" if row == 2 else "ok",
    }
    for row in range(5)
]
LONG = [{"time [s]": f"{row}", "push [mN]": f"{row % 7}"} for row in range(400)]


@pytest.fixture
def page(opened, tmp_path):
    sheets = [Sheet("Short", ROWS, "short.csv", frozenset({2})), Sheet("Long", LONG), Sheet("Words", ROWS, wrap=True)]
    drawn = tmp_path / "drawn.png"
    matplotlib.image.imsave(drawn, np.zeros((20, 30)))
    text = [("head", "some **bold** `code`")]
    sections = [Section("one", "One <b>", text, {drawn: "a picture"}, sheets), Section("two", "Two")]
    return opened(save_page(document_page("A & B", ["See [it](short.csv)."], sections), tmp_path / "index.html"))


def test_tables_sort_filter_and_tell_failed_rows_apart(page):
    rows = page.locator("#sheet-0 tbody tr[data-row]")
    assert page.locator("#sheet-0 thead th").nth(1).inner_text().strip() == "force y [mN]"
    page.locator("#sheet-0 thead button").nth(1).click()
    page.locator("#sheet-0 thead button").nth(1).click()
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    assert [text.split()[1] for text in rows.all_inner_texts()] == ["4", "3", "0", "2", "1"]
    assert page.locator("#sheet-0 tr.bad").all_inner_texts() == [rows.nth(3).inner_text()]
    page.get_by_label("filter force y [mN]").first.fill("> 25")
    page.wait_for_function("() => document.querySelectorAll('#sheet-0 tr[data-row]').length === 2")


def test_a_long_table_is_made_when_it_is_opened(page):
    assert page.locator("#sheet-1 tr").count() == 0
    page.locator("summary", has_text="Long").click()
    page.wait_for_selector("#sheet-1 tr[data-row]")
    assert page.locator("#sheet-1 tr").count() < 100


def test_contents_lead_to_sections_and_names_cannot_break_the_page(page):
    assert page.title() == "A & B"
    links = page.locator("#contents a")
    assert links.all_inner_texts() == ["One <b>", "Two"]
    assert [page.locator(href).count() for href in ("#one", "#two")] == [1, 1]
    assert page.locator("#one b").inner_text() == "bold"


def test_pictures_are_in_the_page_itself(page, tmp_path):
    (tmp_path / "drawn.png").unlink()
    page.reload()
    image = page.get_by_alt_text("a picture")
    image.scroll_into_view_if_needed()
    page.wait_for_function("() => document.querySelector('figure img').naturalWidth === 30")
    assert page.locator("figcaption a").get_attribute("href") == "drawn.pdf"


def test_words_are_marked_up_and_made_safe():
    assert inline("**a** `b` [c](d.csv) <e>") == '<b>a</b> <code>b</code> <a href="d.csv">c</a> &lt;e&gt;'
