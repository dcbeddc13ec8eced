"""The hub of a force drive: its own books, beside those of the wire that it pushes."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class HubEnergies:
    """All in J, and each from its own force.

    work (of the drive's force), passed_on (to the wire: the insertion work), damping_loss, numerical_loss (of the time
        integration) : sums since the start. kinetic : now.
    """

    work: float = 0.0
    passed_on: float = 0.0
    kinetic: float = 0.0
    damping_loss: float = 0.0
    numerical_loss: float = 0.0

    @property
    def error(self) -> float:
        """What does not add up, J."""
        return self.work - self.passed_on - self.kinetic - self.damping_loss - self.numerical_loss


@dataclass(frozen=True)
class HubInstant:
    """The hub at one time: travel (m), speed (m/s), acceleration (m/s^2), force of the drive on it (N), and of it on
    the wire (N), positive when pushing."""

    travel: float = 0.0
    speed: float = 0.0
    acceleration: float = 0.0
    force: float = 0.0
    push: float = 0.0


def hub_advanced(
    before: HubEnergies, mass: float, damping: float, old: HubInstant, new: HubInstant, step: float
) -> HubEnergies:
    """The hub's energies after a step. mass : kg. damping : N s/m. step : s.

    As with the wire's (see energy.py), the forces balance at the step's end, so their work over the step does too; what
    each force really stored or took differs by the numerical loss.
    """
    moved = new.travel - old.travel
    kinetic = 0.5 * mass * new.speed**2
    lost = damping * moved**2 / step
    numerical = (
        0.5 * (new.force - old.force) * -moved
        + damping * new.speed * moved - lost
        + mass * new.acceleration * moved - (kinetic - before.kinetic)
        - 0.5 * (old.push - new.push) * moved
    )  # fmt: skip
    return HubEnergies(
        work=before.work + 0.5 * (old.force + new.force) * moved,
        passed_on=before.passed_on + 0.5 * (old.push + new.push) * moved,
        kinetic=kinetic,
        damping_loss=before.damping_loss + lost,
        numerical_loss=before.numerical_loss + numerical,
    )
