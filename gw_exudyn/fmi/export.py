"""Export of a scenario as an FMU: description, wrapper for every platform with its source, table and scenario."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
import struct
import sys
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import gw_exudyn
from gw_exudyn.errors import StorageError, UsageError
from gw_exudyn.fmi import bundle, description, icon
from gw_exudyn.fmi.bundle import FOLDER
from gw_exudyn.fmi.legal import licence
from gw_exudyn.fmi.page import documentation, external_dependencies
from gw_exudyn.fmi.related import related_files
from gw_exudyn.fmi.resources import HASHES, SCENARIO, TABLE, Launch, table_text
from gw_exudyn.fmi.table import DEFAULT_STATIONS, variables_of
from gw_exudyn.fmi.wrapper import HEADERS, PLATFORMS, SOURCES, library, source_folder

if TYPE_CHECKING:
    from gw_exudyn.scenario import Scenario


_DATE = (1980, 1, 1, 0, 0, 0)
_FOLDERS2 = {"x86_64-linux": "linux64", "aarch64-linux": "aarch64-linux", "x86_64-windows": "win64"}


def launch_of(python: str | None = None) -> Launch:
    """How the worker of an FMU made here is started. python : interpreter to record; None takes this one."""
    # As it was called: the file behind the link of a virtual environment knows nothing of the environment.
    here = python or sys.executable
    package = Path(gw_exudyn.__file__).resolve().parent
    installed = package.parent.name in ("site-packages", "dist-packages")
    return Launch(here, "" if installed else str(package.parent), gw_exudyn.__version__)


def identifier_of(name: str) -> str:
    """A name that a C function and a file may have."""
    text = re.sub(r"\W", "_", name, flags=re.ASCII)
    return text if re.match(r"[A-Za-z_]", text) else f"_{text}"


def export(
    scenario: Scenario,
    file: str | os.PathLike[str],
    fmi: int = 2,
    *,
    stations: int = DEFAULT_STATIONS,
    launch: Launch | None = None,
    bundled: bool = False,
) -> Path:
    """Write the FMU of a scenario and return its file. The same scenario on the same machine gives the same bytes.

    bundled : with a worker inside that needs no Python, for this machine's platform alone.

    Raises ScenarioError for a scenario that cannot start, UsageError for an FMI version that there is not, StorageError
    where the file can't be written.
    """
    if fmi not in (2, 3):
        raise UsageError(f"there is no FMI {fmi} here; take 2 or 3")
    if stations < 2:
        raise UsageError(f"{stations} stations describe no wire; take 2 or more")
    files = _files(scenario, fmi, stations, launch or launch_of(), bundled)
    target = Path(file)
    part = target.with_name(f".{target.name}.part")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, content in sorted(files.items(), key=lambda item: (item[0] != "modelDescription.xml", item[0])):
                entry = zipfile.ZipInfo(name, _DATE)
                entry.compress_type = zipfile.ZIP_DEFLATED
                entry.external_attr = (0o755 if name.startswith(("binaries/", f"resources/{FOLDER}/")) else 0o644) << 16
                # What is frozen is large: a level less takes little more room and half the time.
                archive.writestr(entry, content, compresslevel=5 if name.startswith(f"resources/{FOLDER}/") else None)
        os.replace(part, target)
    except OSError as error:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)
        raise StorageError(f"{target}: can't be written: {error.strerror or error}") from error
    return target


def _files(scenario: Scenario, fmi: int, stations: int, launch: Launch, bundled: bool) -> dict[str, bytes]:
    """Every file of the FMU by its name."""
    variables = variables_of(scenario, fmi, stations)
    worker = bundle.frozen() if bundled else {}
    platforms = (bundle.this_platform(),) if bundled else PLATFORMS
    if bundled:
        launch = replace(
            launch,
            python="",
            path=f"{FOLDER}/_internal",
            arguments=(),
            program=f"{FOLDER}/{FOLDER}",
            glibc=bundle.glibc_need(worker),
        )
    headers = sorted(header for header in _fmi_headers() if not header.name.startswith("fmi1"))
    identifier = identifier_of(scenario.name)
    files = {f"resources/{SCENARIO}": (json.dumps(scenario.to_dict(), indent=1) + "\n").encode()}
    files |= {f"sources/{name}": (source_folder() / name).read_bytes() for name in (*SOURCES, *HEADERS)}
    files |= {f"sources/{header.name}": header.read_bytes() for header in headers}
    files |= {f"binaries/{name}": content for name, content in _binaries(fmi, identifier, platforms).items()}
    files |= {f"resources/{name}": content for name, content in worker.items()}
    if bundled:
        files[bundle.LICENCES] = bundle.licences(worker).encode()
        hashes = {f"resources/{name}": hashlib.sha256(content).hexdigest() for name, content in worker.items()}
        files[HASHES] = (json.dumps(hashes, indent=1, sort_keys=True) + "\n").encode()
    model = description.Model(
        name=scenario.name,
        identifier=identifier,
        token="",
        version=launch.version,
        description="A guidewire pushed into a vessel, simulated by gw-exudyn.",
        stop=scenario.drive.duration,
        step=scenario.solver.step,
        sources=SOURCES,
        bundled=bundled,
    )
    if fmi == 3:
        files["sources/buildDescription.xml"] = description.build_description(model)
        files["terminalsAndIcons/terminalsAndIcons.xml"] = description.terminals_and_icons()
        files |= {"terminalsAndIcons/icon.png": icon.png(), "terminalsAndIcons/icon.svg": icon.svg()}
    else:
        files["model.png"] = icon.png()
    files |= related_files(scenario, variables)
    model = replace(model, token=_token(files, repr((fmi, variables, launch))))
    files[f"resources/{TABLE}"] = table_text(variables, model.token, launch).encode()
    files["modelDescription.xml"] = description.model_description(model, variables, fmi)
    files["documentation/index.html"] = documentation(model, variables, fmi, launch).encode()
    files["documentation/externalDependencies.txt"] = external_dependencies(launch).encode()
    files["documentation/licenses/license.txt"] = licence(bundled).encode()
    return files


def _fmi_headers() -> list[Path]:
    from gw_exudyn.fmi.wrapper.build import fmi_headers

    return list(fmi_headers().glob("fmi*.h"))


def _binaries(fmi: int, identifier: str, platforms: Sequence[str]) -> dict[str, bytes]:
    """The wrapper's libraries, by their place. FMI 2 has one folder for macOS: both processors go into one file."""
    contents = {platform: library(platform).read_bytes() for platform in platforms}
    if fmi == 3:
        return {f"{p}/{identifier}{library(p).suffix}": content for p, content in contents.items()}
    placed = {f"{f}/{identifier}{library(p).suffix}": contents[p] for p, f in _FOLDERS2.items() if p in contents}
    if "x86_64-darwin" not in contents:
        return placed
    both = universal([contents["x86_64-darwin"], contents["aarch64-darwin"]])
    return {**placed, f"darwin64/{identifier}.dylib": both}


def universal(libraries: Sequence[bytes]) -> bytes:
    """Libraries of macOS for several processors as one file: a head of big-endian numbers, then each, aligned."""
    align = 14  # 2^14 bytes, a page of either processor
    head = struct.pack(">II", 0xCAFEBABE, len(libraries))
    place, body = 1 << align, b""
    for content in libraries:
        _, processor, kind = struct.unpack_from("<III", content)
        head += struct.pack(">IIIII", processor, kind, place, len(content), align)
        padded = content + bytes(-len(content) % (1 << align))
        body, place = body + padded, place + len(padded)
    return head.ljust(1 << align, b"\0") + body


def _token(files: Mapping[str, bytes], more: str) -> str:
    """A GUID of the contents: other contents, other GUID."""
    digest = hashlib.sha256(more.encode())
    for name in sorted(files):
        digest.update(name.encode() + b"\0" + hashlib.sha256(files[name]).digest())
    text = digest.hexdigest()
    return f"{{{text[:8]}-{text[8:12]}-{text[12:16]}-{text[16:20]}-{text[20:32]}}}"
