"""Fig. 4 and Eq. 1: three-point bending of both wires at five stations, apparent against true bending stiffness.

The values that the paper measured are quoted in no text that we have. Ours are the catalogue's ESTIMATE, put through
the same test: what a step of EI does to the apparent value, and whether the load cell could have seen it. The cells'
resolution is not in the paper; ASSUMED is 0.1 % of full scale.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import shared
from shared import COLOURS, ESTIMATES, HERE, OUT, TITLES, Case

from gw_exudyn import Result, load_scenario
from gw_exudyn.plots import save_figure
from gw_exudyn.plots.style import NOTE_COLOUR, axis_label, new_figure, tidy

MODELS = {"universal": "universal-ii", "amplatz": "amplatz-super-stiff"}
STATIONS = (15e-3, 45e-3, 75e-3, 105e-3, 135e-3)
"""m from the tip: the middle of every 30 mm."""

SPAN = 28e-3
"""m between the supports, so that the wire reaches over both at the first station, which begins at its tip."""

DEFLECTION = 1e-3
NOSE_RADIUS = 1e-3
CELLS = {"10 N": 10.0, "1 N": 1.0}
RESOLUTION = 1e-3
"""Assumed, of full scale."""


def main(out: Path = OUT, quick: bool = False) -> None:
    """Run, draw, and write fig4.csv."""
    stations = STATIONS[1:2] if quick else STATIONS
    cases = {
        (wire, estimate, station): _case(wire, estimate, station, 100 if quick else 200)
        for wire in MODELS
        for estimate in ESTIMATES
        for station in stations
    }
    runs = shared.run_all("fig4", cases, out)
    shared.check(runs.values())
    rows = [_row(*key, result) for key, result in runs.items()]
    shared.write_table(out / "fig4.csv", rows)
    save_figure(_draw(rows), out / "fig4")


def _case(wire: str, estimate: str, station: float, segments: int) -> Case:
    radius = load_scenario(HERE / "three-point.yaml", {"wire.model": MODELS[wire]}).wire.diameter / 2
    middle, aside = 0.15 - station, NOSE_RADIUS + radius
    return Case(
        HERE / "three-point.yaml",
        {
            "wire.model": MODELS[wire],
            "wire.estimate": estimate,
            "wire.segments": segments,
            "supports.0.at": [middle - SPAN / 2, -aside],
            "supports.1.at": [middle + SPAN / 2, -aside],
            "nose.at": [middle, aside],
        },
    )


def _row(wire: str, estimate: str, station: float, result: Result) -> dict[str, Any]:
    """EI in N mm^2."""
    force, deflection = float(result.values("nose_force")[-1]), float(result.values("nose_travel")[-1])
    per_force = SPAN**3 / (48 * deflection) * 1e6  # N mm^2 of bending stiffness per N [Eq. 1]
    true = [_true(result, station + shift) for shift in np.linspace(-SPAN / 2, SPAN / 2, 281)]
    return {
        "wire": wire,
        "estimate": estimate,
        "station [mm]": station * 1e3,
        "force [mN]": force * 1e3,
        "apparent_EI [N mm2]": force * per_force,
        "true_EI_at_the_nose [N mm2]": _true(result, station),
        "lowest_true_EI_in_the_span [N mm2]": min(true),
        "highest_true_EI_in_the_span [N mm2]": max(true),
        **{f"error_of_the_{name}_cell [N mm2]": full * RESOLUTION * per_force for name, full in CELLS.items()},
        "status": shared.status(result),
    }


def _true(result: Result, place: float) -> float:
    """EI, N mm^2, at a place (m from the tip)."""
    pieces = result.scenario.wire.effective_stiffness
    inside = [piece for piece in pieces if piece.start <= place <= piece.end] or [pieces[-1]]
    return inside[0].value * 1e6


def _draw(rows: list[dict[str, Any]]) -> Any:
    figure = new_figure(11.0, 4.8)
    for number, (axes, wire) in enumerate(zip(figure.subplots(1, 2), ("amplatz", "universal"), strict=True)):
        tidy(axes)
        _draw_true(axes, wire)
        chosen = {e: [row for row in rows if (row["wire"], row["estimate"]) == (wire, e)] for e in ESTIMATES}
        place = [row["station [mm]"] for row in chosen["best"]]
        apparent = {e: np.array([row["apparent_EI [N mm2]"] for row in chosen[e]]) for e in ESTIMATES}
        for name, shift, colour in (("10 N", -1.2, NOTE_COLOUR), ("1 N", 1.2, COLOURS[wire])):
            error = np.array([row[f"error_of_the_{name}_cell [N mm2]"] for row in chosen["best"]])
            # On a scale of logarithms an error down to zero or below goes to the foot of the axes.
            below = np.minimum(error, apparent["best"] - 1e-3)
            axes.errorbar(
                np.array(place) + shift, apparent["best"], yerr=[below, error], fmt="o", markersize=5, capsize=4,
                color=colour, label=f"apparent, Eq. 1, best EI, ± {RESOLUTION:.1%} of a {name} cell",
            )  # fmt: skip
        for estimate, marker in (("low", "v"), ("high", "^")):
            axes.plot(
                place, apparent[estimate], marker, color=COLOURS[wire], alpha=0.5, label=f"apparent, {estimate} EI"
            )
        axes.set_yscale("log")
        axes.set_ylim(0.3, 800)
        axes.set_xlim(0, 150)
        axes.set_xticks(range(0, 151, 30))
        axes.set_xlabel("distance from the tip [mm]")
        if number == 0:
            axes.set_ylabel(axis_label("bending stiffness EI", "N mm²"))
        axes.set_title(
            f"({'ab'[number]}) {TITLES[wire]}: an estimate, not the paper's values", loc="left", fontsize=9.5
        )
        axes.legend(fontsize=8, frameon=False, loc="upper left" if wire == "universal" else "lower right")
    return figure


def _draw_true(axes: Any, wire: str) -> None:
    """EI along the wire as a line, low to high as a band."""
    place = np.linspace(0.0, 150.0, 1501)
    values = {}
    for estimate in ESTIMATES:
        scenario = load_scenario(HERE / "three-point.yaml", {"wire.model": MODELS[wire], "wire.estimate": estimate})
        pieces = scenario.wire.effective_stiffness
        values[estimate] = np.array([next(p.value for p in pieces if x * 1e-3 <= p.end + 1e-9) * 1e6 for x in place])
    axes.fill_between(place, values["low"], values["high"], color=COLOURS[wire], alpha=0.18, linewidth=0)
    axes.plot(place, values["best"], color=COLOURS[wire], linewidth=1.2, label="true, band: low to high")


if __name__ == "__main__":
    shared.command(main)
