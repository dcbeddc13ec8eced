"""Pull-back: push force against insertion depth, in and out again, and what the loop between them costs.

The paper moves its wires one way. Pulled back, the same wire takes another force at the same depth: friction turns
round, and the wire lies along other walls.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import shared
from shared import COLOURS, ESTIMATES, OUT, TITLES, WIRES, Case

from gw_exudyn import Result
from gw_exudyn.plots import save_figure
from gw_exudyn.plots.scene import beyond_exit, draw_vessel
from gw_exudyn.plots.style import axis_label, label_places, new_figure, tidy

DEPTH = 80e-3
SPEED = 2e-3
SHOWN = 60e-3
"""m, the depth at which both shapes are drawn."""

Runs = dict[tuple[str, str], Result]


def main(out: Path = OUT, quick: bool = False) -> None:
    """Run, draw, and write pull-back.csv (the loops) and pull-back-summary.csv."""
    depth = 30e-3 if quick else DEPTH
    phases = [{"speed": speed, "distance": depth} for speed in (SPEED, -SPEED)]
    overrides = {"wire.segments": 24 if quick else 100, "drive": {"kind": "speed", "phases": phases}}
    cases = {
        (wire, estimate): Case(WIRES[wire], {"wire.estimate": estimate, **overrides})
        for wire in WIRES
        for estimate in ESTIMATES
    }
    runs = shared.run_all("pull_back", cases, out)
    shared.check(runs.values())
    # The turn itself belongs to the way in; at the very end the wire is all in the catheter again.
    grid = np.linspace(0.0, depth, 161)
    loops = {key: (_leg(result, grid, True), _leg(result, grid, False)) for key, result in runs.items()}
    rows: list[dict[str, Any]] = [{"insertion_depth [mm]": d * 1e3} for d in grid]
    for (wire, estimate), legs in loops.items():
        for word, leg in zip(("in", "out"), legs, strict=True):
            for row, force in zip(rows, leg, strict=True):
                row[f"{wire} {estimate} {word} [mN]"] = float(force) * 1e3
    shared.write_table(out / "pull-back.csv", rows)
    shared.write_table(out / "pull-back-summary.csv", [_summary(*key, runs[key], *loops[key], grid) for key in runs])
    save_figure(_draw(runs, loops, grid), out / "pull-back")


def _leg(result: Result, grid: Any, inwards: bool) -> Any:
    """Push force, N, over the insertion depth on the way in or out."""
    depth, force = result.values("insertion_depth"), result.values("push_force")
    turn = int(np.argmax(depth))
    chosen = slice(0, turn + 1) if inwards else slice(turn + 1, None)
    order = np.argsort(depth[chosen], kind="stable")
    return np.interp(grid, depth[chosen][order], force[chosen][order])


def _summary(wire: str, estimate: str, result: Result, into: Any, back: Any, grid: Any) -> dict[str, Any]:
    depth = result.values("insertion_depth")
    turn = int(np.argmax(depth))
    work = result.values("insertion_work")
    shapes = [_nodes_at(result, SHOWN, inwards) for inwards in (True, False)]
    apart = np.hypot(*(shapes[0] - shapes[1]).T).max() if depth[turn] >= SHOWN else np.nan
    return {
        "wire": wire,
        "estimate": estimate,
        "status": shared.status(result),
        "largest_push [mN]": result.peaks["push_force"][0] * 1e3,
        "largest_pull [mN]": result.peaks["pull_force"][0] * 1e3,
        "work_in [uJ]": work[turn] * 1e6,
        "work_out [uJ]": (work[-1] - work[turn]) * 1e6,
        "loop [uJ]": float(np.trapezoid(into - back, grid)) * 1e6,
        "friction_loss [uJ]": result.values("friction_loss")[-1] * 1e6,
        "elastic_energy_at_the_turn [uJ]": result.values("elastic_energy")[turn] * 1e6,
        "shapes_apart_at_60_mm [mm]": apart * 1e3,
    }


def _nodes_at(result: Result, depth: float, inwards: bool) -> Any:
    """(n + 1, 2) float, m. Nodes at the output nearest to a depth, on the way in or out."""
    reached = result.values("insertion_depth")
    turn = int(np.argmax(reached))
    chosen = np.arange(turn + 1) if inwards else np.arange(turn, len(reached))
    i = int(chosen[np.argmin(np.abs(reached[chosen] - depth))])
    return np.column_stack([result.values("node_x")[i], result.values("node_y")[i]])


def _draw(runs: Runs, loops: dict[tuple[str, str], Any], grid: Any) -> Any:
    figure = new_figure(11.0, 8.2)
    panels = figure.subplots(2, 2, height_ratios=(1.0, 1.0))
    for column, wire in enumerate(WIRES):
        axes = panels[0, column]
        tidy(axes)
        for leg, style, word in ((0, "-", "in"), (1, "--", "out")):
            low, high = shared.band([loops[wire, e][leg] for e in ESTIMATES])
            axes.fill_between(grid * 1e3, low * 1e3, high * 1e3, color=COLOURS[wire], alpha=0.2, linewidth=0)
            axes.plot(grid * 1e3, loops[wire, "best"][leg] * 1e3, style, color=COLOURS[wire], linewidth=1.5, label=word)
        axes.axhline(0.0, color="black", linewidth=0.6)
        axes.set_xlabel("insertion depth [mm]")
        axes.set_ylabel(axis_label("push force", "mN"))
        axes.set_title(f"{TITLES[wire]}; line: best EI, band: low to high", loc="left", fontsize=9.5)
        axes.legend(frameon=False, fontsize=9)
        _draw_shapes(panels[1, column], wire, runs[wire, "best"])
        label_places(panels[1, column], y=column == 0)
    return figure


def _draw_shapes(axes: Any, wire: str, result: Result) -> None:
    tidy(axes)
    draw_vessel(axes, result)
    depth = result.values("insertion_depth")
    turn = int(np.argmax(depth))
    wanted = min(SHOWN, depth[turn])
    for chosen, style, word in ((np.arange(turn + 1), "-", "in"), (np.arange(turn, len(depth)), "--", "out")):
        i = int(chosen[np.argmin(np.abs(depth[chosen] - wanted))])
        axes.plot(*(beyond_exit(result, i) * 1e3).T, style, color=COLOURS[wire], linewidth=1.5, label=word, zorder=5)
    axes.set_aspect("equal")
    axes.set_xlim(-4, 62)
    axes.set_ylim(-15, 36)
    axes.set_title(f"shape at {wanted * 1e3:.0f} mm, best EI", loc="left", fontsize=9.5)
    axes.legend(loc="upper left", fontsize=9, frameon=False)


if __name__ == "__main__":
    shared.command(main)
