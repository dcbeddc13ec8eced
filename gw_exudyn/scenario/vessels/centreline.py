"""Centre lines with radii from CSV files, in the plane or in space, as the branches of a vessel."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, PrivateAttr, ValidationInfo, field_validator, model_validator

from gw_exudyn.errors import UnitError
from gw_exudyn.scenario.faults import Faults, wrong
from gw_exudyn.scenario.fields import Choice, Table, Text
from gw_exudyn.scenario.kinds import FILLET
from gw_exudyn.scenario.section import Section
from gw_exudyn.scenario.units import in_si, parse_number
from gw_exudyn.scenario.vessels.branches import BranchesVessel, BranchSpec, united
from gw_exudyn.scenario.words import shown

MOST_OUT_OF_PLANE = 0.5
"""How far from its best plane a centre line may run, over the local radius: beyond, the cut is well off its middle."""

_MOST_FILES = 100
_HEADER = re.compile(r"\s*(x|y|z|radius|branch)\s*(?:\[\s*(.+?)\s*\])?\s*", re.IGNORECASE)
_FORM = "'x,y,radius' in metres or 'x [mm],y [mm],radius [mm]', with columns z and branch if you like"

_THINNEST, _WIDEST = 0.05e-3, 50e-3
_UNIT_HINT = "the header names the unit, as radius [mm], else it is metres"


@dataclass
class Line:
    """One centre line. rows : [x, y, z, radius], m. lines : of the file, one a row."""

    name: str
    file: str
    rows: list[tuple[float, float, float, float]]
    lines: list[int]


class CentrelineForm(Section):
    """Branches along centre lines from CSV files, with the lumen's radius at every point."""

    what: ClassVar[str] = "a vessel along centre lines"

    kind: Annotated[Literal["centreline"], Choice(("centreline",))]
    file: Annotated[str | None, Text("file name", optional=True)] = Field(
        default=None,
        description="CSV file, relative to this; header x,y,radius (metres) or x [mm],y [mm],radius [mm]; "
        "columns z (projected on the best plane) and branch (name) if you like",
    )
    files: Annotated[tuple[str, ...] | None, Table(Text("file name"), 1, _MOST_FILES, "file", optional=True)] = Field(
        default=None, validate_default=True, description="several such files, one branch each, named after it"
    )
    fillet: Annotated[float | None, FILLET] = Field(
        default=None, description="radius of corners into the lumen where branches meet"
    )

    _lines: list[Line] = PrivateAttr(default_factory=list)

    @field_validator("files", mode="after")
    @classmethod
    def _either(cls, files: tuple[str, ...] | None, info: ValidationInfo) -> tuple[str, ...] | None:
        if "file" in info.data and (files is None) == (info.data["file"] is None):
            if files is None:
                raise wrong("is missing: give file: centreline.csv, or files: [...]", missing=True, instead=("file",))
            raise wrong("stands beside file; give one of the two")
        return files

    @model_validator(mode="after")
    def _read(self, info: ValidationInfo) -> CentrelineForm:
        folder, faults = Path((info.context or {}).get("folder", ".")), Faults()
        given = [(("file",), self.file)] if self.file else [(("files", i), n) for i, n in enumerate(self.files or ())]
        for loc, name in given:
            found = faults.read(loc, lambda name: read_centrelines(folder / name), name)
            self._lines.extend(found or ())
        names = [line.name for line in self._lines]
        for i, line in enumerate(self._lines):
            if line.name in names[:i]:
                text = f"{shown(line.name)} is the name of another branch too; rename one"
                faults.add((), wrong(text, file=line.file, line=line.lines[0]))
        faults.raise_if_any()
        return self

    def resolve(self) -> BranchesVessel:
        """The branches, in the plane. Raises ValidationError with the file and the line."""
        faults = Faults()
        flat, share = _in_plane(self._lines, faults)
        faults.raise_if_any()
        specs = tuple(_spec(line, points, self.fillet) for line, points in zip(self._lines, flat, strict=True))
        found = united(specs)
        if isinstance(found, list):
            for fault in found:
                i = fault.loc[1] if len(fault.loc) > 1 else 0
                at = self._lines[int(i)], flat[int(i)]
                faults.add((), wrong(fault.message, file=at[0].file, line=_nearest_line(*at, fault.where)))
        faults.raise_if_any()
        return BranchesVessel(kind="branches", branches=specs, out_of_plane=share)


def read_centrelines(path: Path) -> list[Line]:
    """The centre lines in a CSV file: one, or one for each name in the column branch. Raises what `wrong` makes."""
    from gw_exudyn.scenario.vessels.outline import LARGEST_FILE, csv_rows, header_unit
    from gw_exudyn.scenario.vessels.outline_files import text_of

    file = str(path)
    rows = csv_rows(text_of(path, LARGEST_FILE), file)
    if not rows:
        raise wrong(f"is empty; a header is needed, {_FORM}, then one point a line", file=file, line=1)
    first, cells = rows[0]
    factors: dict[str, Any] = {}
    for cell in cells:
        match = _HEADER.fullmatch(cell)
        if match is None or match[1].lower() in factors:
            raise wrong(f"header {shown(cell)} is not understood; write {_FORM}", file=file, line=first)
        factors[match[1].lower()] = header_unit(match[2] or "m", file, first)
    if not {"x", "y", "radius"} <= factors.keys():
        raise wrong(f"header has the columns {', '.join(factors)}; write {_FORM}", file=file, line=first)
    return _lines(rows[1:], factors, path)


