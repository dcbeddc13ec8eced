"""The worker with its own Python, frozen for the platform of this machine, for FMUs that need no Python.

PyInstaller (extra `bundle`) does it. Exudyn links libGL and libX11, which it never calls in a worker: the system's own
go with it, so that a machine without them runs the worker too.
"""

from __future__ import annotations

import importlib.metadata
import os
import platform
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path

from gw_exudyn.errors import UsageError
from gw_exudyn.fmi.legal import own_licence

FOLDER = "worker"
"""The frozen worker's folder in the FMU's resources; its program bears the same name."""

LICENCES = "documentation/licenses/bundled.txt"

_SYSTEM = ("libGL", "libGLX", "libGLdispatch", "libX11", "libxcb", "libXau", "libXdmcp", "libbsd", "libmd")
"""What Exudyn links of the graphics system, and what that links."""

# Not needed by a worker: each costs time to look through, room, and some of it time at the start. readline is left out
# for its licence as well (GPL). One import in a place that a worker may come to after all is told as what is missing.
_LEFT_OUT = (
    "IPython", "PIL", "_hashlib", "_ssl", "ast_serialize", "asyncio", "bdb", "cmd", "concurrent", "curses", "dask",
    "distributed", "doctest", "exudyn.FEM", "exudyn.exudynCPPfast", "exudyn.misc.GUI", "exudyn.physics",
    "exudyn.utilities", "fmpy", "ftplib", "getpass", "gw_exudyn.comparison",
    "gw_exudyn.metrics", "gw_exudyn.plots", "gw_exudyn.storage", "gymnasium", "h5netcdf", "h5py", "http", "hypothesis",
    "lxml", "matplotlib", "mpl_toolkits", "mujoco", "multiprocessing", "mypy", "netrc", "numpy.f2py", "numpy.testing",
    "pandas", "pdb", "pip", "psutil", "py_compile", "pydantic.experimental", "pydantic.mypy", "pydantic.v1",
    "pydoc", "pydoc_data", "pytest", "readline", "rich", "runpy", "scipy", "setuptools", "socketserver", "sqlite3",
    "ssl", "tarfile", "tkinter", "unittest", "urllib.request", "webbrowser", "xarray", "xml.sax", "xmlrpc", "ziglang",
)  # fmt: skip
# pkgutil is asked for by the package svg in a way that is not seen.
_PARTS = ("gw_exudyn.fmi.worker", "gw_exudyn.fmi.plant", "exudyn.exudynCPP", "pkgutil", "shapely")
_SHOWN = ("exudyn", "numpy", "pydantic", "pydantic_core", "shapely", "PyYAML", "typing_extensions",
          "annotated-types", "typing-inspection", "pyinstaller")  # fmt: skip
# Its graph of modules is never freed; looking for what could be only takes time.
_FREEZE = "import gc; gc.disable(); from PyInstaller.__main__ import run; run()"
_ENTRY = "import sys\nfrom gw_exudyn.fmi.worker import main\nmain(sys.argv[1:])\n"


def this_platform() -> str:
    """The platform that a worker can be frozen for here, as FMI 3 names it. Raises UsageError where there is none."""
    if sys.platform == "linux" and platform.machine() in ("x86_64", "aarch64") and platform.libc_ver()[0] == "glibc":
        return f"{platform.machine()}-linux"
    raise UsageError("--bundled is there on Linux with glibc, on x86_64 and aarch64; leave it out here")


def frozen() -> dict[str, bytes]:
    """Every file of the frozen worker by its place in the FMU's resources.

    Raises UsageError where PyInstaller is missing or fails, or the system's libraries are not all there.
    """
    this_platform()
    if find_spec("PyInstaller") is None:
        raise UsageError("--bundled needs PyInstaller; install it with `pip install '.[bundle]'` in the checkout")
    with tempfile.TemporaryDirectory(prefix="gw-bundle-") as scratch:
        entry = Path(scratch, f"{FOLDER}.py")
        entry.write_text(_ENTRY, encoding="utf-8")
        command = [sys.executable, "-c", _FREEZE, *_options(Path(scratch)), str(entry)]
        environment = {**os.environ, "PYINSTALLER_CONFIG_DIR": f"{scratch}/config", "PYTHONHASHSEED": "0"}
        run = subprocess.run(command, cwd=scratch, env=environment, capture_output=True, text=True)
        if run.returncode != 0:
            raise UsageError(f"PyInstaller could not freeze the worker:\n{run.stderr.strip()[-2000:]}")
        made = Path(scratch, "dist", FOLDER)
        # Links are no files of a ZIP archive; what they lead to is there, and is found where it lies.
        files = (file for file in sorted(made.rglob("*")) if file.is_file() and not file.is_symlink())
        return {f"{FOLDER}/{file.relative_to(made).as_posix()}": file.read_bytes() for file in files}


