"""For all tests: no test depends on a display, and the threads of numpy's linear algebra stay out of the way."""

import os

os.environ.setdefault("MPLBACKEND", "Agg")
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(name, "1")
