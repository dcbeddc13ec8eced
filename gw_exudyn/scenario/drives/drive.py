"""The drive of a scenario: what moves the proximal end, in any of its forms. Every course becomes one table."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Discriminator, Tag

from gw_exudyn.scenario.drives.force import ForceDrive, ForceForm
from gw_exudyn.scenario.drives.speed import DriveForm, SpeedDrive
from gw_exudyn.scenario.drives.tip_speed import TipSpeedDrive, TipSpeedForm
from gw_exudyn.scenario.faults import Faults, wrong
from gw_exudyn.scenario.fields import Choice
from gw_exudyn.scenario.section import KIND_TAG, Form
from gw_exudyn.scenario.words import shown

DRIVE_KINDS = Choice(("speed", "force", "tip_speed"))


def _tag(drive: Any) -> str:
    kind = drive.get("kind") if isinstance(drive, dict) else getattr(drive, "kind", None)
    return f"{KIND_TAG}{kind}"


AnyForm = Annotated[
    Annotated[DriveForm, Tag(f"{KIND_TAG}speed")]
    | Annotated[ForceForm, Tag(f"{KIND_TAG}force")]
    | Annotated[TipSpeedForm, Tag(f"{KIND_TAG}tip_speed")],
    Discriminator(_tag),
]
"""What a file may hold."""


def _check_drive(drive: Any) -> None:
    """The kind first: it says what the other keys mean."""
    allowed = ", ".join(DRIVE_KINDS.words)
    if not isinstance(drive, dict):
        found = "is empty; a drive is needed" if drive is None else f"{shown(drive)} stands where a drive is needed"
        raise wrong(f"{found}: lines of 'key: value', the first kind: {allowed.replace(', ', ' | ')}")
    faults = Faults()
    if "kind" not in drive:
        faults.add(("kind",), wrong(f"is missing: what the drive is; allowed: {allowed}", missing=True))
    else:
        faults.read(("kind",), DRIVE_KINDS.read, drive["kind"])
    faults.raise_if_any()


Drive = Annotated[
    SpeedDrive | ForceDrive | TipSpeedDrive,
    Form(AnyForm, (SpeedDrive, ForceDrive, TipSpeedDrive), check=_check_drive),
]
"""The drive as the program sees it, read from any of the forms."""
