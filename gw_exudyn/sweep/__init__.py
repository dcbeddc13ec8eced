"""Sweeps: a scenario over a grid, a list or a sample of parameters, in parallel.

The way of the data: `studies` (the file, checked, and its points) -> `plan` (which are missing) -> `run` (dask's `pool`
hands points to workers) -> `worker` -> `point_process` (a child that runs one point after the other) -> `folder`
(points on disk) -> `table`, `dataset`, `figures`, `sensitivity`. Names are loaded when they are first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gw_exudyn.sweep.plan import Options, Summary
    from gw_exudyn.sweep.run import run_sweep
    from gw_exudyn.sweep.studies.loading import load_study
    from gw_exudyn.sweep.studies.study import Study

_HOME = {
    "Options": "plan",
    "Study": "studies.study",
    "Summary": "plan",
    "load_study": "studies.loading",
    "run_sweep": "run",
}

__all__ = ["Options", "Study", "Summary", "load_study", "run_sweep"]


def __getattr__(name: str) -> Any:
    """Import a public name from its module when it is first asked for."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
