"""Insertion at constant force: how far a wire gets, and how fast, when it is pushed with a force instead of a speed.

The paper says that "a defined force" moves its wires, and shows none. Here the hub is pushed with a constant force
against a damper; where the wire needs more than that force, it stops. A run that goes wrong far behind the second
corner, where the wire jams, is shown until then, with a cross: every step before has passed its checks.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import shared
from shared import COLOURS, ESTIMATES, OUT, TITLES, WIRES, Case

from gw_exudyn import Result
from gw_exudyn.plots import save_figure
from gw_exudyn.plots.style import new_figure, tidy

FORCES = {"universal": (10, 20, 40, 80, 160), "amplatz": (25, 50, 100, 200, 400)}
"""mN, on the hub."""

FREE_SPEED = 4e-3
"""m/s, of a wire that nothing holds: the hub's damper is chosen for it, so that forces are told apart by the vessel."""

DURATION = 40.0
HUB_MASS = 0.01
DEEP = 80e-3
"""m. A wire that gets here has passed both corners."""

Runs = dict[tuple[str, str, int], Result]


def main(out: Path = OUT, quick: bool = False) -> None:
    """Run, draw, and write constant-force.csv (depth against time) and constant-force-summary.csv."""
    forces = {wire: values[1::2] if quick else values for wire, values in FORCES.items()}
    runs: Runs = shared.run_all("constant_force", _cases(forces, quick), out)
    grid = np.linspace(0.0, 2.0 if quick else DURATION, 81)
    rows: list[dict[str, Any]] = [{"time [s]": float(t)} for t in grid]
    for (wire, estimate, force), result in runs.items():
        for row, depth in zip(rows, shared.over(result, "insertion_depth", grid), strict=True):
            row[f"{wire} {estimate} {force} mN [mm]"] = float(depth) * 1e3
    shared.write_table(out / "constant-force.csv", rows)
    shared.write_table(out / "constant-force-summary.csv", [_summary(*key, result) for key, result in runs.items()])
    save_figure(_draw(runs, forces), out / "constant-force")


def _cases(forces: dict[str, tuple[int, ...]], quick: bool) -> dict[tuple[str, str, int], Case]:
    return {
        (wire, estimate, force): Case(
            WIRES[wire],
            {
                "wire.estimate": estimate,
                "wire.segments": 24 if quick else 60,
                "output.interval": 0.2,
                "drive": {
                    "kind": "force",
                    "force": force * 1e-3,
                    "duration": 2.0 if quick else DURATION,
                    "hub_mass": HUB_MASS,
                    "hub_damping": force * 1e-3 / FREE_SPEED,
                },
            },
        )
        for wire, values in forces.items()
        for force in values
        for estimate in ESTIMATES
    }


def _summary(wire: str, estimate: str, force: int, result: Result) -> dict[str, Any]:
    depth = result.values("insertion_depth")
    deep = depth >= DEEP
    last = result.time >= result.time[-1] - 5.0
    return {
        "wire": wire,
        "estimate": estimate,
        "force [mN]": force,
        "status": shared.status(result),
        "duration [s]": result.time[-1],
        "depth_reached [mm]": depth.max() * 1e3,
        "time_to_80_mm [s]": float(result.time[np.argmax(deep)]) if deep.any() else np.nan,
        "final_speed [mm/s]": round(_mean_speed(result.time[last], depth[last]) * 1e3, 3) + 0.0,
    }


def _mean_speed(time: Any, depth: Any) -> float:
    """m/s over some outputs."""
    return float((depth[-1] - depth[0]) / (time[-1] - time[0]))


def _draw(runs: Runs, forces: dict[str, tuple[int, ...]]) -> Any:
    from matplotlib import colormaps

    figure = new_figure(11.0, 7.6)
    panels = figure.subplots(2, 2)
    for column, (wire, values) in enumerate(forces.items()):
        above, below = panels[:, column]
        for force, colour in zip(values, colormaps["viridis"](np.linspace(0.0, 0.85, len(values))), strict=True):
            found = [runs[wire, e, force] for e in ESTIMATES]
            grid = found[1].time
            low, high = shared.band([_held(one, grid) for one in found])
            above.fill_between(grid, low * 1e3, high * 1e3, color=colour, alpha=0.22, linewidth=0)
            above.plot(grid, found[1].values("insertion_depth") * 1e3, color=colour, linewidth=1.5, label=f"{force} mN")
            for one in found:
                if not one.status.status.trusted:
                    above.plot(one.time[-1], one.values("insertion_depth")[-1] * 1e3, "x", color=colour, markersize=7)
        depths = {e: [runs[wire, e, f].values("insertion_depth").max() * 1e3 for f in values] for e in ESTIMATES}
        low, high = shared.band([np.array(depths[e]) for e in ESTIMATES])
        below.fill_between(values, low, high, color=COLOURS[wire], alpha=0.22, linewidth=0)
        below.plot(values, depths["best"], color=COLOURS[wire], marker="o", markersize=4)
        below.set_xscale("log")
        below.set_xticks(values, [str(f) for f in values])
        below.minorticks_off()
        for axes in (above, below):
            tidy(axes)
            axes.set_ylim(0, 160)
        above.set_title(f"{TITLES[wire]}; line: best EI, band: low to high", loc="left", fontsize=9.5)
        above.set_xlabel("time [s]")
        below.set_xlabel("force on the hub [mN]")
        above.legend(frameon=False, fontsize=8.5, loc="upper left")
    panels[0, 0].set_ylabel("insertion depth [mm]")
    panels[1, 0].set_ylabel(f"depth reached in {DURATION:g} s [mm]")
    return figure


def _held(result: Result, grid: Any) -> Any:
    """Insertion depth, m; a run that ended before stays where it was."""
    return np.interp(grid, result.time, result.values("insertion_depth"))


if __name__ == "__main__":
    shared.command(main)
