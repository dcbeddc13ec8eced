"""Run folders on disk: `run.nc` (everything, netCDF-4), `series.csv` (scalars over time), `run.json` (status,
metrics, scenario), `figures/`.

A run folder appears as a whole or not at all, whatever happens while it is written; see `run_folder`.
"""

from gw_exudyn.storage.run_folder import check_run_folder
from gw_exudyn.storage.runs import read_run, write_run

__all__ = ["check_run_folder", "read_run", "write_run"]
