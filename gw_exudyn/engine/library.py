"""The import of Exudyn, with one clear sentence where the machine lacks what it needs."""

from __future__ import annotations

from typing import Any

from gw_exudyn.errors import SolverError


def exudyn() -> Any:
    """The module exudyn. Raises SolverError where it, or a library of the system that it links, is missing."""
    try:
        import exudyn as module
    except ImportError as error:
        text = str(error)
        if "libGL" in text or "libX11" in text:
            raise SolverError(
                f"Exudyn needs the system libraries libGL and libX11 ({text}); "
                "on Debian and Ubuntu: apt-get install libgl1 libx11-6"
            ) from error
        raise SolverError(f"Exudyn cannot be imported ({text}); pip install exudyn") from error
    return module
