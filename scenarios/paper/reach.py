"""Which wires of the catalogue can be pushed into a side branch, and how hard they press on its walls.

The paper names its objective, the choice of a wire for a vessel, and its ranges: bifurcations of 60 to 120 degrees,
branches of 2 to 8 mm. It compares two wires in one phantom. This is the map that its objective asks for, in a vessel of
our own (bifurcation.yaml).

Of most wires the shaft alone is known. All of these get the same ASSUMED floppy tip, so that what differs is the shaft.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import shared
from shared import ESTIMATES, HERE, OUT, Case

from gw_exudyn import Result
from gw_exudyn.metrics import metrics
from gw_exudyn.plots import save_figure
from gw_exudyn.plots.style import NOTE_COLOUR, new_figure

ANGLES = (60, 75, 90, 105, 120)
"""Degrees, between trunk and side branch."""

DIAMETERS = (2, 4, 8)
"""mm, of the side branch."""

FLOPPY_TIP = {"length": 30e-3, "bending_stiffness": 5e-6, "taper": 30e-3}
"""Assumed, in SI: 30 mm of 5 N mm^2, the estimate of the Amplatz's tip, and a taper of 30 mm to the shaft."""

WHOLE_WIRES = ("universal-ii", "amplatz-super-stiff")
SHAFTS = (
    "amplatz-bard-shaft",
    "heavy-duty-shaft",
    "amplatz-stiff-cook-shaft",
    "amplatz-extra-stiff-cook-shaft",
    "amplatz-super-stiff-shaft",
    "amplatz-ultra-stiff-cook-shaft",
    "backup-meier-shaft",
    "lunderquist-extra-stiff-shaft",
)
"""From the most flexible to the stiffest."""

FAR = 30e-3
"""m. A wire has reached the branch if at the end its tip is in it, so far along it."""


def main(out: Path = OUT, quick: bool = False) -> None:
    """Run, draw, and write reach.csv."""
    found = shared.run_all("reach", _cases(quick), out, keep=_outcome)
    rows = [
        {"wire": wire, "estimate": estimate, "angle [deg]": angle, "diameter [mm]": diameter, **outcome}
        for (wire, estimate, angle, diameter), outcome in found.items()
    ]
    shared.write_table(out / "reach.csv", rows)
    save_figure(_draw(rows), out / "reach")


def _cases(quick: bool) -> dict[tuple[str, str, int, int], Case]:
    wires = [(name, estimate) for name in WHOLE_WIRES for estimate in ESTIMATES] + [(name, "best") for name in SHAFTS]
    angles, diameters = (ANGLES[:1], DIAMETERS[1:2]) if quick else (ANGLES, DIAMETERS)
    extra = {"wire.segments": 30, "drive.distance": 0.02} if quick else {}
    return {
        (name, estimate, angle, diameter): Case(
            HERE / "bifurcation.yaml",
            {
                "wire.model": name,
                "wire.estimate": estimate,
                "vessel.branches.side.angle": f"{angle} deg",
                "vessel.branches.side.diameter": f"{diameter} mm",
                **({"wire.floppy_tip": FLOPPY_TIP} if name in SHAFTS else {}),
                **extra,
            },
        )
        for name, estimate in (wires[::6] if quick else wires)
        for angle in angles
        for diameter in diameters
    }


def _outcome(result: Result) -> dict[str, Any]:
    numbers = metrics(result)
    along = _along_branch(result)
    missed = "drawn out" if along.max() >= FAR / 2 else "passed by"
    outcome = "reached" if along[-1] >= FAR else missed
    trusted = result.status.status.trusted
    return {
        "outcome": outcome if trusted else "no answer",
        "deepest_in_branch [mm]": float(along.max()) * 1e3,
        "final_in_branch [mm]": float(along[-1]) * 1e3,
        "largest_wall_force [mN]": numbers["wall_force_max"].value * 1e3,
        "largest_push_force [mN]": numbers["push_force_max"].value * 1e3,
        "insertion [mm]": numbers["insertion_depth_max"].value * 1e3,
        "status": shared.status(result),
    }


