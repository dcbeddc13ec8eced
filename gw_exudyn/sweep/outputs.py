"""What a sweep leaves when its points are done: table, data set, indices, best and worst run, figures."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from gw_exudyn.errors import StorageError
from gw_exudyn.storage.manifest import MANIFEST
from gw_exudyn.storage.netcdf import DATA
from gw_exudyn.sweep.dataset import DATASET, write_dataset
from gw_exudyn.sweep.folder import SweepFolder
from gw_exudyn.sweep.page import EXTREMES, run_id
from gw_exudyn.sweep.plan import Options, Plan, Summary
from gw_exudyn.sweep.studies.design import FOR_INDICES
from gw_exudyn.sweep.studies.study import Study
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
        from gw_exudyn.sweep.figures.drawing import write_figures

        runs = _best_and_worst(study, plan, place, table, run_whole)
        write_figures(study, place, table, runs, summary)


def write_page(folder: Path, summary: Summary) -> None:
    """Write the page of a folder in which all else is written, and name it in `summary`. One that can't be made is a
    warning.
    """
    from gw_exudyn.sweep.page import save_study_page

    try:
        summary.files.append(save_study_page(folder))
    except StorageError:
        raise
    except Exception as error:  # a night of computing is not given up for a page
        told = f"the page could not be made ({type(error).__name__}: {error}); the data is complete"
        warnings.warn(told, RuntimeWarning, stacklevel=2)


def _best_and_worst(study: Study, plan: Plan, place: SweepFolder, table: Table, run_whole: RunWhole) -> dict[str, Path]:
    """Run folders of the points with the smallest and the largest value of the study's first metric."""
    values = np.where(table.good, table.metrics[study.metrics[0]], np.nan)
    if not np.isfinite(values).any():
        return {}
    runs: dict[str, Path] = {}
    for name, point in zip(EXTREMES, (int(np.nanargmin(values)), int(np.nanargmax(values))), strict=True):
        folder = place.point(plan.ids[point])
        if not (folder / DATA).is_file():
            folder = place.path / name
            if run_id(folder) != plan.ids[point]:
                files = run_whole(point)
                if MANIFEST not in files:
                    continue
                folder = place.add_run(name, files)
        runs[name] = folder
    return runs
