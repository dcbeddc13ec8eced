"""Run folders: what is in them, and that nothing half-written is ever taken for a run."""

from __future__ import annotations

import csv
import errno
import json
import math
import multiprocessing
import os
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from synthetic import StandInScenario, made_up_result

from gw_exudyn.errors import StorageError
from gw_exudyn.quantities import QUANTITIES, SCALARS, SERIES_COLUMNS
from gw_exudyn.result import SnapEvent, Status, StatusReport
from gw_exudyn.storage import check_run_folder, read_run, write_run
from gw_exudyn.storage import run_folder as run_folder_module

REPOSITORY = Path(__file__).parents[2]


@pytest.fixture(autouse=True)
def stand_in_scenario(monkeypatch):
    """The made-up scenario is none that the real reader knows."""
    monkeypatch.setattr("gw_exudyn.scenario.loading.scenario_from_dict", StandInScenario.from_dict)


@pytest.fixture
def result():
    return made_up_result(segments=10, instants=9)


def write(result, folder, **further):
    return write_run(result, folder, "gw-exudyn run corner90-universal", **({"figures": False} | further))


def content_of(folder):
    return json.loads((folder / "run.json").read_text(encoding="utf-8"))


def names_in(folder):
    return sorted(path.name for path in folder.iterdir())


# ---- what is in a run folder


def test_a_run_comes_back_as_it_was(result, tmp_path):
    again = read_run(write(result, tmp_path / "run"))
    assert again.dataset.identical(result.dataset)
    assert {name: again.dataset[name].dtype for name in again.dataset} == {
        name: result.dataset[name].dtype for name in result.dataset
    }
    assert again.status == result.status
    assert again.snaps == result.snaps
    assert again.scenario == result.scenario
    assert again.wall_time == result.wall_time
    assert again.counters == result.counters
    assert again.provenance["versions"] == result.provenance["versions"]
    assert again.provenance["note"] == "made up"
    for before, after in (
        (result.vessel_outline, again.vessel_outline),
        (result.catheter_outline, again.catheter_outline),
    ):
        assert len(before) == len(after)
        assert all(np.array_equal(a, b) for a, b in zip(before, after, strict=True))


def test_a_run_written_again_gives_the_same_bytes(result, tmp_path):
    first, second = write(result, tmp_path / "one"), write(read_run(tmp_path / "one"), tmp_path / "two")
    for name in ("run.nc", "series.csv", "run.json"):
        assert (first / name).read_bytes() == (second / name).read_bytes(), name


def test_the_folder_holds_all_parts_and_nothing_else(result, tmp_path):
    folder = write(result, tmp_path / "runs" / "corner", figures=True)
    assert names_in(folder) == ["figures", "run.json", "run.nc", "series.csv"]
    assert {path.suffix for path in (folder / "figures").iterdir()} == {".png", ".pdf"}
    assert names_in(tmp_path / "runs") == ["corner"]


def test_the_data_file_opens_without_us_with_units_and_compressed(result, tmp_path):
    with xr.open_dataset(write(result, tmp_path / "run") / "run.nc", engine="h5netcdf") as file:
        for name in (*SCALARS, "time", "node_x", "contact_kind", "vessel_wall_x", "catheter_wall_y"):
            assert file[name].attrs["units"] == QUANTITIES[name].unit
            assert file[name].attrs["long_name"] == QUANTITIES[name].long_name
            assert file[name].encoding["zlib"], file[name].encoding
        assert file["time"].dtype == float
        assert file.attrs["Conventions"].startswith("CF-")
        assert file.attrs["status"] == "completed"
        assert json.loads(file.attrs["scenario"])["name"] == "corner90-universal"
        assert all(isinstance(value, str) for value in file.attrs.values())
        walls = np.column_stack([file["vessel_wall_x"], file["vessel_wall_y"]])
        assert np.isnan(walls[:, 0]).sum() == len(result.vessel_outline) - 1


