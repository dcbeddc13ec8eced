"""Scenarios: schema, strict loading, units, and the catalogue of wires.

Names are loaded when they are first used, so that importing this package costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gw_exudyn.scenario.catalogue import CatalogueWire, catalogue_names, load_catalogue
    from gw_exudyn.scenario.drives.force import ForceDrive
    from gw_exudyn.scenario.drives.speed import SpeedDrive
    from gw_exudyn.scenario.drives.tip_speed import TipSpeedDrive
    from gw_exudyn.scenario.loading import load_scenario, scenario_from_dict
    from gw_exudyn.scenario.loads import DiscSpec, NoseSpec, TipSpec
    from gw_exudyn.scenario.schema import CatheterSpec, ContactSpec, OutputSpec, Scenario, SolverSpec, json_schema
    from gw_exudyn.scenario.shipped import list_shipped, resolve, shipped_folder
    from gw_exudyn.scenario.stiffness import StiffnessPiece
    from gw_exudyn.scenario.stop import StopSpec, TargetSpec
    from gw_exudyn.scenario.units import format_quantity, parse_quantity, parse_unit
    from gw_exudyn.scenario.vessels.branches import BranchesVessel
    from gw_exudyn.scenario.vessels.vessel import ArcVessel, NoVessel, PolygonVessel, StraightVessel
    from gw_exudyn.scenario.wire import TipShape, WireSpec

_HOME = {
    "ArcVessel": "vessels.vessel",
    "BranchesVessel": "vessels.branches",
    "CatalogueWire": "catalogue",
    "CatheterSpec": "schema",
    "ContactSpec": "schema",
    "DiscSpec": "loads",
    "ForceDrive": "drives.force",
    "NoVessel": "vessels.vessel",
    "NoseSpec": "loads",
    "OutputSpec": "schema",
    "PolygonVessel": "vessels.vessel",
    "Scenario": "schema",
    "SolverSpec": "schema",
    "SpeedDrive": "drives.speed",
    "StiffnessPiece": "stiffness",
    "StopSpec": "stop",
    "StraightVessel": "vessels.vessel",
    "TargetSpec": "stop",
    "TipSpeedDrive": "drives.tip_speed",
    "TipShape": "wire",
    "TipSpec": "loads",
    "WireSpec": "wire",
    "catalogue_names": "catalogue",
    "format_quantity": "units",
    "json_schema": "schema",
    "list_shipped": "shipped",
    "load_catalogue": "catalogue",
    "load_scenario": "loading",
    "parse_quantity": "units",
    "parse_unit": "units",
    "resolve": "shipped",
    "scenario_from_dict": "loading",
    "shipped_folder": "shipped",
}

__all__ = [
    "ArcVessel",
    "BranchesVessel",
    "CatalogueWire",
    "CatheterSpec",
    "ContactSpec",
    "DiscSpec",
    "ForceDrive",
    "NoVessel",
    "NoseSpec",
    "OutputSpec",
    "PolygonVessel",
    "Scenario",
    "SolverSpec",
    "SpeedDrive",
    "StiffnessPiece",
    "StopSpec",
    "StraightVessel",
    "TargetSpec",
    "TipShape",
    "TipSpec",
    "TipSpeedDrive",
    "WireSpec",
    "catalogue_names",
    "format_quantity",
    "json_schema",
    "list_shipped",
    "load_catalogue",
    "load_scenario",
    "parse_quantity",
    "parse_unit",
    "resolve",
    "scenario_from_dict",
    "shipped_folder",
]


def __getattr__(name: str) -> Any:
    """Import a public name from its module when it is first asked for."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    """The public names."""
    return sorted(__all__)
