"""A value over time as the forms of a drive give it: one value with a ramp, or a table."""

from __future__ import annotations

from collections.abc import Sequence

from gw_exudyn.scenario.faults import Faults, wrong
from gw_exudyn.scenario.units import format_quantity

Rows = Sequence[tuple[float, float]]


def check_table(rows: Rows, faults: Faults) -> None:
    """Note what is wrong with the times of a table."""
    times = [time for time, _ in rows]
    if times[0] != 0:
        faults.add(("table", 0), f"begins at {times[0]:.6g} s; the first time is 0")
    if times[-1] <= 0:
        faults.add(("table", len(rows) - 1), "ends at 0 s; the drive must last")
    for i in range(1, len(rows)):
        if times[i] < times[i - 1]:
            faults.add(("table", i), f"{times[i]:.6g} s comes after {times[i - 1]:.6g} s; times never fall")
        elif i > 1 and times[i] == times[i - 2]:
            faults.add(("table", i), f"a third row at {times[i]:.6g} s; two make a step")


def check_course(
    name: str, value: float | None, duration: float | None, ramp: float | None, table: Rows | None
) -> None:
    """One value (called `name`) with its duration, or a table. Raises ValidationError."""
    faults = Faults()
    if value is None and table is None:
        instead = (name, "table")
        raise wrong(f"says no {name}; give {name} with duration, or table", missing=True, instead=instead)
    if table is not None:
        for key, given in ((name, value), ("duration", duration), ("ramp", ramp)):
            if given is not None:
                faults.add((key,), "stands beside table; the table says it all, remove it")
        check_table(table, faults)
    elif duration is None:
        faults.add(("duration",), wrong("is missing: how long the drive lasts; give duration: 40 s", missing=True))
    elif ramp is not None and ramp > duration:
        faults.add(("ramp",), f"{format_quantity(ramp, 's')} is longer than the drive lasts; shorten it")
    faults.raise_if_any()


def course_rows(value: float, duration: float, ramp: float | None) -> Rows:
    """The table of one value that is reached by a ramp from 0."""
    if not ramp:
        return [(0.0, value), (duration, value)]
    return [(0.0, 0.0), (ramp, value), *([(duration, value)] if duration > ramp else [])]
