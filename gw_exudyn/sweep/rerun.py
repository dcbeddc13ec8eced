"""How a point of a study is run again by itself: the words of `gw-exudyn run` and its `--set`."""

from __future__ import annotations

import json
from typing import Any

from gw_exudyn.errors import ScenarioError
from gw_exudyn.scenario.yaml_source import parse_value
from gw_exudyn.sweep.studies.study import Study


def rerun(study: Study) -> dict[str, Any]:
    """What sweep.json keeps for that.

    scenario : as `gw-exudyn run` takes it; None for an FMU, which it does not take. set : text of each path that is the
    same in all points. values : of the parameters that are words, the text of each word by path.
    """
    beside = study.file.parent / study.base
    scenario = beside.as_posix() if beside.is_file() else study.base
    return {
        "scenario": None if study.fmu is not None else scenario,
        "set": {path: _text(study.beside(path, value)) for path, value in study.fixed.items()},
        "values": {
            axis.path: {
                str(label): _text(study.beside(axis.path, value))
                for label, value in zip(axis.labels, axis.values, strict=True)
            }
            for axis in study.design.axes
            if axis.unit is None
        },
    }


def _text(value: Any) -> str:
    """The value as YAML reads it back."""
    if not isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    try:
        return value if parse_value(value, "") == value else json.dumps(value, ensure_ascii=False)
    except ScenarioError:
        return json.dumps(value, ensure_ascii=False)
