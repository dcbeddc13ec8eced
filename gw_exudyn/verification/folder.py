"""The folder of evidence: the table as CSV and Markdown, figures, and the versions that made them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from gw_exudyn.errors import StorageError
from gw_exudyn.result import software_versions
from gw_exudyn.storage.manifest import to_text
from gw_exudyn.storage.run_folder import write_file
from gw_exudyn.verification.drawing import png
from gw_exudyn.verification.running import Outcome
from gw_exudyn.verification.table import as_csv, as_markdown

TABLE, TEXT, VERSIONS, FIGURES = "evidence.csv", "README.md", "versions.json", "figures"
_FURTHER = ("scipy", "shapely", "matplotlib", "mujoco")  # beside what takes part in a run


def write(outcomes: Sequence[Outcome], folder: Path, command: str) -> list[Path]:
    """Write the evidence into a folder (made if missing) and return the files; what is there of the same names is
    replaced, figures that no case draws any more are removed.

    Raises StorageError where the disk or the system refuses.
    """
    charts = [chart for outcome in outcomes for chart in outcome.finding.charts]
    files = {folder / FIGURES / f"{chart.name}.png": png(chart) for chart in charts}
    files[folder / TABLE] = as_csv(outcomes).encode()
    files[folder / TEXT] = as_markdown(outcomes, command).encode()
    files[folder / VERSIONS] = to_text({"command": command, "versions": software_versions(*_FURTHER)}).encode()
    try:
        known = _figures_of_before(folder)
        for path, content in files.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            write_file(path, content)
        for path in known - set(files):
            path.unlink(missing_ok=True)
    except OSError as error:
        raise StorageError(
            f"{folder}: evidence can't be written: {error.strerror or error}; name another folder (--out)"
        ) from error
    return sorted(files)


def _figures_of_before(folder: Path) -> set[Path]:
    """The figures that an older table here shows; files of anybody else's are not touched."""
    try:
        text = (folder / TEXT).read_text(encoding="utf-8")
    except (OSError, ValueError):
        return set()
    if not text.startswith("# Evidence\n"):
        return set()
    names = [line.rpartition(f"({FIGURES}/")[2].rstrip(")") for line in text.splitlines() if line.startswith("![")]
    return {folder / FIGURES / name for name in names if "/" not in name and "\\" not in name}
