"""Units in which figures of a sweep show parameters and metrics, and colours for values."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gw_exudyn.plots.style import axis_label, shown
from gw_exudyn.quantities import LIKE, plain
from gw_exudyn.result import Floats
from gw_exudyn.sweep.studies.axes import Axis

if TYPE_CHECKING:
    from gw_exudyn.sweep.studies.study import Study

COLOUR_MAP = "cividis"
"""Told apart with any colour vision, and in grey."""


def short(value: float) -> str:
    """Three digits, and as many before the point as there are: `2550`, not `2.55e+03`."""
    number = f"{value:.3g}"
    return f"{value:.0f}" if "e+" in number else number


def scaled(text: str, unit: str, values: Floats) -> tuple[str, Floats]:
    """Label with unit, and the values in it, of something in SI."""
    like = LIKE.get(unit)
    if like is None:
        return axis_label(text, unit), values
    name, factor = shown(like, values)
    return axis_label(text, name), values * factor


def metric_scaled(study: Study, name: str, values: Floats) -> tuple[str, Floats]:
    """Label and values of a metric as an axis shows them."""
    return scaled(name.replace("_", " "), study.metric_table[name].unit, values)


def metric_words(study: Study, name: str, value: float) -> str:
    """A metric and its value in words: `push force max 20.7 mN`."""
    return f"{name.replace('_', ' ')} {value_words(study.metric_table[name].unit, value)}"


def value_words(unit: str, value: float) -> str:
    """A value in SI in words: `20.7 mN`."""
    shown_unit, factor = shown(LIKE[unit], np.array([value])) if unit in LIKE else (unit, 1.0)
    number = short(value * factor)
    return number if shown_unit == "1" else f"{number} {plain(shown_unit)}"


def axis_name(axis: Axis) -> str:
    """The parameter's path as words."""
    return axis.path.replace("_", " ").replace(".", ": ")


def axis_scaled(axis: Axis, labels: list[float | str]) -> tuple[str, Floats, list[str]]:
    """Label, numbers and words of a parameter's coordinates; words are numbered in the order of their first sight."""
    if axis.unit is not None:
        text, values = scaled(axis_name(axis), axis.unit, np.array(labels, dtype=float))
        return text, values, [short(value) for value in values]
    words = list(dict.fromkeys([str(label) for label in axis.labels] or [str(label) for label in labels]))
    return axis_name(axis), np.array([float(words.index(str(label))) for label in labels]), [str(x) for x in labels]
