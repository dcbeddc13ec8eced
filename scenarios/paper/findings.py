"""The paper's results and discussion, sentence by sentence, as checks on our runs over the estimates of EI.

Reads the tables that the other scripts wrote; run those first (`make paper`). A sentence that does not hold here is
reported so; what holds because our phantom or our catalogue was made so is marked as such and proves nothing.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import shared
from shared import ESTIMATES, OUT, WIRES, Case

from gw_exudyn import Result, load_scenario
from gw_exudyn.comparison import compare, course_of

SCALE = 10.0


@dataclass(frozen=True)
class Finding:
    """A sentence of the paper (`says`, shortened, with its place), how it was tested, whether it held at each estimate
    of EI, the number, and whether it holds by construction."""

    says: str
    place: str
    test: str
    held: Mapping[str, bool]
    number: str
    by_construction: bool = False

    @property
    def verdict(self) -> str:
        """In words, over the estimates."""
        good = [name for name, held in self.held.items() if held]
        if len(good) == len(self.held):
            words = "holds"
        elif good:
            words = f"in part: {', '.join(good)}; not {', '.join(n for n in self.held if n not in good)}"
        else:
            words = "does not hold"
        return f"{words} (by construction)" if self.by_construction else words


def main(out: Path = OUT, quick: bool = False) -> None:
    """Write findings.csv, findings.md, causes.csv (what makes the wires' paths differ) and table2-times.csv."""
    causes = _causes(out, quick)
    shared.write_table(out / "causes.csv", causes)
    tables = Tables(out)
    _write_times(tables, out)
    makers: Sequence[Callable[[Tables], Finding]] = [
        _stiffness_pattern, _nitinol_softer, _paths_differ, partial(_flexibility_alone, causes), _more_contact_length,
        _more_contacts, _fewer_segments, _threshold, _time_grows, _stiffer_more_sensitive, _stiffer_presses_more_y,
        _stiffer_presses_more, _less_push, _small_forces, partial(_peaks_at_corner, "first"),
        partial(_peaks_at_corner, "second"), _second_corner_time,
        partial(_friction_raises, "peak_force_y [mN]", "a higher friction coefficient increases the contact force",
                "largest force along y rises with every step of friction, 0.05 to 0.6"),
        partial(_friction_raises, "mean_normal_force [mN]", "a higher friction coefficient increases the contact force",
                "the same for the sum of normal forces, mean over the run"),
        partial(_friction_raises, "mean_bending_energy [uJ]", "more friction: navigates with more bending",
                "mean bending energy rises with every step of friction"),
        partial(_friction_raises, "peak_tip_force [mN]", "more friction: the tip applies more force to the wall",
                "largest force on the tip rises with every step of friction"),
        _flexible_slower,
    ]  # fmt: skip
    found = [make(tables) for make in makers]
    rows = [
        {"finding": f.says, "place": f.place, "test": f.test, "verdict": f.verdict, "number": f.number} for f in found
    ]
    shared.write_table(out / "findings.csv", rows)
    (out / "findings.md").write_text(_markdown(rows), encoding="utf-8")


class Tables:
    """The tables of the study, read once each; all cells are text."""

    def __init__(self, out: Path) -> None:
        self._out = out
        self._read: dict[str, list[dict[str, str]]] = {}

    def rows(self, name: str, **where: str) -> list[dict[str, str]]:
        """Rows of a table whose cells are as given."""
        if name not in self._read:
            path = self._out / f"{name}.csv"
            if not path.exists():
                sys.exit(f"{path}: is not there; run the script that makes it first, or make paper")
            self._read[name] = shared.read_table(path)
        return [row for row in self._read[name] if all(row[key] == value for key, value in where.items())]

    def number(self, name: str, column: str, **where: str) -> float:
        """The one number in a column of the row."""
        return float(self.rows(name, **where)[0][column])


def _by_estimate(values: Mapping[str, float], form: str = "{:.3g}") -> str:
    return ", ".join(f"{form.format(value)} ({name})" for name, value in values.items())


def _both(tables: Tables, name: str, column: str) -> dict[str, tuple[float, float]]:
    """(Universal, Amplatz) at each estimate."""
    return {
        e: (
            tables.number(name, column, wire="universal", estimate=e),
            tables.number(name, column, wire="amplatz", estimate=e),
        )
        for e in ESTIMATES
    }


def _ratio(
    tables: Tables, name: str, column: str, says: str, place: str, test: str, least: float = 1.0, inverse: bool = False
) -> Finding:
    """Amplatz over Universal, or the inverse, above `least`."""
    both = _both(tables, name, column)
    ratios = {e: (soft / stiff if inverse else stiff / soft) for e, (soft, stiff) in both.items()}
    words = "Universal over Amplatz" if inverse else "Amplatz over Universal"
    held = {e: ratio > least for e, ratio in ratios.items()}
    return Finding(says, place, test, held, f"{words}: {_by_estimate(ratios)}")


# Bending stiffness


def _stiffness_pattern(tables: Tables) -> Finding:
    ratios, held = [], dict.fromkeys(ESTIMATES, True)
    for wire in WIRES:
        for e in ESTIMATES:
            values = [float(row["apparent_EI [N mm2]"]) for row in tables.rows("fig4", wire=wire, estimate=e)]
            held[e] &= values[-1] >= values[0]
            ratios.append(values[-1] / values[0])
    return Finding(
        "EI: flexible distal part, then an abrupt increase, alike for both wires", "Fig. 4",
        "apparent EI by Eq. 1 at the last station above that at the first; EI is the catalogue's estimate", held,
        f"last over first station: {min(ratios):.3g} to {max(ratios):.3g}", by_construction=True,
    )  # fmt: skip


def _nitinol_softer(tables: Tables) -> Finding:
    lowest = {}
    for e in ESTIMATES:
        soft, stiff = (
            [float(row["apparent_EI [N mm2]"]) for row in tables.rows("fig4", wire=w, estimate=e)] for w in WIRES
        )
        lowest[e] = min(b / a for a, b in zip(soft, stiff, strict=True))
    return Finding(
        "the nitinol wire is more flexible than the steel wire", "Discussion, Bending Stiffness",
        "apparent EI of the Amplatz over the Universal's, least of the five stations",
        {e: ratio > 1 for e, ratio in lowest.items()}, _by_estimate(lowest), by_construction=True,
    )  # fmt: skip


# Path and contact


def _paths_differ(tables: Tables) -> Finding:
    apart = {}
    for e in ESTIMATES:
        soft, stiff = (tables.rows("fig6-summary", wire=wire, estimate=e)[0] for wire in WIRES)
        names = [name.removeprefix("tip_x at ") for name in soft if name.startswith("tip_x at ")]
        apart[e] = max(
            float(np.hypot(*(float(stiff[f"tip_{k} at {n}"]) - float(soft[f"tip_{k} at {n}"]) for k in "xy")))
            for n in names
        )
    radii = sorted(load_scenario(WIRES[wire]).wire.diameter / 2 * 1e3 for wire in WIRES)
    least = radii[1] - radii[0]
    return Finding(
        "the wire of higher flexibility takes a different trajectory", "Results, Fig. 6",
        f"largest distance of the two tips at equal depth (20, 40, 60, 80 mm) above the difference of their radii, "
        f"{least:.3g} mm",
        {e: value > least for e, value in apart.items()}, f"{_by_estimate(apart)} mm",
    )  # fmt: skip


def _causes(out: Path, quick: bool) -> list[dict[str, Any]]:
    """The Universal with one property changed at a time, at n = 100: how far the path moves, how the force changes."""
    stiff = load_scenario(WIRES["amplatz"])
    pieces = [{"from": p.start, "to": p.end, "value": p.value} for p in stiff.wire.effective_stiffness]
    changes: dict[str, dict[str, Any]] = {
        "Universal": {},
        f"its EI times {SCALE:g}": {"wire.stiffness_factor": {"tip": SCALE, "shaft": SCALE}},
        "the Amplatz's EI along the wire": {"wire.bending_stiffness": pieces},
        "the Amplatz's diameter": {"wire.diameter": stiff.wire.diameter},
        "both": {"wire.bending_stiffness": pieces, "wire.diameter": stiff.wire.diameter},
    }
    extra = shared.QUICK if quick else {}
    cases = {
        name: Case(WIRES["universal"], {"wire.segments": 100, **extra, **change}) for name, change in changes.items()
    }
    runs: dict[str, Result] = shared.run_all("findings", cases, out)
    shared.check(runs.values())
    base = next(iter(runs.values()))
    return [
        {
            "wire": name,
            "tip_rms_distance [mm]": compare(course_of(base), course_of(result))["tip_rms"].value * 1e3,
            "tip_nearest_rms_distance [mm]": compare(course_of(base), course_of(result))["tip_nearest_rms"].value * 1e3,
            "mean_push_force [mN]": float(result.values("push_force").mean()) * 1e3,
            "mean_push_over_the_universals": float(
                result.values("push_force").mean() / base.values("push_force").mean()
            ),
        }
        for name, result in runs.items()
    ]


def _flexibility_alone(causes: list[dict[str, Any]], tables: Tables) -> Finding:
    """One run each at the best estimate: EI as a whole has no other stiffness to be compared with."""
    moved = {str(row["wire"]): float(row["tip_rms_distance [mm]"]) for row in causes[1:]}
    scaled, force = next(iter(moved.values())), float(causes[1]["mean_push_over_the_universals"])
    others = ", ".join(f"{name} {value:.2g} mm" for name, value in list(moved.items())[1:])
    return Finding(
        "flexibility itself is what changes the trajectory", "Results, Fig. 6; Discussion",
        f"the Universal with EI times {SCALE:g} everywhere: its tip's path moves by more than 0.1 mm (RMS, n = 100)",
        {"best": scaled > 0.1},
        f"{scaled:.2g} mm, push force times {force:.3g}: in a rigid vessel forces scale with EI, the path stays; "
        f"it moves with: {others}",
    )  # fmt: skip


def _more_contact_length(tables: Tables) -> Finding:
    return _ratio(
        tables, "fig6-summary", "mean_length_along_wall [mm]", "higher flexibility: more contact with the wall",
        "Results, Fig. 6", "mean length of wire within 0.1 mm of a wall is larger", inverse=True,
    )  # fmt: skip


def _more_contacts(tables: Tables) -> Finding:
    return _ratio(
        tables, "fig6-summary", "mean_contacts", "higher flexibility: more contact with the wall", "Results, Fig. 6",
        "mean number of separate contacts with force is larger", inverse=True,
    )  # fmt: skip


# Segments


def _errors(tables: Tables, wire: str, estimate: str, grading: str = "uniform") -> list[tuple[int, float]]:
    rows = tables.rows("table2", wire=wire, estimate=estimate, segments=grading)
    return sorted((int(row["n"]), float(row["error [mm]"])) for row in rows)


def _fewer_segments(tables: Tables) -> Finding:
    held, words = dict.fromkeys(ESTIMATES, True), []
    for wire in WIRES:
        for e in ESTIMATES:
            errors = [error for _, error in _errors(tables, wire, e)]
            held[e] &= all(np.diff(errors) < 0)
        first, last = _errors(tables, wire, "best")[0], _errors(tables, wire, "best")[-1]
        words.append(f"{wire}, best: {first[1]:.3g} mm at n = {first[0]} to {last[1]:.2g} mm at {last[0]}")
    return Finding(
        "a lower number of segments results in a bigger error", "Results, Fig. 7, Table 2",
        "error against n = 800 (our Eq. 14) falls with every larger n, both wires, uniform segments", held,
        "; ".join(words),
    )  # fmt: skip


def _threshold(tables: Tables) -> Finding:
    held, words = dict.fromkeys(ESTIMATES, True), []
    for wire in WIRES:
        radius = load_scenario(WIRES[wire]).wire.diameter / 2 * 1e3
        enough = {e: [n for n, error in _errors(tables, wire, e) if error < radius] for e in ESTIMATES}
        for e in ESTIMATES:
            held[e] &= bool(enough[e])
        least = sorted({min(numbers) for numbers in enough.values() if numbers})
        words.append(f"{wire}: from n = {' or '.join(str(n) for n in least) or 'none'}")
    return Finding(
        "above a certain number of segments the behaviour changes no more", "Results",
        "there is an n from which the error is below the wire's radius", held, "; ".join(words),
    )  # fmt: skip


def _times(tables: Tables) -> dict[tuple[str, str], list[tuple[int, float]]]:
    """Processor time, s, of every n by (wire, estimate), uniform segments."""
    found: dict[tuple[str, str], list[tuple[int, float]]] = {}
    for row in tables.rows("timings", script="table2"):
        wire, grading, estimate, n = row["run"].split()
        if grading == "uniform":
            found.setdefault((wire, estimate), []).append((int(n), float(row["processor_time [s]"])))
    return {key: sorted(values) for key, values in found.items()}


def _time_grows(tables: Tables) -> Finding:
    held = dict.fromkeys(ESTIMATES, True)
    for (_, e), values in _times(tables).items():
        held[e] &= values[-1][1] > values[0][1]
    return Finding(
        "the computation time increases with the number of segments", "Results, Table 2",
        "processor time at the largest n above that at the smallest", held, "see table2-times.csv (not compared)",
    )  # fmt: skip


def _write_times(tables: Tables, out: Path) -> None:
    """Processor times beside the paper's; never the same twice."""
    paper = {(row["wire"], row["n"]): row["paper_time [s]"] for row in tables.rows("table2")}
    times = {key: values for key, values in _times(tables).items() if key[1] == "best"}
    rows = []
    for (wire, _), values in times.items():
        known = [(n, t) for n, t in values if paper.get((wire, str(n)))]
        slope = np.polyfit(*np.log(np.array(known)).T, 1)[0] if len(known) > 1 else np.nan
        theirs = [(n, float(paper[wire, str(n)])) for n, _ in known]
        slope_paper = np.polyfit(*np.log(np.array(theirs)).T, 1)[0] if len(theirs) > 1 else np.nan
        rows += [
            {
                "wire": wire,
                "n": n,
                "processor_time [s]": t,
                "paper_time [s]": paper.get((wire, str(n)), ""),
                "exponent_of_n": float(slope),
                "paper_exponent_of_n": float(slope_paper),
            }
            for n, t in values
        ]
    shared.write_table(out / "table2-times.csv", rows)


def _stiffer_more_sensitive(tables: Tables) -> Finding:
    worst = {e: tuple(_errors(tables, wire, e)[0][1] for wire in WIRES) for e in ESTIMATES}
    return Finding(
        "the stiffer wire is more sensitive to the number of segments", "Results (its Table 2 shows the opposite)",
        "error of the Amplatz above the Universal's at the smallest n",
        {e: stiff > soft for e, (soft, stiff) in worst.items()},
        f"Amplatz over Universal: {_by_estimate({e: stiff / soft for e, (soft, stiff) in worst.items()})}; "
        "in the paper's Table 2 0.155",
    )  # fmt: skip


# Forces


def _stiffer_presses_more_y(tables: Tables) -> Finding:
    both = {
        e: tuple(abs(tables.number("fig8-peaks", "peak_force_y [mN]", wire=w, estimate=e)) for w in WIRES)
        for e in ESTIMATES
    }
    ratios = {e: stiff / soft for e, (soft, stiff) in both.items()}
    return Finding(
        "the contact force is much higher for the stiffer wire", "Results, Fig. 8",
        "largest force along y, Amplatz over Universal, above 2", {e: r > 2 for e, r in ratios.items()},
        f"{_by_estimate(ratios)}; low Amplatz over high Universal {both['low'][1] / both['high'][0]:.2g}",
    )  # fmt: skip


def _stiffer_presses_more(tables: Tables) -> Finding:
    return _ratio(
        tables, "fig8-peaks", "peak_resultant [mN]", "the contact force is much higher for the stiffer wire",
        "Results, Fig. 8; Discussion", "largest resultant force on the vessel, ratio above 2", least=2.0,
    )  # fmt: skip


def _less_push(tables: Tables) -> Finding:
    return _ratio(
        tables, "pull-back-summary", "largest_push [mN]", "the flexible wire needs less force to navigate",
        "Discussion, Bending Stiffness", "largest push force on the way in is higher for the Amplatz",
    )  # fmt: skip


def _small_forces(tables: Tables) -> Finding:
    largest = {
        e: abs(tables.number("fig8-peaks", "peak_force_y [mN]", wire="universal", estimate=e)) for e in ESTIMATES
    }
    return Finding(
        "the Universal's forces were very small, so the 10 N cell was changed for one of 1 N", "Experiment",
        "its largest force along y is below 1 % of 10 N", {e: f < 100 for e, f in largest.items()},
        f"{_by_estimate(largest)} mN",
    )  # fmt: skip


def _peaks_at_corner(corner: str, tables: Tables) -> Finding:
    found = {
        e: [row["corner_of_the_tip"] for row in tables.rows("fig9-peaks", friction="0.4", estimate=e)]
        for e in ESTIMATES
    }
    counts = {e: f"{names.count(corner)} of {len(names)}" for e, names in found.items()}
    return Finding(
        f"the force peaks in the corners: the {corner}", "Results, Fig. 8 and 9",
        f"Amplatz, friction 0.4: the force along y has a peak while the tip is within 8 mm of the {corner} corner",
        {e: corner in names for e, names in found.items()},
        "peaks there: " + ", ".join(f"{words} ({e})" for e, words in counts.items()),
    )  # fmt: skip


def _second_corner_time(tables: Tables) -> Finding:
    times = {}
    for e in ESTIMATES:
        rows = tables.rows("fig9-peaks", friction="0.4", estimate=e, corner_of_the_tip="second")
        times[e] = min((float(row["time [s]"]) for row in rows), default=np.nan)
    return Finding(
        "a small peak at 22 s, at the second corner", "Results, Fig. 9",
        "first peak while the tip is at the second corner, within 4 s of 22 s; the corner was put there",
        {e: abs(t - 22) <= 4 for e, t in times.items()}, f"{_by_estimate(times)} s", by_construction=True,
    )  # fmt: skip


def _friction_raises(column: str, says: str, test: str, tables: Tables) -> Finding:
    held, words = {}, []
    for e in ESTIMATES:
        rows = sorted(tables.rows("fig9-summary", estimate=e), key=lambda row: float(row["friction"]))
        values = [float(row[column]) for row in rows]
        held[e] = all(np.diff(values) > 0)
        words.append(f"{values[0]:.3g} to {values[-1]:.3g} ({e})")
    unit = column.partition("[")[2].rstrip("]")
    return Finding(
        says, "Results, Fig. 9; Discussion, Friction", f"Amplatz: {test}", held, f"{', '.join(words)} {unit}"
    )


def _flexible_slower(tables: Tables) -> Finding:
    ratios = {}
    for e in ESTIMATES:
        counts = [
            sum(int(row["newton_iterations"]) for row in tables.rows("table2", wire=w, estimate=e, segments="uniform"))
            for w in WIRES
        ]
        ratios[e] = counts[0] / counts[1]
    return Finding(
        "the flexible wire takes slightly longer to compute", "Discussion; Table 2",
        "Newton iterations over all n, Universal over Amplatz, above 1", {e: r > 1 for e, r in ratios.items()},
        _by_estimate(ratios),
    )  # fmt: skip


ODDITIES = (
    "The flexural strength of 49 MPa is a strength; it gives no stiffness k_w of the wall.",
    "The text calls the Amplatz more sensitive to the number of segments; Table 2 shows the Universal to be "
    "(4.91 to 0.38 mm against 0.76 to 0.56 mm).",
    "Eq. 14 as printed sums over all pairs i, j and divides by i; we read it as pairs at equal time from the start.",
)


def _markdown(rows: list[dict[str, str]]) -> str:
    lines = ["| the paper says | tested by | verdict over low, best, high EI | number |", "|---|---|---|---|"]
    lines += [f"| {r['finding']} ({r['place']}) | {r['test']} | **{r['verdict']}** | {r['number']} |" for r in rows]
    lines += ["", "Oddities of the paper, left as they are:", "", *(f"- {text}" for text in ODDITIES), ""]
    return "\n".join(lines)


if __name__ == "__main__":
    shared.command(main)
