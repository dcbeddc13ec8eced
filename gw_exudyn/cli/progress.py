"""Progress of a simulation on stderr: a bar with the simulated time and the push force."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from gw_exudyn.cli.console import stderr_console, tell

if TYPE_CHECKING:
    from gw_exudyn.scenario import Scenario
    from gw_exudyn.simulation import Progress

_FORCE_DECIMALS = 5
"""Of the push force, N, that the bar shows."""


@contextmanager
def progress(scenario: Scenario, quiet: bool) -> Iterator[Progress | None]:
    """Give a function that shows how far a simulation has got; None if nobody wants to know.

    Where stderr is no terminal, one line at the start stands for the bar.
    """
    if quiet:
        yield None
        return
    console = stderr_console()
    if not console.is_terminal:
        tell(f"{scenario.name}: simulating {scenario.drive.duration:g} s")
        yield None
        return
    from rich.progress import BarColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bars

    from gw_exudyn.quantities import display

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("{task.completed:.1f} of {task.total:.1f} s", markup=False),
        TextColumn("push force {task.fields[force]}", markup=False),
        TimeRemainingColumn(),
    )
    with Bars(*columns, console=console, transient=True) as bars:
        task = bars.add_task(scenario.name, total=scenario.drive.duration, force="-")

        def report(time: float, end: float, outputs: Mapping[str, Any]) -> None:
            force = round(float(outputs["push_force"]), _FORCE_DECIMALS) + 0.0  # no dust, and no minus before a zero
            bars.update(task, completed=time, total=end, force=display("push_force", force))

        yield report
