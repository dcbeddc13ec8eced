"""fmu/README.md says what is so."""

from __future__ import annotations

from pathlib import Path

from gw_exudyn.fmi.page import readme_parts

README = (Path(__file__).resolve().parents[2] / "fmu" / "README.md").read_text(encoding="utf-8")


def test_it_says_what_the_fmus_own_page_says():
    parts = readme_parts()
    for part in parts:
        assert part in README, "python -m gw_exudyn.fmi.page makes it anew"
    assert README.endswith(parts[-1] + "\n")


def test_every_source_file_has_its_line():
    from gw_exudyn.fmi.wrapper import SOURCES

    for name in SOURCES:
        assert f"`{name}`" in README
