"""Figures as files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from io import BytesIO
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from gw_exudyn.errors import StorageError
from gw_exudyn.plots.contact_map import plot_contact_map
from gw_exudyn.plots.energy import plot_energy
from gw_exudyn.plots.forces import plot_forces
from gw_exudyn.plots.insertion import plot_insertion
from gw_exudyn.plots.tip_path import plot_tip_path

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gw_exudyn.result import Result

FORMATS = ("png", "pdf")
FIGURES: Mapping[str, Callable[[Result], Figure]] = MappingProxyType(
    {
        "insertion": plot_insertion,
        "forces": plot_forces,
        "tip_path": plot_tip_path,
        "energy": plot_energy,
        "contact_map": plot_contact_map,
    }
)
"""The figures of one run by name; the name is also the file's."""

_RESOLUTION = 160
# No date and no program version in a file: the same run gives the same bytes.
_METADATA = {"png": {"Software": None}, "pdf": {"CreationDate": None, "Producer": None, "Creator": None}}


def render(figure: Figure, file_format: str) -> bytes:
    """A figure as the bytes of a file. Raises ValueError for a format that matplotlib does not know."""
    from matplotlib import rc_context

    buffer = BytesIO()
    with rc_context({"pdf.fonttype": 42, "svg.hashsalt": "gw_exudyn"}):
        figure.savefig(
            buffer,
            format=file_format,
            dpi=_RESOLUTION,
            bbox_inches="tight",
            pad_inches=0.12,
            metadata=_METADATA.get(file_format),
        )
    return buffer.getvalue()


def render_figures(
    result: Result, names: Sequence[str] = tuple(FIGURES), formats: Sequence[str] = FORMATS
) -> dict[str, bytes]:
    """Figures of a run as bytes by file name (`insertion.png`).

    Raises KeyError for the name of a figure that there is not.
    """
    files: dict[str, bytes] = {}
    for name in names:
        figure = FIGURES[name](result)
        files.update({f"{name}.{file_format}": render(figure, file_format) for file_format in formats})
    return files


def save_figure(figure: Figure, path: str | Path, formats: Sequence[str] = FORMATS) -> list[Path]:
    """Write a figure as `path` with each format's suffix, and return the files.

    Raises StorageError where the disk or the system refuses.
    """
    stem = Path(path)
    return _write(stem.parent, {f"{stem.name}.{file_format}": render(figure, file_format) for file_format in formats})


def save_figures(
    result: Result, folder: str | Path, names: Sequence[str] = tuple(FIGURES), formats: Sequence[str] = FORMATS
) -> list[Path]:
    """Write figures of a run into `folder` (made if missing), and return the files.

    Raises StorageError where the disk or the system refuses.
    """
    return _write(Path(folder), render_figures(result, names, formats))


def _write(folder: Path, files: Mapping[str, bytes]) -> list[Path]:
    from gw_exudyn.storage.run_folder import write_file

    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in files.items():
            write_file(folder / name, content)
    except OSError as error:
        raise StorageError(
            f"{folder}: figures can't be written: {error.strerror or error}; name another folder (--out)"
        ) from error
    return [folder / name for name in files]
