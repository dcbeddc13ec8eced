"""What stands in the FMU: valid XML, the same bytes each time, every platform, units and limits of the scenario."""

from __future__ import annotations

import re
import struct
import zipfile

import pytest
from fmpy import read_model_description
from fmpy.validation import validate_fmu
from hosts import OK, Host

from gw_exudyn.errors import ScenarioError, StorageError, UsageError
from gw_exudyn.fmi.export import export, identifier_of
from gw_exudyn.fmi.table import variables_of
from gw_exudyn.fmi.units import fmi_name
from gw_exudyn.fmi.variables import REAL, output_name
from gw_exudyn.quantities import QUANTITIES, SCALARS
from gw_exudyn.scenario import list_shipped, load_scenario


def test_fmpy_finds_nothing_wrong(fmu):
    assert validate_fmu(str(fmu)) == []


@pytest.mark.parametrize("name", list_shipped())
def test_every_shipped_scenario_makes_a_valid_fmu(name, tmp_path):
    for fmi in (2, 3):
        assert validate_fmu(str(export(load_scenario(name), tmp_path / f"{name}.fmu", fmi))) == []


def test_the_same_scenario_gives_the_same_bytes_and_another_one_another_token(scenario, fmus, tmp_path):
    again = export(scenario, tmp_path / "again.fmu", 2, stations=7)
    assert again.read_bytes() == fmus[2].read_bytes()
    other = export(load_scenario("straight"), tmp_path / "other.fmu", 2)
    assert read_model_description(str(other)).guid != read_model_description(str(again)).guid


def test_every_platform_is_there_with_the_source(fmus):
    platforms = {
        2: {"linux64": "so", "aarch64-linux": "so", "win64": "dll", "darwin64": "dylib"},
        3: {"x86_64-linux": "so", "aarch64-linux": "so", "x86_64-windows": "dll", "aarch64-darwin": "dylib",
            "x86_64-darwin": "dylib"},
    }  # fmt: skip
    for fmi, file in fmus.items():
        with zipfile.ZipFile(file) as archive:
            names = set(archive.namelist())
        for folder, ending in platforms[fmi].items():
            assert f"binaries/{folder}/arc90.{ending}" in names
        assert {"sources/fmi2.c", "sources/fmi3.c", "sources/fmi3Functions.h"} <= names
        assert ("sources/buildDescription.xml" in names) == (fmi == 3)


def test_the_macos_file_of_fmi2_holds_both_processors(fmus):
    with zipfile.ZipFile(fmus[2]) as archive:
        content = archive.read("binaries/darwin64/arc90.dylib")
    magic, count = struct.unpack_from(">II", content)
    assert (magic, count) == (0xCAFEBABE, 2)
    processors = set()
    for i in range(count):
        processor, _, offset, size, align = struct.unpack_from(">IIIII", content, 8 + 20 * i)
        assert offset % (1 << align) == 0
        assert offset + size <= len(content)
        thin_magic, thin_processor = struct.unpack_from("<II", content, offset)
        assert (thin_magic, thin_processor) == (0xFEEDFACF, processor)
        processors.add(processor)
    assert processors == {0x01000007, 0x0100000C}


def test_every_output_has_the_unit_of_its_quantity(fmu):
    variables = {v.name: v for v in read_model_description(str(fmu)).modelVariables}
    for quantity in SCALARS:
        variable = variables[output_name(quantity)]
        assert variable.causality == "output"
        assert variable.description == QUANTITIES[quantity].long_name
        if not QUANTITIES[quantity].integer:
            assert variable.unit == fmi_name(QUANTITIES[quantity].unit)


