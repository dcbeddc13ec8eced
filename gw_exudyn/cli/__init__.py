"""The command `gw-exudyn`: one small module a command, each loaded when it is called."""

from gw_exudyn.cli.main import main

__all__ = ["main"]
