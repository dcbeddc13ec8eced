"""modelDescription.xml and buildDescription.xml, for FMI 2.0 and 3.0, checked against the standard's schemas."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from gw_exudyn.errors import UsageError
from gw_exudyn.fmi import variables as v
from gw_exudyn.fmi.units import definitions, fmi_name
from gw_exudyn.fmi.variables import Variable

if TYPE_CHECKING:
    from lxml.etree import _Element

CATEGORIES = (
    ("logEvents", "starts of workers and what they do"),
    ("logStatusWarning", "warnings"),
    ("logStatusDiscard", "steps that ended early"),
    ("logStatusError", "errors"),
    ("logStatusFatal", "a worker that was lost"),
    ("logAll", "everything"),
)


@dataclass(frozen=True)
class Model:
    """What the XML says about the FMU as a whole. stop, step : s, of the default experiment."""

    name: str
    identifier: str
    token: str
    version: str
    description: str
    stop: float
    step: float
    sources: tuple[str, ...]
    bundled: bool = False


_CAPABILITIES = {
    "canHandleVariableCommunicationStepSize": True,
}
_STATES = {2: ("canGetAndSetFMUstate", "canSerializeFMUstate"), 3: ("canGetAndSetFMUState", "canSerializeFMUState")}
_TOKENS = {2: "guid", 3: "instantiationToken"}


def model_description(model: Model, variables: Sequence[Variable], fmi: int) -> bytes:
    """The XML of an FMU. fmi : 2 or 3; FMI 2 has neither the time nor arrays among its variables."""
    root = _element("fmiModelDescription")
    _set(root, fmiVersion=f"{fmi}.0", modelName=model.name, description=model.description, version=model.version)
    _set(root, license="MIT", generationTool=f"gw-exudyn {model.version}", variableNamingConvention="structured")
    _set(root, **{_TOKENS[fmi]: model.token})
    _co_simulation(root, model, fmi)
    _units(root, variables)
    categories = _element("LogCategories", root)
    for name, description in CATEGORIES:
        _element("Category", categories, name=name, description=description)
    step = {"stepSize": model.step}
    _element("DefaultExperiment", root, startTime=0.0, stopTime=model.stop, **step)
    listed = _element("ModelVariables", root)
    shown = [(i, variable) for i, variable in enumerate(variables) if _shown(variable, fmi)]
    for reference, variable in shown:
        (_variable2 if fmi == 2 else _variable3)(listed, reference, variable)
    _structure(root, shown, fmi)
    return _checked(root, fmi, "ModelDescription")


def _shown(variable: Variable, fmi: int) -> bool:
    return fmi == 3 or (variable.role != v.INDEPENDENT and variable.size == 1)


def _co_simulation(root: _Element, model: Model, fmi: int) -> None:
    flags: dict[str, Any] = {"modelIdentifier": model.identifier, "needsExecutionTool": not model.bundled}
    flags |= _CAPABILITIES
    flags |= dict.fromkeys(_STATES[fmi], True)
    if fmi == 3:
        flags["mightReturnEarlyFromDoStep"] = True
    element = _element("CoSimulation", root, **flags)
    if fmi == 2:
        files = _element("SourceFiles", element)
        for name in model.sources:
            _element("File", files, name=name)


def _units(root: _Element, variables: Sequence[Variable]) -> None:
    listed = _element("UnitDefinitions", root)
    for unit in definitions(variables):
        element = _element("Unit", listed, name=unit.name)
        _element("BaseUnit", element, **unit.exponents)
        for name, factor in sorted(unit.displays.items()):
            _element("DisplayUnit", element, name=name, factor=factor)


def _roles(variable: Variable) -> dict[str, str]:
    """causality, variability and, for what is computed, initial."""
    discrete = "continuous" if variable.kind == v.REAL else "discrete"
    return {
        v.INDEPENDENT: {"causality": "independent", "variability": "continuous"},
        v.INPUT: {"causality": "input", "variability": discrete},
        v.FIXED: {"causality": "parameter", "variability": "fixed"},
        v.TUNABLE: {"causality": "parameter", "variability": "tunable"},
        v.OUTPUT: {"causality": "output", "variability": discrete, "initial": "calculated"},
    }[variable.role]


def _value(variable: Variable) -> dict[str, Any]:
    """Unit, limits and start."""
    values: dict[str, Any] = {}
    if variable.unit:
        values["unit"] = fmi_name(variable.unit)
        display = fmi_name(variable.display_unit)
        if display and display != values["unit"]:
            values["displayUnit"] = display
    if variable.low is not None:
        values["min"] = variable.low
    if variable.high is not None:
        values["max"] = variable.high
    if variable.settable:
        values["start"] = variable.start
    return values


def _variable2(listed: _Element, reference: int, variable: Variable) -> None:
    element = _element("ScalarVariable", listed, name=variable.name, valueReference=reference)
    _set(element, description=variable.description, **_roles(variable))
    kinds = {v.REAL: "Real", v.INTEGER: "Integer", v.BOOLEAN: "Boolean", v.TEXT: "String"}
    _element(kinds[variable.kind], element, **_value(variable))


def _variable3(listed: _Element, reference: int, variable: Variable) -> None:
    kinds = {v.REAL: "Float64", v.INTEGER: "Int32", v.BOOLEAN: "Boolean", v.TEXT: "String"}
    element = _element(kinds[variable.kind], listed, name=variable.name, valueReference=reference)
    values = _value(variable)
    start = values.pop("start") if variable.kind == v.TEXT and "start" in values else None
    _set(element, description=variable.description, **_roles(variable), **values)
    if variable.size > 1:
        _element("Dimension", element, start=variable.size)
    if start is not None:
        _element("Start", element, value=start)


def _structure(root: _Element, shown: Sequence[tuple[int, Variable]], fmi: int) -> None:
    structure = _element("ModelStructure", root)
    outputs = [
        (place, reference) for place, (reference, variable) in enumerate(shown, start=1) if variable.role == v.OUTPUT
    ]
    if fmi == 3:
        for tag in ("Output", "InitialUnknown"):
            for _, reference in outputs:
                _element(tag, structure, valueReference=reference)
        return
    for tag in ("Outputs", "InitialUnknowns"):
        listed = _element(tag, structure)
        for place, _ in outputs:
            _element("Unknown", listed, index=place)


def build_description(model: Model) -> bytes:
    """sources/buildDescription.xml of FMI 3: how the wrapper is built anew."""
    root = _element("fmiBuildDescription", fmiVersion="3.0")
    configuration = _element("BuildConfiguration", root, modelIdentifier=model.identifier)
    files = _element("SourceFileSet", configuration, language="C99")
    for name in model.sources:
        _element("SourceFile", files, name=name)
    return _checked(root, 3, "BuildDescription")


def terminals_and_icons() -> bytes:
    """terminalsAndIcons/terminalsAndIcons.xml of FMI 3: the icon fills the block, 20 mm wide on a sheet."""
    root = _element("fmiTerminalsAndIcons", fmiVersion="3.0")
    shown = _element("GraphicalRepresentation", root)
    corners = {"x1": -100.0, "y1": -100.0, "x2": 100.0, "y2": 100.0}
    _element("CoordinateSystem", shown, **corners, suggestedScalingFactorTo_mm=0.1)
    _element("Icon", shown, **corners)
    return _checked(root, 3, "TerminalsAndIcons")


def _element(tag: str, parent: _Element | None = None, **attributes: Any) -> _Element:
    from lxml import etree

    element = etree.Element(tag) if parent is None else etree.SubElement(parent, tag)
    _set(element, **attributes)
    return element


def _set(element: _Element, **attributes: Any) -> None:
    for name, value in attributes.items():
        if isinstance(value, bool):
            text = "true" if value else "false"
        else:
            text = repr(value) if isinstance(value, float) else str(value)
        element.set(name, text)


def _checked(root: _Element, fmi: int, which: str) -> bytes:
    """The XML as bytes, valid by the standard's schema, which comes with fmpy."""
    from importlib.util import find_spec
    from pathlib import Path

    from lxml import etree

    found = find_spec("fmpy")
    if found is None or found.origin is None:
        raise UsageError("the package fmpy, which has the schemas of the FMI standard, is missing; pip install fmpy")
    schema = etree.XMLSchema(etree.parse(Path(found.origin).parent / "schema" / f"fmi{fmi}" / f"fmi{fmi}{which}.xsd"))
    schema.assertValid(root)
    content: bytes = etree.tostring(root, xml_declaration=True, encoding="UTF-8", pretty_print=True)
    return content
