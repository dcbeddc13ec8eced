"""What all pages share: templates and their assets put together, tables, pictures, and how a page is written."""

from __future__ import annotations

import base64
import html
import json
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

from gw_exudyn.errors import StorageError


def filled(template: str, scripts: Sequence[str], title: str, data: Mapping[str, Any], parts: Mapping[str, str]) -> str:
    """A page from the template of its body: style, scripts, title (plain text), the scripts' data, HTML parts by name.

    Raises ValueError for data with numbers that are not finite.
    """
    given = {
        "PLAYER": asset("player.html") if "player.js" in scripts else "",
        **parts,
        "TITLE": html.escape(title),
        "STYLE": asset("style.css"),
        "SCRIPT": "\n".join(asset(name) for name in scripts),
        "DATA": _script_safe(json.dumps(data, allow_nan=False)),
    }
    page = asset("frame.html").replace("<!--BODY-->\n", asset(template))
    for name, text in given.items():
        page = page.replace(f"<!--{name}-->", text)
    return page


def asset(name: str) -> str:
    """The text of a template, a style or a script."""
    return files("gw_exudyn.report").joinpath("assets", name).read_text(encoding="utf-8")


def _script_safe(text: str) -> str:
    """JSON that may stand inside a script element."""
    return text.replace("</", "<\\/")


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A plain table of plain texts."""

    def cells(row: Sequence[str], tag: str) -> str:
        return "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in row)

    body = "".join(f"<tr>{cells(row, 'td')}</tr>" for row in rows)
    return f'<div class="wide"><table><thead><tr>{cells(head, "th")}</tr></thead><tbody>{body}</tbody></table></div>'


def picture(content: bytes, words: str, caption: str = "") -> str:
    """A PNG inside the page. words : what it shows, for those who do not see it. caption : HTML below it."""
    source = f"data:image/png;base64,{base64.b64encode(content).decode('ascii')}"
    below = f"<figcaption>{caption}</figcaption>" if caption else ""
    return f'<figure><img alt="{html.escape(words)}" loading="lazy" src="{source}">{below}</figure>'


def save_page(page: str, path: str | Path) -> Path:
    """Write a page and return its path; it appears whole or not at all.

    Raises StorageError where the disk refuses.
    """
    from gw_exudyn.storage.run_folder import write_file

    target = Path(path)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        write_file(target, page.encode())
    except OSError as error:
        raise StorageError(f"{target}: can't be written: {error.strerror or error}; name another place") from error
    return target
