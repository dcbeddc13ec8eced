"""`gw-exudyn check`: is the scenario sound, and what would be run?"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import click

from gw_exudyn.cli import options
from gw_exudyn.cli.console import put_json, put_table, tell
from gw_exudyn.errors import ScenarioError

if TYPE_CHECKING:
    from gw_exudyn.scenario import Scenario


@click.command(
    cls=options.ShippedCommand,
    short_help="Check a scenario and say what would be run.",
    help=f"""Check a SCENARIO without running it: everything that is wrong is told at once, with file, line and what is
    allowed; else a summary of what would be run.

    {options.SCENARIO_HELP}.""",
)
@click.argument("scenario", metavar="SCENARIO")
@options.overrides
@click.option(
    "--draw",
    "picture",
    is_flag=False,
    flag_value="",
    metavar="[FILE]",
    help="Draw vessel, open ends, corners, branches, catheter and wire into FILE (.png, .pdf, .svg); without FILE into "
    "the current folder, named after the scenario.",
)
@options.as_json
def command(scenario: str, overrides: tuple[str, ...], picture: str | None, as_json: bool) -> int:
    """Load, build the model, draw it if asked, and tell of it."""
    from gw_exudyn import model
    from gw_exudyn.scenario import load_scenario

    try:
        loaded = load_scenario(scenario, overrides)
        built = model.build(loaded)
        described = built.describe()
    except ScenarioError as error:
        if as_json:
            put_json({"valid": False, "problems": [asdict(problem) for problem in error.problems]})
        raise
    if picture is not None:
        from gw_exudyn.cli.draw import draw, picture_file

        file = picture_file(picture, loaded.name)
        draw(built, file)
        tell(f"drawn: {file}")
    if as_json:
        put_json({"valid": True, "problems": [], "name": loaded.name, "model": described})
        return 0
    put_table(summary_rows(loaded, described))
    for warning in described["warnings"]:
        tell(f"warning: {warning}")
    return 0


def summary_rows(scenario: Scenario, described: dict[str, Any]) -> list[tuple[str, str]]:
    """What would be run, as label and text."""
    from gw_exudyn.scenario.units import format_quantity

    def given(path: str, unit: str) -> str:
        return format_quantity(float(f"{described[path]:.4g}"), unit)

    wire, catheter = scenario.wire, scenario.catheter
    least, largest = (given(f"wire.bending_stiffness_{end}", "N*mm^2") for end in ("least", "largest"))
    shortest, longest = (given(f"wire.{end}_segment", "mm") for end in ("shortest", "longest"))
    place = ", ".join(f"{value * 1e3:.4g}" for value in catheter.exit)
    stiffness = "chosen" if scenario.contact.wall_stiffness is None else "given"
    return [
        ("scenario", scenario.name),
        ("wire", f"{wire.model or 'given inline'}, {given('wire.diameter', 'mm')} by {given('wire.length', 'mm')}"),
        ("bending stiffness", least if least == largest else f"{least} to {largest}"),
        ("segments", f"{wire.segments} of {shortest if shortest == longest else f'{shortest} to {longest}'}"),
        *_vessel_rows(scenario, described, given),
        ("catheter", f"exit at ({place}) mm, {_bore(scenario)}"),
        ("friction", f"{scenario.contact.friction_coefficient:g}"),
        ("wall stiffness", f"{given('contact.wall_stiffness', 'N/m')}, {stiffness}"),
        ("drive", f"{_drive(scenario, described)}, {given('drive.duration', 's')} in all"),
        ("solver steps", f"about {described['solver.steps']} of {format_quantity(scenario.solver.step, 'ms')}"),
    ]


def _vessel_rows(
    scenario: Scenario, described: dict[str, Any], given: Callable[[str, str], str]
) -> list[tuple[str, str]]:
    from gw_exudyn.scenario.units import format_quantity

    if scenario.vessel.kind == "none":
        return [("vessel", "none")]
    room = format_quantity(float(f"{described['vessel.width_at_exit'] - scenario.wire.diameter:.4g}"), "mm")
    walls = f"{described['vessel.walls']} walls, {_corners(described)} into the lumen"
    return [
        ("vessel", f"{scenario.vessel.kind}, {walls}"),
        *_out_of_plane(described),
        ("lumen at the exit", f"{given('vessel.width_at_exit', 'mm')}, {room} wider than the wire"),
    ]


def _bore(scenario: Scenario) -> str:
    from gw_exudyn.scenario.units import format_quantity

    bore = scenario.catheter.bore
    if bore is None:
        return "no tube: only the drive holds the wire"
    inner, play = (format_quantity(float(f"{width:.4g}"), "mm") for width in (bore, bore - scenario.wire.diameter))
    return f"bore {inner}, {play} wider than the wire"


def _drive(scenario: Scenario, described: dict[str, Any]) -> str:
    from gw_exudyn.scenario.units import format_quantity

    drive = scenario.drive
    if drive.kind == "force":
        return f"force of up to {format_quantity(max(drive.force, key=abs), 'mN')} on the hub"
    furthest = format_quantity(float(f"{described['drive.furthest']:.4g}"), "mm")
    return f"{furthest} in" if drive.kind == "speed" else f"{furthest} of the tip's path, by the hub's speed"


def _out_of_plane(described: dict[str, Any]) -> list[tuple[str, str]]:
    share = described["vessel.out_of_plane"]
    return [] if share is None else [("out of plane", f"at most {share:.3g} of the radius, projected")]


def _corners(described: dict[str, Any]) -> str:
    count = described["vessel.corners"]
    return f"{count} corner{'' if count == 1 else 's'}"
