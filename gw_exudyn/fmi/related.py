"""What an FMU has besides itself for other tools: its parameter set, and the scenario it was made of.

After the layered standard FMI-LS-REF, version 1.0.0-alpha.1: a manifest says what each file is. A tool that knows the
standard offers the set by name and applies it as it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from gw_exudyn.fmi.resources import SCENARIO
from gw_exudyn.fmi.ssp import parameter_set
from gw_exudyn.fmi.variables import Variable

if TYPE_CHECKING:
    from gw_exudyn.scenario import Scenario

FOLDER = "extra/org.fmi-standard.fmi-ls-ref"
MANIFEST = "fmi-ls-manifest.xml"
PARAMETERS = "parameters.ssv"
SET_FROM_PAGE = f"../{FOLDER}/{PARAMETERS}"
"""Where the parameter set lies, seen from the FMU's page."""

_NAMESPACE = "http://fmi-standard.org/fmi-ls-manifest"


def related_files(scenario: Scenario, variables: Sequence[Variable]) -> dict[str, bytes]:
    """The files of the layered standard, by their place in the FMU."""
    related = (
        ("application/x-ssp-parameter-set", PARAMETERS, "parameter", "All parameters, with their exported starts"),
        ("application/json", f"../../resources/{SCENARIO}", "model", "The scenario that this FMU was exported from"),
    )
    return {
        f"{FOLDER}/{MANIFEST}": _manifest(related),
        f"{FOLDER}/{PARAMETERS}": parameter_set(scenario.name, variables),
    }


def _manifest(related: Sequence[tuple[str, str, str, str]]) -> bytes:
    from lxml import etree

    attributes = {
        "name": "org.fmi-standard.fmi-ls-ref",
        "version": "1.0.0-alpha.1",
        "description": "Layered Standard providing information on related files included in an FMU.",
    }
    root = etree.Element(
        "fmiReferences",
        {f"{{{_NAMESPACE}}}fmi-ls-{name}": text for name, text in attributes.items()},
        nsmap={"fmi-ls": _NAMESPACE},
    )
    for kind, source, role, description in related:
        etree.SubElement(root, "Related", {"type": kind, "source": source, "role": role, "description": description})
    content: bytes = etree.tostring(root, xml_declaration=True, encoding="UTF-8", pretty_print=True)
    return content
