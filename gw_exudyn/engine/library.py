"""The import of Exudyn, with one clear sentence where the machine lacks what it needs."""

from __future__ import annotations

import re
from typing import Any

from gw_exudyn.errors import SolverError


def exudyn() -> Any:
    """The module exudyn. Raises SolverError where it, or a library of the system that it links, is missing."""
    try:
        import exudyn as module
    except ImportError as error:
        library = re.search(r"lib(?:GL|X11)[\w.]*", str(error))
        if library is not None:
            raise SolverError(
                f"Exudyn needs the system's libraries libGL and libX11, and {library[0]} is missing; "
                "on Debian and Ubuntu: apt-get install libgl1 libx11-6"
            ) from error
        reason = " ".join(str(error).split())
        raise SolverError(f"Exudyn cannot be imported ({reason}); install it again: pip install exudyn") from error
    return module
