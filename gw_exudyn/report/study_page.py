"""The page of a study: its points in a table and a chart, and each point by itself."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING, Any

import numpy as np

from gw_exudyn.report.columns import Column
from gw_exudyn.report.curves import Curves
from gw_exudyn.report.pack import scalars_table
from gw_exudyn.report.packing import base64_text
from gw_exudyn.report.parts import filled, picture, table

if TYPE_CHECKING:
    from gw_exudyn.result import Floats

SCRIPTS = ("base.js", "data.js", "scene.js", "chart.js", "player.js", "grid.js", "scatter.js", "study.js")


class Outcome(IntEnum):
    """What a point came to: it failed or can't be trusted, it is good, it was not run."""

    FAILED = 0
    GOOD = 1
    NOT_RUN = 2


class Kept(IntEnum):
    """What there is of a point beside the page."""

    NOTHING = 0
    SERIES = 1
    WHOLE = 2


@dataclass(frozen=True)
class StudyPage:
    """What the page tells of a study.

    columns : of its points; the first names a point, and by their role there are one `id`, `status` and `reason`,
    `parameter`s in SI, labelled with their paths, and `metric`s. outcome, kept : (points,) of `Outcome` and `Kept`.
    folder : of the study, as a person types it. elsewhere : folders in it of whole runs, by point. runs : runs as
    `packed_run` gives them, by point. command : words that run a scenario of the study but for its parameters; empty
    where there is no such command. planned : points of the study, where that are more than these. values : by path and
    word, what stands for a parameter's word in a scenario.
    first : point shown at first. varied, measured, indices, provenance : heads and rows of tables. notes : sentences.
    figures : PNG files by name.
    """

    title: str
    columns: Sequence[Column]
    outcome: Floats
    kept: Floats
    folder: str
    varied: tuple[Sequence[str], Sequence[Sequence[str]]]
    measured: tuple[Sequence[str], Sequence[Sequence[str]]]
    provenance: tuple[Sequence[str], Sequence[Sequence[str]]]
    indices: tuple[Sequence[str], Sequence[Sequence[str]]] | None = None
    curves: Curves | None = None
    runs: Mapping[int, Mapping[str, Any]] = field(default_factory=dict)
    elsewhere: Mapping[int, str] = field(default_factory=dict)
    command: Sequence[str] = ()
    values: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    first: int = 0
    planned: int = 0
    notes: Sequence[str] = ()
    figures: Mapping[str, bytes] = field(default_factory=dict)


def study_page(study: StudyPage) -> str:
    """The page as HTML text."""
    about = {
        "outcome": base64_text(study.outcome, "u1"),
        "kept": base64_text(study.kept, "u1"),
        "folder": study.folder,
        "elsewhere": dict(study.elsewhere),
        "runs": dict(study.runs),
        "command": list(study.command),
        "values": {path: dict(words) for path, words in study.values.items()},
        "first": study.first,
        "curves": study.curves.packed() if study.curves is not None else None,
    }
    data = {"study": about, "columns": [column.packed() for column in study.columns], "scalars": scalars_table()}
    parts = {
        "STATUS": _status(study),
        "VARIED": table(*study.varied) + table(*study.measured),
        "HINT": _hint(study),
        "INDICES": f"<section><h2>Sensitivity</h2>{table(*study.indices)}</section>" if study.indices else "",
        "FIGURES": _figures(study.figures),
        "PROVENANCE": table(*study.provenance),
    }
    return filled("study.html", SCRIPTS, study.title, data, parts)


def _status(study: StudyPage) -> str:
    counts = {outcome: int(np.count_nonzero(np.asarray(study.outcome) == outcome)) for outcome in Outcome}
    count = len(study.outcome)
    left = max(study.planned - count, 0)
    told = [f"{f'{count} of {study.planned}' if left else count} points: {counts[Outcome.GOOD]} came out well"]
    if counts[Outcome.FAILED]:
        told.append(f"{counts[Outcome.FAILED]} failed or can't be trusted")
    if counts[Outcome.NOT_RUN]:
        told.append(f"{counts[Outcome.NOT_RUN]} not run")
    kind = "bad" if counts[Outcome.FAILED] else "waiting" if counts[Outcome.NOT_RUN] or left else "good"
    notes = "".join(f'<p class="hint">{html.escape(note)}</p>' for note in study.notes)
    return f'<p class="status {kind}">{", ".join(told)}</p>{notes}'


def _hint(study: StudyPage) -> str:
    if not (np.asarray(study.outcome) == Outcome.FAILED).any():
        return ""
    return (
        "Points that failed are crosses, in red: they count neither for the axes nor for the colours, stand behind the "
        "others in the table, and their numbers are those of runs that can't be trusted."
    )


def _figures(figures: Mapping[str, bytes]) -> str:
    if not figures:
        return ""
    shown = "".join(picture(content, name.replace("_", " ")) for name, content in figures.items())
    return f"<section><h2>Figures</h2>{shown}</section>"