def test_the_series_has_headings_with_units_and_every_digit(result, tmp_path):
    with open(write(result, tmp_path / "run") / "series.csv", newline="", encoding="utf-8") as file:
        header, *rows = list(csv.reader(file))
    assert header == [f"{name} [{QUANTITIES[name].unit}]" for name in SERIES_COLUMNS]
    assert header[2] == "tip_x [m]"
    table = np.array(rows, dtype=float)
    for column, name in enumerate(SERIES_COLUMNS):
        assert np.array_equal(table[:, column], result.values(name)), name


def test_the_manifest_says_what_a_program_needs(result, tmp_path):
    content = content_of(write(result, tmp_path / "run"))
    assert (content["format"], content["format_version"]) == ("gw_exudyn run", 1)
    assert content["trusted"] is True
    assert content["wall_time"] == 1.25
    assert content["command"] == "gw-exudyn run corner90-universal"
    assert content["status"]["name"] == "completed"
    assert content["status"]["sentence"].startswith("The run reached its end")
    assert content["metrics"]["push_force_max"].keys() == {"value", "unit", "meaning"}
    assert content["scenario"] == result.scenario.to_dict()
    assert {"python", "numpy", "exudyn"} <= content["versions"].keys()
    assert content["snaps"] == [{"time": 17.3, "released_energy": 2.1e-6}]


def test_a_command_of_several_words_is_quoted_for_a_shell(result, tmp_path):
    folder = write_run(result, tmp_path / "run", ["gw-exudyn", "run", "my file.yaml"], figures=False)
    assert content_of(folder)["command"] == "gw-exudyn run 'my file.yaml'"


def test_a_run_that_broke_is_kept_and_marked(tmp_path):
    report = StatusReport(Status.NOT_FINITE, 3.0, "node 4", "push force is nan")
    broken = made_up_result(segments=10, instants=5, status=report, snaps=(SnapEvent(1.0, math.nan),))
    broken.dataset["push_force"].values[:] = math.nan
    folder = write(broken, tmp_path / "run")
    content = content_of(folder)
    assert content["trusted"] is False
    assert content["metrics"]["push_force_max"]["value"] is None
    assert "node 4" in content["status"]["sentence"]
    (folder / "run.json").write_text(
        (folder / "run.json").read_text().replace('"released_energy": null', '"released_energy": 0')
    )
    assert read_run(folder).status == report


def test_a_run_without_walls_or_contacts_comes_back(tmp_path):
    free = made_up_result(segments=10, instants=3, deepest=0.01)
    free = type(free)(free.dataset, free.status, free.scenario)
    again = read_run(write(free, tmp_path / "run"))
    assert again.vessel_outline == ()
    assert again.dataset.identical(free.dataset)
    assert math.isnan(again.wall_time)


def test_peaks_come_back_and_an_older_run_has_none(tmp_path):
    peaks = {"push_force": (0.5, 3.25), "wall_force_max": (math.inf, 1.0)}
    folder = write(made_up_result(segments=10, instants=3, peaks=peaks), tmp_path / "run")
    content = content_of(folder)
    assert content["peaks"]["push_force"] == {"value": 0.5, "time": 3.25}
    again = read_run(folder)
    assert again.peaks["push_force"] == (0.5, 3.25)
    assert math.isnan(again.peaks["wall_force_max"][0])
    del content["peaks"]
    (folder / "run.json").write_text(json.dumps(content))
    assert read_run(folder).peaks == {}


def test_no_relative_energy_error_is_null(tmp_path):
    idle = made_up_result(segments=10, instants=3, scale=0.0)
    assert content_of(write(idle, tmp_path / "run"))["metrics"]["energy_error_relative"]["value"] is None


def test_a_figure_that_fails_is_a_warning_and_not_the_loss_of_the_run(result, tmp_path, monkeypatch):
    monkeypatch.setattr("gw_exudyn.plots.save.render_figures", lambda _: 1 / 0)
    with pytest.warns(RuntimeWarning, match="figures could not be drawn .*the results are complete"):
        folder = write(result, tmp_path / "run", figures=True)
    assert read_run(folder).dataset.identical(result.dataset)


# ---- whose folder it is


