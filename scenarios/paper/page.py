"""The whole study on one page, index.html: every figure, every table, and the paper's statements beside ours.

Reads what the other scripts wrote and the words of results/README.md; runs nothing.
"""

from __future__ import annotations

import dataclasses
import re
import sys
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import shared

from gw_exudyn.report import Section, Sheet, document_page, save_page
from gw_exudyn.result import Status

WORDS = shared.OUT.parent / "README.md"
LEFT_OUT = ("timings", "table2-times")
"""Tables that are never the same twice; the page, which is, names them only."""

VERDICTS = {
    "holds": "hold",
    "holds (by construction)": "hold by construction",
    "in part": "hold in part",
    "does not hold": "do not hold",
}
FINDING = ("finding", "verdict", "number", "test", "place")
"""Columns of the findings in the order of the page."""


@dataclass(frozen=True)
class Part:
    """What the page shows of a script: a title, pictures with what they show, and tables with titles."""

    script: str
    title: str
    pictures: Mapping[str, str]
    tables: Mapping[str, str]


PARTS = (
    Part("fig4", "Bending stiffness by three-point bending",
         {"fig4": "Apparent bending stiffness along both wires"}, {"fig4": "Stations"}),
    Part("fig6", "Path and contact", {"fig6": "Paths of both wires, and contact with the wall over depth"},
         {"fig6-summary": "Contact and place of the tip", "fig6": "Contact over depth"}),
    Part("table2", "Number of segments",
         {"fig7": "Path of the tip at several numbers of segments", "table2-error": "Error over their number"},
         {"table2": "Errors", "table2-orders": "Orders", "fig7": "Paths of the tip"}),
    Part("fig8", "Force on the vessel", {"fig8": "Force along y of both wires over time"},
         {"fig8-peaks": "Peaks", "fig8": "Force over time"}),
    Part("fig9", "Friction", {"fig9": "Force along y of the Amplatz at several frictions over time"},
         {"fig9-summary": "Forces and energies by friction", "fig9-peaks": "Peaks", "fig9": "Force over time"}),
    Part("reach", "Which wire reaches a side branch", {"reach": "Reach and force by wire, angle and diameter"},
         {"reach": "All runs"}),
    Part("uncertainty", "What unknown friction and stiffness do",
         {"uncertainty": "Bands of the push force, and which parameter they come from"},
         {"uncertainty-indices": "Sensitivity indices", "uncertainty-band": "Bands over depth",
          "uncertainty": "All runs"}),
    Part("constant_force", "Insertion at constant force", {"constant-force": "Depth over time at constant force"},
         {"constant-force-summary": "Depth reached", "constant-force": "Depth over time"}),
    Part("pull_back", "Pull-back", {"pull-back": "Force in and out over depth"},
         {"pull-back-summary": "Forces and energies", "pull-back": "Force over depth"}),
)  # fmt: skip
"""In the order of the page."""


def main(out: Path = shared.OUT, quick: bool = False) -> None:
    """Write index.html."""
    words = WORDS.read_text(encoding="utf-8")
    rows = statements(words)
    sections = [_findings(out, words), *(_section(part, rows[part.script], out) for part in PARTS), _causes(out, words)]
    lead = [
        "Every figure and table of the study of a guidewire pushed into a branching phantom, with what the paper says "
        "beside what comes out here. `make paper` makes all of it anew. How long the runs took is in "
        "[timings.csv](timings.csv) and [table2-times.csv](table2-times.csv).",
        *cautions(words),
    ]
    save_page(document_page("The study of Sharei et al. 2019", lead, sections), out / "index.html")


def statements(words: str) -> dict[str, list[tuple[str, str]]]:
    """What the tables of README.md tell of each script: pairs of a column's head and a text."""
    found: dict[str, list[tuple[str, str]]] = {}
    head: list[str] = []
    for line in words.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("|") else []
        if "script" in cells:
            head = cells
        elif head and len(cells) == len(head) and not set(cells[0]) <= set("-"):
            row = dict(zip(head, cells, strict=True))
            script = row.pop("script").strip("`").removesuffix(".py")
            found[script] = [(name, text) for name, text in row.items() if text]
    return found


def cautions(words: str) -> list[str]:
    """What is to be read before any number."""
    block = words.partition("Read before any number:")[2].partition("\n|")[0]
    return [" ".join(item.split()) for item in re.split(r"^- ", block, flags=re.MULTILINE)[1:]]


def _paragraphs(words: str, head: str) -> list[str]:
    """Paragraphs under a head of README.md, links as seen from the page."""
    block = words.partition(f"### {head}\n")[2].partition("\n#")[0]
    return [" ".join(text.split()).replace("](paper/", "](") for text in block.strip().split("\n\n")]


def _sheet(title: str, name: str, out: Path) -> Sheet:
    path = out / f"{name}.csv"
    if not path.exists():
        sys.exit(f"{path}: is not there; run the script that makes it first, or make paper")
    rows = shared.read_table(path)
    bad = frozenset(i for i, row in enumerate(rows) if "status" in row and not Status[row["status"].upper()].trusted)
    return Sheet(title, rows, path.name, bad)


def _section(part: Part, told: list[tuple[str, str]], out: Path) -> Section:
    texts = dict(told)
    place = texts.pop("paper", "")
    sheets = [_sheet(title, name, out) for name, title in part.tables.items()]
    pictures = {out / f"{name}.png": shown for name, shown in part.pictures.items()}
    title = f"{part.title} ({place})" if place else part.title
    return Section(part.script, title, list(texts.items()), pictures, sheets)


def _findings(out: Path, words: str) -> Section:
    """The paper's sentences as checks, and how many of them hold."""
    read = _sheet("Sentences of the paper as checks", "findings", out)
    sheet = dataclasses.replace(read, rows=[{key: row[key] for key in FINDING} for row in read.rows], wrap=True)
    counts = Counter("in part" if row["verdict"].startswith("in part") else row["verdict"] for row in sheet.rows)
    told = ", ".join(f"{counts[verdict]} {shown}" for verdict, shown in VERDICTS.items() if counts[verdict])
    lines = (out / "findings.md").read_text(encoding="utf-8").splitlines()
    oddities = [line.removeprefix("- ") for line in lines if line.startswith("- ")]
    summary = _paragraphs(words, "The paper's findings, as checks")[0]
    return Section(
        "findings",
        "The paper's findings, as checks",
        [
            ("over low, best and high estimates of EI", f"Of {len(sheet.rows)} sentences {told}.\n\n{summary}"),
            ("oddities of the paper, left as they are", "\n\n".join(oddities)),
        ],
        sheets=[sheet],
    )


def _causes(out: Path, words: str) -> Section:
    texts = [("", text) for text in _paragraphs(words, "The paper's findings, as checks")[1:]]
    sheets = [_sheet("One property changed at a time", "causes", out)]
    return Section("causes", "What makes the paths differ", texts, sheets=sheets)


if __name__ == "__main__":
    shared.command(main)
