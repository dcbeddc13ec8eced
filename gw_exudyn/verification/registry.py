"""All cases there are: those in the tuples `CASES` of this package's modules."""

from __future__ import annotations

import pkgutil
from importlib import import_module

import gw_exudyn.verification
from gw_exudyn.errors import UsageError
from gw_exudyn.verification.evidence import Case


def all_cases() -> tuple[Case, ...]:
    """Every case, sorted by module and in the order of each module's tuple."""
    found: list[Case] = []
    for module in sorted(entry.name for entry in pkgutil.iter_modules(gw_exudyn.verification.__path__)):
        found += getattr(import_module(f"gw_exudyn.verification.{module}"), "CASES", ())
    return tuple(found)


def groups() -> tuple[str, ...]:
    """Names of the groups, in the order of their cases."""
    return tuple(dict.fromkeys(case.group for case in all_cases()))


def cases_of(names: tuple[str, ...]) -> tuple[Case, ...]:
    """The cases of the named groups, of all where none is named. Raises UsageError for a group that is not there."""
    known = groups()
    for name in names:
        if name not in known:
            raise UsageError(f"there is no group {name!r} of evidence; groups: {', '.join(known)}")
    return tuple(case for case in all_cases() if not names or case.group in names)


def case_named(group: str, name: str) -> Case:
    """The case of that group and name; they are unique. Raises KeyError if there is none."""
    return {(case.group, case.name): case for case in all_cases()}[group, name]