def test_an_older_run_is_replaced_as_a_whole(result, tmp_path):
    folder = write(result, tmp_path / "run")
    (folder / "leftover.txt").write_text("of the older run")
    write(made_up_result("second", segments=5, instants=3), folder)
    assert names_in(folder) == ["run.json", "run.nc", "series.csv"]
    assert read_run(folder).scenario.name == "second"
    assert names_in(tmp_path) == ["run"]


def test_an_empty_folder_may_be_used(result, tmp_path):
    (tmp_path / "run").mkdir()
    check_run_folder(tmp_path / "run")
    write(result, tmp_path / "run")
    assert names_in(tmp_path) == ["run"]


def test_a_link_to_a_folder_stays_a_link(result, tmp_path):
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "run").symlink_to(tmp_path / "elsewhere")
    for _ in range(2):
        write(result, tmp_path / "run")
    assert (tmp_path / "run").is_symlink()
    assert "run.json" in names_in(tmp_path / "elsewhere")


def foreign_folder(place):
    place.mkdir()
    (place / "thesis.tex").write_text("dear")


def folder_with_other_manifest(place):
    place.mkdir()
    (place / "run.json").write_text('{"format": "somebody else\'s"}')


@pytest.mark.parametrize("use", [check_run_folder, lambda place: write(made_up_result(instants=2), place)])
@pytest.mark.parametrize(
    ("prepare", "message"),
    [
        (
            foreign_folder,
            r"is not a run of gw-exudyn .* left alone; empty or remove it, or name another folder \(--out\)",
        ),
        (folder_with_other_manifest, r"is not a run of gw-exudyn"),
        (lambda place: place.write_text("dear"), r"a file is in the way; remove it, or name another folder \(--out\)"),
    ],
)
def test_what_is_not_ours_is_left_alone(use, prepare, message, tmp_path):
    place = tmp_path / "run"
    prepare(place)
    before = place.read_text() if place.is_file() else names_in(place)
    with pytest.raises(StorageError, match=message):
        use(place)
    assert (place.read_text() if place.is_file() else names_in(place)) == before
    assert names_in(tmp_path) == ["run"]


def test_the_current_folder_is_not_replaced(result, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for place in (Path(), Path("..")):
        with pytest.raises(StorageError, match=r"current folder.*name a folder inside it"):
            write(result, place)


def test_a_file_among_the_parents_is_named(result, tmp_path):
    (tmp_path / "runs").write_text("a file")
    with pytest.raises(StorageError, match=r"a file is where a folder is needed; name another folder"):
        write(result, tmp_path / "runs" / "one")


def test_checking_a_place_changes_nothing(tmp_path):
    check_run_folder(tmp_path / "runs" / "one")
    assert names_in(tmp_path / "runs") == []


# ---- trouble with the disk


def refuse(number):
    def refusing(*_, **__):
        raise OSError(number, os.strerror(number))

    return refusing


@pytest.mark.parametrize(
    ("function", "number", "message"),
    [
        ("fsync", errno.ENOSPC, "No space left on device; free some space"),
        ("fsync", errno.EDQUOT, "free some space"),
        ("replace", errno.EIO, "name another folder"),
        ("rename", errno.EACCES, "name a folder that you may write to"),
        ("rename", errno.EBUSY, "mount point; name a folder inside it"),
    ],
)
def test_a_disk_that_refuses_costs_neither_the_older_run_nor_leaves_anything(
    result, tmp_path, monkeypatch, function, number, message
):
    folder = write(result, tmp_path / "run")
    monkeypatch.setattr(run_folder_module.os, function, refuse(number))
    if function == "fsync":  # folders may refuse it; only files matter
        monkeypatch.setattr(run_folder_module, "_sync_folder", lambda _: None)
    with pytest.raises(StorageError, match=message) as caught:
        write(made_up_result("second", segments=10, instants=9), folder)
    monkeypatch.undo()
    assert caught.value.exit_code == 7
    assert names_in(tmp_path) == ["run"]
    assert json.loads((folder / "run.json").read_text())["name"] == "corner90-universal"


def test_a_failure_in_the_midst_of_the_exchange_puts_the_older_run_back(result, tmp_path, monkeypatch):
    folder = write(result, tmp_path / "run")
    rename = os.rename

    def second_fails(source, target):
        if ".writing-" in str(source):
            raise OSError(errno.EIO, "broken")
        rename(source, target)

    monkeypatch.setattr(run_folder_module.os, "rename", second_fails)
    with pytest.raises(StorageError, match="broken"):
        write(made_up_result("second", instants=3), folder)
    assert read_run(folder).scenario.name == "corner90-universal"
    assert names_in(tmp_path) == ["run"]


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="needs a file system that nobody may write to")
def test_a_place_that_nobody_may_write_to(result):
    for use in (check_run_folder, lambda place: write(result, place)):
        with pytest.raises(StorageError, match=r"can't be written"):
            use("/proc/runs/one")


