"""What a sweep leaves when its points are done: table, data set, indices, best and worst run, figures."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from gw_exudyn.storage.manifest import MANIFEST
from gw_exudyn.storage.netcdf import DATA
from gw_exudyn.sweep.dataset import DATASET, write_dataset
from gw_exudyn.sweep.design import FOR_INDICES
from gw_exudyn.sweep.folder import SweepFolder
from gw_exudyn.sweep.run import Options, Plan, Summary
from gw_exudyn.sweep.study import Study
from gw_exudyn.sweep.table import TABLE, Table, write_table

RunWhole = Callable[[int], Mapping[str, bytes]]


def write_outputs(
    study: Study, plan: Plan, options: Options, place: SweepFolder, summary: Summary, run_whole: RunWhole | None
) -> None:
    """Write everything and name it in `summary`. run_whole : gives the files of a point's run folder; None: leave out
    what needs more runs.
    """
    table = write_table(study, plan, place, summary)
    summary.files.append(place.path / TABLE)
    write_dataset(study, plan, place, table)
    summary.files.append(place.path / DATASET)
    if run_whole is None:
        return
    if not table.good.any():
        summary.notes.append("no point came out well, so there is nothing to draw")
        return
    if study.method in FOR_INDICES and study.mode == "sample":
        from gw_exudyn.sweep.sensitivity import write_indices

        write_indices(study, table, place, summary)
    if options.figures:
        from gw_exudyn.sweep.figures import write_figures

        runs = _best_and_worst(study, plan, place, table, run_whole)
        write_figures(study, place, table, runs, summary)


def _best_and_worst(study: Study, plan: Plan, place: SweepFolder, table: Table, run_whole: RunWhole) -> dict[str, Path]:
    """Run folders of the points with the smallest and the largest value of the study's first metric."""
    values = np.where(table.good, table.metrics[study.metrics[0]], np.nan)
    if not np.isfinite(values).any():
        return {}
    runs: dict[str, Path] = {}
    for name, point in (("best", int(np.nanargmin(values))), ("worst", int(np.nanargmax(values)))):
        folder = place.point(plan.ids[point])
        if not (folder / DATA).is_file():
            folder = place.path / name
            if _id_of(folder) != plan.ids[point]:
                files = run_whole(point)
                if MANIFEST not in files:
                    continue
                folder = place.add_run(name, files)
        runs[name] = folder
    return runs


def _id_of(folder: Path) -> str | None:
    """The id of the point whose run a folder holds."""
    try:
        found = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))["provenance"]["point"]["id"]
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return str(found)
