"""Sweeps in this process: what comes out, what is run again, and what is not lost."""

from __future__ import annotations

import csv
import dataclasses
import json
import os
import threading
from pathlib import Path

import numpy as np
import odd_runners
import pytest
import xarray as xr

from gw_exudyn.errors import SolverError, StorageError, UsageError
from gw_exudyn.metrics import metrics
from gw_exudyn.simulation import simulate
from gw_exudyn.storage import read_run
from gw_exudyn.sweep.folder import SweepFolder
from gw_exudyn.sweep.plan import Options
from gw_exudyn.sweep.run import run_sweep
from gw_exudyn.sweep.studies.loading import load_study

OUT = Path("out")
PLAIN = Options(jobs=1, figures=False)


def rows(folder: Path = OUT) -> list[dict[str, str]]:
    with open(folder / "sweep.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def manifests(folder: Path = OUT) -> dict[str, bytes]:
    return {file.parent.name: file.read_bytes() for file in folder.glob("points/*/run.json")}


def test_points_that_fail_cost_themselves_alone_and_are_run_again_on_demand(study, tmp_path):
    odd = [odd_runners.HANG, odd_runners.EXIT, odd_runners.SEGFAULT, odd_runners.RAISE]
    # 36 mm of six long segments do not go round the corner: a run that ends as not to be trusted.
    points = [(0.4, 4), (0.4, 36), *((friction, 4) for friction in odd)]
    lines = ["contact.friction_coefficient,drive.distance [mm]", *(f"{friction},{way}" for friction, way in points)]
    (tmp_path / "points.csv").write_text("\n".join(lines))
    settings = "{wire.segments: 6, solver.step: 0.1 s, output.interval: 0.5 s}"
    found = study("", base="corner90-universal", set=settings, mode="list", points="points.csv")
    options = dataclasses.replace(PLAIN, timeout=3.0, runner="odd_runners:OddRunner")
    summary = run_sweep(found, OUT, options)
    assert (summary.run, summary.completed, summary.failed) == (6, 1, 5)
    table = rows()
    assert [row["status"] for row in table] == ["completed", "too_deep", "timed_out", "crashed", "crashed", "error"]
    assert "SIGSEGV" in table[4]["reason"]
    assert float(table[0]["push_force_max [N]"]) > 0
    assert table[2]["push_force_max [N]"] == ""
    # The run that failed on its way is in the data set as far as it got.
    with xr.open_dataset(OUT / "sweep.nc") as data:
        known = np.isfinite(data["push_force"].values).sum(axis=1)
        assert known[1] > known[0] == 5
        assert known[2:].tolist() == [0, 0, 0, 0]
        assert data["status"].values.tolist() == [row["status"] for row in table]

    before = manifests()
    again = run_sweep(found, OUT, options)
    assert (again.run, again.earlier, again.failed) == (0, 6, 5)
    assert manifests() == before
    retried = run_sweep(found, OUT, dataclasses.replace(options, retry_failed=True))
    assert (retried.run, retried.completed, retried.failed) == (5, 1, 5)
    assert manifests()[table[0]["id"]] == before[table[0]["id"]]


def test_a_run_that_does_not_converge_is_one_failed_point(study):
    vary = "solver.step: [50 ms, 0.5 s]\nsolver.minimum_step: [1 us, 0.5 s]"
    wire = (
        "{wire.model: amplatz-super-stiff, wire.segments: 60, contact.friction_coefficient: 0.6, drive.distance: 2 mm}"
    )
    summary = run_sweep(study(vary, base="phantom-universal", mode="zip", set=wire), OUT, PLAIN)
    assert (summary.completed, summary.failed) == (1, 1)
    assert [row["status"] for row in rows()] == ["completed", "not_converged"]
    assert "no balance of forces" in rows()[1]["reason"]


def test_times_that_differ_by_their_last_digit_are_the_same(study):
    found = study()
    run_sweep(found, OUT, PLAIN)
    series = OUT / "points" / rows()[1]["id"] / "series.csv"
    text = series.read_text()
    assert "\n1.5," in text
    series.write_text(text.replace("\n1.5,", "\n1.4999999999999998,"))
    run_sweep(found, OUT, PLAIN)
    with xr.open_dataset(OUT / "sweep.nc") as data:
        assert data["push_force"].dims == ("contact_friction_coefficient", "time")
        assert 1.5 in data["time"].values
        assert np.isfinite(data["push_force"].values).all()


def test_a_grid_is_a_data_set_with_its_parameters_as_dimensions(study):
    found = study("wire.diameter: [0.3 mm, 0.36 mm]\ncontact.friction_coefficient: [0.1, 0.2, 0.4]")
    run_sweep(found, OUT, dataclasses.replace(PLAIN, jobs=2, keep_runs=True))
    result = simulate(found.scenario(4))
    with xr.open_dataset(OUT / "sweep.nc") as data:
        assert data["push_force"].dims == ("wire_diameter", "contact_friction_coefficient", "time")
        assert data["wire_diameter"].attrs["units"] == "m"
        assert data["push_force"].attrs["units"] == "N"
        point = data.sel(wire_diameter=0.36e-3, contact_friction_coefficient=0.2)
        for name in ("push_force", "tip_x", "elastic_energy"):
            assert np.array_equal(point[name].values, result.values(name)), name
        assert np.array_equal(point["time"].values, result.time)
        assert float(point["metric_push_force_max"]) == metrics(result)["push_force_max"].value
        folder = OUT / "points" / str(point["id"].values)
    assert read_run(folder).dataset.equals(result.dataset)
    assert float(rows()[4]["push_force_max [N]"]) == metrics(result)["push_force_max"].value
    assert rows()[4]["wire.diameter [m]"] == "0.00036"


def test_points_with_other_output_times_keep_their_own(study):
    found = study("output.interval: [0.5 s, 0.8 s]", set="{wire.segments: 5, solver.step: 0.5 s, drive.distance: 4 mm}")
    run_sweep(found, OUT, PLAIN)
    with xr.open_dataset(OUT / "sweep.nc", decode_times=False) as data:
        assert data["push_force"].dims == ("output_interval", "output")
        assert data["time"].values[1].tolist()[:4] == [0.0, 0.8, 1.6, 2.0]
        assert np.isnan(data["time"].values[1, 4])


def test_blocks_of_the_data_set_hold_every_point_in_its_place(study, monkeypatch):
    from gw_exudyn.sweep import dataset

    monkeypatch.setattr(dataset, "_AT_ONCE", 1)  # a point at a time
    found = study("wire.diameter: [0.3 mm, 0.36 mm]\ncontact.friction_coefficient: [0.1, 0.2, 0.4]")
    run_sweep(found, OUT, PLAIN)
    with xr.open_dataset(OUT / "sweep.nc") as data:
        largest = data["push_force"].max("time").values.ravel()
    assert largest == pytest.approx([float(simulate(found.scenario(i)).values("push_force").max()) for i in range(6)])


def test_what_is_damaged_or_forgotten_is_run_again_and_what_another_study_shares_is_not(study):
    found = study()
    run_sweep(found, OUT, PLAIN)
    first = manifests()
    damaged = next(OUT.glob("points/*/run.json"))
    damaged.write_text("{")
    assert run_sweep(found, OUT, PLAIN).run == 1
    assert json.loads(damaged.read_text())["status"]["name"] == "completed"
    assert run_sweep(found, OUT, dataclasses.replace(PLAIN, fresh=True)).run == 2
    assert manifests().keys() == first.keys()
    wider = study("contact.friction_coefficient: [0.2, 0.3]")
    assert run_sweep(wider, OUT, PLAIN).run == 1
    assert len(rows()) == 2


def test_a_sweep_that_is_stopped_keeps_what_it_has_and_goes_on(study):
    found = study("contact.friction_coefficient: {linspace: [0.1, 0.4, 12]}")
    stop = threading.Event()
    summary = run_sweep(
        found, OUT, PLAIN, report=lambda progress: progress.done and stop.set(), should_stop=stop.is_set
    )
    assert summary.interrupted
    assert 0 < summary.completed < 12
    assert [row["status"] for row in rows()].count("not_run") == 12 - summary.completed
    before = manifests()
    assert run_sweep(found, OUT, PLAIN).run == 12 - summary.completed
    assert before.items() <= manifests().items()


def test_a_folder_that_is_not_ours_is_left_alone(study):
    OUT.mkdir()
    (OUT / "thesis.tex").write_text("years of work")
    with pytest.raises(StorageError, match="is not a sweep of gw-exudyn"):
        run_sweep(study(), OUT, PLAIN)
    assert os.listdir(OUT) == ["thesis.tex"]


def test_a_second_sweep_into_the_folder_is_refused(study):
    with SweepFolder(OUT), pytest.raises(StorageError, match="another sweep is writing to this folder"):
        run_sweep(study(), OUT, PLAIN)
    with SweepFolder(OUT):  # given up, it can be had again
        pass


def test_a_disk_that_is_full_leaves_nothing_half_written(study):
    resource = pytest.importorskip("resource")
    with SweepFolder(OUT) as folder:
        folder.add("first", {"run.json": b"{}"})
        before = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (4096, before[1]))
        try:
            with pytest.raises(StorageError, match="free some space and give the same command again"):
                folder.add("first", {"series.csv": b"x" * 100, "run.json": b"y" * 10_000})
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)
        assert (folder.point("first") / "run.json").read_bytes() == b"{}"
        assert os.listdir(OUT / "points") == ["first"]
        assert not any((OUT / ".writing").iterdir())


