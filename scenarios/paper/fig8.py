"""Fig. 8: force of the wire on the vessel along y against time, both wires, friction 0.4.

The paper's curves are an experiment in a phantom that is not published in numbers; what can be compared is the order of
the two wires, the shape and the ratio.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import shared
from corners import CORNERS
from shared import COLOURS, ESTIMATES, OUT, TITLES, WIRES

from gw_exudyn import Result
from gw_exudyn.plots import save_figure
from gw_exudyn.plots.style import NOTE_COLOUR, axis_label, new_figure, tidy

FORCE = "wall_force_y"


def main(out: Path = OUT, quick: bool = False) -> None:
    """Run, draw, and write fig8.csv (the curves) and fig8-peaks.csv."""
    runs = shared.run_all("fig8", shared.phantom_cases(WIRES, {"wire.segments": 200}, quick), out)
    shared.check(runs.values())
    grid = runs["universal", "best"].time
    rows = [{"time [s]": float(t)} for t in grid]
    for (wire, estimate), result in runs.items():
        for row, force in zip(rows, shared.over(result, FORCE, grid), strict=True):
            row[f"{wire} {estimate} [mN]"] = float(force) * 1e3
    shared.write_table(out / "fig8.csv", rows)
    shared.write_table(out / "fig8-peaks.csv", [_peaks(wire, est, run) for (wire, est), run in runs.items()])
    save_figure(_draw(runs), out / "fig8")


def _peaks(wire: str, estimate: str, result: Result) -> dict[str, object]:
    force, entry = result.values(FORCE), shared.entries(result)
    largest = int(np.argmax(np.abs(force)))
    return {
        "wire": wire,
        "estimate": estimate,
        "status": shared.status(result),
        "peak_force_y [mN]": force[largest] * 1e3,
        "peak_time [s]": result.time[largest],
        "rms_force_y [mN]": float(np.sqrt(np.mean(force**2))) * 1e3,
        "peak_resultant [mN]": float(np.hypot(result.values("wall_force_x"), force).max()) * 1e3,
        "first_corner_time [s]": entry.get("left", np.nan),
        "second_corner_time [s]": entry.get("target", np.nan),
    }


def _draw(runs: dict[tuple[str, str], Result]) -> object:
    figure = new_figure(8.0, 7.0)
    panels = figure.subplots(3, 1, sharex=True)
    for wire in WIRES:
        low, high = shared.band([shared.over(runs[wire, e], FORCE, runs[wire, "best"].time) for e in ESTIMATES])
        best = runs[wire, "best"]
        for axes in (panels[0], panels[1 if wire == "amplatz" else 2]):
            axes.fill_between(best.time, low * 1e3, high * 1e3, color=COLOURS[wire], alpha=0.22, linewidth=0)
            axes.plot(best.time, best.values(FORCE) * 1e3, color=COLOURS[wire], linewidth=1.5, label=TITLES[wire])
    for axes, title in zip(panels, ("both wires", TITLES["amplatz"], TITLES["universal"]), strict=True):
        tidy(axes)
        axes.axhline(0.0, color="black", linewidth=0.6)
        axes.set_ylabel(axis_label("force along y", "mN"))
        axes.set_title(title, loc="left", fontsize=10)
        axes.margins(x=0.01)
    for panel, wire in ((panels[1], "amplatz"), (panels[2], "universal")):
        _mark_corners(panel, runs[wire, "best"])
    panels[0].legend(loc="upper left", frameon=False, fontsize=9)
    panels[-1].set_xlabel("time [s]")
    figure.suptitle(
        "Force on the vessel along y; line: best estimate of EI, band: low to high estimate", fontsize=10.5, x=0.02,
        ha="left",
    )  # fmt: skip
    return figure


def _mark_corners(axes: object, result: Result) -> None:
    for branch, time in shared.entries(result).items():
        if branch in CORNERS:
            axes.axvline(time, color=NOTE_COLOUR, linewidth=0.9, linestyle=(0, (4, 3)))
            words, where = f" tip past the {CORNERS[branch]} corner", ("data", "axes fraction")
            axes.annotate(words, (time, 0.98), xycoords=where, fontsize=8.5, va="top", color=NOTE_COLOUR)


if __name__ == "__main__":
    shared.command(main)