def _options(scratch: Path) -> Iterator[str]:
    from gw_exudyn.model.kernel import LIBRARY_FOLDER, library_name
    from gw_exudyn.scenario.shipped import shipped_folder

    package = Path(__file__).resolve().parents[1]
    kernel = LIBRARY_FOLDER / library_name(platform.system(), platform.machine())
    # Modules as files of their own: they load faster than from an archive in the program.
    yield from ("--debug", "noarchive")
    yield from ("--onedir", "--name", FOLDER, "--noconfirm", "--log-level", "ERROR", "--paths", str(package.parent))
    yield from ("--distpath", str(scratch / "dist"), "--workpath", str(scratch / "work"), "--specpath", str(scratch))
    yield from ("--collect-binaries", "exudyn")
    yield from ("--add-data", f"{package / 'scenario' / 'catalogue.yaml'}:gw_exudyn/scenario")
    yield from ("--add-data", f"{shipped_folder()}:gw_exudyn/shipped")
    yield from ("--add-binary", f"{kernel}:gw_exudyn/model/kernel/lib")
    for library in _system_libraries():
        yield from ("--add-binary", f"{library}:.")
    for name in _PARTS:
        yield from ("--hidden-import", name)
    for name in _LEFT_OUT:
        yield from ("--exclude-module", name)


def _system_libraries() -> list[str]:
    """Paths of the libraries of the graphics system that Exudyn links here."""
    found = find_spec("exudyn")
    places = list(found.submodule_search_locations or []) if found is not None else []
    module = next((file for place in places for file in Path(place).glob("exudynCPP.*.so")), None)
    if module is None:
        raise UsageError("Exudyn is not installed here; install it with: pip install exudyn")
    linked = subprocess.run(["ldd", str(module)], capture_output=True, text=True, check=False).stdout
    if "not found" in linked:
        raise UsageError("Exudyn's libraries are not all here; on Debian and Ubuntu: apt-get install libgl1 libx11-6")
    paths = re.findall(r"=> (/\S+)", linked)
    return [path for path in paths if Path(path).name.partition(".so")[0] in _SYSTEM]


def glibc_need(files: Mapping[str, bytes]) -> str:
    """The oldest version of glibc with which the files run."""
    versions = {m for content in files.values() for m in re.findall(rb"GLIBC_(\d+)\.(\d+)", content)}
    major, minor = max((int(a), int(b)) for a, b in versions)
    return f"{major}.{minor}"


def licences(files: Mapping[str, bytes]) -> str:
    """The licences of what is frozen: of the Python packages, of Python, and of the system's libraries."""
    parts = [f"What runs this FMU, in resources/{FOLDER}, is made of the following, each under its own licence.\n"]
    parts.append(_heading("gw-exudyn") + own_licence())
    parts.append(_heading(f"Python {platform.python_version()}") + _python_licence())
    for name in _SHOWN:
        try:
            found = importlib.metadata.distribution(name)
        except importlib.metadata.PackageNotFoundError:
            continue
        texts = [
            file.locate().read_text(encoding="utf-8", errors="replace")  # type: ignore[attr-defined]
            for file in found.files or []
            if re.match(r"(licen[cs]e|copying|notice)", file.name, re.IGNORECASE) and file.suffix not in (".py", ".pyc")
        ]
        kind = (found.metadata.json.get(key) for key in ("license_expression", "license"))
        parts.append(
            _heading(f"{name} {found.version}")
            + ("\n".join(texts) or f"{next(filter(None, kind), 'see its home page')}\n")
        )
    names = sorted(Path(file).name for file in files if re.fullmatch(rf"{FOLDER}/_internal/[^/]+\.so[.\d]*", file))
    for package, held in sorted(_packages_of(names).items()):
        text = Path("/usr/share/doc", package, "copyright")
        known = text.read_text(encoding="utf-8", errors="replace") if package and text.is_file() else ""
        parts.append(_heading(", ".join(held)) + (known or "from the system on which this FMU was exported\n"))
    return "\n".join(parts)


def _heading(text: str) -> str:
    return f"{'=' * 80}\n{text}\n{'=' * 80}\n"


def _python_licence() -> str:
    text = Path(sysconfig.get_path("stdlib"), "LICENSE.txt")
    return text.read_text(encoding="utf-8") if text.is_file() else "Python Software Foundation License, version 2\n"


def _packages_of(libraries: Sequence[str]) -> dict[str, list[str]]:
    """The libraries by the package of the system that they are of; empty where that is not known."""
    told = ""
    if shutil.which("dpkg") is not None:
        patterns = [f"*/{library}" for library in libraries]
        told = subprocess.run(["dpkg", "-S", *patterns], capture_output=True, text=True, check=False).stdout
    # A line says `package:architecture: /path/library`.
    package_of = {Path(line.rpartition(" ")[2]).name: line.partition(":")[0] for line in reversed(told.splitlines())}
    packages: dict[str, list[str]] = {}
    for library in libraries:
        packages.setdefault(package_of.get(library, ""), []).append(library)
    return packages
