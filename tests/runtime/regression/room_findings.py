"""Findings about episodes in a room with a hall and two switches, for tests of explanations."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tests.runtime.regression.handmade import ROOM, an_episode
from tltl_runtime.regression.explain.explain import findings
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.levels.file import load_level
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace

SPEC = """import spatial
import stealth
entity s1, s2, exit
exclusive near(s1), near(s2), near(exit)
spec way { limit 100 steps  reach near(s1) then near(s2) then near(exit)  keep alive }
"""
HALL = '[[region]]\nname = "north_hall"\nat = [5.0, 9.0, 0.0]\nsize = [9.6, 1.6, 3.0]\n'
SWITCHES = '[[switch]]\nname = "s1"\nat = [2.0, 5.0, 0.0]\n[[switch]]\nname = "s2"\nat = [2.0, 8.0, 0.0]\n'
NORTH, MIDDLE = (5.0, 9.0, 0.0), (5.0, 5.0, 0.0)


@pytest.fixture(name="level", scope="module")
def _level(tmp_path_factory: pytest.TempPathFactory) -> StealthLevel:
    path = tmp_path_factory.mktemp("levels") / "room.toml"
    path.write_text(ROOM + HALL + SWITCHES, encoding="utf-8")
    return load_level(str(path))


@pytest.fixture(name="fspa", scope="module")
def _fspa() -> Fspa:
    (fspa,) = compile_text(SPEC)
    return fspa


def states_after(fspa: Fspa, stages: int) -> list[int]:
    """The states of an episode that completed this many stages."""
    distances = [3 - stage for stage in range(stages + 1)]
    return [next(state.id for state in fspa.states if state.distance == distance) for distance in distances]


def successes(fspa: Fspa, count: int = 25) -> list[ExplainedEpisode]:
    return [an_episode(index, states=states_after(fspa, 3)) for index in range(count)]


def sentences(
    level: StealthLevel, fspa: Fspa, now: Sequence[ExplainedEpisode], before: Sequence[ExplainedEpisode] = ()
) -> list[str]:
    return [finding.text for finding in findings(level, fspa, now, before or successes(fspa))]


def deaths(fspa: Fspa, count: int, **changed: object) -> list[ExplainedEpisode]:
    died = [
        an_episode(index, False, states=states_after(fspa, 2), cause="killed", by=("guard",), place=NORTH)
        for index in range(count)
    ]
    return [*(replace(explained, **changed) for explained in died), *successes(fspa)[count:]]
