"""The page of a sweep, from its folder: finished, or as far as it got."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from gw_exudyn.metrics import Metric
from gw_exudyn.quantities import number_text
from gw_exudyn.report.columns import Column, si_column
from gw_exudyn.report.pack import packed_run
from gw_exudyn.report.parts import save_page
from gw_exudyn.report.study_page import Kept, Outcome, StudyPage, study_page
from gw_exudyn.result import Floats
from gw_exudyn.storage.manifest import MANIFEST
from gw_exudyn.storage.netcdf import DATA
from gw_exudyn.storage.series import SERIES
from gw_exudyn.sweep.finished import Points, read_about, read_points
from gw_exudyn.sweep.folder import POINTS, read_point
from gw_exudyn.sweep.page_curves import read_curves
from gw_exudyn.sweep.table import NOT_RUN

PAGE = "report.html"
EXTREMES = ("best", "worst")

_MOST_RUNS = 24
_FRAMES, _NODES = 150, 101
"""Of a run that the page plays."""

_MOST_NUMBERS = 600_000
"""Metrics of all points; with more than these the page leaves out those that the study is not about."""


def save_study_page(folder: Path, out: Path | None = None, *, title: str = "", figures: bool = True) -> Path:
    """Write the page of a sweep's folder, report.html in it if `out` is not given, and return its path.

    Raises StorageError for a folder that is no sweep, for one that is damaged, and where the disk refuses.
    """
    return save_page(study_page(page_of(folder, title=title, figures=figures)), out or folder / PAGE)


def page_of(folder: Path, *, title: str = "", figures: bool = True) -> StudyPage:
    """What the page of a sweep's folder tells."""
    about = read_about(folder)
    points = read_points(folder, about)
    known = _known_metrics(folder, points)
    shown, notes = _metrics_shown(about, points)
    elsewhere = _elsewhere(folder, points)
    if not points.whole:
        notes.append("The sweep did not come to its end; these points were done.")
    curves = read_curves(folder, points.ids, about["metrics"], points.whole) if points.ids else None
    if points.ids and curves is None:
        notes.append("The page has no curves: there are none, or too many for a page; sweep.nc has what there is.")
    return StudyPage(
        title=title or about["name"],
        columns=list(_columns(about, points, known, shown)),
        outcome=_outcomes(points),
        kept=_kept(folder, points),
        folder=folder.as_posix(),
        varied=_varied(about, points),
        measured=_measured(about, points, known),
        provenance=_provenance(about),
        indices=_indices(folder, about),
        curves=curves,
        runs=_runs(folder, points, elsewhere),
        elsewhere=elsewhere,
        command=_command(about),
        values=about.get("run", {}).get("values", {}),
        first=_first(about, points),
        planned=about["points"],
        notes=notes,
        figures=_figures(folder, about) if figures else {},
    )


def _known_metrics(folder: Path, points: Points) -> dict[str, Metric]:
    """Units and meanings of the metrics, as a point tells them that came out well; else of those that failed."""
    for row in sorted(range(len(points.ids)), key=lambda row: not points.trusted[row]):
        content = read_point(folder / POINTS / points.ids[row]) if points.status[row] != NOT_RUN else None
        if content is not None and content.get("metrics"):
            told = {
                name: Metric(0.0, e["unit"], e["meaning"], e.get("label", "")) for name, e in content["metrics"].items()
            }
            return {"wall_time": Metric(0.0, "s", "time of the solution on the clock"), **told}
    return {}


def _metrics_shown(about: Mapping[str, Any], points: Points) -> tuple[list[str], list[str]]:
    """Names of the metrics that the page has, and what there is to say about it."""
    mine = [name for name in about["metrics"] if name in points.metrics]
    rest = [name for name in points.metrics if name not in mine]
    if len(points.ids) * len(points.metrics) <= _MOST_NUMBERS:
        return mine + rest, []
    return mine, [f"{len(rest)} further metrics of so many points have no room in a page; sweep.csv has them."]


def _columns(
    about: Mapping[str, Any], points: Points, known: Mapping[str, Metric], shown: Sequence[str]
) -> Iterator[Column]:
    yield Column("point", np.array(points.numbers, dtype=float), role="point", digits=7)
    yield Column("id", points.ids, role="id", open=False, meaning="of what is run, and by what")
    for path, unit in about["parameters"].items():
        values = points.labels[path]
        if isinstance(values, np.ndarray):
            there = np.isfinite(values)
            yield si_column(path, path, unit, values, there, role="parameter", digits=6)
        else:
            yield Column(path, values, role="parameter")
    yield Column("status", points.status, role="status", meaning="how the point ended")
    for name in shown:
        meaning = known[name].meaning if name in known else ""
        about_it = {"role": "metric", "open": name in about["metrics"], "meaning": meaning}
        yield si_column(
            name, name.replace("_", " "), points.units[name], points.metrics[name], points.trusted, **about_it
        )
    yield Column("reason", points.reason, role="reason", open=any(points.reason), meaning="why it failed")


def _outcomes(points: Points) -> Floats:
    ran = np.array([status != NOT_RUN for status in points.status], dtype=bool)
    return np.where(points.trusted, Outcome.GOOD, np.where(ran, Outcome.FAILED, Outcome.NOT_RUN))


