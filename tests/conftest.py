"""For all tests: no test depends on a display."""

import os

os.environ.setdefault("MPLBACKEND", "Agg")
