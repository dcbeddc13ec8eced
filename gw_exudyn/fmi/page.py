"""The variables for a person to read: as a page in the FMU, and as a table in Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from gw_exudyn.fmi import variables as v
from gw_exudyn.fmi.resources import Launch
from gw_exudyn.fmi.units import fmi_name
from gw_exudyn.fmi.variables import Variable

HEADINGS = ("name", "role", "type", "unit", "shown in", "start", "from", "to", "meaning")
_ROLES = {
    v.INDEPENDENT: "time",
    v.INPUT: "input",
    v.FIXED: "parameter, fixed",
    v.TUNABLE: "parameter, tunable",
    v.OUTPUT: "output",
}
_KINDS = {v.REAL: "Real", v.INTEGER: "Integer", v.BOOLEAN: "Boolean", v.TEXT: "String"}


def rows(variables: Sequence[Variable]) -> list[tuple[str, ...]]:
    """One row a variable, after `HEADINGS`."""
    return [
        (
            variable.name + (f"[{variable.size}]" if variable.size > 1 else ""),
            _ROLES[variable.role],
            _KINDS[variable.kind],
            fmi_name(variable.unit),
            fmi_name(variable.display_unit),
            _text(variable.start) if variable.settable else "",
            _text(variable.low),
            _text(variable.high),
            variable.description,
        )
        for variable in variables
    ]


def _text(value: object) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def markdown(variables: Sequence[Variable]) -> str:
    """The table in Markdown."""
    lines = [HEADINGS, ("---",) * len(HEADINGS), *rows(variables)]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)


def documentation(name: str, variables: Sequence[Variable], fmi: int, launch: Launch) -> str:
    """documentation/index.html of an FMU."""
    shown = [x for x in variables if fmi == 3 or (x.role != v.INDEPENDENT and x.size == 1)]
    body = "\n".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows(shown))
    head = "".join(f"<th>{heading}</th>" for heading in HEADINGS)
    return f"""<!DOCTYPE html>
<html><head><meta charset="utf-8"><title>{escape(name)}</title></head><body>
<h1>{escape(name)}</h1>
<p>A guidewire pushed into a vessel, by gw-exudyn {launch.version}, under the MIT licence. {_where(launch)} If the
worker does not start, {escape(launch.remedy)}.</p>
<p>All values are in SI. Forces are those of the wire on the vessel; the push force is positive when pushing.</p>
<table>
<tr>{head}</tr>
{body}
</table>
</body></html>
"""


def _where(launch: Launch) -> str:
    """In which Python the worker runs, and on which machines."""
    if launch.program:
        return (
            f"The worker and its Python are in this FMU, for Linux with glibc {launch.glibc} or newer on the processor "
            "of the library in binaries/; the libraries for other platforms are left out. licenses/bundled.txt has the "
            "licences of what is inside."
        )
    return (
        "The worker runs in a Python that has it: that of the environment variable GW_EXUDYN_PYTHON, else the one that "
        "exported this FMU, else the first python3 on the PATH."
    )


def readme_table() -> str:
    """The table of fmu/README.md: the variables of the scenario `arc90`, in FMI 3."""
    from gw_exudyn.fmi.export import variables_of
    from gw_exudyn.scenario import load_scenario

    return markdown(variables_of(load_scenario("arc90"), 3))


if __name__ == "__main__":
    import sys

    sys.stdout.write(readme_table() + "\n")
