"""The variables for a person to read: as a page in the FMU, and as a table in Markdown."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import escape
from textwrap import fill
from typing import TYPE_CHECKING

from gw_exudyn.fmi import variables as v
from gw_exudyn.fmi.prose import ENDING_HEADINGS, ENDINGS, LIMITS, METHOD
from gw_exudyn.fmi.related import SET_FROM_PAGE
from gw_exudyn.fmi.resources import Launch, how_to_install
from gw_exudyn.fmi.units import fmi_name
from gw_exudyn.fmi.variables import Variable

if TYPE_CHECKING:
    from gw_exudyn.fmi.description import Model

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


def markdown(headings: Sequence[str], lines: Sequence[Sequence[str]]) -> str:
    """A table in Markdown."""
    table = [headings, ("---",) * len(headings), *lines]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in table)


_STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; max-width: 76em; margin: 2em auto; padding: 0 1em; color: #1d2733; }
header { display: flex; align-items: center; gap: 1.5em; }
table { border-collapse: collapse; margin: .6em 0; }
th, td { text-align: left; vertical-align: top; padding: .25em .7em .25em 0; border-bottom: 1px solid #d8dde2; }
th { border-bottom-color: #66707a; }
.variables td:first-child, code { font-family: ui-monospace, monospace; font-size: 92%; }
"""


def documentation(model: Model, variables: Sequence[Variable], fmi: int, launch: Launch) -> str:
    """documentation/index.html of an FMU."""
    shown = [x for x in variables if fmi == 3 or (x.role != v.INDEPENDENT and x.size == 1)]
    icon = "../terminalsAndIcons/icon.svg" if fmi == 3 else "../model.png"
    parts = {
        "Method": "\n".join(_paragraph(text) for text in METHOD),
        "Limits": "<ul>\n" + "\n".join(f"<li>{_marked(text)}</li>" for text in LIMITS) + "\n</ul>",
        "How a run ends early": _table(ENDING_HEADINGS, ENDINGS),
        "Where it runs": _paragraph(_where(launch)) + _paragraph(f"If the worker does not start, {launch.remedy}."),
        "Parameters": _paragraph(_PARAMETERS) + f'<p><a href="{SET_FROM_PAGE}">The parameter set as SSV</a></p>',
        "Licence": '<p>MIT; <a href="licenses/license.txt">licenses/license.txt</a> has the text.</p>',
        "Variables": _paragraph(_SIGNS) + f'<div class="variables">{_table(HEADINGS, rows(shown))}</div>',
    }
    body = "\n".join(f"<h2>{heading}</h2>\n{content}" for heading, content in parts.items())
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{escape(model.name)}</title><style>{_STYLE}</style></head><body>
<header><img src="{icon}" width="96" height="96" alt=""><div><h1>{escape(model.name)}</h1>
<p>{escape(model.description)} FMI {fmi}.0 for co-simulation, by gw-exudyn {escape(launch.version)}.
The exported run takes {model.stop:g} s, with a solver step of {model.step:g} s.</p></div></header>
{body}
</body></html>
"""


_PARAMETERS = (
    "They are fixed: set them before the initialization ends; `worker.timeout` can be changed at any time. One that "
    "equals its start overrides nothing. What is out of range is told, all of it at once, when the initialization ends."
)
_SIGNS = "All values are in SI. Forces are those of the wire on the vessel; the push force is positive when pushing."


def _marked(text: str) -> str:
    """Text as HTML, with what stands between backticks as code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(text))


def _paragraph(text: str) -> str:
    return f"<p>{_marked(text)}</p>"


def _table(headings: Sequence[str], lines: Sequence[Sequence[str]]) -> str:
    head = "".join(f"<th>{heading}</th>" for heading in headings)
    body = "\n".join("<tr>" + "".join(f"<td>{_marked(cell)}</td>" for cell in line) + "</tr>" for line in lines)
    return f"<table>\n<tr>{head}</tr>\n{body}\n</table>"


def external_dependencies(launch: Launch) -> str:
    """documentation/externalDependencies.txt: what the FMU needs besides itself."""
    if launch.program:
        return f"Linux with glibc {launch.glibc} or newer. Everything else is in resources/.\n"
    return (
        f"Python 3.11 or newer with the package gw-exudyn {launch.version}; {how_to_install(launch.version)}\n"
        f"{_where(launch)}\n"
    )


def _where(launch: Launch) -> str:
    """In which Python the worker runs, and on which machines."""
    if launch.program:
        return (
            f"The worker and its Python are in this FMU, for Linux with glibc {launch.glibc} or newer on the processor "
            "of the library in binaries/; the libraries for other platforms are left out."
        )
    return (
        "The worker runs in a Python that has it: that of the environment variable GW_EXUDYN_PYTHON, else the one that "
        "exported this FMU, else the first python3 on the PATH."
    )


def readme_parts() -> tuple[str, ...]:
    """What stands in fmu/README.md from here: method, limits, how a run ends, and, at its end, the variables of the
    scenario `arc90` in FMI 3."""
    from gw_exudyn.fmi.table import variables_of
    from gw_exudyn.scenario import load_scenario

    return (
        "\n\n".join(fill(text, 118, break_on_hyphens=False) for text in METHOD),
        "\n".join(fill(f"- {text}", 118, subsequent_indent="  ") for text in LIMITS),
        markdown(ENDING_HEADINGS, ENDINGS),
        markdown(HEADINGS, rows(variables_of(load_scenario("arc90"), 3))),
    )


if __name__ == "__main__":
    import sys

    sys.stdout.write("\n\n".join(readme_parts()) + "\n")
