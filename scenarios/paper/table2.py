"""Fig. 7 and Table 2: path of the tip, its error and the time to compute it, over the number of segments.

The paper's error is that of its simulation against its experiment; ours is that against 800 segments and contains no
experiment. Its simulated time and its machine are not stated. Compared are how the error falls with the number of
segments and how the time grows.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import shared
from shared import COLOURS, ESTIMATES, OUT, TITLES, WIRES, Case

from gw_exudyn import Result
from gw_exudyn.comparison import compare, course_of
from gw_exudyn.plots import save_figure
from gw_exudyn.plots.scene import draw_vessel
from gw_exudyn.plots.style import BLACK, label_places, new_figure, tidy

SEGMENTS = (20, 40, 100, 200, 400)
REFERENCE = 800
GRADINGS = {"uniform": 1.0, "graded": 4.0}
"""Length of the proximal over that of the distal segment; the paper grades, and does not say how much."""

PAPER = {
    "universal": {20: (4, 4.91), 40: (15, 3.12), 100: (96, 1.68), 200: (469, 0.87), 400: (3534, 0.38)},
    "amplatz": {20: (4, 0.76), 40: (14, 0.70), 100: (91, 0.69), 200: (455, 0.56), 400: (2857, 0.56)},
}
"""Table 2 of the paper: computation time, s, and error, mm."""

Runs = dict[tuple[str, str, str, int], Result]


def main(out: Path = OUT, quick: bool = False) -> None:
    """Run, draw, and write fig7.csv (paths), table2.csv and table2-orders.csv; times stand in timings.csv."""
    segments, reference = ((10, 20), 40) if quick else (SEGMENTS, REFERENCE)
    runs: Runs = shared.run_all("table2", _cases(segments, reference, quick), out)
    shared.check(runs.values())
    rows = [_row(key, result, runs, reference) for key, result in runs.items() if key[3] != reference]
    shared.write_table(out / "table2.csv", rows)
    shared.write_table(out / "table2-orders.csv", _orders(rows))
    shared.write_table(out / "fig7.csv", _paths(runs, reference))
    draw(out, segments, reference, next(iter(runs.values())))


def draw(out: Path, segments: tuple[int, ...], reference: int, any_run: Result) -> None:
    """Figures of the tables as they stand in the folder. any_run : shows the vessel."""
    paths = shared.read_table(out / "fig7.csv")
    save_figure(_draw_paths(paths, segments, reference, any_run), out / "fig7")
    save_figure(_draw_errors(shared.read_table(out / "table2.csv"), segments), out / "table2-error")


def _cases(segments: tuple[int, ...], reference: int, quick: bool) -> dict[tuple[str, str, str, int], Case]:
    """The largest first, so that no long run is left for the end."""
    cases = {}
    for n in sorted((*segments, reference), reverse=True):
        for grading, ratio in GRADINGS.items():
            if n == reference and grading != "uniform":
                continue
            found = shared.phantom_cases(WIRES, {"wire.grading": ratio}, quick)
            for (wire, estimate), case in found.items():
                cases[wire, grading, estimate, n] = Case(case.scenario, {**case.overrides, "wire.segments": n})
    return cases


def _row(key: tuple[str, str, str, int], result: Result, runs: Runs, reference: int) -> dict[str, Any]:
    wire, grading, estimate, n = key
    norms = compare(course_of(runs[wire, "uniform", estimate, reference]), course_of(result))
    return {
        "wire": wire,
        "segments": grading,
        "estimate": estimate,
        "n": n,
        "error [mm]": norms["tip_rms"].value * 1e3,
        "nearest_error [mm]": norms["tip_nearest_rms"].value * 1e3,
        "largest_error [mm]": norms["tip_max"].value * 1e3,
        "paper_error [mm]": float(PAPER[wire].get(n, (np.nan, np.nan))[1]),
        "paper_time [s]": float(PAPER[wire].get(n, (np.nan, np.nan))[0]),
        "solver_steps": result.counters["solver_steps"],
        "newton_iterations": result.counters["newton_iterations"],
        "status": shared.status(result),
    }


def _orders(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Exponents of n, by least squares over all n in logarithms: of our error, and of the paper's error and time."""
    found = []
    for wire, grading, estimate in dict.fromkeys((r["wire"], r["segments"], r["estimate"]) for r in rows):
        chosen = [r for r in rows if (r["wire"], r["segments"], r["estimate"]) == (wire, grading, estimate)]
        n = [r["n"] for r in chosen]
        names = {"error": "error [mm]", "nearest_error": "nearest_error [mm]", "paper_error": "paper_error [mm]"}
        slopes = {f"{name}_exponent": _exponent(n, [r[column] for r in chosen]) for name, column in names.items()}
        iterations = _exponent(n, [r["newton_iterations"] for r in chosen])
        paper_time = _exponent(n, [r["paper_time [s]"] for r in chosen])
        found.append(
            {
                "wire": wire,
                "segments": grading,
                "estimate": estimate,
                **slopes,
                "newton_iterations_exponent": iterations,
                "paper_time_exponent": paper_time,
            }
        )
    return found


def _exponent(n: list[int], values: list[float]) -> float:
    if np.isnan(values).any() or not np.all(np.array(values) > 0):
        return float("nan")
    return float(np.polyfit(np.log(n), np.log(values), 1)[0])