def _lines(rows: list[tuple[int, list[str]]], units: dict[str, Any], path: Path) -> list[Line]:
    found: dict[str, Line] = {}
    faults, file = Faults(), str(path)
    whole = re.sub(r"[^\w-]", "-", path.stem)
    whole = whole if re.match(r"[A-Za-z_]", whole) else f"branch-{whole}"
    for number, cells in rows:
        try:
            name, row = _row(cells, units)
        except UnitError as error:
            faults.add((), wrong(str(error), file=file, line=number))
            continue
        if not _THINNEST <= row[3] <= _WIDEST:
            text = f"radius: {row[3] * 1e3:.6g} mm is outside the plausible 0.05 mm to 50 mm"
            faults.add((), wrong(f"{text}; {_UNIT_HINT}", file=file, line=number))
            break  # a slip of units is in every row
        line = found.setdefault(name or whole, Line(name or whole, file, [], []))
        line.rows.append(row)
        line.lines.append(number)
    faults.raise_if_any()
    for line in found.values():
        if len(line.rows) < 2:
            text = f"branch {line.name!r} has one point; two at least are needed"
            faults.add((), wrong(text, file=file, line=line.lines[0]))
    if not found:
        faults.add((), wrong("has no points; write one a line below the header", file=file, line=1))
    faults.raise_if_any()
    return list(found.values())


def _row(cells: list[str], units: dict[str, Any]) -> tuple[str, tuple[float, float, float, float]]:
    if len(cells) != len(units):
        raise UnitError(f"row has {len(cells)} cells, the header {len(units)}; write {','.join(units)}")
    values, name = {"z": 0.0}, ""
    for column, cell in zip(units, cells, strict=True):
        if column == "branch":
            name = cell.strip()
            continue
        try:
            values[column] = in_si(parse_number(cell), units[column])
        except UnitError as error:
            raise UnitError(f"{column}: {error}") from None
    return name, (values["x"], values["y"], values["z"], values["radius"])


def _in_plane(lines: list[Line], faults: Faults) -> tuple[list[Any], float | None]:
    """Each line as (k, 3) rows of x, y, radius in the best plane, and how far it runs from that over the local radius;
    None if it is plane as given.
    """
    import numpy as np

    rows = [np.array(line.rows) for line in lines]
    stacked = np.concatenate(rows)
    if np.ptp(stacked[:, 2]) == 0:
        return [row[:, [0, 1, 3]] for row in rows], None
    middle = stacked[:, :3].mean(axis=0)
    normal = np.linalg.svd(stacked[:, :3] - middle)[2][-1]
    normal *= 1.0 if normal[np.argmax(np.abs(normal))] > 0 else -1.0
    # x stays as near to x as the plane lets it, so that a centre line that is all but flat keeps its coordinates.
    guide = np.eye(3)[0] if abs(normal[0]) < 0.9 else np.eye(3)[1]
    first = guide - (guide @ normal) * normal
    first /= np.linalg.norm(first)
    axes = np.column_stack([first, np.cross(normal, first)])
    shares = [np.abs((row[:, :3] - middle) @ normal) / row[:, 3] for row in rows]
    for line, share in zip(lines, shares, strict=True):
        worst = int(np.argmax(share))
        if share[worst] > MOST_OUT_OF_PLANE:
            text = (
                f"branch {line.name!r} runs {share[worst]:.3g} of its radius out of the best plane, at most "
                f"{MOST_OUT_OF_PLANE:g} are allowed; the model is planar: take a part of the vessel that is flatter"
            )
            faults.add((), wrong(text, file=line.file, line=line.lines[worst]))
    return [np.column_stack([row[:, :3] @ axes, row[:, 3]]) for row in rows], float(max(s.max() for s in shares))


def _spec(line: Line, rows: Any, fillet: float | None) -> BranchSpec:
    """A branch along a line, with no more stations than the facets' tolerance asks for."""
    import numpy as np

    from gw_exudyn.scenario.vessels.branch_course import FACET_TOLERANCE

    rows = rows[np.concatenate([[True], np.hypot(*np.diff(rows[:, :2], axis=0).T) > 1e-9])]
    kept = rows[_needed(rows, FACET_TOLERANCE * 2 * rows[:, 2].min())]
    places = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(kept[:, :2], axis=0).T))])
    return BranchSpec(
        name=line.name,
        points=tuple((float(x), float(y)) for x, y, _ in kept),
        diameter=tuple((float(s), float(2 * r)) for s, r in zip(places, kept[:, 2], strict=True)),
        fillet=fillet,
    )


def _needed(rows: Any, tolerance: float) -> Any:
    """Indices of the rows (x, y, radius) whose polyline keeps within the tolerance of all (Ramer, Douglas, Peucker)."""
    import numpy as np

    kept, spans = {0, len(rows) - 1}, [(0, len(rows) - 1)]
    while spans:
        a, b = spans.pop()
        if b - a < 2:
            continue
        chord = rows[b] - rows[a]
        part = np.clip((rows[a + 1 : b] - rows[a]) @ chord / max(chord @ chord, 1e-30), 0, 1)
        far = np.linalg.norm(rows[a + 1 : b] - rows[a] - part[:, None] * chord, axis=1)
        worst = int(np.argmax(far))
        if far[worst] > tolerance:
            kept.add(a + 1 + worst)
            spans += [(a, a + 1 + worst), (a + 1 + worst, b)]
    return sorted(kept)


def _nearest_line(line: Line, rows: Any, where: tuple[float, float] | None) -> int:
    import numpy as np

    if where is None:
        return line.lines[0]
    return line.lines[int(np.argmin(np.hypot(*(rows[:, :2] - np.array(where)).T)))]
