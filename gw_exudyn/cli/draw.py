"""The figure of `gw-exudyn check --draw`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from gw_exudyn.errors import UsageError

if TYPE_CHECKING:
    from gw_exudyn.model import Model
    from gw_exudyn.plots.drawing import Drawing

FORMATS = ("png", "pdf", "svg")


def picture_file(given: str, name: str) -> Path:
    """The file to draw into: the one given, or one named after the scenario in the current folder."""
    path = Path(given) if given else Path(f"{name}.png")
    if path.suffix.lstrip(".").lower() not in FORMATS:
        raise UsageError(f"--draw {given}: a picture's name ends in {', '.join(f'.{end}' for end in FORMATS)}")
    return path


def draw(model: Model, path: Path) -> None:
    """Draw a model into a file. Raises StorageError where the disk refuses."""
    from gw_exudyn.plots import save_figure
    from gw_exudyn.plots.drawing import plot_drawing

    save_figure(plot_drawing(_drawing(model)), path.with_suffix(""), (path.suffix.lstrip(".").lower(),))


def _drawing(model: Model) -> Drawing:
    import numpy as np

    from gw_exudyn.plots.drawing import Drawing

    outline, vessel = model.outline, model.scenario.vessel
    lumen = model.frame.points_out(outline.points)
    wire = np.column_stack([-model.wire.node_arc_length, np.zeros(model.wire.segments + 1)])
    lines = {name: r.centre_line for name, r in vessel.regions().items() if r.centre_line is not None}
    return Drawing(
        title=model.scenario.name,
        lumen=lumen,
        walls=model.vessel_outline(),
        open_ends=[lumen[[i, (i + 1) % len(lumen)]] for i in sorted(outline.open_edges)],
        corners=model.frame.points_out(model.walls.corner),
        catheter=model.catheter_outline(),
        branches=lines,
        wire=model.frame.points_out(wire),
        diameter=model.scenario.wire.diameter,
    )