def _kept(folder: Path, points: Points) -> Floats:
    def kept(point: str) -> Kept:
        place = folder / POINTS / point
        return Kept.WHOLE if (place / DATA).is_file() else Kept.SERIES if (place / SERIES).is_file() else Kept.NOTHING

    return np.array([kept(point) for point in points.ids])


def _elsewhere(folder: Path, points: Points) -> dict[int, str]:
    """The best and the worst run by their rows, where they lie beside the points."""
    rows = {point: row for row, point in reversed(list(enumerate(points.ids)))}
    return {rows[found]: name for name in EXTREMES if (found := run_id(folder / name)) in rows}


def run_id(folder: Path) -> str:
    """The id of the point whose run a folder holds; empty where it holds none."""
    try:
        found = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))["provenance"]["point"]["id"]
    except (OSError, ValueError, KeyError, TypeError):
        return ""
    return str(found)


def _runs(folder: Path, points: Points, elsewhere: Mapping[int, str]) -> dict[int, dict[str, Any]]:
    """Whole runs for the player: the best and the worst, and others as far as there is room."""
    from gw_exudyn.storage import read_run

    places = {row: folder / name for row, name in elsewhere.items()}
    for row, point in enumerate(points.ids):
        place = folder / POINTS / point
        if len(places) < _MOST_RUNS and row not in places and (place / DATA).is_file():
            places[row] = place
    return {row: packed_run(read_run(place), _FRAMES, _NODES) for row, place in places.items()}


def _first(about: Mapping[str, Any], points: Points) -> int:
    """The best point: that with the smallest first metric; the first where none came out well."""
    values = points.metrics.get(about["metrics"][0])
    if values is None or not np.isfinite(values[points.trusted]).any():
        return 0
    return int(np.nanargmin(np.where(points.trusted, values, np.nan)))


def _varied(about: Mapping[str, Any], points: Points) -> tuple[list[str], list[list[str]]]:
    rows = []
    for path, unit in about["parameters"].items():
        values = points.labels[path]
        if not isinstance(values, np.ndarray):
            words = list(dict.fromkeys(values))
            rows.append([path, f"{', '.join(words[:20])}{', ...' if len(words) > 20 else ''}", str(len(words))])
            continue
        numbers = np.unique(values)
        texts = [number_text("", value, unit) for value in numbers]
        told = ", ".join(texts) if len(texts) <= 8 else f"{texts[0]} to {texts[-1]}"
        rows.append([path, told, str(len(numbers))])
    return ["parameter", f"values ({_how(about)})", "different ones"], rows


def _how(about: Mapping[str, Any]) -> str:
    words = {"grid": "all combinations", "zip": "the first of all, the second of all, ...", "list": "rows of a list"}
    return words.get(about["mode"]) or f"drawn: {about['method']}, seed {about['seed']}"


def _measured(
    about: Mapping[str, Any], points: Points, known: Mapping[str, Metric]
) -> tuple[list[str], list[list[str]]]:
    """The study's metrics over the points that came out well."""
    rows = []
    for name in about["metrics"]:
        values = points.metrics.get(name, np.full(len(points.ids), np.nan))[points.trusted]
        values = values[np.isfinite(values)]
        ends = [values.min(), np.median(values), values.max()] if len(values) else [None] * 3
        texts = [number_text(name, end, points.units.get(name, "1")) for end in ends]
        rows.append([name.replace("_", " "), *texts, known[name].meaning if name in known else ""])
    return ["metric", "smallest", "median", "largest", "meaning"], rows


def _indices(folder: Path, about: Mapping[str, Any]) -> tuple[list[str], list[list[str]]] | None:
    from gw_exudyn.sweep.sensitivity import INDICES

    if INDICES not in about.get("files", ()) or not (folder / INDICES).is_file():
        return None
    with open(folder / INDICES, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))

    def number(row: Mapping[str, str], key: str) -> str:
        return number_text("", float(row[key]), row["unit"]) if row[key] else "-"

    return ["metric", "parameter", "index", "value", "\u00b1 (95 %)", "meaning"], [
        [row["metric"].replace("_", " "), row["parameter"], row["index"], number(row, "value"),
         number(row, "confidence_95"), row["meaning"]]
        for row in rows
    ]  # fmt: skip


def _figures(folder: Path, about: Mapping[str, Any]) -> dict[str, bytes]:
    files = [folder / name for name in about.get("files", ()) if name.endswith(".png")]
    return {file.stem: file.read_bytes() for file in files if file.is_file()}


def _command(about: Mapping[str, Any]) -> list[str]:
    run = about.get("run", {})
    if not run.get("scenario"):
        return []
    fixed = [word for path, text in run["set"].items() for word in ("--set", f"{path}={text}")]
    return ["gw-exudyn", "run", run["scenario"], *fixed]


def _provenance(about: Mapping[str, Any]) -> tuple[list[str], list[list[str]]]:
    fixed = ", ".join(f"{path} = {value}" for path, value in about["set"].items())
    versions = ", ".join(f"{name} {version}" for name, version in about["versions"].items())
    rows = [["scenario", about["base"]], ["set in all points", fixed or "-"], ["command", about["command"] or "-"]]
    return ["what", ""], [*rows, ["versions", versions], ["digest of gw-exudyn's source", about["code"]]]
