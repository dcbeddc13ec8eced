"""fmu/README.md says what is so."""

from __future__ import annotations

from pathlib import Path

from gw_exudyn.fmi.page import readme_table

README = (Path(__file__).resolve().parents[2] / "fmu" / "README.md").read_text(encoding="utf-8")


def test_the_table_of_variables_is_the_present_one():
    assert README.endswith(readme_table() + "\n"), "python -m gw_exudyn.fmi.page makes it anew"


def test_every_source_file_has_its_line():
    from gw_exudyn.fmi.wrapper import SOURCES

    for name in SOURCES:
        assert f"`{name}`" in README
