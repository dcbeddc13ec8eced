"""`docs/theory.md` names functions that exist, and every numbered equation of the paper."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import pytest

THEORY = (Path(__file__).resolve().parents[2] / "docs" / "theory.md").read_text(encoding="utf-8")
NAMES = sorted(set(re.findall(r"`(gw_exudyn(?:\.\w+)+)`", THEORY)))


def test_every_equation_has_its_row():
    first_cells = re.findall(r"^\| (.*?) \|", THEORY, re.MULTILINE)
    numbered = {int(number) for cell in first_cells for number in re.findall(r"\((\d+)\)", cell)}
    assert numbered == set(range(1, 15))


@pytest.mark.parametrize("name", NAMES)
def test_what_it_names_is_there(name):
    """A module, or something in one."""
    try:
        import_module(name)
    except ModuleNotFoundError:
        module, _, member = name.rpartition(".")
        assert hasattr(import_module(module), member)
