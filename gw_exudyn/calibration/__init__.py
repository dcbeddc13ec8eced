"""Calibrations: parameters of a scenario fitted to measured tip paths and force curves.

The way of the data: `form` (the file, checked) -> `simulations` (points run by the study engine, kept by id) ->
`observations` (residuals against what was measured) -> `fit` (least squares) -> `statistics`, `advice` (what is known
of the parameters, and what is not) -> `outputs`, `figures`. Names are loaded when they are first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gw_exudyn.calibration.form import Calibration, load_calibration
    from gw_exudyn.calibration.run import Summary, run_calibration

_HOME = {"Calibration": "form", "Summary": "run", "load_calibration": "form", "run_calibration": "run"}

__all__ = ["Calibration", "Summary", "load_calibration", "run_calibration"]


def __getattr__(name: str) -> Any:
    """Import a public name from its module when it is first asked for."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
