"""Studies made up for their pages: no point of them was run."""

from __future__ import annotations

from typing import Any

import numpy as np

from gw_exudyn.report.columns import Column, si_column
from gw_exudyn.report.curves import Curves, chosen
from gw_exudyn.report.study_page import Kept, Outcome, StudyPage

WIRES = ("universal-ii", "amplatz-super-stiff")
FAILED, NOT_RUN = 3, 5
"""Rows of the small study; the failed one has a force far beyond the others, and no time of it."""


def made_up_study(count: int = 12, metrics: int = 2, instants: int = 20, **further: Any) -> StudyPage:
    """Friction goes up, wires take turns; the push force is 10 mN a row, 5 N at the failed one."""
    rows = np.arange(count, dtype=float)
    good = np.ones(count, dtype=bool)
    good[[FAILED, NOT_RUN]] = False
    force = np.where(rows == FAILED, 5.0, np.where(rows == NOT_RUN, np.nan, 0.01 * (rows + 1)))
    status = ["too_deep" if row == FAILED else "not_run" if row == NOT_RUN else "completed" for row in range(count)]
    columns = [
        Column("point", rows, role="point", digits=7),
        Column("id", [f"{row:016x}" for row in range(count)], role="id", open=False),
        si_column("", "contact.friction_coefficient", "1", 0.1 + 1e-7 * 1.5 * rows, good, role="parameter", digits=6),
        si_column("", "drive.distance", "m", 1e-7 * (1 + rows), good, role="parameter", digits=6),
        Column("wire.model", [WIRES[row % 2] for row in range(count)], role="parameter"),
        Column("status", status, role="status"),
        si_column("push_force_max", "push force max", "N", force, good, role="metric", meaning="largest push force"),
        si_column("time", "push force max time", "s", np.where(good, rows, np.nan), good, role="metric"),
        *(si_column("", f"further {i}", "1", np.sin(rows * (i + 1)), good, role="metric", open=False)
          for i in range(metrics - 2)),
        Column("reason", ["Pressed into a wall" if text == "too_deep" else "" for text in status], role="reason"),
    ]  # fmt: skip
    names, places = chosen(["push_force", "insertion_depth"], count, instants, 2)
    time = np.linspace(0.0, 1.0, instants)[places]
    series = {name: np.outer(rows + 1, time) * 1e-3 for name in names}
    for values in series.values():
        values[NOT_RUN] = np.nan
    outcome = np.where(good, Outcome.GOOD, Outcome.FAILED)
    outcome[NOT_RUN] = Outcome.NOT_RUN
    given: dict[str, Any] = {
        "title": "made up",
        "columns": columns,
        "outcome": outcome,
        "kept": np.where(outcome == Outcome.NOT_RUN, Kept.NOTHING, Kept.SERIES),
        "folder": "results/sweeps/made up",
        "varied": (["parameter", "values"], []),
        "measured": (["metric", "smallest"], []),
        "provenance": (["what", ""], [["scenario", "straight"]]),
        "curves": Curves(time, series),
        "command": ["gw-exudyn", "run", "straight", "--set", "output.interval=0.5 s"],
        "values": {"wire.model": {wire: wire for wire in WIRES}},
    }
    return StudyPage(**{**given, **further})
