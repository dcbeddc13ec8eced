"""Fig. 9: force of the Amplatz on the vessel along y against time, for five friction coefficients.

What the paper's curves for other values than 0.4 are is not in its text. Compared are the order of the curves and where
their peaks lie.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import corners
import numpy as np
import shared
from shared import ESTIMATES, OUT

from gw_exudyn import Result
from gw_exudyn.metrics import metrics
from gw_exudyn.plots import save_figure
from gw_exudyn.plots.style import NOTE_COLOUR, axis_label, new_figure, tidy

FRICTIONS = (0.05, 0.1, 0.2, 0.4, 0.6)
FORCE = "wall_force_y"


def main(out: Path = OUT, quick: bool = False) -> None:
    """Run, draw, and write fig9.csv (the curves), fig9-peaks.csv and fig9-summary.csv."""
    frictions = FRICTIONS[1::3] if quick else FRICTIONS
    cases = {
        (friction, estimate): case
        for friction in frictions
        for (_, estimate), case in shared.phantom_cases(
            ["amplatz"], {"wire.segments": 200, "contact.friction_coefficient": friction}, quick
        ).items()
    }
    runs = shared.run_all("fig9", cases, out)
    shared.check(runs.values())
    grid = runs[frictions[0], "best"].time
    rows: list[dict[str, Any]] = [{"time [s]": float(t)} for t in grid]
    for (friction, estimate), result in runs.items():
        for row, force in zip(rows, shared.over(result, FORCE, grid), strict=True):
            row[f"friction {friction:g} {estimate} [mN]"] = float(force) * 1e3
    shared.write_table(out / "fig9.csv", rows)
    shared.write_table(out / "fig9-summary.csv", [_summary(*key, result) for key, result in runs.items()])
    shared.write_table(out / "fig9-peaks.csv", [row for key, result in runs.items() for row in _peaks(*key, result)])
    save_figure(_draw(runs, frictions), out / "fig9")


def _summary(friction: float, estimate: str, result: Result) -> dict[str, Any]:
    found = metrics(result)
    force = result.values(FORCE)
    return {
        "friction": friction,
        "estimate": estimate,
        "status": shared.status(result),
        "peak_force_y [mN]": float(np.abs(force).max()) * 1e3,
        "rms_force_y [mN]": float(np.sqrt(np.mean(force**2))) * 1e3,
        "mean_normal_force [mN]": float(result.values("wall_force_normal").mean()) * 1e3,
        "largest_contact [mN]": found["wall_force_max"].value * 1e3,
        "peak_tip_force [mN]": found["tip_force_max"].value * 1e3,
        "mean_tip_force [mN]": float(result.values("tip_force").mean()) * 1e3,
        "peak_push_force [mN]": found["push_force_max"].value * 1e3,
        "mean_bending_energy [uJ]": float(result.values("elastic_energy").mean()) * 1e6,
        "peak_bending_energy [uJ]": float(result.values("elastic_energy").max()) * 1e6,
    }


def _peaks(friction: float, estimate: str, result: Result) -> list[dict[str, Any]]:
    force = result.values(FORCE)
    return [
        {
            "friction": friction,
            "estimate": estimate,
            "time [s]": result.time[i],
            "insertion_depth [mm]": result.values("insertion_depth")[i] * 1e3,
            "force_y [mN]": force[i] * 1e3,
            "corner_of_the_tip": corner,
        }
        for i, corner in corners.peaks(result, force)
    ]


def _draw(runs: dict[Any, Result], frictions: tuple[float, ...]) -> Any:
    from matplotlib import colormaps

    figure = new_figure(8.0, 9.5)
    panels = figure.subplots(len(frictions) + 1, 1, sharex=True, height_ratios=[1.7] + [1.0] * len(frictions))
    colours = colormaps["viridis"](np.linspace(0.0, 0.85, len(frictions)))
    for axes, friction, colour in zip(panels[1:], frictions, colours, strict=True):
        best = runs[friction, "best"]
        low, high = shared.band([shared.over(runs[friction, e], FORCE, best.time) for e in ESTIMATES])
        for one in (panels[0], axes):
            one.plot(best.time, best.values(FORCE) * 1e3, color=colour, linewidth=1.5, label=f"{friction:g}")
        axes.fill_between(best.time, low * 1e3, high * 1e3, color=colour, alpha=0.22, linewidth=0)
        axes.plot(
            [best.time[i] for i, _ in corners.peaks(best, best.values(FORCE))],
            [best.values(FORCE)[i] * 1e3 for i, _ in corners.peaks(best, best.values(FORCE))],
            linestyle="none", marker="o", markersize=4, color=colour,
        )  # fmt: skip
        axes.set_title(f"friction {friction:g}", loc="left", fontsize=9, pad=2)
    for axes in panels:
        tidy(axes)
        axes.axhline(0.0, color="black", linewidth=0.6)
        axes.margins(x=0.01)
        _shade_corners(axes, runs[frictions[-1], "best"])
    panels[0].legend(title="friction", loc="upper left", fontsize=8.5, title_fontsize=8.5, frameon=False)
    panels[0].set_title("best estimate of EI", loc="left", fontsize=9, pad=2)
    panels[-1].set_xlabel("time [s]")
    figure.supylabel(axis_label("force on the vessel along y", "mN"), fontsize=10)
    figure.suptitle(
        "Amplatz Super Stiff. Band: low to high estimate of EI; dots: peaks; grey: tip at a corner",
        fontsize=10.5, x=0.02, ha="left",
    )  # fmt: skip
    return figure


def _shade_corners(axes: Any, result: Result) -> None:
    """Grey where the tip is at a corner."""
    at = np.array([corners.corner_at(result, i) != "none" for i in range(len(result.time))])
    axes.fill_between(
        result.time, 0, 1, where=at, color=NOTE_COLOUR, alpha=0.12, linewidth=0, zorder=0,
        transform=axes.get_xaxis_transform(),
    )  # fmt: skip


if __name__ == "__main__":
    shared.command(main)
