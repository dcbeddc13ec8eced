"""Deliberate errors in the physics, and whether the tests notice: `make mutate`.

Each error is a text change in a copy of the project; the text must be there exactly once, so that a change of the
source cannot leave a mutant empty. The tests that should notice are run first, on a copy without the error (where they
must pass) and on the mutant, then everything; the first failure ends it. A mutant that no test kills makes the exit
code 1.

    python tests/mutation/mutate.py [NAME...]
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COPIED = ("gw_exudyn", "tests", "scenarios", "benchmarks", "docs", "pyproject.toml", "README.md", "CHANGELOG.md")
KERNEL = "gw_exudyn/model/kernel/contact.c"
EVIDENCE = "tests/verification/test_evidence.py"
EVERYTHING = ("tests/unit", "tests/verification", "tests/scenarios")
FAILED, NONE_CHOSEN = 1, 5
"""Exit codes of pytest: a test failed; no test was chosen."""


@dataclass(frozen=True)
class Mutant:
    """An error. file, old, new : the change. tests : what should notice, a list of pytest's arguments after another."""

    name: str
    file: str
    old: str
    new: str
    tests: tuple[tuple[str, ...], ...]


def evidence(words: str) -> tuple[str, ...]:
    """The cases of the evidence whose names have these words, as pytest's -k."""
    return (EVIDENCE, "-k", f"holds and ({words})")


MUTANTS = (
    Mutant(
        "friction pulls along instead of dragging",
        KERNEL,
        "law.tangential = -sign * limit * share;",
        "law.tangential = sign * limit * share;",
        (
            ("tests/unit/test_contact_kernel.py", "tests/unit/test_energy.py"),
            evidence("friction or (energy and corner90-universal)"),
        ),
    ),
    Mutant(
        "a full instead of half a segment at the clamp",
        "gw_exudyn/model/wire.py",
        "    stiffness = 1 / compliance(spec.effective_stiffness, near, far)\n",
        "    stiffness = 1 / compliance(spec.effective_stiffness, near, far)\n    stiffness[0] /= 2\n",
        (evidence("statics or convergence"), ("tests/unit/test_wire.py",)),
    ),
    Mutant(
        "gap of a corner without a sign",
        KERNEL,
        "if (side == 0) side = pl.y < 0 ? -1 : 1;",
        "side = pl.y < 0 ? -1 : 1;",
        (("tests/unit/test_contact_kernel.py", "tests/unit/test_contact_memory.py"), evidence("tunnelling")),
    ),
    Mutant(
        "a catheter without friction",
        "gw_exudyn/model/build.py",
        "value_or(scenario.catheter.friction_coefficient, contact.friction_coefficient),",
        "0.0,",
        (evidence("balance"), ("tests/unit/test_outline_walls.py",)),
    ),
    Mutant(
        "half the bending stiffness",
        "gw_exudyn/model/wire.py",
        "    stiffness = 1 / compliance(spec.effective_stiffness, near, far)\n",
        "    stiffness = 0.5 / compliance(spec.effective_stiffness, near, far)\n",
        (evidence("statics or second"), ("tests/unit/test_wire.py",)),
    ),
    Mutant(
        "force on the wire reported as the force on the vessel",
        "gw_exudyn/sampling.py",
        "wall, catheter = force[vessel].sum(axis=0), force[inside].sum(axis=0)",
        "wall, catheter = -force[vessel].sum(axis=0), force[inside].sum(axis=0)",
        (evidence("balance"), ("tests/verification/test_contact_scenes.py",)),
    ),
    Mutant(
        "damping dropped from the energies",
        "gw_exudyn/model/energy.py",
        "damping_loss=before.damping_loss + damping + wall_damping,",
        "damping_loss=before.damping_loss,",
        (("tests/unit/test_energy.py",), evidence("energy and corner90")),
    ),
    Mutant(
        "a wall that pulls back what leaves it quickly",
        KERNEL,
        "const int pushing = modulus > 0;",
        "const int pushing = 1;",
        (evidence("signs"), ("tests/unit/test_contact_kernel.py",)),
    ),
    Mutant(
        "a dead load at the tip that turns with it",
        "gw_exudyn/model/loads.py",
        "total: Floats = (self.tip.dead + turned) * self.tip.share(self.time)",
        "x, y = self.tip.dead\n        turned += np.array([x * c - y * s - x, x * s + y * c - y])\n"
        "        total: Floats = (self.tip.dead + turned) * self.tip.share(self.time)",
        (evidence("cantilever"), ("tests/unit/test_loads.py",)),
    ),
)


