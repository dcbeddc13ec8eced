"""What a calibration leaves: the fitted scenario, the residuals, and fit.json with everything that is known."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from gw_exudyn.calibration.report import Report
from gw_exudyn.calibration.statistics import CONFIDENCE, autocorrelation, widening
from gw_exudyn.errors import StorageError
from gw_exudyn.quantities import QUANTITIES
from gw_exudyn.storage.manifest import to_text
from gw_exudyn.storage.run_folder import write_file
from gw_exudyn.sweep.folder import as_storage_error, is_sweep

FIT = "fit.json"
MARKER = "gw_exudyn fit"
SCENARIO = "fitted.yaml"
RESIDUALS = "residuals.csv"
SIMULATIONS = "simulations"
"""The folder, beside fit.json, of the points that were run: a sweep's."""


def is_fit(folder: Path) -> bool:
    """Whether the folder holds a fit of ours."""
    try:
        content = json.loads((folder / FIT).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    return isinstance(content, dict) and content.get("format") == MARKER


def prepare(folder: Path) -> None:
    """Make the folder of a calibration. Raises StorageError for one that is somebody else's."""
    with as_storage_error(folder):
        if folder.is_dir() and any(folder.iterdir()) and not is_fit(folder) and not is_sweep(folder / SIMULATIONS):
            raise StorageError(
                f"{folder}: the folder exists and is not a calibration of gw-exudyn (it holds no {FIT} of ours), "
                "so it is left alone; empty or remove it, or name another folder (--out)"
            )
        folder.mkdir(parents=True, exist_ok=True)


def write_outputs(report: Report, folder: Path, content: Mapping[str, Any], figures: bool) -> list[Path]:
    """Write everything, fit.json last, and return the files. content : of fit.json."""
    with as_storage_error(folder):
        (folder / FIT).unlink(missing_ok=True)
        write_file(folder / SCENARIO, scenario_text(report, str(content["command"])).encode())
        write_file(folder / RESIDUALS, "".join(_residual_lines(report)).encode())
    files = [folder / SCENARIO, folder / RESIDUALS]
    if figures:
        from gw_exudyn.calibration.figures import write_figures

        files += write_figures(report, folder)
    with as_storage_error(folder):
        write_file(folder / FIT, to_text(content).encode())
    return [folder / FIT, *files]


def scenario_text(report: Report, command: str) -> str:
    """The scenario with the fitted values, resolved, as YAML that says how it came."""
    import yaml

    scenario = report.calibration.scenario(report.fit.point).to_dict()
    scenario["name"] = f"{report.calibration.name}-fitted"[:100]
    lines = [f"{report.calibration.base} with values fitted by: {command}"]
    for one in report.estimates:
        doubt = "; NOT identified" if one.doubts else ""
        width = one.parameter.text(one.half_width, 2)
        lines.append(f"{one.parameter.path}: {one.parameter.text(one.value, 6)} +- {width} ({CONFIDENCE:.0%}){doubt}")
    if not report.fit.converged:
        lines.append("THE FIT DID NOT CONVERGE.")
    lines.append("All values in SI, those left to their defaults too.")
    body = yaml.safe_dump(scenario, sort_keys=False, allow_unicode=True, default_flow_style=None, width=120)
    return "".join(f"# {line}\n" for line in lines) + body


def _residual_lines(report: Report) -> Iterator[str]:
    """A row a measured value: in SI, the residual in units of the noise."""
    yield "file,quantity,unit,time [s],measured,fitted,noise,residual [1]\n"
    for channel in report.channels:
        head = f'"{channel.file}",{channel.quantity},{QUANTITIES[channel.quantity].unit}'
        rows = zip(channel.time, channel.measured, channel.fitted, channel.residuals, strict=True)
        for time, measured, fitted, residual in rows:
            numbers = (time, measured, fitted, channel.noise, residual)
            yield f"{head},{','.join(repr(float(number)) for number in numbers)}\n"


def content_of(report: Report, command: str, further: Mapping[str, Any]) -> dict[str, Any]:
    """The content of fit.json, in SI."""
    calibration, fit, found = report.calibration, report.fit, report.statistics
    paths = [one.path for one in calibration.parameters]
    return {
        "format": MARKER,
        "format_version": 1,
        "name": calibration.name,
        "base": calibration.base,
        "set": dict(calibration.fixed),
        "converged": fit.converged,
        "message": fit.message,
        "identified": not any(one.doubts for one in report.estimates),
        "parameters": {
            one.parameter.path: {
                "value": one.value,
                "unit": one.parameter.unit,
                "standard_error": one.standard_error,
                "roughness": one.roughness,
                "interval": list(one.interval),
                "confidence": CONFIDENCE,
                "start": one.parameter.start,
                "low": one.parameter.low,
                "high": one.parameter.high,
                "identified": not one.doubts,
                "doubts": list(one.doubts),
            }
            for one in report.estimates
        },
        "correlation": {
            path: dict(zip(paths, row, strict=True))
            for path, row in zip(paths, found.correlation.tolist(), strict=True)
        },
        "singular_values": found.singular_values.tolist(),
        "singular_directions": [dict(zip(paths, row, strict=True)) for row in found.directions.tolist()],
        "chi_square": found.chi_square,
        "degrees_of_freedom": found.degrees,
        "reduced_chi_square": found.reduced,
        "student_factor": found.factor,
        "widening_by_autocorrelation": widening(report.channels),
        "differences": {
            one.path: apart * one.range for one, (_, _, apart) in zip(calibration.parameters, fit.sides, strict=False)
        },
        "align": calibration.align,
        "measured": [
            {
                "file": channel.file,
                "quantity": channel.quantity,
                "unit": QUANTITIES[channel.quantity].unit,
                "count": len(channel.time),
                "noise": channel.noise,
                "rms": float((channel.residuals**2).mean() ** 0.5) * channel.noise,
                "rms_by_noise": float((channel.residuals**2).mean() ** 0.5),
                "autocorrelation": autocorrelation(channel),
            }
            for channel in report.channels
        ],
        "files": {file.name: _digest(file) for file in calibration.measured_files},
        "descents": [
            {
                "start": calibration.values(one.start),
                "end": None if one.best is None else calibration.values(one.best.point),
                "chi_square": None if one.best is None else one.best.chi_square,
                "converged": one.converged,
                "message": one.message,
            }
            for one in fit.descents
        ],
        "steps": [
            {"values": calibration.values(step.point), "chi_square": step.chi_square, "failed": step.reason or None}
            for step in fit.steps
        ],
        "notes": list(report.notes),
        "command": command,
        **further,
    }


def _digest(file: Path) -> str:
    with as_storage_error(file.parent):
        return hashlib.sha256(file.read_bytes()).hexdigest()
