"""The search for demonstrations keeps places apart that differ in what the spec remembers."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pytest

from tests.runtime.gymnasium_games import maze
from tests.runtime.training.test_search_any_game import CORNERS
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.spec.automaton_observation import AutomatonObservation
from tltl_runtime.training.exploration.cells import position_grid
from tltl_runtime.training.exploration.memory_cells import MemoryCells
from tltl_runtime.training.exploration.returning_env import ReturningEnv
from tltl_runtime.training.exploration.search import SearchProgress, SearchSettings, TrajectorySearch
from tltl_runtime.vector import make_vec
from tltl_runtime.vector.env import TLTL_INFO
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.monitor import Monitor

NAMES = "clock 10 Hz\nsignal has_key: bool\nsignal opened: bool\nsignal place in [-1, 17]\n"


def spec_of(clauses: str) -> Fspa:
    (fspa,) = compile_text(f"{NAMES}spec fetch {{\n  {clauses}\n  limit 120 steps\n}}")
    return fspa


def numbers(fspa: Fspa, letters: list[str]) -> list[int]:
    """Return the number of what a spec remembers after each sample; a sample names the signals that hold."""
    monitor, observation, cells = Monitor(fspa), AutomatonObservation(fspa), MemoryCells(fspa)
    result = []
    for letter in letters:
        monitor.step({"has_key": "k" in letter, "opened": "o" in letter, "place": 0})
        result.append(cells.number(observation.of(monitor.state, monitor.registers)))
    return result


def test_a_place_before_an_event_differs_from_one_after_it() -> None:
    before, during, after, later = numbers(spec_of("keep opened implies once has_key"), ["", "k", "", ""])
    assert before != during == after == later


def test_counts_and_times_have_bins() -> None:
    counted = numbers(spec_of("keep times(has_key) <= 3"), ["", "k", "", "k", "", "k", "", "k"])
    assert counted == [0, 1, 1, 2, 2, 3, 3, 4]
    timed = numbers(spec_of("keep time_holding(has_key) <= 4 s"), ["k"] * 41)
    assert timed == sorted(timed)
    assert len(set(timed)) == 5


def test_a_deadline_has_bins() -> None:
    fspa = spec_of("reach has_key then within 10 s opened")
    assert [register.kind for register in fspa.registers] == ["time_since"]
    since = numbers(fspa, ["k"] + [""] * 100)
    assert since == sorted(since)
    assert len(set(since)) == 5


def test_without_memory_there_is_one_number() -> None:
    assert set(numbers(spec_of("reach has_key then opened"), ["", "k", "o"])) == {0}


def test_only_a_few_registers_count() -> None:
    fspa = spec_of("  ".join(f"keep times(place > {place}) <= 3" for place in range(12)))
    row = np.ones(len(fspa.states) + len(fspa.registers), np.float32)
    assert 0 < MemoryCells(fspa).number(row) < 8**6


@pytest.mark.parametrize("remembers", [True, False])
def test_a_search_finds_the_way_if_places_with_the_key_differ(tmp_path: Path, *, remembers: bool) -> None:
    # The door opens only with the key, and the state of this automaton does not say who has it.
    fspa = spec_of("reach opened and once has_key")
    assert len(fspa.states) == 2
    progress, found = search(maze.write(tmp_path), fspa, MemoryCells(fspa) if remembers else None)
    assert (found >= 3) == remembers, progress


def search(game: Path, fspa: Fspa, memory: MemoryCells | None) -> tuple[SearchProgress, int]:
    """Return the progress of a search in the maze, and how many demonstrations it found."""
    wrapper = partial(ReturningEnv, game=GAME, grid=position_grid(CORNERS, []), snapshots=False)
    info = {**TLTL_INFO, "cell": np.int64}
    env = make_vec(f"{game}:placed", "v0", 4, 1, spec=fspa, wrapper=wrapper, info=info)
    try:
        settings = SearchSettings(ways=3, steps=20_000, parts=4, imitation=0)
        trajectories = TrajectorySearch(env, settings, np.random.SeedSequence(7), memory=memory)
        (*_, last) = trajectories.run()
        return last, len(trajectories.demonstrations)
    finally:
        env.close()
