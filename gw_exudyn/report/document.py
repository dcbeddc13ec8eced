"""A page of sections with texts, figures and tables that sort and filter; all of it in one file."""

from __future__ import annotations

import html
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from gw_exudyn.report.columns import Column, text_column
from gw_exudyn.report.packing import base64_text
from gw_exudyn.report.parts import filled, picture

SCRIPTS = ("base.js", "grid.js", "document.js")
_SHORT = 60
"""Rows of a table that is open at first."""


@dataclass(frozen=True)
class Sheet:
    """A table of a page.

    title : its head. rows : cells as text, by the columns' heads (`peak_force [mN]`); at least one. file : it lies
    beside the page in that file. bad : numbers of the rows that can't be trusted. open : shown at first; by its length
    if not given. wrap : of sentences, shown in full; not for hundreds of rows.
    """

    title: str
    rows: Sequence[Mapping[str, str]]
    file: str = ""
    bad: frozenset[int] = frozenset()
    open: bool | None = None
    wrap: bool = False

    def columns(self) -> list[Column]:
        """Its columns, those of numbers as numbers."""
        return [text_column(head.replace("_", " "), [row[head] for row in self.rows]) for head in self.rows[0]]


@dataclass(frozen=True)
class Section:
    """A section of a page.

    name : its anchor. title : its head. texts : pairs of a heading (or nothing) and a text, in which `**bold**`,
    `` `code` `` and `[words](link)` are understood, and an empty line begins a paragraph. pictures : PNG files with
    what they show; they are put into the page, and a PDF of the same name beside it is linked.
    """

    name: str
    title: str
    texts: Sequence[tuple[str, str]] = ()
    pictures: Mapping[Path, str] = field(default_factory=dict)
    sheets: Sequence[Sheet] = ()


def document_page(title: str, lead: Sequence[str], sections: Sequence[Section]) -> str:
    """The page as HTML text, the same bytes for the same content. lead : paragraphs under the title."""
    sheets = [sheet for section in sections for sheet in section.sheets]
    parts = {
        "LEAD": "".join(f"<p>{inline(text)}</p>" for text in lead),
        "CONTENTS": "".join(f'<li><a href="#{one.name}">{html.escape(one.title)}</a></li>' for one in sections),
        "SECTIONS": "\n".join(_section(section, sheets) for section in sections),
    }
    return filled("document.html", SCRIPTS, title, {"sheets": [_packed(sheet) for sheet in sheets]}, parts)


def inline(text: str) -> str:
    """Text with its bold words, code and links as HTML."""
    found = html.escape(text, quote=False)
    found = re.sub(r"`([^`]+)`", r"<code>\1</code>", found)
    found = re.sub(r"\*\*([^*]+)\*\*", r"<b>\1</b>", found)
    return re.sub(r"\[([^\]]+)\]\(([^)\s\"]+)\)", r'<a href="\2">\1</a>', found)


def _section(section: Section, sheets: Sequence[Sheet]) -> str:
    texts = "".join(_text(head, text) for head, text in section.texts)
    pictures = "".join(_picture(file, words) for file, words in section.pictures.items())
    tables = "".join(_sheet(sheet, next(i for i, one in enumerate(sheets) if one is sheet)) for sheet in section.sheets)
    head = f'<h2>{html.escape(section.title)} <a class="up" href="#contents" aria-label="contents">&#8593;</a></h2>'
    return f'<section id="{section.name}">{head}<div class="texts">{texts}</div>{pictures}{tables}</section>'


def _text(head: str, text: str) -> str:
    paragraphs = "".join(f"<p>{inline(part)}</p>" for part in text.split("\n\n"))
    return f"<div>{f'<h3>{html.escape(head)}</h3>' if head else ''}{paragraphs}</div>"


def _picture(file: Path, words: str) -> str:
    caption = f'{html.escape(words)} (<a href="{file.with_suffix(".pdf").name}">PDF</a>)'
    return picture(file.read_bytes(), words, caption)


def _sheet(sheet: Sheet, number: int) -> str:
    shown = len(sheet.rows) <= _SHORT if sheet.open is None else sheet.open
    file = f'<p class="hint"><a href="{sheet.file}">{html.escape(sheet.file)}</a></p>' if sheet.file else ""
    summary = f"<summary>{html.escape(sheet.title)}, {len(sheet.rows)} rows</summary>"
    return (
        f'<details class="sheet"{" open" if shown else ""}>{summary}'
        f'<div id="sheet-{number}" class="rows"></div>{file}</details>'
    )


def _packed(sheet: Sheet) -> dict[str, object]:
    bad = np.array([row in sheet.bad for row in range(len(sheet.rows))])
    columns = [column.packed() for column in sheet.columns()]
    return {"title": sheet.title, "wrap": sheet.wrap, "bad": base64_text(bad, "u1"), "columns": columns}
