"""The parameter set and the example system beside an FMU."""

from __future__ import annotations

import zipfile
from importlib.util import find_spec
from pathlib import Path

import pytest
from hosts import Host
from lxml import etree

from gw_exudyn.cli.main import main
from gw_exudyn.fmi.related import FOLDER, PARAMETERS

STEP, STEPS = 0.05, 38
SETTINGS = ["wire.segments=20", "drive.speed=20 mm/s", "drive.distance=70 mm"]


def schema(name: str) -> etree.XMLSchema:
    folder = Path(find_spec("fmpy").origin).parent / "ssp" / "schema"
    return etree.XMLSchema(etree.parse(folder / f"SystemStructure{name}.xsd"))


@pytest.fixture
def files(tmp_path, capsys) -> tuple[Path, Path, Path]:
    file = tmp_path / "a.fmu"
    settings = [word for text in SETTINGS for word in ("--set", text)]
    assert main(["fmu", "export", "arc90", *settings, "--ssp", "--out", str(file)]) == 0
    told = [Path(line) for line in capsys.readouterr().out.splitlines()]
    assert told == [file, tmp_path / "a.ssv", tmp_path / "a.ssp"]
    return file, *told[1:]


def test_they_are_what_the_standard_wants(files):
    fmu, values, system = files
    parameters = etree.parse(values)
    schema("ParameterValues").assertValid(parameters)
    with zipfile.ZipFile(system) as archive:
        assert archive.read("resources/a.ssv") == values.read_bytes()
        assert archive.read("resources/a.fmu") == fmu.read_bytes()
    with zipfile.ZipFile(fmu) as archive:  # the one inside is the same
        assert archive.read(f"{FOLDER}/{PARAMETERS}") == values.read_bytes()
    with zipfile.ZipFile(system) as archive:
        schema("Description").assertValid(etree.fromstring(archive.read("SystemStructure.ssd")))
    with Host(fmu) as host:
        wanted = {name for name, variable in host.variables.items() if variable.causality == "parameter"}
    assert {parameter.get("name") for parameter in parameters.getroot()[0]} == wanted


@pytest.mark.parametrize("name", ["x.ssp", "x.ssv", "x.SSP"])
def test_a_name_that_would_overwrite_the_fmu_is_refused_before_anything_is_written(tmp_path, capsys, name):
    assert main(["fmu", "export", "arc90", "--ssp", "--out", str(tmp_path / name)]) == 2
    assert f"name the FMU otherwise: {tmp_path / 'x.fmu'}" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_libcosim_runs_the_system_and_takes_another_set(files, tmp_path):
    pytest.importorskip("libcosimpy", reason="libcosimpy is not installed")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver

    fmu, values, system = files
    frictions = {"0.3": None, "0.1": None}
    exported = etree.parse(values).find(".//{*}Parameter[@name='contact.friction_coefficient']/{*}Real").get("value")
    for friction in frictions:
        folder = tmp_path / friction
        with zipfile.ZipFile(system) as archive:
            archive.extractall(folder)
        place = folder / "resources" / "a.ssv"
        text = place.read_text()
        old = f'name="contact.friction_coefficient">\n      <ssv:Real value="{exported}"'
        assert old in text
        place.write_text(text.replace(old, old.replace(exported, friction)))
        execution = CosimExecution.from_ssp_file(ssp_path=str(folder), step_size=int(STEP * 1e9))
        observer = CosimObserver.create_last_value()
        assert execution.add_observer(observer)
        assert execution.step(STEPS)
        with Host(fmu) as host:
            reference = host.variables["push.force"].valueReference
            host.start({"contact.friction_coefficient": float(friction)})
            for _ in range(STEPS):
                host.step(STEP)
            expected = host.get("push.force")
        (force,) = observer.last_real_values(slave_index=0, variable_references=[reference])
        assert force == pytest.approx(expected, rel=1e-9)
        frictions[friction] = force
    assert frictions["0.3"] != frictions["0.1"]
