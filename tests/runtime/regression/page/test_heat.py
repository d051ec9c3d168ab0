"""The heat maps of time spent and of failed ends."""

from __future__ import annotations

import pytest

from tests.runtime.regression.handmade import changed
from tests.runtime.regression.page import samples
from tltl_runtime.regression.report.page.heat import ENDS_CELL, TIME_CELL, failed_ends, time_spent
from tltl_runtime.stealth.level import Box
from tltlc.core.record import replace

BOUNDS = Box((0.0, 0.0, 0.0), (10.0, 4.0, 3.0))


def test_time_is_counted_in_the_cells_of_the_path() -> None:
    explained = samples.explained_of(0, samples.navigation()[0])
    # Three seconds in the north-west corner, one second at the eastern bound.
    first = replace(explained, way=((0.1, 3.9, 0, 0.0), (0.3, 3.7, 0, 2.95), (10.0, 0.1, 1, 3.0), (10.0, 0.1, 1, 4.0)))
    second = replace(explained, way=((0.1, 3.9, 0, 0.0), (0.1, 3.9, 0, 1.0)))
    heat = time_spent(BOUNDS, [first, second])
    assert (heat.cell, heat.columns) == (TIME_CELL, 20)
    assert heat.values == ((0, 2.0), (7 * 20 + 19, 0.5))


def test_the_cells_add_up_to_the_length_of_the_episodes() -> None:
    episodes = samples.navigation()
    explained_episodes = [samples.explained_of(index, episode) for index, episode in enumerate(episodes)]
    heat = time_spent(episodes[0].level.bounds, explained_episodes)
    seconds = sum(episode.snapshots[-1].time for episode in episodes) / len(episodes)
    assert sum(value for _, value in heat.values) == pytest.approx(seconds, abs=0.1)


def test_only_ends_of_failures_are_counted() -> None:
    explained = samples.explained_of(0, samples.navigation()[0])
    failed = replace(changed(explained, success=False), place=(9.5, 0.5, 0.0))
    heat = failed_ends(BOUNDS, [explained, failed, failed, replace(failed, place=(0.0, 4.0, 0.0))])
    assert (heat.cell, heat.columns) == (ENDS_CELL, 10)
    assert heat.values == ((0, 1.0), (39, 2.0))
