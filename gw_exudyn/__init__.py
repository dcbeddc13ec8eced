"""Guidewire insertion on Exudyn: how a guidewire moves, and what forces act, when it is pushed into a vessel.

The public names are loaded when they are first used, so that `import gw_exudyn` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gw_exudyn.errors import GwError, ScenarioError, SolverError, StorageError, UsageError
    from gw_exudyn.result import Result, SnapEvent, Status, StatusReport
    from gw_exudyn.scenario import Scenario, json_schema, list_shipped, load_scenario, scenario_from_dict
    from gw_exudyn.simulation import Simulation, simulate
    from gw_exudyn.storage import read_run, write_run

__version__ = "0.1.0"

_HOME = {
    "GwError": "errors",
    "Result": "result",
    "Scenario": "scenario",
    "ScenarioError": "errors",
    "Simulation": "simulation",
    "SnapEvent": "result",
    "SolverError": "errors",
    "Status": "result",
    "StatusReport": "result",
    "StorageError": "errors",
    "UsageError": "errors",
    "json_schema": "scenario",
    "list_shipped": "scenario",
    "load_scenario": "scenario",
    "read_run": "storage",
    "scenario_from_dict": "scenario",
    "simulate": "simulation",
    "write_run": "storage",
}

__all__ = [
    "GwError",
    "Result",
    "Scenario",
    "ScenarioError",
    "Simulation",
    "SnapEvent",
    "SolverError",
    "Status",
    "StatusReport",
    "StorageError",
    "UsageError",
    "__version__",
    "json_schema",
    "list_shipped",
    "load_scenario",
    "read_run",
    "scenario_from_dict",
    "simulate",
    "write_run",
]


def __getattr__(name: str) -> Any:
    """Import a public name from its module when it is first asked for."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    """The public names."""
    return sorted(__all__)
