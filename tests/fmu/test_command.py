"""`gw-exudyn fmu` and the session behind it."""

from __future__ import annotations

import json

import numpy as np
import pytest

from gw_exudyn.cli.main import main
from gw_exudyn.errors import SolverError, StorageError, UsageError
from gw_exudyn.fmi.run_files import read_inputs
from gw_exudyn.fmi.session import FmuSession
from gw_exudyn.scenario import load_scenario
from gw_exudyn.simulation import Simulation

UNITS = {"command.speed": "m/s", "command.active": ""}


def test_export_run_and_check(tmp_path, capsys):
    file = str(tmp_path / "a.fmu")
    assert main(["fmu", "export", "arc90", "--set", "wire.segments=20", "--fmi", "3", "--out", file]) == 0
    assert capsys.readouterr().out == f"{file}\n"
    inputs = tmp_path / "speeds.csv"
    inputs.write_text("time,command.speed [mm/s]\n0,20\n1,20\n")
    out = tmp_path / "run"
    command = ["fmu", "run", file, "--set", "contact.friction_coefficient=0.1", "--input", str(inputs)]
    assert main([*command, "--stop", "0.5", "--step", "0.1", "--out", str(out)]) == 0
    lines = (out / "outputs.csv").read_text().splitlines()
    assert lines[0].startswith("time [s],insertion.depth [m],tip.x [m]")
    assert len(lines) == 7
    assert [float(x) for x in lines[-1].split(",")[:2]] == pytest.approx([0.5, 0.01])
    assert json.loads((out / "run.json").read_text())["status"] == 0
    stations = np.genfromtxt(out / "stations.csv", delimiter=",", skip_header=1)
    assert (out / "stations.csv").read_text().splitlines()[0] == (
        "time [s],station,wire.station.arc_length [m],wire.station.x [m],wire.station.y [m],"
        "wire.station.normal_force [N]"
    )
    assert stations.shape == (6 * 51, 6)
    tip = stations[stations[:, 1] == 0]
    wanted = np.genfromtxt(out / "outputs.csv", delimiter=",", skip_header=1)
    np.testing.assert_allclose(tip[:, [0, 3, 4]], wanted[:, [0, 2, 3]], atol=1e-12)
    capsys.readouterr()
    assert main(["fmu", "run", file, "--stop", "0.1", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["final"]["insertion.depth"] == pytest.approx(0.0002)
    assert main(["fmu", "check", file]) == 0
    text = capsys.readouterr().out
    assert "fmpy validation" in text
    assert "FAILED" not in text


def test_stations_that_fmi_2_cannot_show_are_refused(tmp_path, capsys):
    file = str(tmp_path / "a.fmu")
    assert main(["fmu", "export", "arc90", "--stations", "9", "--out", file]) == 2
    assert "--stations: FMI 2.0 has no arrays" in capsys.readouterr().err
    assert main(["fmu", "export", "arc90", "--stations", "9", "--fmi", "3", "--out", file]) == 0
    with FmuSession(file) as session:
        assert session.variables["wire.station.x"].dimensions[0].start == 9


@pytest.mark.parametrize(
    ("arguments", "code", "sentence"),
    [
        (["--set", "contact.frictionn=1"], 2, "nearest: contact.friction"),
        (["--set", "contact.friction_coefficient"], 2, "write name=value"),
        (["--set", "contact.friction_coefficient=much"], 2, "is no Real; write a number\n"),
        (["--set", "wire.length=much"], 2, "is no Real; write a number in m\n"),
        (["--set", "wire.segments=30.0"], 2, "'30.0' is no Integer; write a whole number\n"),
        (["--set", "command.active=yes"], 2, "'yes' is no Boolean; write true or false\n"),
        (["--set", "contact.friction_coefficient=7"], 4, "allowed: 0 to 2"),
        (["--input", "nowhere.csv"], 7, "nowhere.csv: can't be read"),
    ],
)
def test_what_goes_wrong_is_told(fmus, arguments, code, sentence, capsys):
    assert main(["fmu", "run", str(fmus[2]), "--stop", "0.1", *arguments]) == code
    assert sentence in capsys.readouterr().err


def test_a_file_that_is_no_fmu(tmp_path, capsys):
    (tmp_path / "no.fmu").write_text("no")
    assert main(["fmu", "run", str(tmp_path / "no.fmu")]) == 7
    assert "can't be read as an FMU" in capsys.readouterr().err
    assert main(["fmu", "check", str(tmp_path / "no.fmu")]) == 6


def test_one_instance_serves_many_points_and_an_error_does_not_end_it(fmu, scenario):
    simulation = Simulation(load_scenario("arc90", {"wire.segments": 20, "drive.speed": 0.02, "drive.distance": 0.03}))
    simulation.advance(1.5)
    with FmuSession(fmu) as session:
        point = {"drive.distance": 0.03}
        first = session.run({**point, "contact.friction_coefficient": 0.1}, step=0.25)
        with pytest.raises(SolverError, match="allowed: 0 to 2"):
            session.run({"contact.friction_coefficient": 9.0})
        run = session.run(point, stop=1.5, step=0.5)
        again = session.run({**point, "contact.friction_coefficient": 0.1}, step=0.25)
    assert first.outputs.tobytes() == again.outputs.tobytes()
    assert first.code == again.code == 0
    assert first.final["push.force.peak"] >= first.final["push.force"]
    assert run.final["tip.x"] == pytest.approx(simulation.outputs["tip_x"], rel=1e-9)
    np.testing.assert_allclose(run.outputs["time"], [0, 0.5, 1.0, 1.5])


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("time,command.speed\n0,x\n", ":2: "),
        ("command.speed,time\n0,1\n", "it must be time"),
        ("time,command.speed\n0,1,2\n", "2 numbers are needed"),
        ("time,command.speed\n1,1\n0,1\n", "must not fall"),
        ("time,command.speed [mm/q]\n1,1\n", "unknown unit"),
        ("time,command.speed [deg]\n1,1\n", ":1: command.speed [deg]: is an angle, not a speed; units that fit: m/s"),
        ("time [mm],command.speed\n1,1\n", ":1: time [mm]: is a length, not a time"),
        ("time,command.speed [mm/s\n1,1\n", ":1: command.speed [mm/s: is no heading"),
        ("time,command.speed []\n1,1\n", "is no unit"),
        ("time,command.active [s]\n1,1\n", "has no unit in the FMU"),
        ("time,command.speed,command.speed [mm/s]\n0,1,1\n", ":1: command.speed: there are two columns"),
        ("time [mm],command.speed [N]\n1,1\n", ":1: command.speed [N]: is a force"),
        ("time\n", "has no rows"),
    ],
)
def test_inputs_that_make_no_sense(tmp_path, text, sentence):
    (tmp_path / "in.csv").write_text(text)
    with pytest.raises(StorageError, match=r"in\.csv") as error:
        read_inputs(tmp_path / "in.csv", UNITS)
    assert sentence in str(error.value)


