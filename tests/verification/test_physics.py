"""The physics against closed forms, other models and expected orders: every row of every case is where it should be."""

from __future__ import annotations

import pytest

from gw_exudyn.verification import convergence, friction, second_opinion, statics
from gw_exudyn.verification.evidence import Case

CASES = [*statics.CASES, *friction.CASES, *convergence.CASES, *second_opinion.CASES]


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.group}: {case.name}")
def test_every_row_holds(case: Case) -> None:
    rows = case.find().rows
    assert rows
    assert len({row.quantity for row in rows}) == len(rows), "two rows of one name"
    failed = [
        f"{r.quantity}: {r.measured:.9g}, {r.rule} {r.tolerance:.3g} of {r.expected:.9g}" for r in rows if not r.holds
    ]
    assert not failed, "\n".join(failed)
