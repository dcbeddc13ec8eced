"""A band on the push force from what is not known, friction and bending stiffness, and which of these it comes from.

The paper gives one value of each and names them among the reasons why simulation and experiment differ. Sobol' indices
after Saltelli et al. 2010 by SALib; samples are few, and the intervals of 95 % that stand beside the indices are to be
read with them.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import shared
from shared import COLOURS, OUT, TITLES, WIRES, Case

from gw_exudyn import Result, load_scenario
from gw_exudyn.plots import save_figure
from gw_exudyn.plots.style import axis_label, new_figure, tidy

BASE_SAMPLES = 32
FRICTION = (0.05, 0.6)
"""The range of the paper's Fig. 9 as we run it; uniform. Published values for guidewires fill it."""

NAMES = ("friction", "tip", "shaft")
WORDS = {"friction": "friction", "tip": "EI of the tip", "shaft": "EI of the shaft"}
OUTPUTS = ("peak_push [mN]", "mean_push [mN]", "peak_wall_force [mN]")
DEPTH = 80e-3
COARSE = {"wire.segments": 40, "solver.step": 0.1, "output.interval": 0.2}


def main(out: Path = OUT, quick: bool = False) -> None:
    """Run, draw, and write uncertainty.csv (samples), uncertainty-band.csv and uncertainty-indices.csv."""
    base = 2 if quick else BASE_SAMPLES
    designs = {wire: _design(wire, base) for wire in WIRES}
    extra = {"wire.segments": 20, "drive.distance": 0.03} if quick else {}
    cases = {
        (wire, number): Case(
            WIRES[wire],
            {
                **COARSE,
                "contact.friction_coefficient": float(point[0]),
                "wire.stiffness_factor": {"tip": float(point[1]), "shaft": float(point[2])},
                **extra,
            },
        )
        for wire, points in designs.items()
        for number, point in enumerate(points)
    }
    found = shared.run_all("uncertainty", cases, out, keep=_outcome)
    by_wire = {wire: [found[wire, i] for i in range(len(points))] for wire, points in designs.items()}
    shared.write_table(out / "uncertainty.csv", _samples(designs, by_wire))
    indices = [row for wire in WIRES for row in _indices(wire, by_wire[wire])]
    shared.write_table(out / "uncertainty-indices.csv", indices)
    depth = _grid(extra.get("drive.distance", DEPTH))
    bands = {wire: _band(outcomes) for wire, outcomes in by_wire.items()}
    shared.write_table(out / "uncertainty-band.csv", _band_rows(depth, bands))
    save_figure(_draw(depth, bands, indices), out / "uncertainty")


def _ranges(wire: str) -> dict[str, tuple[float, float]]:
    """Friction; factors of the best estimate of EI of tip and shaft, to the bounds of the catalogue."""
    tip, shaft = zip(*(_stiffness(wire, estimate) for estimate in ("low", "best", "high")), strict=True)
    return {
        "friction": FRICTION,
        "tip": (tip[0] / tip[1], tip[2] / tip[1]),
        "shaft": (shaft[0] / shaft[1], shaft[2] / shaft[1]),
    }


def _stiffness(wire: str, estimate: str) -> tuple[float, float]:
    """EI of tip and shaft, N m^2."""
    pieces = load_scenario(WIRES[wire], {"wire.estimate": estimate}).wire.effective_stiffness
    return pieces[0].value, pieces[-1].value


def _problem() -> dict[str, Any]:
    return {"num_vars": len(NAMES), "names": list(NAMES), "bounds": [[0.0, 1.0]] * len(NAMES)}


def _design(wire: str, base: int) -> Any:
    """(base * 5, 3) float. Saltelli's design over friction (uniform) and both factors (uniform in their logarithm)."""
    from SALib.sample import sobol

    unit = sobol.sample(_problem(), base, calc_second_order=False, seed=1)
    ranges = _ranges(wire)
    columns = [ranges["friction"][0] + unit[:, 0] * np.diff(ranges["friction"])[0]]
    for i, name in ((1, "tip"), (2, "shaft")):
        low, high = ranges[name]
        columns.append(low * (high / low) ** unit[:, i])
    return np.round(np.column_stack(columns), 9)


def _grid(depth: float) -> Any:
    return np.linspace(0.0, depth, 161)


def _outcome(result: Result) -> dict[str, Any]:
    """What is kept of a run: its status, the outputs (mN), and the push force over depth, NaN where it had ended."""
    end = 2e-3 * result.scenario.drive.duration
    return {
        "status": shared.status(result),
        "trusted": result.status.status.trusted,
        "push": shared.over(result, "push_force", _grid(end), "insertion_depth"),
        "peak_push [mN]": result.peaks["push_force"][0] * 1e3,
        "mean_push [mN]": float(result.values("push_force").mean()) * 1e3,
        "peak_wall_force [mN]": result.peaks["wall_force_max"][0] * 1e3,
    }