def in_process(code, folder, *, limit=""):
    """Run a script that has `folder` and `result` (named "second") in a process of its own."""
    script = f"""
        import sys, os, signal, errno
        sys.path[:0] = [{str(REPOSITORY)!r}, {str(Path(__file__).parent)!r}]
        from pathlib import Path
        from synthetic import made_up_result
        from gw_exudyn.errors import StorageError
        from gw_exudyn.storage import run_folder, runs, write_run
        folder = Path({str(folder)!r})
        result = made_up_result("second", segments=10, instants=9)
    """
    whole = textwrap.dedent(script) + textwrap.dedent(limit) + textwrap.dedent(code)
    return subprocess.run([sys.executable, "-B", "-c", whole], capture_output=True, text=True, timeout=120, check=False)


@pytest.mark.skipif(sys.platform == "win32", reason="no such limit")
def test_a_full_disk(result, tmp_path):
    folder = write(result, tmp_path / "run")
    done = in_process(
        """
        import resource
        resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))
        try:
            write_run(result, folder, figures=False)
        except StorageError as error:
            print(error)
        """,
        folder,
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert "free some space" in done.stdout
    assert read_run(folder).scenario.name == "corner90-universal"
    assert names_in(tmp_path) == ["run"]


KILLS = {
    "after the data": """
        original = runs.write_file
        def killing(path, content):
            original(path, content)
            if path.name == "run.nc":
                os.kill(os.getpid(), signal.SIGKILL)
        runs.write_file = killing
    """,
    "within a file": """
        original = os.fsync
        def killing(handle):
            os.kill(os.getpid(), signal.SIGKILL)
        os.fsync = killing
    """,
    "before the exchange": """
        def killing(*_):
            os.kill(os.getpid(), signal.SIGKILL)
        run_folder._swap_in = killing
    """,
    "within the exchange": """
        def killing(*_):
            os.kill(os.getpid(), signal.SIGKILL)
        run_folder._renamed_unless_taken = killing
    """,
    "after the exchange": """
        def killing(*_):
            os.kill(os.getpid(), signal.SIGKILL)
        run_folder._remove_old = killing
    """,
}


@pytest.mark.skipif(sys.platform == "win32", reason="no such signal")
@pytest.mark.parametrize("moment", KILLS)
@pytest.mark.parametrize("there", ["an older run", "nothing"])
def test_a_kill_leaves_a_whole_run_or_none_and_the_next_writer_tidies_up(result, tmp_path, moment, there):
    folder = tmp_path / "run"
    if there == "an older run":
        write(result, folder)
    killed = in_process("write_run(result, folder, figures=False)", folder, limit=KILLS[moment])
    if moment == "after the exchange":
        assert read_run(folder).scenario.name == "second"
    else:
        assert killed.returncode == -signal.SIGKILL, killed.stderr
        assert all(name == "run" or name.startswith((".run.writing-", ".run.replaced-")) for name in names_in(tmp_path))
        if there == "an older run":
            assert read_run(folder).scenario.name == "corner90-universal"
        else:
            with pytest.raises(StorageError, match="no such folder"):
                read_run(folder)
    write(made_up_result("third", instants=3), folder)
    assert read_run(folder).scenario.name == "third"
    assert names_in(tmp_path) == ["run"]


def write_often(folder, name, times):
    result = made_up_result(name, segments=10, instants=9)
    for _ in range(times):
        write_run(result, folder, figures=False)


@pytest.mark.skipif(sys.platform == "win32", reason="folders in use can't be renamed")
def test_writers_at_the_same_time_leave_one_whole_run_and_readers_see_whole_runs_only(result, tmp_path):
    folder = write(result, tmp_path / "run")
    context = multiprocessing.get_context("spawn")
    writers = [context.Process(target=write_often, args=(folder, name, 5)) for name in ("one", "two", "three")]
    for writer in writers:
        writer.start()
    seen = set()
    while any(writer.is_alive() for writer in writers):
        seen.add(read_run(folder).scenario.name)
        time.sleep(0.002)
    for writer in writers:
        writer.join()
    assert [writer.exitcode for writer in writers] == [0, 0, 0]
    assert read_run(folder).scenario.name in {"one", "two", "three"}
    assert seen <= {"corner90-universal", "one", "two", "three"}
    assert names_in(tmp_path) == ["run"]


def test_what_another_process_is_writing_is_not_taken_for_a_leftover(result, tmp_path):
    place = tmp_path / "run"
    with run_folder_module.replaced_folder(place) as writing:
        write(made_up_result("second", instants=3), place)
        assert writing.is_dir()
        (writing / "run.json").write_text('{"format": "gw_exudyn run"}')
    assert names_in(place) == ["run.json"]
    assert names_in(tmp_path) == ["run"]


# ---- reading what is no whole run


def test_places_that_are_no_run(tmp_path):
    (tmp_path / "file").write_text("a file")
    (tmp_path / "empty").mkdir()
    (tmp_path / "half").mkdir()
    (tmp_path / "half" / "run.nc").write_bytes(b"")
    cases = {
        "absent": "no such folder",
        "file": "is a file",
        "empty": "not a run folder",
        "half": r"half-written or half-copied, it has run.nc but no run.json",
    }
    for name, message in cases.items():
        with pytest.raises(StorageError, match=message) as caught:
            read_run(tmp_path / name)
        assert str(tmp_path / name) in str(caught.value)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda content: content.update(format="other"), "was not written by gw-exudyn"),
        (lambda content: content.update(format_version=2), "format version 2, this gw-exudyn reads up to 1; update"),
        (lambda content: content.update(format_version="1"), "format_version is '1'"),
        (lambda content: content.pop("status"), "damaged.*status"),
        (lambda content: content["status"].update(name="splendid"), "damaged.*splendid"),
        (lambda content: content.update(snaps=[{}]), "damaged.*time"),
        (lambda content: content.update(scenario=None), "damaged"),
        (lambda content: content.update(files={}), r"damaged.*has no run\.nc"),
    ],
)
def test_a_changed_manifest_is_refused(result, tmp_path, change, message):
    folder = write(result, tmp_path / "run")
    content = content_of(folder)
    change(content)
    (folder / "run.json").write_text(json.dumps(content))
    with pytest.raises(StorageError, match=message):
        read_run(folder)


@pytest.mark.parametrize("text", ["", "{", "[]", "\xff"])
def test_a_damaged_manifest_is_refused(result, tmp_path, text):
    folder = write(result, tmp_path / "run")
    (folder / "run.json").write_bytes(text.encode("latin-1"))
    with pytest.raises(StorageError, match=r"run\.json: (damaged|was not written)"):
        read_run(folder)


def test_a_data_file_that_is_missing_cut_short_or_of_another_run_is_refused(result, tmp_path):
    folder = write(result, tmp_path / "run")
    data = (folder / "run.nc").read_bytes()
    (folder / "run.nc").write_bytes(data[:-100])
    with pytest.raises(StorageError, match="damaged or half-copied"):
        read_run(folder)
    other = write(made_up_result("second", segments=10, instants=9, scale=0.03), tmp_path / "other")
    (folder / "run.nc").write_bytes((other / "run.nc").read_bytes())
    with pytest.raises(StorageError, match="damaged or half-copied"):
        read_run(folder)
    (folder / "run.nc").unlink()
    with pytest.raises(StorageError, match=r"run\.nc: missing"):
        read_run(folder)
