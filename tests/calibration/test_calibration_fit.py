"""The fit on curves that cost nothing: what it recovers, what it refuses, and what it says of itself."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from calibration_cases import BASE, FRICTION, TIP

from gw_exudyn.calibration import Calibration, load_calibration
from gw_exudyn.calibration.fit import fitted
from gw_exudyn.calibration.report import Report, report_of
from gw_exudyn.calibration.simulations import Simulated
from gw_exudyn.comparison import COMPARED, PATH, Course
from gw_exudyn.errors import ScenarioError, SolverError

TIME = np.linspace(0.0, 10.0, 101)
TRUTH = np.array([0.27, 1.3])
NOISE = 1e-3

Curve = Callable[[float, float], np.ndarray]


def both(friction: float, stiffness: float) -> np.ndarray:
    """A force, N, in which the two do different things."""
    return stiffness * 0.01 * TIME + 0.1 * friction**2 * np.sin(TIME)


def product(friction: float, stiffness: float) -> np.ndarray:
    """A force, N, that knows the product of the two alone."""
    return friction * stiffness * 0.01 * TIME


def first_alone(friction: float, stiffness: float) -> np.ndarray:
    """A force, N, on which the second has no effect."""
    return friction * 0.1 * TIME


class Made:
    """Stands for the engine: courses by a formula, and failures where it is told so."""

    def __init__(self, curve: Curve, wall: Curve = first_alone, fails: Callable[[float, float], str] | None = None):
        self.curve, self.wall, self.fails = curve, wall, fails or (lambda friction, stiffness: "")
        self.asked: list[np.ndarray] = []

    def __call__(self, calibration: Calibration, points: Sequence[np.ndarray]) -> list[Simulated]:
        self.asked += [np.array(calibration.values(point)) for point in points]
        return [self.one(*calibration.values(point)) for point in points]

    def one(self, friction: float, stiffness: float) -> Simulated:
        reason = self.fails(friction, stiffness)
        if reason == "early":
            return Simulated(self.course(friction, stiffness, 60), False, "the tip stayed where it was")
        return Simulated(None, False, reason) if reason else Simulated(self.course(friction, stiffness), True, "")

    def course(self, friction: float, stiffness: float, until: int = 101) -> Course:
        values = {name: np.zeros_like(TIME) for name in (*PATH, *COMPARED)}
        values |= {"push_force": self.curve(friction, stiffness), "wall_force_y": self.wall(friction, stiffness)}
        return Course("made", TIME[:until], {name: one[:until] for name, one in values.items()})


def calibration(curve: Curve, seed: int = 1, noise: float = NOISE, start: str = "0.4") -> Calibration:
    """A calibration whose cell measured the curve at the truth, with noise."""
    force = curve(*TRUTH) + np.random.default_rng(seed).normal(0, noise, len(TIME))
    Path("cell.csv").write_text("\n".join(["time,push_force", *(f"{t},{f}" for t, f in zip(TIME, force, strict=True))]))
    Path("fit.yaml").write_text(
        f"base: {BASE}\nset: {{wire.segments: 10}}\nmeasured: [cell.csv]\nnoise: {{push_force: 1 mN}}\nfit:\n"
        f"  {FRICTION}: {{start: {start}, low: 0.05, high: 0.8}}\n  {TIP}: {{start: 1, low: 0.5, high: 2}}\n"
    )
    return load_calibration("fit.yaml")


def report(given: Calibration, engine: Made) -> Report:
    return report_of(given, *fitted(given, engine))


def test_it_finds_the_truth_within_intervals_that_are_those_of_the_closed_form():
    given = calibration(both)
    found = report(given, Made(both))
    assert found.fit.converged
    assert [np.allclose(step.point, found.fit.steps[0].point) for step in found.fit.steps].count(True) == 1
    assert not any(one.doubts for one in found.estimates)
    assert found.notes == ()
    assert found.statistics.reduced == pytest.approx(1.0, abs=0.4)
    # The derivatives of the formula, in place of differences.
    values = np.array([one.value for one in found.estimates])
    exact = np.column_stack([0.2 * values[0] * np.sin(TIME), 0.01 * TIME]) / NOISE
    errors = np.sqrt(found.statistics.reduced * np.diag(np.linalg.inv(exact.T @ exact)))
    assert [one.standard_error for one in found.estimates] == pytest.approx(errors, rel=1e-3)
    assert [one.half_width for one in found.estimates] == pytest.approx(1.984 * errors, rel=2e-3)
    assert np.all(np.abs(values - TRUTH) < 4 * errors)
    # What least squares gives without our differences, bounds and simulations.
    from scipy.optimize import curve_fit

    force = found.channels[0].measured
    best, _ = curve_fit(lambda _, a, b: both(a, b), TIME, force, [0.4, 1.0])
    assert values == pytest.approx(best, abs=0.02 * errors.min())


def test_intervals_hold_the_truth_as_often_as_they_say():
    held, given = np.zeros(2), calibration(both)
    for seed in range(100):
        force = both(*TRUTH) + np.random.default_rng(seed).normal(0, NOISE, len(TIME))
        found = report(replace(given, measured=(Course("cell", TIME, {"push_force": force}),)), Made(both))
        ends = [one.interval for one in found.estimates]
        held += [low <= true <= high for (low, high), true in zip(ends, TRUTH, strict=True)]
    # 95 of 100 expected; a binomial count lies outside 88 to 100 once in three hundred, and the seeds are fixed.
    assert np.all(held >= 88)
    assert np.all(held <= 99)


def test_simulations_that_jump_widen_the_intervals():
    def jumping(friction: float, stiffness: float) -> np.ndarray:
        return both(friction, stiffness) + 2e-3 * np.sign(np.sin(2000 * stiffness)) * (TIME > 8)

    smooth, rough = (report(calibration(both), Made(curve)) for curve in (both, jumping))
    assert smooth.estimates[1].roughness < 0.01 * smooth.estimates[1].standard_error
    assert rough.estimates[1].roughness > 0.5 * rough.estimates[1].standard_error
    assert rough.estimates[1].half_width > 1.2 * smooth.estimates[1].half_width
    assert any(note.startswith("simulations jump") for note in rough.notes)


@pytest.mark.parametrize("from_the_end", [0.0, 0.004, 0.1])
def test_a_straight_model_is_not_rough_at_a_bound_either(from_the_end):
    def straight(friction: float, stiffness: float) -> np.ndarray:
        return stiffness * 0.01 * TIME + 0.1 * friction * np.sin(TIME)

    given = calibration(straight)
    high = given.parameters[1].low + (TRUTH[1] - given.parameters[1].low) / (1 - from_the_end)
    Path("fit.yaml").write_text(Path("fit.yaml").read_text().replace("high: 2}", f"high: {high:.9f}}}"))
    found = report(load_calibration("fit.yaml"), Made(straight))
    assert found.estimates[1].roughness < 1e-3 * found.estimates[1].standard_error
    assert not any(note.startswith("simulations jump") for note in found.notes)


def test_points_that_fit_as_well_beyond_linear_theory_widen_the_intervals():
    def stairs(friction: float, stiffness: float) -> np.ndarray:
        """Steep at the truth, next to flat beside it."""
        off = friction - TRUTH[0]
        return both(TRUTH[0] + 0.1 * off + 0.0035 * np.tanh(off / 0.003), stiffness)

    found = report(calibration(stairs, start="0.28"), Made(stairs))
    friction, tip = found.estimates
    linear = found.statistics.factor * friction.standard_error
    assert friction.half_width > 1.4 * linear
    assert tip.half_width == pytest.approx(found.statistics.factor * tip.standard_error)
    (note,) = [note for note in found.notes if note.startswith("chi square is no parabola")]
    assert f"the interval of {FRICTION} is wider" in note


def test_a_better_point_beside_the_end_is_taken():
    def wavy(friction: float, stiffness: float) -> np.ndarray:
        """Waves in the second parameter as long as a difference's step to each side, which derivatives don't see."""
        return both(friction, stiffness) + 2e-3 * np.sin(2 * np.pi * (stiffness - TRUTH[1]) / 0.015) * np.cos(3 * TIME)

    found = report(calibration(wavy, seed=3), Made(wavy))
    first, *later = found.fit.descents
    assert later
    assert found.fit.converged
    assert found.statistics.chi_square < first.chi_square - 1
    assert abs(found.estimates[1].value - TRUTH[1]) < 0.002


def test_several_starts_find_the_better_of_two_minima():
    def waves(friction: float, stiffness: float) -> np.ndarray:
        return stiffness * 0.01 * TIME + 0.02 * np.sin(20 * friction) * np.sin(TIME) + 0.02 * friction * np.cos(TIME)

    given = calibration(waves, start="0.55")
    alone = report(given, Made(waves))
    assert abs(alone.estimates[0].value - TRUTH[0]) > 0.1
    text = Path("fit.yaml").read_text()
    Path("fit.yaml").write_text(f"{text}starts: 8\n")
    several = report(load_calibration("fit.yaml"), Made(waves))
    assert len(several.fit.descents) >= 8
    assert several.statistics.chi_square < alone.statistics.chi_square
    low, high = several.estimates[0].interval
    assert low <= TRUTH[0] <= high


def test_a_second_minimum_that_is_as_good_is_told():
    def even(friction: float, stiffness: float) -> np.ndarray:
        return both(abs(friction - 0.4) + 0.1, stiffness)

    given = calibration(even, start="0.3")
    text = Path("fit.yaml").read_text()
    Path("fit.yaml").write_text(f"{text}starts: 4\n")
    found = report(load_calibration("fit.yaml"), Made(even))
    assert any(note.startswith("another start ended at") for note in found.notes)
    low, high = found.estimates[0].interval
    assert low < 0.27 < high
    assert low < 0.53 < high
    assert given.starts == 1


def test_what_stands_in_for_each_other_is_named_with_the_measurement_that_helps():
    found = report(calibration(product), Made(product))
    friction, tip = found.estimates
    assert f"it is correlated with {TIP} (-1.000), which can stand in for it" in friction.doubts
    assert f"it is correlated with {FRICTION} (-1.000), which can stand in for it" in tip.doubts
    assert any(
        one.startswith("wall_force_y measured as well, with a noise of 1 mN, would bring it") for one in tip.doubts
    )


def test_a_parameter_without_effect_is_not_identified():
    found = report(calibration(first_alone), Made(first_alone))
    friction, tip = found.estimates
    assert friction.doubts == ()
    assert tip.doubts[0] == "its interval is wider than half its range"
    assert tip.doubts[-1].startswith("no further quantity of this run would settle it")
    assert found.statistics.singular_values[1] == 0
    assert friction.value == pytest.approx(TRUTH[0], abs=4 * friction.standard_error)


def test_a_parameter_at_its_bound_is_told():
    given = calibration(both)
    text = Path("fit.yaml").read_text().replace("high: 2}", "high: 1.1}")
    Path("fit.yaml").write_text(text)
    found = report(load_calibration("fit.yaml"), Made(both))
    assert found.estimates[1].doubts == ("it lies at its high end, 1.1: widen the range",)
    assert "times the stated noise: the model does not fit" in found.notes[0]
    assert given.parameters[1].high == 2


def test_a_failed_simulation_costs_its_step_and_not_the_fit():
    # From 0.1 the first step overshoots to beyond 0.3, where runs end early, or nothing works out.
    def fails(friction: float, stiffness: float) -> str:
        return "too deep" if friction > 0.35 else "early" if friction > 0.3 else ""

    engine = Made(both, fails=fails)
    found = report(calibration(both, start="0.1"), engine)
    assert any(step.reason for step in found.fit.steps)
    assert found.fit.converged
    assert [one.value for one in found.estimates] == pytest.approx(TRUTH, abs=0.02)
    assert {step.reason for step in found.fit.steps} == {"", "the tip stayed where it was"}


def test_a_point_between_failures_ends_the_fit_with_the_best_so_far():
    engine = Made(both, fails=lambda friction, stiffness: "" if stiffness < 1.002 and friction > 0.39 else "too deep")

    def nowhere(friction: float, stiffness: float) -> str:
        return "" if (friction, stiffness) == (0.4, 1.0) else "too deep"

    with pytest.raises(SolverError, match="no simulation beside the best point works out for contact"):
        report(calibration(both), Made(both, fails=nowhere))
    found = report(calibration(both), engine)
    assert all(step.reason or step.chi_square >= found.statistics.chi_square for step in found.fit.steps)


def test_a_start_that_gives_nothing_is_told():
    with pytest.raises(SolverError, match="at the start values failed: too deep; take others"):
        report(calibration(both), Made(both, fails=lambda *_: "too deep"))
    with pytest.raises(SolverError, match=r"ends at 5.9 s, before what was measured \(10 s\): the tip stayed"):
        report(calibration(both), Made(both, fails=lambda *_: "early"))


def test_too_few_values_are_told():
    given = calibration(both)
    Path("cell.csv").write_text("time,push_force\n0,0\n1,0.01\n2,\n")
    with pytest.raises(ScenarioError, match=r"fit\.yaml: measured: 2 measured values are too few for 2 unknowns"):
        report(load_calibration(given.file), Made(both))
    Path("cell.csv").write_text("time,push_force\n20,0\n21,0.01\n22,1\n")
    with pytest.raises(ScenarioError, match="no time in common"):
        report(load_calibration(given.file), Made(both))


def test_residuals_that_follow_each_other_are_told():
    def bent(friction: float, stiffness: float) -> np.ndarray:
        return both(friction, stiffness) + 2e-3 * np.sin(0.9 * TIME)

    given = calibration(bent)
    found = report(given, Made(both))
    assert any("follow each other (autocorrelation 0." in note for note in found.notes)


def test_noise_overstated_is_told():
    found = report(calibration(both, noise=0.2 * NOISE), Made(both))
    (note,) = found.notes
    assert re.match(r"the residuals are 0\.(1|2)\d? of the stated noise, which is overstated", note)
    assert found.estimates[1].half_width == pytest.approx(
        0.2 * report(calibration(both), Made(both)).estimates[1].half_width, rel=0.2
    )


def test_an_aligned_path_is_turned_and_costs_degrees_of_freedom():
    class Turning(Made):
        def course(self, friction: float, stiffness: float, until: int = 101) -> Course:
            course = super().course(friction, stiffness, until)
            path = {"tip_x": 1e-3 * TIME, "tip_y": friction * 1e-4 * TIME**2 + stiffness * 1e-4 * TIME**3}
            return Course(course.name, course.time, {**course.values, **path})

    engine = Turning(both)
    given = calibration(both)
    truth = engine.course(*TRUTH).values
    a, random = 0.3, np.random.default_rng(2)
    x = np.cos(a) * truth["tip_x"] - np.sin(a) * truth["tip_y"] + 0.05 + random.normal(0, 1e-4, len(TIME))
    y = np.sin(a) * truth["tip_x"] + np.cos(a) * truth["tip_y"] - 0.02 + random.normal(0, 1e-4, len(TIME))
    rows = [f"{t},{p},{q}" for t, p, q in zip(TIME, x, y, strict=True)]
    Path("camera.csv").write_text("\n".join(["time,tip_x,tip_y", *rows]) + "\n")
    text = given.file.read_text().replace("[cell.csv]", "[camera.csv]").replace("{push_force: 1 mN}", "{tip: 0.1 mm}")
    given.file.write_text(text + "align: true\n")
    found = report(load_calibration(given.file), engine)
    assert found.statistics.degrees == 2 * len(TIME) - 2 - 3
    assert found.statistics.reduced == pytest.approx(1.0, abs=0.3)
    for one, true in zip(found.estimates, TRUTH, strict=True):
        assert one.value == pytest.approx(true, abs=4 * one.standard_error)
    given.file.write_text(text)
    assert report(load_calibration(given.file), engine).statistics.reduced > 100