def test_workers_that_cannot_run_anything_end_the_sweep(study):
    with pytest.raises(SolverError, match="the licence has expired"):
        run_sweep(study(), OUT, dataclasses.replace(PLAIN, runner="odd_runners:NoRunner"))
    assert not manifests()


def test_a_scheduler_that_is_not_there_is_told(study, monkeypatch):
    from gw_exudyn.sweep import pool

    monkeypatch.setattr(pool, "CONNECT_LIMIT", 0.5)
    with pytest.raises(UsageError, match=r"--scheduler tcp://127.0.0.1:1: no dask scheduler answers there"):
        run_sweep(study(), OUT, dataclasses.replace(PLAIN, scheduler="tcp://127.0.0.1:1"))


def test_figures_of_a_grid(study):
    found = study("contact.friction_coefficient: [0.1, 0.2]\nwire.model: catalogue", metrics="[push_force_max, snaps]")
    summary = run_sweep(found, OUT, Options(jobs=1))
    drawn = {file.name for file in summary.files if file.suffix == ".png"}
    assert drawn == {"curves.png", "map.png", "best_and_worst.png"}
    best = read_run(OUT / "best").provenance["point"]["id"]
    least = min(rows(), key=lambda row: float(row["push_force_max [N]"]))
    assert best == least["id"]
    assert load_study(found.file).metrics == ("push_force_max", "snaps")
