"""The page of a run, or of a few."""

from __future__ import annotations

import html
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gw_exudyn.comparison import differences
from gw_exudyn.errors import UsageError
from gw_exudyn.metrics import Metric, metrics
from gw_exudyn.plots.save import render_figures
from gw_exudyn.quantities import number_text, value_text
from gw_exudyn.report.pack import packed_run, scalars_table
from gw_exudyn.report.parts import filled, picture, save_page, table

if TYPE_CHECKING:
    from gw_exudyn.result import Result

MOST_RUNS = 4
SCRIPTS = ("base.js", "data.js", "scene.js", "chart.js", "player.js", "run.js")
_FIGURES = ("insertion", "forces", "tip_path", "energy", "contact_map")


def report_page(results: Sequence[Result], *, title: str = "", figures: bool = True, names: Sequence[str] = ()) -> str:
    """The page as HTML text. names : of the runs, their scenarios' if not given; numbered where alike.

    Raises UsageError for no run, or for more than the player can set beside each other.
    """
    if not 1 <= len(results) <= MOST_RUNS:
        raise UsageError(f"a report shows 1 to {MOST_RUNS} runs, not {len(results)}; make several reports")
    names = _numbered(names or [result.scenario.name for result in results])
    runs = [packed_run(result) | {"name": name} for result, name in zip(results, names, strict=True)]
    parts = {
        "STATUS": "".join(_status(result, name) for result, name in zip(results, names, strict=True)),
        "METRICS": _metrics(results, names),
        "SCENARIOS": _scenarios(results, names),
        "FIGURES": "".join(_figures(r, n) for r, n in zip(results, names, strict=True)) if figures else "",
        "PROVENANCE": _provenance(results, names),
    }
    data = {"runs": runs, "scalars": scalars_table()}
    return filled("run.html", SCRIPTS, title or " and ".join(names), data, parts)


def save_report(
    results: Sequence[Result],
    path: str | Path,
    *,
    title: str = "",
    figures: bool = True,
    names: Sequence[str] = (),
) -> Path:
    """Write the page and return its path. Raises StorageError where the disk refuses."""
    return save_page(report_page(results, title=title, figures=figures, names=names), path)


def _numbered(plain: Sequence[str]) -> list[str]:
    """Names of the runs, numbered where two have the same."""
    return [f"{name} ({i + 1})" if list(plain).count(name) > 1 else name for i, name in enumerate(plain)]


def _status(result: Result, name: str) -> str:
    kind = "good" if result.status.status.trusted else "bad"
    return f'<p class="status {kind}"><b>{html.escape(name)}</b> {html.escape(result.status.sentence())}</p>'


def _metrics(results: Sequence[Result], names: Sequence[str]) -> str:
    found = [metrics(result) for result in results]
    known = {key: metric for one in reversed(found) for key, metric in one.items()}
    # In the order of the run that has most of them; runs in other vessels have other branches.
    order = dict.fromkeys(key for one in sorted(found, key=len, reverse=True) for key in one)
    rows = [[key, *(_metric_text(key, one.get(key)) for one in found), known[key].meaning] for key in order]
    return table(["metric", *names, "meaning"], rows)


def _metric_text(name: str, metric: Metric | None) -> str:
    """A metric as text; nothing where the run has none of that name."""
    if metric is None:
        return ""
    return metric.label or number_text(name, metric.value, metric.unit)


def _scenarios(results: Sequence[Result], names: Sequence[str]) -> str:
    """All inputs of the first run, and what the others have otherwise."""
    plain = [result.scenario.to_dict() for result in results]
    others: dict[str, list[Any]] = {}
    for number, other in enumerate(plain[1:]):
        for change in differences(plain[0], other):
            row = others.setdefault(change.path, [change.first] * len(plain))
            row[number + 1] = change.second
    changed = (
        table(["differs", *names], [[path, *map(value_text, row)] for path, row in others.items()]) if others else ""
    )
    inputs = "".join(
        f"<details><summary>inputs of {html.escape(name)}</summary>"
        f"<pre>{html.escape(json.dumps(one, indent=1, ensure_ascii=False))}</pre></details>"
        for name, one in zip(names, plain, strict=True)
    )
    return changed + inputs


def _figures(result: Result, name: str) -> str:
    pictures = render_figures(result, _FIGURES, ("png",))
    shown = "".join(picture(content, f"{name}: {file}") for file, content in pictures.items())
    return f"<details><summary>figures of {html.escape(name)}</summary>{shown}</details>"


def _provenance(results: Sequence[Result], names: Sequence[str]) -> str:
    rows = []
    for result, name in zip(results, names, strict=True):
        versions: Mapping[str, str] = result.provenance.get("versions", {})
        command = str(result.provenance.get("command", ""))
        rows.append([name, command or "-", ", ".join(f"{key} {value}" for key, value in versions.items())])
    return table(["run", "command", "versions"], rows)
