"""Every script of the paper's study, short and coarse: it runs, and writes its tables and figures, the same twice."""

from __future__ import annotations

import base64
import importlib
import re
import shutil
import sys
from pathlib import Path

import pytest

from gw_exudyn import load_scenario
from gw_exudyn.report.document import inline

FOLDER = Path(__file__).resolve().parents[2] / "scenarios" / "paper"
WRITES = {
    "fig4": {"fig4.csv", "fig4.png", "fig4.pdf"},
    "fig6": {"fig6.csv", "fig6-summary.csv", "fig6.png", "fig6.pdf"},
    "fig8": {"fig8.csv", "fig8-peaks.csv", "fig8.png", "fig8.pdf"},
    "fig9": {"fig9.csv", "fig9-summary.csv", "fig9-peaks.csv", "fig9.png", "fig9.pdf"},
    "table2": {"fig7.csv", "fig7.png", "fig7.pdf", "table2.csv", "table2-orders.csv", "table2-error.png"},
    "reach": {"reach.csv", "reach.png", "reach.pdf"},
    "pull_back": {"pull-back.csv", "pull-back-summary.csv", "pull-back.png", "pull-back.pdf"},
    "constant_force": {"constant-force.csv", "constant-force-summary.csv", "constant-force.png"},
    "uncertainty": {"uncertainty.csv", "uncertainty-band.csv", "uncertainty-indices.csv", "uncertainty.png"},
    "findings": {"findings.csv", "findings.md", "causes.csv", "table2-times.csv"},
    "page": {"index.html"},
}
"""In the order in which they run: the last two read what the others wrote."""


@pytest.fixture(scope="module")
def study():
    """The scripts as modules, run in this process."""
    sys.path.insert(0, str(FOLDER))
    shared = importlib.import_module("shared")
    workers, shared.WORKERS = shared.WORKERS, 1
    yield importlib.import_module
    shared.WORKERS = workers
    sys.path.remove(str(FOLDER))


@pytest.fixture(scope="module")
def out(tmp_path_factory):
    return tmp_path_factory.mktemp("paper")


def test_every_script_is_tested_and_in_the_makefile():
    scripts = {path.stem for path in FOLDER.glob("*.py")} - {"shared", "corners"}
    assert scripts == set(WRITES)
    makefile = (FOLDER.parents[1] / "Makefile").read_text(encoding="utf-8")
    line = next(line for line in makefile.splitlines() if line.startswith("STUDY :="))
    assert line.split()[2:] == list(WRITES)


@pytest.mark.parametrize("script", WRITES)
def test_it_runs_and_writes_its_files(study, out, script):
    if script in ("findings", "page"):  # these read what those before them wrote, here or in another process
        for other in list(WRITES)[: list(WRITES).index(script)]:
            write(study, out, other)
    write(study, out, script)
    assert {path.name for path in out.iterdir()} >= WRITES[script]


def write(study, out, script):
    """Run a script, unless its files are there."""
    if script == "uncertainty":
        pytest.importorskip("SALib")
    if not {path.name for path in out.iterdir()} >= WRITES[script]:
        study(script).main(out, quick=True)


def test_a_script_writes_the_same_bytes_again_on_two_workers(study, tmp_path):
    script, shared = study("fig8"), study("shared")
    folders = tmp_path / "one", tmp_path / "two"
    for folder, workers in zip(folders, (1, 2), strict=True):
        shared.WORKERS = workers
        script.main(folder, quick=True)
    shared.WORKERS = 1
    for name in WRITES["fig8"]:
        assert (folders[0] / name).read_bytes() == (folders[1] / name).read_bytes(), name


def test_a_run_that_cannot_be_trusted_stops_the_script(study):
    from gw_exudyn import simulate

    shared = study("shared")
    short = {"wire.segments": 20, "drive.distance": 0.03, "contact.wall_stiffness": 0.05, "solver.step": 0.1}
    result = simulate(load_scenario("phantom-amplatz", short))
    assert not result.status.status.trusted
    with pytest.raises(SystemExit, match="phantom-amplatz"):
        shared.check([result])


def test_a_finding_is_told_as_it_is(study):
    finding = study("findings").Finding
    held = {"low": False, "best": True, "high": True}
    assert finding("a", "b", "c", held, "1").verdict == "in part: best, high; not low"
    assert finding("a", "b", "c", dict.fromkeys(held, False), "1").verdict == "does not hold"
    assert finding("a", "b", "c", dict.fromkeys(held, True), "1", True).verdict == "holds (by construction)"


def test_the_page_has_every_figure_table_and_statement_and_is_made_of_them(study, tmp_path):
    page = study("page")
    shutil.copytree(page.shared.OUT, tmp_path, dirs_exist_ok=True)
    committed = (tmp_path / "index.html").read_bytes()
    page.main(tmp_path)
    assert (tmp_path / "index.html").read_bytes() == committed, "make paper, or scenarios/paper/page.py"
    text = committed.decode()
    kept = {path.name for path in tmp_path.iterdir()} - {"index.html", "findings.md"}
    drawn = {name for name in kept if name.endswith(".png")}
    missing = {name for name in kept - drawn if f'"{name}"' not in text}
    missing |= {name for name in drawn if base64.b64encode((tmp_path / name).read_bytes()).decode() not in text}
    assert missing == set()
    links = set(re.findall(r'(?:href|src)="(?!#|data:)([^"]+)"', text))
    assert links - kept == {"findings.md"}
    told = page.statements(page.WORDS.read_text(encoding="utf-8"))
    assert set(told) == set(WRITES) - {"findings", "page"}
    for texts in told.values():
        for _, words in texts:
            assert inline(words) in text
