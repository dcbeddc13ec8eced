"""Solver settings. Each line was chosen by counting residuals and tangents on insertions round corners."""

from __future__ import annotations

from typing import Any

from gw_exudyn.engine.library import exudyn

SPECTRAL_RADIUS = 0.0
"""Generalized-alpha with full damping at high frequency: the motion is quasi-static, and fewest iterations follow."""

ALPHA_M = (2 * SPECTRAL_RADIUS - 1) / (SPECTRAL_RADIUS + 1)
ALPHA_F = SPECTRAL_RADIUS / (SPECTRAL_RADIUS + 1)
GAMMA = 0.5 + ALPHA_F - ALPHA_M
BETA = 0.25 * (GAMMA + 0.5) ** 2
"""Constants of the integrator [Arnold and Bruls 2007]."""

MOST_ITERATIONS = 12
"""Of Newton's method in a step. Where more are needed, shorter steps are cheaper."""


def velocity_factor(step: float) -> float:
    """d q_t / d q of the integrator within a step, 1/s."""
    return GAMMA / (BETA * step)


def acceleration_factor(step: float) -> float:
    """d q_tt / d q of the integrator within a step, 1/s^2."""
    return (1 - ALPHA_M) / (BETA * step**2 * (1 - ALPHA_F))


def simulation_settings(step: float, minimum_step: float, tolerance: float, absolute_tolerance: float) -> Any:
    """Exudyn's settings. step, minimum_step : s. tolerance : relative, of the residual; absolute_tolerance : N."""
    settings = exudyn().SimulationSettings()
    integration = settings.timeIntegration
    integration.numberOfSteps = 1
    integration.endTime = step
    integration.initialStepSize = step
    integration.minimumStepSize = min(minimum_step, step)
    integration.adaptiveStep = True
    # A step that failed is cut to a quarter: what fails at once is mostly a snap, which wants much shorter steps.
    integration.adaptiveStepDecrease = 0.25
    integration.adaptiveStepRecoverySteps = 2
    integration.verboseMode = 0
    integration.generalizedAlpha.spectralRadius = SPECTRAL_RADIUS
    integration.generalizedAlpha.computeInitialAccelerations = False
    integration.generalizedAlpha.resetAccelerations = False
    # The contact's tangent is exact and cheap, so full Newton needs fewest residuals.
    integration.newton.useModifiedNewton = False
    integration.newton.relativeTolerance = tolerance
    integration.newton.absoluteTolerance = absolute_tolerance
    integration.newton.maxIterations = MOST_ITERATIONS
    # One pass, whose result the checks after Newton may refuse: then the step is cut.
    integration.discontinuous.maxIterations = 1
    integration.discontinuous.ignoreMaxIterations = False
    settings.linearSolver.solverType = exudyn().LinearSolverType.EigenSparse
    settings.linearSolver.reuseAnalyzedPattern = True
    settings.solution.file.write = False
    settings.parallel.numberOfThreads = 1
    return settings
