"""A sweep in a process of its own, to be killed: `python slow_sweep.py STUDY OUT`."""

import sys
from pathlib import Path

from gw_exudyn.sweep.plan import Options
from gw_exudyn.sweep.run import run_sweep
from gw_exudyn.sweep.studies.loading import load_study

OPTIONS = Options(jobs=2, figures=False, runner="odd_runners:SlowRunner")

if __name__ == "__main__":
    run_sweep(load_study(sys.argv[1]), Path(sys.argv[2]), OPTIONS)
