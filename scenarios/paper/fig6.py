"""Fig. 6: both wires (n = 200) in the phantom at several depths, side by side, and how much of each touches the wall.

The phantom is ours, so the shapes are not the paper's; compared is which of the wires touches more.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import shared
from shared import COLOURS, ESTIMATES, OUT, TITLES, WIRES

from gw_exudyn import Result
from gw_exudyn.plots import save_figure
from gw_exudyn.plots.scene import beyond_exit, draw_vessel
from gw_exudyn.plots.style import label_places, new_figure, tidy

DEPTHS = (20e-3, 40e-3, 60e-3, 80e-3)
"""m, of insertion."""

NEAR = 0.1e-3
"""m. A part of the wire counts as along the wall where its surface is no farther from it."""

Runs = dict[tuple[str, str], Result]


def main(out: Path = OUT, quick: bool = False) -> None:
    """Run, draw, and write fig6.csv (contact against depth) and fig6-summary.csv."""
    runs = shared.run_all("fig6", shared.phantom_cases(WIRES, {"wire.segments": 200}, quick), out)
    shared.check(runs.values())
    touching = {key: Touching(result) for key, result in runs.items()}
    depth = runs["universal", "best"].values("insertion_depth")
    rows: list[dict[str, Any]] = [{"insertion_depth [mm]": d * 1e3} for d in depth]
    for (wire, estimate), touch in touching.items():
        for i, row in enumerate(rows):
            row[f"{wire} {estimate} length [mm]"] = touch.length[i] * 1e3
            row[f"{wire} {estimate} contacts"] = int(touch.contacts[i])
    shared.write_table(out / "fig6.csv", rows)
    shared.write_table(out / "fig6-summary.csv", [_summary(*key, runs[key], touching[key]) for key in runs])
    save_figure(_draw(runs, touching, depth), out / "fig6")


class Touching:
    """How much of a wire touches the vessel, at each output: length (t,), m, within NEAR of a wall; contacts (t,),
    places with force: neighbouring nodes are one."""

    def __init__(self, result: Result) -> None:
        count = len(result.time)
        self.length = np.array([_length_along_wall(result, i) for i in range(count)])
        self.contacts = np.array([_separate_contacts(result, i) for i in range(count)])


def _length_along_wall(result: Result, instant: int) -> float:
    """m, of the segments outside of the catheter whose middle is close to a wall of the vessel."""
    from shapely import LineString, MultiLineString, distance, points

    nodes = beyond_exit(result, instant)
    if len(nodes) < 2:
        return 0.0
    walls = MultiLineString([LineString(line) for line in result.vessel_outline])
    apart = distance(walls, points((nodes[1:] + nodes[:-1]) / 2)) - result.scenario.wire.diameter / 2
    return float(np.hypot(*np.diff(nodes, axis=0).T)[apart <= NEAR].sum())


def _separate_contacts(result: Result, instant: int) -> int:
    """Contacts with the vessel that carry force, those at most two segments apart along the wire taken as one."""
    found = result.contacts_at(instant)
    place = np.sort(found["contact_arc_length"][found["contact_owner"] == 0])
    apart = 2.01 * np.abs(np.diff(result.values("node_arc_length"))).max()
    return int(np.count_nonzero(np.diff(place) > apart) + (len(place) > 0))


def _summary(wire: str, estimate: str, result: Result, touch: Touching) -> dict[str, Any]:
    depth = result.values("insertion_depth")
    return {
        "wire": wire,
        "estimate": estimate,
        "status": shared.status(result),
        "mean_length_along_wall [mm]": touch.length.mean() * 1e3,
        "final_length_along_wall [mm]": touch.length[-1] * 1e3,
        "mean_contacts": touch.contacts.mean(),
        "most_contacts": int(touch.contacts.max()),
        "final_contacts": int(touch.contacts[-1]),
        **{
            f"tip_x at {d * 1e3:g} mm [mm]": float(np.interp(d, depth, result.values("tip_x"))) * 1e3
            for d in DEPTHS
            if d <= depth[-1] + 1e-9
        },
        **{
            f"tip_y at {d * 1e3:g} mm [mm]": float(np.interp(d, depth, result.values("tip_y"))) * 1e3
            for d in DEPTHS
            if d <= depth[-1] + 1e-9
        },
    }


def _draw(runs: Runs, touching: dict[tuple[str, str], Touching], depth: Any) -> Any:
    figure = new_figure(11.0, 9.0)
    grid = figure.add_gridspec(2, 2, height_ratios=(1.5, 1.0))
    for column, wire in enumerate(WIRES):
        axes = figure.add_subplot(grid[0, column])
        _draw_wire(axes, wire, runs)
        label_places(axes, y=column == 0)
    lengths = {key: touch.length * 1e3 for key, touch in touching.items()}
    _draw_curves(figure.add_subplot(grid[1, 0]), depth, lengths, "length within 0.1 mm of a wall [mm]")
    counts = {key: touch.contacts.astype(float) for key, touch in touching.items()}
    axes = figure.add_subplot(grid[1, 1])
    _draw_curves(axes, depth, counts, "separate contacts with force")
    axes.set_yticks(range(int(max(one.max() for one in counts.values())) + 1))
    return figure


def _draw_wire(axes: Any, wire: str, runs: Runs) -> None:
    tidy(axes)
    draw_vessel(axes, runs[wire, "best"])
    for d in DEPTHS:
        shapes = []
        for estimate in ESTIMATES:
            result = runs[wire, estimate]
            reached = result.values("insertion_depth") >= d - 1e-9
            if reached.any():
                shapes.append(beyond_exit(result, int(np.argmax(reached))) * 1e3)
        if not shapes:
            continue
        axes.fill(
            *np.concatenate([shapes[0], shapes[-1][::-1]]).T, color=COLOURS[wire], alpha=0.25, linewidth=0, zorder=4
        )
        strength = 0.35 + 0.65 * d / DEPTHS[-1]
        axes.plot(*shapes[1].T, color=COLOURS[wire], alpha=strength, linewidth=1.6, zorder=5)
        axes.plot(*shapes[1][-1:].T, "o", color=COLOURS[wire], alpha=strength, markersize=4, zorder=6)
    axes.set_aspect("equal")
    axes.set_xlim(-4, 78)
    axes.set_ylim(-22, 38)
    depths = ", ".join(f"{d * 1e3:g}" for d in DEPTHS)
    axes.set_title(f"{TITLES[wire]} at {depths} mm\nline: best EI, band: low to high", loc="left", fontsize=9.5)


def _draw_curves(axes: Any, depth: Any, values: dict[tuple[str, str], Any], label: str) -> None:
    tidy(axes)
    for wire in WIRES:
        low, high = shared.band([values[wire, e] for e in ESTIMATES])
        axes.fill_between(depth * 1e3, low, high, color=COLOURS[wire], alpha=0.22, linewidth=0)
        axes.plot(depth * 1e3, values[wire, "best"], color=COLOURS[wire], linewidth=1.5, label=TITLES[wire])
    axes.set_xlabel("insertion depth [mm]")
    axes.set_ylabel(label)
    axes.legend(loc="upper left", fontsize=9, frameon=False)


if __name__ == "__main__":
    shared.command(main)