def test_all_headings_that_make_no_sense_are_told_at_once(tmp_path):
    (tmp_path / "in.csv").write_text("time [mm],command.speed [deg]\n0,1\n")
    with pytest.raises(StorageError) as error:
        read_inputs(tmp_path / "in.csv", UNITS)
    assert len(str(error.value).splitlines()) == 2


@pytest.mark.parametrize(
    ("unit", "heading", "value"),
    [
        ("m/s", " [mm/s]", 0.002),
        ("m/s", "", 2.0),
        ("mm/s", " [m/s]", 2000.0),
        ("N.mm2", "[N*m^2]", 2e6),
        ("degC", " [degC]", 2.0),
    ],
)
def test_inputs_come_in_the_unit_of_their_variable(tmp_path, unit, heading, value):
    (tmp_path / "in.csv").write_text(f"time [ms],x{heading}\n1000,2\n")
    table = read_inputs(tmp_path / "in.csv", {"x": unit})
    assert table.tolist() == [(1.0, pytest.approx(value))]


def test_an_input_that_the_fmu_does_not_have(fmus):
    inputs = np.zeros(2, [("time", float), ("command.spede", float)])
    with FmuSession(fmus[2]) as session, pytest.raises(UsageError, match=r"command\.speed"):
        session.run(inputs=inputs, stop=0.1)
