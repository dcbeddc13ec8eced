"""SALib, which draws the points of sensitivity studies and works out their indices (an extra: `sensitivity`)."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from gw_exudyn.sweep.studies.axes import Axis


def missing_library() -> str | None:
    """What to do where SALib is missing; None where it is there."""
    if find_spec("SALib") is not None:
        return None
    return "needs the package SALib; pip install '.[sensitivity]' in the checkout"


def salib(module: str) -> Any:
    """A module of SALib."""
    return import_module(f"SALib.{module}")


def problem_of(axes: Sequence[Axis]) -> dict[str, Any]:
    """The parameters as SALib names them, by their probabilities in the unit cube."""
    return {"num_vars": len(axes), "names": [axis.path for axis in axes], "bounds": [[0.0, 1.0]] * len(axes)}
