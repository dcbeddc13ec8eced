"""The drive that prescribes the speed of the proximal end: one speed, phases, or a table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, ValidationInfo, field_validator, model_validator

from gw_exudyn.scenario.drives.base import CourseDrive, Hold, Start
from gw_exudyn.scenario.drives.course import check_table
from gw_exudyn.scenario.faults import Faults, wrong
from gw_exudyn.scenario.kinds import DURATION, RAMP, SPEED, SPEED_OR_NONE, SPEED_TABLE, TRAVEL
from gw_exudyn.scenario.section import Section
from gw_exudyn.scenario.units import format_quantity
from gw_exudyn.scenario.words import plural

LONGEST = 1e5
"""s, of a whole drive."""

_MOST_PHASES = 10_000


class SpeedDrive(CourseDrive):
    """Prescribed speed of the proximal end along the catheter's axis.

    speed : m/s, one for each time; positive pushes in.
    """

    kind: Literal["speed"] = "speed"
    speed: tuple[float, ...]

    def to_plain(self) -> dict[str, Any]:
        """The drive as a file could hold it: its table."""
        return self._plain(self.kind, self.speed)


class PhaseForm(Section):
    """One stretch of constant speed: how fast, and how far or how long."""

    what: ClassVar[str] = "a phase of the drive"

    speed: Annotated[float, SPEED] = Field(
        description="positive pushes in, 0 holds, negative pulls back", examples=["2 mm/s"]
    )
    distance: Annotated[float | None, TRAVEL] = Field(default=None, description="travel in the direction of the speed")
    duration: Annotated[float | None, DURATION] = Field(
        default=None, validate_default=True, description="how long it lasts"
    )
    ramp: Annotated[float | None, RAMP] = Field(
        default=None,
        description="time in which the speed goes linearly from the one before (0 at the start) to this one",
    )

    @field_validator("duration", mode="after")
    @classmethod
    def _far_or_long(cls, duration: float | None, info: ValidationInfo) -> float | None:
        if "speed" in info.data and "distance" in info.data:
            check_extent(info.data["speed"], info.data["distance"], duration)
        return duration


class DriveForm(Section):
    """A prescribed speed: one speed with distance or duration, several phases, or a table of speed against time."""

    what: ClassVar[str] = "the drive"

    kind: Literal["speed"]
    speed: Annotated[float | None, SPEED_OR_NONE] = Field(
        default=None, description="one constant speed; positive pushes in"
    )
    distance: Annotated[float | None, TRAVEL] = Field(default=None, description="travel in the direction of the speed")
    duration: Annotated[float | None, DURATION] = Field(default=None, description="how long it lasts")
    ramp: Annotated[float | None, RAMP] = Field(
        default=None, description="time over which the speed rises linearly from 0 at the start"
    )
    phases: tuple[PhaseForm, ...] | None = Field(
        default=None, description="stretches of constant speed, one after the other"
    )
    table: Annotated[tuple[tuple[float, float], ...] | None, SPEED_TABLE] = Field(
        default=None, description="[[time, speed], ...] from time 0, linear in between; two equal times make a step"
    )
    start: Start = 0.0
    hold: Hold = "clamped"

    @field_validator("phases", mode="before")
    @classmethod
    def _some(cls, phases: Any) -> Any:
        if isinstance(phases, list | tuple) and not 1 <= len(phases) <= _MOST_PHASES:
            raise wrong(f"has {plural(len(phases), 'phase')}; 1 to {_MOST_PHASES} are needed")
        return phases

    @model_validator(mode="after")
    def _one_form(self) -> Self:
        given = [name for name in ("speed", "phases", "table") if getattr(self, name) is not None]
        if not given:
            raise wrong("says no speed; give speed with distance or duration, or phases, or table", missing=True)
        faults = Faults()
        for name in given[1:]:
            faults.add((name,), f"stands beside {given[0]}; give one of speed, phases, table")
        for name in ("distance", "duration", "ramp"):
            if given == ["phases"] and getattr(self, name) is not None:
                faults.add((name,), "stands beside phases; put it into a phase")
            if given == ["table"] and getattr(self, name) is not None:
                faults.add((name,), "stands beside table; the table says it all, remove it")
        faults.raise_if_any()
        if self.speed is not None:
            faults.read(
                ("distance",), lambda travel: check_extent(self.speed or 0.0, travel, self.duration), self.distance
            )
        if self.table is not None:
            check_table(self.table, faults)
        faults.raise_if_any()
        return self

    def resolve(self) -> SpeedDrive:
        """The table of speed against time. Raises ValidationError for a phase that is shorter than its ramp."""
        return self._table().model_copy(update={"start": self.start, "hold": self.hold})

    def _table(self) -> SpeedDrive:
        if self.table is not None:
            return SpeedDrive(time=tuple(t for t, _ in self.table), speed=tuple(v for _, v in self.table))
        if self.phases is not None:
            return _sequence(self.phases, [("phases", i) for i in range(len(self.phases))])
        phase = PhaseForm(speed=self.speed or 0.0, distance=self.distance, duration=self.duration, ramp=self.ramp)
        return _sequence([phase], [()])


def check_extent(speed: float, distance: float | None, duration: float | None) -> None:
    """Check that a phase says either how far or how long."""
    if distance is None and duration is None:
        raise wrong(
            "is missing: how far or how long; give distance: 60 mm, or duration: 30 s",
            missing=True,
            instead=("distance",),
        )
    if distance is not None and duration is not None:
        raise wrong("distance and duration are both given; give one of the two")
    if distance is not None and speed == 0:
        raise wrong("a speed of 0 covers no distance; give a duration to hold")


def _sequence(phases: Sequence[PhaseForm], places: Sequence[tuple[str | int, ...]]) -> SpeedDrive:
    """Phases one after the other as a table."""
    faults, rows = Faults(), [(0.0, 0.0)]
    for phase, place in zip(phases, places, strict=True):
        start, before = rows[-1]
        ramp = phase.ramp or 0.0
        steady = _steady_time(phase, before, ramp)
        if steady < -1e-9:
            faults.add((*place, "ramp"), f"{format_quantity(ramp, 's')} is longer than the phase lasts; shorten it")
        rows.append((start + ramp, phase.speed))
        rows.append((start + ramp + max(0.0, steady), phase.speed))
    if rows[-1][0] > LONGEST:
        long = (
            f"the drive lasts {format_quantity(rows[-1][0], 's')}, at most {format_quantity(LONGEST, 's')} are allowed"
        )
        faults.add((*places[-1], "speed"), f"{long}; a faster speed or a shorter way")
    faults.raise_if_any()
    rows = _tidy(rows)
    return SpeedDrive(time=tuple(t for t, _ in rows), speed=tuple(v for _, v in rows))


def _steady_time(phase: PhaseForm, before: float, ramp: float) -> float:
    """How long a phase keeps its speed once the ramp is over, s; negative if the ramp is too long."""
    if phase.duration is not None:
        return phase.duration - ramp
    travelled = (before + phase.speed) / 2 * ramp  # during the ramp, m, signed
    sign = 1.0 if phase.speed > 0 else -1.0
    return (sign * (phase.distance or 0.0) - travelled) / phase.speed


def _tidy(rows: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Rows without repetitions, and without a step at the very start, before which there is nothing."""
    kept: list[tuple[float, float]] = []
    for row in rows:
        if kept and row == kept[-1]:
            continue
        if len(kept) >= 1 and kept[-1][0] == row[0] and (row[0] == 0.0 or (len(kept) >= 2 and kept[-2][0] == row[0])):
            kept[-1] = row
            continue
        kept.append(row)
    return kept