def test_parameters_have_start_limits_and_unit_of_the_scenario(fmu, scenario):
    description = read_model_description(str(fmu))
    variables = {v.name: v for v in description.modelVariables}
    friction, diameter = variables["contact.friction_coefficient"], variables["wire.diameter"]
    assert (friction.causality, friction.variability) == ("parameter", "fixed")
    assert [float(x) for x in (friction.start, friction.min, friction.max)] == [0.4, 0.0, 2.0]
    assert float(diameter.start) == scenario.wire.diameter
    assert variables["wire.segments"].start in ("20", 20)
    assert variables["worker.timeout"].variability == "tunable"
    assert float(variables["contact.wall_stiffness"].start) > 0  # automatic: what the model chose
    displayed = {d.name: d.factor for unit in description.unitDefinitions for d in unit.displayUnits}
    assert displayed["mm"] == pytest.approx(1000)
    assert displayed["deg"] == pytest.approx(57.29577951308232)


def test_what_the_vessel_has_becomes_a_parameter():
    names = {v.name for v in variables_of(load_scenario("arc90"), 2)}
    assert {"vessel.diameter", "vessel.angle", "vessel.radius"} <= names
    assert not [n for n in {v.name for v in variables_of(load_scenario("corner90-universal"), 2)} if "vessel" in n]


@pytest.mark.parametrize("name", list_shipped())
def test_no_name_is_that_of_a_list_and_of_a_value(name):
    names = [variable.name for variable in variables_of(load_scenario(name), 3)]
    assert len(set(names)) == len(names)
    assert not {n.partition("[")[0] for n in names if n.endswith("]")} & set(names)


def test_what_a_word_stands_for_is_no_start_of_a_parameter():
    names = {variable.name for variable in variables_of(load_scenario("arc90", ["stop.tip_stall=off"]), 2)}
    assert "stop.tip_stall" not in names


@pytest.mark.parametrize("name", list_shipped())
def test_descriptions_offer_nothing_that_a_number_cannot_be(name):
    variables = variables_of(load_scenario(name, ["stop.push_force=1 N"]), 3)
    shown = {v.name: v for v in variables}
    for variable in variables:
        if variable.kind == REAL:
            assert not re.search(
                r"\b(auto|off|sleeve|left out)\b|largest largest|largest deepest", variable.description
            )
        if variable.unit == "N":
            assert variable.display_unit == "mN"
    assert shown["stop.tip_stall"].description.endswith("while the wire is pushed in by this")
    assert shown["catheter.bore"].description == "inner diameter"


def test_a_distance_is_said_not_to_end_a_run_in_a_host(fmus, scenario):
    variables = {v.name: v for v in read_model_description(str(fmus[2])).modelVariables}
    assert "does not end a run" in variables["drive.distance"].description
    beyond = scenario.drive.duration + 0.2
    with Host(fmus[2]).start() as host:
        assert host.step(beyond)["status"] == OK
        assert host.get("insertion.depth") == pytest.approx(0.02 * beyond)


def test_capabilities_are_declared_in_both_versions(fmu):
    co_simulation = read_model_description(str(fmu)).coSimulation
    assert co_simulation.canHandleVariableCommunicationStepSize
    assert co_simulation.canGetAndSetFMUstate
    assert co_simulation.canSerializeFMUstate
    assert co_simulation.needsExecutionTool
    assert not co_simulation.canBeInstantiatedOnlyOncePerProcess


def test_what_cannot_be_exported_is_told(scenario, tmp_path):
    with pytest.raises(UsageError, match="there is no FMI 1"):
        export(scenario, tmp_path / "x.fmu", 1)
    (tmp_path / "file").write_text("")
    with pytest.raises(StorageError, match="can't be written"):
        export(scenario, tmp_path / "file" / "x.fmu", 2)
    with pytest.raises(ScenarioError):
        export(load_scenario("straight", ["wire.diameter=3 mm"]), tmp_path / "x.fmu", 2)
    assert not list(tmp_path.glob("*.fmu"))


@pytest.mark.parametrize(("name", "identifier"), [("a-b.c", "a_b_c"), ("9lives", "_9lives"), ("é", "_")])
def test_the_identifier_is_one_of_c(name, identifier):
    assert identifier_of(name) == identifier
