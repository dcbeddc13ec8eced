"""No import runs upwards: the syntax trees say so, also for imports inside functions and for type checking only."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "gw_exudyn"

ABOVE_RESULT = {"errors", "quantities", "scenario", "result"}
MAY_IMPORT = {
    "errors": set(),
    "scenario": {"errors"},
    "quantities": {"errors"},
    "native": {"errors"},
    "model": {"errors", "quantities", "scenario", "native"},
    "engine": {"errors", "quantities", "scenario", "model"},
    "result": {"errors", "quantities", "scenario"},
    "metrics": ABOVE_RESULT,
    "comparison": ABOVE_RESULT,
    "measured": ABOVE_RESULT | {"comparison"},
    "plots": ABOVE_RESULT | {"metrics", "storage", "comparison"},
    "report": ABOVE_RESULT | {"metrics", "comparison", "plots", "storage"},
    "storage": ABOVE_RESULT | {"metrics", "plots"},
    "sampling": ABOVE_RESULT | {"model", "engine"},
    "trust": ABOVE_RESULT | {"model", "engine"},
    "events": ABOVE_RESULT | {"model", "engine"},
    "simulation": ABOVE_RESULT | {"model", "engine", "sampling", "trust", "events"},
    "rl": ABOVE_RESULT | {"model", "simulation"},
    "fmi": ABOVE_RESULT | {"native", "model", "engine", "simulation"},
    "verification": ABOVE_RESULT
    | {"metrics", "comparison", "plots", "storage", "model", "engine", "trust", "simulation"},
    "sweep": ABOVE_RESULT | {"metrics", "plots", "report", "storage", "model", "engine", "simulation", "fmi"},
    "calibration": ABOVE_RESULT | {"comparison", "measured", "plots", "storage", "model", "sweep"},
}
"""What each place may import of ours, besides itself. The command line and the package's own face may import all."""

TOP = {"__init__", "__main__", "cli"}
MODULES = sorted(PACKAGE.rglob("*.py"))


def place_of(module: Path) -> str:
    return module.relative_to(PACKAGE).with_suffix("").parts[0]


def imported_names(module: Path) -> Iterator[str]:
    """Full dotted names of everything that a module imports, wherever the import stands."""
    for node in ast.walk(ast.parse(module.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{module}:{node.lineno}: a relative import; write the full name"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def our_places(module: Path) -> set[str]:
    """The places of ours that a module imports; `gw_exudyn` itself as "face"."""
    known = {place_of(other) for other in MODULES}
    found = {name.split(".")[1] for name in imported_names(module) if name.startswith("gw_exudyn.")}
    return {place if place in known else "face" for place in found}


@pytest.mark.parametrize("module", MODULES, ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_no_import_runs_upwards(module):
    place = place_of(module)
    if place in TOP:
        return
    assert place in MAY_IMPORT, f"give {place} its line in MAY_IMPORT"
    assert our_places(module) <= MAY_IMPORT[place] | {place}


@pytest.mark.parametrize("module", MODULES, ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_only_the_engine_imports_exudyn(module):
    if place_of(module) != "engine":
        assert not [name for name in imported_names(module) if name.split(".")[0] == "exudyn"]


def test_the_table_has_no_circle_but_that_of_storage_and_plots():
    # storage writes the figures of a run, and plots writes its files as storage does.
    order: list[str] = []
    pairs = {"storage": MAY_IMPORT["storage"] - {"plots"}}
    left = {place: set(below) for place, below in (MAY_IMPORT | pairs).items()}
    left["plots"] -= {"storage"}
    while left:
        free = [place for place, below in left.items() if below <= set(order)]
        assert free, f"a circle among {sorted(left)}"
        order += free
        for place in free:
            del left[place]


def test_a_forbidden_import_would_be_found(tmp_path):
    module = tmp_path / "sly.py"
    module.write_text("def f():\n    import exudyn.itemInterface\n    from gw_exudyn.simulation import simulate\n")
    assert list(imported_names(module)) == ["exudyn.itemInterface", "gw_exudyn.simulation.simulate"]