def _paths(runs: Runs, reference: int) -> list[dict[str, Any]]:
    """Every fifth output of the paths: at the best estimate all, at the bounds the reference's."""
    chosen = {key: result for key, result in runs.items() if key[2] == "best" or key[3] == reference}
    grid = next(iter(chosen.values())).time[::5]
    rows: list[dict[str, Any]] = [{"time [s]": float(t)} for t in grid]
    for (wire, grading, estimate, n), result in chosen.items():
        for name in ("x", "y"):
            for row, value in zip(rows, shared.over(result, f"tip_{name}", grid), strict=True):
                row[_column(wire, grading, estimate, n, name)] = float(value) * 1e3
    return rows


def _column(wire: str, grading: str, estimate: str, n: int, name: str) -> str:
    return f"{wire} {grading} {estimate} {n} tip_{name} [mm]"


def _path(paths: list[dict[str, str]], wire: str, estimate: str, n: int) -> Any:
    """(t, 2) float, mm, of uniform segments."""
    return np.array([[float(row[_column(wire, "uniform", estimate, n, name)]) for name in "xy"] for row in paths])


def _draw_paths(paths: list[dict[str, str]], segments: tuple[int, ...], reference: int, any_run: Result) -> Any:
    from matplotlib import colormaps

    figure = new_figure(11.0, 8.0)
    panels = figure.subplots(2, 2, height_ratios=(1.5, 1.0))
    colours = colormaps["viridis"](np.linspace(0, 0.9, len(segments)))
    time = np.array([float(row["time [s]"]) for row in paths])
    for number, wire in enumerate(("amplatz", "universal")):
        axes, below = panels[:, number]
        tidy(axes)
        draw_vessel(axes, any_run)
        band = [_path(paths, wire, estimate, reference) for estimate in ("low", "high")]
        axes.fill(*np.concatenate([band[0], band[1][::-1]]).T, color=BLACK, alpha=0.2, linewidth=0, zorder=3)
        exact = _path(paths, wire, "best", reference)
        tidy(below)
        for n, colour in zip(segments, colours, strict=True):
            path = _path(paths, wire, "best", n)
            axes.plot(*path.T, color=colour, linewidth=1.3, label=f"{n}", zorder=5)
            below.plot(time, np.maximum(np.hypot(*(path - exact).T), 1e-4), color=colour, linewidth=1.2)
        axes.plot(*exact.T, color=BLACK, linewidth=1.0, linestyle=":", label=f"{reference}", zorder=6)
        apart = np.max([np.hypot(*(one - exact).T) for one in band], axis=0)
        below.fill_between(time, 1e-4, np.maximum(apart, 1e-4), color=BLACK, alpha=0.15, linewidth=0)
        axes.set_aspect("equal")
        axes.set_xlim(-4, 78)
        axes.set_ylim(-15, 38)
        axes.set_title(f"({'ab'[number]}) {TITLES[wire]}: path of the tip", loc="left", fontsize=9.5)
        label_places(axes, y=number == 0)
        axes.legend(title="segments", loc="lower right", fontsize=8.5, title_fontsize=8.5, ncols=2, framealpha=0.9)
        below.set_yscale("log")
        below.set_ylim(1e-4, 20)
        below.set_xlabel("time [s]")
        below.set_title(
            f"distance from n = {reference} at equal times; grey: of low and high EI from best",
            loc="left",
            fontsize=9.5,
        )
    panels[1, 0].set_ylabel("distance [mm]")
    return figure


def _draw_errors(rows: list[dict[str, str]], segments: tuple[int, ...]) -> Any:
    figure = new_figure(11.0, 4.6)
    for number, (axes, wire) in enumerate(
        zip(figure.subplots(1, 2, sharey=True), ("amplatz", "universal"), strict=True)
    ):
        tidy(axes)
        for grading, style in (("uniform", "-"), ("graded", "--")):
            values = {
                (e, name): [_value(rows, wire, grading, e, n, name) for n in segments]
                for e in ESTIMATES
                for name in ("error [mm]", "nearest_error [mm]")
            }
            low, high = shared.band([np.array(values[e, "error [mm]"]) for e in ESTIMATES])
            axes.fill_between(segments, low, high, color=COLOURS[wire], alpha=0.15, linewidth=0)
            axes.plot(
                segments, values["best", "error [mm]"], style, color=COLOURS[wire], marker="o", markersize=4,
                label=f"ours, equal times, {grading}",
            )  # fmt: skip
            axes.plot(
                segments, values["best", "nearest_error [mm]"], style, color="#808080", marker="s", markersize=3,
                linewidth=1.0, label=f"ours, nearest point, {grading}",
            )  # fmt: skip
        paper = PAPER[wire]
        axes.plot(
            list(paper), [error for _, error in paper.values()], color=BLACK, marker="x", linestyle=":",
            label="paper, against its experiment",
        )  # fmt: skip
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_ylim(3e-5, 10)
        axes.set_xticks(segments, [str(n) for n in segments])
        axes.minorticks_off()
        axes.set_xlabel("segments n")
        if number == 0:
            axes.set_ylabel("error of the tip's path [mm]")
        axes.set_title(f"{TITLES[wire]}; band: low to high EI", loc="left", fontsize=9.5)
        axes.legend(fontsize=8, frameon=False, loc="lower left")
    return figure


def _value(rows: list[dict[str, str]], wire: str, grading: str, estimate: str, n: int, name: str) -> float:
    return next(
        float(r[name])
        for r in rows
        if (r["wire"], r["segments"], r["estimate"], r["n"]) == (wire, grading, estimate, str(n))
    )


if __name__ == "__main__":
    shared.command(main)
