"""`gw-exudyn animate`: a run as a moving picture."""

from __future__ import annotations

from pathlib import Path

import click

from gw_exudyn.cli.console import put, stderr_console, tell
from gw_exudyn.cli.plot import run_folder, short


@click.command(
    short_help="Make a moving picture of a run (GIF, or MP4 with ffmpeg).",
    help="""Draw a RUN (a run folder) as a moving picture: the wire in the vessel with its contact forces, and the
    forces over time. The name of the file is written to stdout.""",
)
@click.argument("run", metavar="RUN")
@click.option(
    "-o",
    "--out",
    metavar="FILE",
    help="The file, ending in .gif or .mp4; figures/animation.gif of the run if not given.",
)
@click.option("--frames", type=click.IntRange(2, 5000), default=120, show_default=True, help="Frames, at most.")
@click.option("--rate", type=click.FloatRange(1, 50), default=15.0, show_default=True, help="Frames a second.")
def command(run: str, out: str | None, frames: int, rate: float) -> int:
    """Read the run, draw, and name the file."""
    from rich.progress import Progress

    from gw_exudyn.plots import save_animation
    from gw_exudyn.storage import read_run

    folder = run_folder(run)
    result = read_run(folder)
    if not result.status.status.trusted:
        tell(f"{result.scenario.name}: {result.status.sentence()}")
    console = stderr_console()
    with Progress(console=console, transient=True, disable=not console.is_terminal) as bars:
        task = bars.add_task("frames", total=frames)
        file = save_animation(
            result,
            Path(out) if out else folder / "figures" / "animation.gif",
            frames=frames,
            rate=rate,
            progress=lambda done, total: bars.update(task, completed=done, total=total),
        )
    put(str(short(file)))
    return 0
