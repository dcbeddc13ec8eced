"""The native wrapper of the FMU: its source, and the libraries built of it, one a platform."""

from __future__ import annotations

from pathlib import Path

LIBRARIES = Path(__file__).resolve().parent / "lib"
SOURCES = (
    "table.c",
    "request.c",
    "instance.c",
    "state.c",
    "fmi2.c",
    "fmi3.c",
    "platform_posix.c",
    "platform_windows.c",
)
HEADERS = ("table.h", "platform.h", "instance.h", "request.h")


def source_folder() -> Path:
    """The folder of the wrapper's source: inside the package when it is installed, beside it in a source tree."""
    package = Path(__file__).resolve().parents[2]
    installed = Path(__file__).resolve().parent / "source"
    return installed if installed.is_dir() else package.parent / "fmu"


def library(platform: str) -> Path:
    """The library of a platform, named as FMI 3 names it (`x86_64-linux`)."""
    endings = {"linux": "so", "windows": "dll", "darwin": "dylib"}
    return LIBRARIES / f"wrapper-{platform}.{endings[platform.partition('-')[2]]}"


PLATFORMS = ("x86_64-linux", "aarch64-linux", "x86_64-windows", "aarch64-darwin", "x86_64-darwin")
"""The platforms for which there is a library."""
