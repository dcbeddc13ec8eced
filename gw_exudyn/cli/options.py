"""Options and arguments that several commands share."""

from __future__ import annotations

import click

SCENARIO_HELP = "SCENARIO is a YAML file, or the name of a shipped scenario"

overrides = click.option(
    "--set",
    "overrides",
    multiple=True,
    metavar="PATH=VALUE",
    help="Override a value of the scenario, as wire.segments=100 or drive.speed='1 mm/s'. May be repeated.",
)
jobs = click.option(
    "--jobs", "-j", type=click.IntRange(1, 1024), metavar="N", help="Worker processes. Without: one a core."
)
scheduler = click.option(
    "--scheduler", metavar="ADDRESS", help="Use the workers of this dask scheduler, as tcp://host:8786."
)
as_json = click.option("--json", "as_json", is_flag=True, help="Write JSON to stdout, for a program to read.")


class ShippedCommand(click.Command):
    """A command whose help ends with the names of the shipped scenarios."""

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the names."""
        from gw_exudyn.scenario.shipped import list_shipped

        with formatter.section("Shipped scenarios"):
            for name in list_shipped():
                formatter.write(f"  {name}\n")
