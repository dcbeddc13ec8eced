"""The best and the worst run of a sweep, drawn in the vessel."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING

from gw_exudyn.metrics import metrics
from gw_exudyn.sweep.figures.scales import metric_words, value_words
from gw_exudyn.sweep.studies.study import Study

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gw_exudyn.result import Result

LETTERS = 36
"""Of a line of the title, so that it is not wider than the narrowest panel."""


def plot_extremes(study: Study, runs: Mapping[str, Path]) -> Figure:
    """Draw the runs side by side as `plot_insertion` does. runs : folders by `best` and `worst`."""
    from gw_exudyn.plots import plot_insertion
    from gw_exudyn.storage import read_run

    return plot_insertion([_titled(name, read_run(folder), study) for name, folder in runs.items()])


def _titled(name: str, result: Result, study: Study) -> Result:
    """The result under a name that tells the metric and the parameters."""
    value = metrics(result)[study.metrics[0]].value
    title = title_of(name, value, result.provenance["point"]["parameters"], study)
    return dataclasses.replace(result, scenario=result.scenario.model_copy(update={"name": title}))


def title_of(name: str, value: float, parameters: Mapping[str, float | str], study: Study) -> str:
    """Words of a point: the value of the study's first metric, and the parameters, in lines of a panel's width."""
    units = {axis.path: axis.unit or "1" for axis in study.design.axes}
    words = [f"{path.rpartition('.')[2].replace('_', ' ')} {_text(units[path], v)}" for path, v in parameters.items()]
    # Spaces that do not break keep a name and its value together.
    lines = wrap(", ".join(word.replace(" ", "\u00a0") for word in words), LETTERS)
    return "\n".join([f"{name}: {metric_words(study, study.metrics[0], value)}", *lines])


def _text(unit: str, value: float | str) -> str:
    return value if isinstance(value, str) else value_words(unit, value)
