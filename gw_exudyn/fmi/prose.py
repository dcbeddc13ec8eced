"""What an FMU's page and fmu/README.md both say of method, limits and ends: one text for the two. `...` marks code."""

from __future__ import annotations

METHOD = (
    "The wire is a chain of rigid segments in the plane, joined by revolute joints with torsional springs and dampers, "
    "as in Sharei et al. 2019 (J. Comput. Nonlinear Dyn. 14(10):101010). It meets the walls of the vessel and of the "
    "straight catheter with normal springs and dampers and with Coulomb friction; a drive moves its proximal end.",
    "The motion is quasi-static: Exudyn's implicit generalized-alpha solver finds the balance at the end of each "
    "`solver.step` by Newton's method, and cuts the step back where Newton's method does not converge, a wall would be "
    "jumped over or the wire snaps or buckles. Results do not depend on the communication step.",
)

LIMITS = (
    "Planar.",
    "No contact of the wire with itself, and none with the catheter's outside.",
    "No gravity.",
    "Walls are rigid or yield elastically at the contact; they do not deform.",
    "Contact stiffness is that of one contact point: a wire that lies along a wall meets a stiffer one with more "
    "segments.",
    "A run that cannot be trusted any more ends, and says so in `status.code` and `status.message`.",
)

ENDING_HEADINGS = ("what happens", "FMI 2.0", "FMI 3.0")
ENDINGS = (
    (
        "an event has ended the run: the tip has reached its target or stalled, the force its limit, the hub its end",
        "`fmi2Discard`; `fmi2Terminated` is true, `fmi2LastSuccessfulTime` says when",
        "`fmi3OK`, `terminateSimulation`, `lastSuccessfulTime`; `earlyReturn` if the host allows it",
    ),
    ("it cannot go on, or cannot be trusted any more", "the same", "the same with `fmi3Warning`"),
    (
        "a value or a call that makes no sense",
        "`fmi2Error`; reset, or restore a state",
        "`fmi3Error`; the same",
    ),
    (
        "the worker was killed, crashed or gave no sign of life for `worker.timeout`",
        "`fmi2Fatal`; a new instance works",
        "`fmi3Fatal`; the same",
    ),
)
"""How a run ends early: what happens, and what each version of the standard says to it."""