def _along_branch(result: Result) -> Any:
    """(t,) float, m. How far along the side branch, from the trunk's axis, the tip is; 0 where it is not in it."""
    tip = np.column_stack([result.values("tip_x"), result.values("tip_y")])
    line = result.scenario.vessel.regions()["side"].centre_line
    ahead = (line[-1] - line[0]) / np.hypot(*(line[-1] - line[0]))
    return np.where(result.scenario.vessel.branch_at(tip) == "side", (tip - line[0]) @ ahead, 0.0)


def _draw(rows: list[dict[str, Any]]) -> Any:
    from matplotlib import colormaps
    from matplotlib.colors import LogNorm

    wires = list(dict.fromkeys((row["wire"], row["estimate"]) for row in rows))
    angles = sorted({row["angle [deg]"] for row in rows})
    diameters = sorted({row["diameter [mm]"] for row in rows})
    forces = [row["largest_wall_force [mN]"] for row in rows if row["outcome"] == "reached"] or [1.0]
    norm, colours = LogNorm(min(forces), max(max(forces), min(forces) * 1.01)), colormaps["viridis_r"]
    figure = new_figure(2.4 + 3.4 * len(diameters), 1.8 + 0.36 * len(wires))
    panels = figure.subplots(1, len(diameters), sharey=True, squeeze=False)[0]
    for axes, diameter in zip(panels, diameters, strict=True):
        for row in rows:
            if row["diameter [mm]"] == diameter:
                x, y = angles.index(row["angle [deg]"]), wires.index((row["wire"], row["estimate"]))
                _draw_cell(axes, x, y, row, colours, norm)
        axes.set_xticks(range(len(angles)), [f"{angle}°" for angle in angles])
        axes.set_yticks(range(len(wires)), [_label(*wire) for wire in wires])
        axes.set_xlim(-0.5, len(angles) - 0.5)
        axes.set_ylim(len(wires) - 0.5, -0.5)
        axes.set_title(f"branch of {diameter} mm", loc="left", fontsize=10)
        axes.set_xlabel("angle of the branch")
        axes.tick_params(labelsize=8.5, length=0)
    _add_bar(figure, panels, norm, colours)
    figure.suptitle(
        "Largest force of one contact [mN] where the wire reaches 30 mm into the branch.  "
        "–: passes by;  ↩: enters, and is drawn out again;  ?: run not to be trusted",  # noqa: RUF001
        fontsize=10, x=0.01, ha="left",
    )  # fmt: skip
    return figure


def _label(wire: str, estimate: str) -> str:
    return f"{wire}, {estimate} EI" if wire in WHOLE_WIRES else f"{wire} *"


def _draw_cell(axes: Any, x: int, y: int, row: dict[str, Any], colours: Any, norm: Any) -> None:
    from matplotlib.patches import Rectangle

    force = row["largest_wall_force [mN]"]
    reached = row["outcome"] == "reached"
    face = colours(norm(force)) if reached else "#EDEDED"
    axes.add_patch(Rectangle((x - 0.5, y - 0.5), 1, 1, facecolor=face, edgecolor="white", linewidth=1.0))
    sign = {"passed by": "–", "drawn out": "↩", "no answer": "?"}.get(row["outcome"])  # noqa: RUF001
    dark = reached and norm(force) > 0.5
    axes.text(
        x, y, sign or f"{force:.0f}", ha="center", va="center", fontsize=8.5,
        color="white" if dark else ("black" if reached else NOTE_COLOUR),
    )  # fmt: skip


def _add_bar(figure: Any, panels: Any, norm: Any, colours: Any) -> None:
    from matplotlib.cm import ScalarMappable

    bar = figure.colorbar(ScalarMappable(norm, colours), ax=list(panels), pad=0.01, fraction=0.04)
    bar.set_label("largest force of one contact [mN]")
    panels[0].annotate(
        f"* shaft known alone; assumed tip: {FLOPPY_TIP['length'] * 1e3:g} mm of "
        f"{FLOPPY_TIP['bending_stiffness'] * 1e6:g} N mm², tapered over {FLOPPY_TIP['taper'] * 1e3:g} mm",
        (0.0, 0.0), xycoords="axes fraction", xytext=(-120, -48), textcoords="offset points", fontsize=8.5,
        color=NOTE_COLOUR, annotation_clip=False,
    )  # fmt: skip


if __name__ == "__main__":
    shared.command(main)
