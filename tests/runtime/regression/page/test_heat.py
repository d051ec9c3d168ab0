"""Heat maps: what is counted where."""

from __future__ import annotations

import pytest

from tests.runtime.regression.page import samples
from tltl_runtime.regression.report.page.heat import ENDS_CELL, TIME_CELL, failed_ends, time_spent
from tltl_runtime.stealth.level import Box
from tltlc.core.record import replace

BOUNDS = Box((0.0, 0.0, 0.0), (10.0, 4.0, 3.0))


def test_time_is_counted_in_the_cells_of_the_way() -> None:
    known = samples.account_of(0, samples.navigation()[0])
    # Three seconds in the north-western corner, one at the eastern bound.
    one = replace(known, way=((0.1, 3.9, 0, 0.0), (0.3, 3.7, 0, 2.95), (10.0, 0.1, 1, 3.0), (10.0, 0.1, 1, 4.0)))
    other = replace(known, way=((0.1, 3.9, 0, 0.0), (0.1, 3.9, 0, 1.0)))
    found = time_spent(BOUNDS, [one, other])
    assert (found.cell, found.columns) == (TIME_CELL, 20)
    assert found.values == ((0, 2.0), (7 * 20 + 19, 0.5))


def test_all_of_the_time_is_there() -> None:
    episodes = samples.navigation()
    accounts = [samples.account_of(index, each) for index, each in enumerate(episodes)]
    found = time_spent(episodes[0].level.bounds, accounts)
    seconds = sum(each.snapshots[-1].time for each in episodes) / len(episodes)
    assert sum(value for _, value in found.values) == pytest.approx(seconds, abs=0.1)


def test_ends_of_failures_alone_are_counted() -> None:
    known = samples.account_of(0, samples.navigation()[0])
    failed = replace(known, success=False, place=(9.5, 0.5, 0.0))
    found = failed_ends(BOUNDS, [known, failed, failed, replace(failed, place=(0.0, 4.0, 0.0))])
    assert (found.cell, found.columns) == (ENDS_CELL, 10)
    assert found.values == ((0, 1.0), (39, 2.0))
