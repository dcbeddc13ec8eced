"""A parameter set (SSV) of an FMU, and an example system (SSP) of one such FMU, after the standard SSP 1.0."""

from __future__ import annotations

import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gw_exudyn.errors import StorageError, UsageError
from gw_exudyn.fmi import variables as v
from gw_exudyn.fmi.variables import Variable

if TYPE_CHECKING:
    from lxml.etree import _Element

    from gw_exudyn.scenario import Scenario

_NAMESPACES = {
    part: f"http://ssp-standard.org/SSP1/SystemStructure{name}"
    for part, name in (("ssd", "Description"), ("ssv", "ParameterValues"), ("ssc", "Common"))
}
_TYPES = {v.REAL: "Real", v.INTEGER: "Integer", v.BOOLEAN: "Boolean", v.TEXT: "String"}
_COMPONENT = "insertion"


def files_beside(fmu: Path) -> tuple[Path, Path]:
    """The SSV and the SSP that belong to an FMU. Raises UsageError for an FMU that one of them would overwrite."""
    # Some file systems take X.SSP and X.ssp for one file.
    if fmu.suffix.lower() in (".ssv", ".ssp"):
        raise UsageError(
            f"{fmu}: the {fmu.suffix[1:].upper()} beside the FMU would overwrite it; "
            f"name the FMU otherwise: {fmu.with_suffix('.fmu')}"
        )
    return fmu.with_suffix(".ssv"), fmu.with_suffix(".ssp")


def write_ssp(scenario: Scenario, fmu: Path, variables: Sequence[Variable]) -> tuple[Path, Path]:
    """Write the SSV and the SSP of an FMU beside it and return their files. Raises StorageError, and UsageError as
    `files_beside` does."""
    values, system = files_beside(fmu)
    parameters = parameter_set(scenario.name, variables)
    try:
        values.write_bytes(parameters)
        with zipfile.ZipFile(system, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("SystemStructure.ssd", _system(scenario, fmu.name, values.name, variables))
            archive.writestr(f"resources/{values.name}", parameters)
            archive.write(fmu, f"resources/{fmu.name}")
    except OSError as error:
        raise StorageError(f"{error.filename or system}: can't be written: {error.strerror or error}") from error
    return values, system


def parameter_set(name: str, variables: Sequence[Variable]) -> bytes:
    """The SSV of the parameters with their starts, in the FMU's units (SI)."""
    root = _element("ssv:ParameterSet", version="1.0", name=name)
    listed = _element("ssv:Parameters", root)
    for variable in variables:
        if variable.role in (v.FIXED, v.TUNABLE):
            parameter = _element("ssv:Parameter", listed, name=variable.name)
            _element(f"ssv:{_TYPES[variable.kind]}", parameter, value=_text(variable))
    return _bytes(root)


def _text(variable: Variable) -> str:
    if variable.kind == v.BOOLEAN:
        return "true" if variable.start else "false"
    return repr(float(variable.start or 0)) if variable.kind == v.REAL else str(variable.start)


def _system(scenario: Scenario, fmu: str, values: str, variables: Sequence[Variable]) -> bytes:
    """The SSD: one component, the FMU with its parameter set."""
    root = _element("ssd:SystemStructureDescription", version="1.0", name=scenario.name)
    elements = _element("ssd:Elements", _element("ssd:System", root, name=scenario.name))
    source = {"source": f"resources/{fmu}", "type": "application/x-fmu-sharedlibrary"}
    component = _element("ssd:Component", elements, name=_COMPONENT, **source)
    connectors = _element("ssd:Connectors", component)
    for variable in variables:
        if variable.role in (v.INPUT, v.OUTPUT) and variable.size == 1:
            kind = "input" if variable.role == v.INPUT else "output"
            connector = _element("ssd:Connector", connectors, name=variable.name, kind=kind)
            _element(f"ssc:{_TYPES[variable.kind]}", connector)
    bindings = _element("ssd:ParameterBindings", component)
    _element("ssd:ParameterBinding", bindings, source=f"resources/{values}")
    _element("ssd:DefaultExperiment", root, startTime="0.0", stopTime=repr(float(scenario.drive.duration)))
    return _bytes(root)


def _element(qualified: str, parent: _Element | None = None, /, **attributes: str) -> _Element:
    from lxml import etree

    prefix, _, tag = qualified.partition(":")
    full: Any = f"{{{_NAMESPACES[prefix]}}}{tag}"
    if parent is None:
        return etree.Element(full, attributes, nsmap=_NAMESPACES)
    return etree.SubElement(parent, full, attributes)


def _bytes(root: _Element) -> bytes:
    from lxml import etree

    text: bytes = etree.tostring(root, xml_declaration=True, encoding="UTF-8", pretty_print=True)
    return text
