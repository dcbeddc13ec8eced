"""The figures of a sweep: curves, a map or a matrix of metrics, bands, indices, the best and the worst run."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from gw_exudyn.errors import StorageError
from gw_exudyn.sweep.dataset import DATASET
from gw_exudyn.sweep.folder import SweepFolder
from gw_exudyn.sweep.plan import Summary
from gw_exudyn.sweep.studies.study import Study
from gw_exudyn.sweep.table import Table

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

FIGURES = "figures"


def write_figures(study: Study, place: SweepFolder, table: Table, runs: Mapping[str, Path], summary: Summary) -> None:
    """Draw what fits the study, and name the files in `summary`. A figure that can't be drawn is a warning.

    runs : run folders of the best and the worst point.
    """
    import xarray as xr

    from gw_exudyn.plots.save import save_figure

    with xr.open_dataset(place.path / DATASET, engine="h5netcdf", decode_times=False) as dataset:
        for name, draw in wanted(study, table, runs, dataset).items():
            try:
                figure = draw()
                if figure is not None:
                    summary.files += save_figure(figure, place.path / FIGURES / name)
            except StorageError:
                raise
            except Exception as error:  # a night of computing is not given up for a picture
                told = f"the figure {name} could not be drawn ({type(error).__name__}: {error}); the data is complete"
                warnings.warn(told, RuntimeWarning, stacklevel=2)


def wanted(
    study: Study, table: Table, runs: Mapping[str, Path], dataset: xr.Dataset
) -> dict[str, Callable[[], Figure | None]]:
    """The figures that fit a study, by name, each as what draws it; None where there is nothing to draw."""
    from gw_exudyn.sweep.figures.bands import plot_bands
    from gw_exudyn.sweep.figures.curves import plot_curves
    from gw_exudyn.sweep.figures.metrics import plot_map, plot_matrix, plot_response

    axes = study.design.axes
    figures: dict[str, Callable[[], Figure | None]] = {"curves": lambda: plot_curves(study, dataset)}
    if len(axes) == 1:
        figures["response"] = lambda: plot_response(study, table)
    elif study.design.grid and len(axes) == 2:
        figures["map"] = lambda: plot_map(study, table)
    else:
        figures["matrix"] = lambda: plot_matrix(study, table)
    if study.mode == "sample":
        figures["bands"] = lambda: plot_bands(study, dataset)
        if study.method not in ("latin-hypercube", "sobol"):
            from gw_exudyn.sweep.figures.indices import plot_indices

            figures["sensitivity"] = lambda: plot_indices(study, table)
    if runs:
        from gw_exudyn.sweep.figures.extremes import plot_extremes

        figures["best_and_worst"] = lambda: plot_extremes(study, runs)
    return figures
