"""`series.csv`: the scalars of a run against time, for spreadsheets and scripts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gw_exudyn.quantities import QUANTITIES, SERIES_COLUMNS

if TYPE_CHECKING:
    from gw_exudyn.result import Result

SERIES = "series.csv"


def series_text(result: Result) -> str:
    """CSV with a header of names and SI units (`tip_x [m]`), one row an output instant, every digit that tells one
    float from the next.
    """
    columns = [[repr(value) for value in result.dataset[name].values.tolist()] for name in SERIES_COLUMNS]
    header = ",".join(QUANTITIES[name].heading for name in SERIES_COLUMNS)
    return "\n".join([header, *(",".join(row) for row in zip(*columns, strict=True))]) + "\n"