def main() -> int:
    """Make each mutant, test it, and say what killed it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="only the mutants whose names have one of these words")
    options = parser.parse_args()
    chosen = [m for m in MUTANTS if not options.names or any(word in m.name for word in options.names)]
    survivors = []
    with tempfile.TemporaryDirectory(prefix="mutants-") as scratch:
        sound = Path(scratch) / "sound"
        copy_project(sound)
        for number, mutant in enumerate(chosen):
            began = time.monotonic()
            killer = killed_by(mutant, Path(scratch) / str(number), sound)
            verdict = f"killed    by {killer}" if killer else "SURVIVED"
            print(f"{mutant.name}: {verdict} ({time.monotonic() - began:.0f} s)", flush=True)
            if not killer:
                survivors.append(mutant.name)
    print(f"{len(chosen) - len(survivors)} of {len(chosen)} mutants killed")
    return 1 if survivors or not chosen else 0


def killed_by(mutant: Mutant, folder: Path, sound: Path) -> str | None:
    """The test that fails in a copy of the project with the error, or None. sound : a copy without."""
    copy_project(folder)
    apply(mutant, folder)
    for arguments in (*(tests for tests in mutant.tests if are_there(tests, sound)), EVERYTHING):
        code, output = pytest(arguments, folder)
        if code == FAILED:
            return failing_test(output)
        if code not in (0, NONE_CHOSEN):
            raise SystemExit(f"{mutant.name}: the tests could not be run:\n{output}")
    return None


@cache
def are_there(arguments: tuple[str, ...], sound: Path) -> bool:
    """Whether there are such tests. Ends the program where they fail without any error made: then they say nothing."""
    code, output = pytest(arguments, sound)
    if code not in (0, NONE_CHOSEN):
        raise SystemExit(f"the tests {' '.join(arguments)} fail without any error made:\n{output}")
    return code == 0


def copy_project(folder: Path) -> None:
    """A copy of what the tests need."""
    folder.mkdir()
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
        elif source.is_file():
            shutil.copy2(source, folder / name)


def apply(mutant: Mutant, folder: Path) -> None:
    """Make the error, and build the contact kernel anew if it is in there. Ends the program where the text is not there
    exactly once."""
    path = folder / mutant.file
    text = path.read_text(encoding="utf-8")
    if text.count(mutant.old) != 1:
        raise SystemExit(f"{mutant.name}: {mutant.file} has {text.count(mutant.old)} times, not once: {mutant.old!r}")
    path.write_text(text.replace(mutant.old, mutant.new), encoding="utf-8")
    if mutant.file == KERNEL:
        build_kernel(folder)


_BUILD = """
import platform
from gw_exudyn.model.kernel import library_name
from gw_exudyn.model.kernel.build import KERNELS
KERNELS.build(library_name(platform.system(), platform.machine()), KERNELS.folder)
"""


def build_kernel(folder: Path) -> None:
    """The contact kernel of this machine, from the source in the folder."""
    run = subprocess.run(
        [sys.executable, "-c", _BUILD], cwd=folder, env=environment(folder), text=True, capture_output=True
    )
    if run.returncode != 0:
        raise SystemExit(f"the kernel could not be built (the package ziglang is needed):\n{run.stderr}")


def pytest(arguments: Sequence[str], folder: Path) -> tuple[int, str]:
    """Exit code and output of pytest in the folder; it stops at the first failure.

    What says whether the built libraries are those of the source is left out: it would kill every change of the kernel.
    """
    there = [a for a in arguments if not a.startswith("tests/") or (folder / a).exists()]
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "--tb=line"]
    command += ["--ignore=tests/unit/test_kernel_build.py", *there]
    run = subprocess.run(command, cwd=folder, env=environment(folder), text=True, capture_output=True)
    return run.returncode, run.stdout + run.stderr


def environment(folder: Path) -> dict[str, str]:
    """This process's, with the copy of the package before any other."""
    return {**os.environ, "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1", "OMP_NUM_THREADS": "1"}


def failing_test(output: str) -> str:
    """The name of the test that failed."""
    found = re.search(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", output, re.MULTILINE)
    return found.group(1) if found else "a test that has no name in pytest's report"


if __name__ == "__main__":
    sys.exit(main())
