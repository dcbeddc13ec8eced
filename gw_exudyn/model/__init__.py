"""The model: wire, walls, contact law and drive of a scenario, in plain numpy, without the engine."""

from __future__ import annotations

from gw_exudyn.model.build import Model, build

__all__ = ["Model", "build"]