def _samples(designs: dict[str, Any], by_wire: dict[str, list[dict[str, Any]]]) -> list[dict[str, Any]]:
    return [
        {
            "wire": wire,
            "sample": number,
            "friction": point[0],
            "tip_factor": point[1],
            "shaft_factor": point[2],
            **{name: outcome[name] for name in OUTPUTS},
            "status": outcome["status"],
        }
        for wire, points in designs.items()
        for number, (point, outcome) in enumerate(zip(points, by_wire[wire], strict=True))
    ]


def _indices(wire: str, outcomes: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Sobol' indices of the outputs' logarithms: forces scale with EI, so that factors add up there."""
    from SALib.analyze import sobol

    rows = []
    for name in OUTPUTS:
        values = np.log(np.maximum([outcome[name] for outcome in outcomes], 1e-6))
        found = sobol.analyze(_problem(), values, calc_second_order=False, seed=1, num_resamples=200)
        rows += [
            {
                "wire": wire,
                "output": f"log of {name}",
                "parameter": parameter,
                "S1": float(found["S1"][i]),
                "S1_interval": float(found["S1_conf"][i]),
                "ST": float(found["ST"][i]),
                "ST_interval": float(found["ST_conf"][i]),
                "runs": len(outcomes),
                "not_completed": sum(outcome["status"] != "completed" for outcome in outcomes),
                "not_trusted": sum(not outcome["trusted"] for outcome in outcomes),
            }
            for i, parameter in enumerate(NAMES)
        ]
    return rows


def _band(outcomes: list[dict[str, Any]]) -> Any:
    """(3, k) float, N. 5th, 50th and 95th percentile of the push force over depth, of the independent samples: the
    first and last of each group of Saltelli's design."""
    size = len(NAMES) + 2
    chosen = [o["push"] for i, o in enumerate(outcomes) if i % size in (0, size - 1) and o["trusted"]]
    return np.nanpercentile(np.array(chosen), (5, 50, 95), axis=0)


def _band_rows(depth: Any, bands: dict[str, Any]) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = [{"insertion_depth [mm]": d * 1e3} for d in depth]
    for wire, curves in bands.items():
        for percent, curve in zip((5, 50, 95), curves, strict=True):
            for row, force in zip(rows, curve, strict=True):
                row[f"{wire} push {percent} % [mN]"] = float(force) * 1e3
    return rows


def _draw(depth: Any, bands: dict[str, Any], indices: list[dict[str, Any]]) -> Any:
    figure = new_figure(11.0, 7.4)
    panels = figure.subplots(2, 2)
    for column, wire in enumerate(WIRES):
        axes = panels[0, column]
        tidy(axes)
        low, middle, high = bands[wire] * 1e3
        axes.fill_between(depth * 1e3, low, high, color=COLOURS[wire], alpha=0.25, linewidth=0, label="5 to 95 %")
        axes.plot(depth * 1e3, middle, color=COLOURS[wire], linewidth=1.5, label="median")
        axes.set_xlabel("insertion depth [mm]")
        axes.set_ylabel(axis_label("push force", "mN"))
        ranges = f"friction {FRICTION[0]:g} to {FRICTION[1]:g}, EI low to high"
        axes.set_title(f"{TITLES[wire]}: {ranges}", loc="left", fontsize=9.5)
        axes.legend(frameon=False, fontsize=9, loc="upper left")
        _draw_indices(panels[1, column], [row for row in indices if row["wire"] == wire])
    return figure


def _draw_indices(axes: Any, rows: list[dict[str, Any]]) -> None:
    tidy(axes)
    outputs = list(dict.fromkeys(row["output"] for row in rows))
    for i, parameter in enumerate(NAMES):
        chosen = [row for row in rows if row["parameter"] == parameter]
        for name, shift, alpha in (("S1", -0.06, 1.0), ("ST", 0.06, 0.45)):
            axes.errorbar(
                np.arange(len(outputs)) + (i - 1) * 0.26 + shift, [row[name] for row in chosen],
                yerr=[row[f"{name}_interval"] for row in chosen], fmt="os^"[i], color="#202020", alpha=alpha,
                markersize=6, capsize=3, label=f"{WORDS[parameter]}, {'first order' if name == 'S1' else 'total'}",
            )  # fmt: skip
    axes.axhline(0.0, color="black", linewidth=0.6)
    axes.set_ylim(-0.3, 1.5)
    axes.set_xticks(range(len(outputs)), [name.replace(" [mN]", "").replace("_", " ") for name in outputs])
    axes.set_ylabel("Sobol' index, 95 % interval")
    axes.legend(fontsize=8, frameon=False, ncols=3, loc="upper center", bbox_to_anchor=(0.5, -0.1))


if __name__ == "__main__":
    shared.command(main)
