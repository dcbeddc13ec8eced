"""The drive of a scenario: what moves the proximal end, in any of its forms. Every course becomes one table."""

from __future__ import annotations

from functools import partial
from typing import Annotated

from pydantic import Discriminator, Tag

from gw_exudyn.scenario.drives.force import ForceDrive, ForceForm
from gw_exudyn.scenario.drives.speed import DriveForm, SpeedDrive
from gw_exudyn.scenario.drives.tip_speed import TipSpeedDrive, TipSpeedForm
from gw_exudyn.scenario.fields import Choice
from gw_exudyn.scenario.section import KIND_TAG, Form, check_kind, kind_tag

DRIVE_KINDS = Choice(("speed", "force", "tip_speed"))


AnyForm = Annotated[
    Annotated[DriveForm, Tag(f"{KIND_TAG}speed")]
    | Annotated[ForceForm, Tag(f"{KIND_TAG}force")]
    | Annotated[TipSpeedForm, Tag(f"{KIND_TAG}tip_speed")],
    Discriminator(kind_tag),
]
"""What a file may hold."""


Drive = Annotated[
    SpeedDrive | ForceDrive | TipSpeedDrive,
    Form(AnyForm, (SpeedDrive, ForceDrive, TipSpeedDrive), check=partial(check_kind, kinds=DRIVE_KINDS, what="drive")),
]
"""The drive as the program sees it, read from any of the forms."""
