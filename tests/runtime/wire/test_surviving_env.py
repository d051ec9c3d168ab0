"""Lost games: how many may be lost, and environments that go on with the next episode."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.runtime.wire.processes import no_game_is_left
from tests.runtime.wire.test_env import COUNTER, RIGHT, STAY, judged
from tests.runtime.wire.test_env import spec as spec
from tests.runtime.wire.test_faults import GAMES, family
from tests.waiting import HANG_S, until_gone
from tltl_runtime.vector import WorkerVectorEnv
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.lost_episodes import MOST_IN_A_ROW, LossLimit, LostEpisodes, most_lost, together
from tltl_runtime.wire.surviving_env import FAULTS, LOST, SurvivingEnv, surviving
from tltl_runtime.wire.wire_game import WireGame
from tltlc.api import Diagnostic

FAULT = Diagnostic("TLT0791", "the game `it` ended", help="the game's standard error ends:\nno map\ncorrect it")


def mortal(folder: Path, *episodes: int | str, fault: str = "exit") -> WireGame:
    words = (sys.executable, "mortal.py", fault, str(folder / "episodes"), *map(str, episodes))
    return WireGame("mortal", GAMES, words, start_s=HANG_S, step_s=HANG_S)


@given(st.lists(st.booleans(), max_size=120))
def test_too_many_losses_are_those_in_a_row_or_beyond_the_share(losses: list[bool]) -> None:
    most = most_lost(len(losses))
    limit, lost, in_a_row = LossLimit(most), 0, 0
    for is_lost in losses:
        if not is_lost:
            limit.add_played()
            in_a_row = 0
            continue
        lost, in_a_row = lost + 1, in_a_row + 1
        if lost > most or in_a_row > MOST_IN_A_ROW:
            with pytest.raises(WireError, match="TLT0791: the game `it` ended"):
                limit.add_lost(FAULT)
            return
        limit.add_lost(FAULT)
    assert lost <= most


def test_a_single_episode_cannot_be_lost_and_of_many_a_tenth_can() -> None:
    assert [most_lost(episodes) for episodes in (1, 2, 9, 10, 25, 300)] == [0, 1, 1, 1, 2, 30]
    limit = LossLimit(2)
    for _ in range(40):
        limit.add_played()
    for _ in range(4):
        limit.add_lost(FAULT)
        limit.add_played()
    with pytest.raises(WireError):
        limit.add_lost(FAULT)


def test_the_text_counts_the_episodes_and_describes_the_first_loss() -> None:
    other = Diagnostic("TLT0792", "the game `it` sent NaN")
    lost = together([None, LostEpisodes(1, FAULT), LostEpisodes(2, other)])
    assert lost == LostEpisodes(3, FAULT) and together([None]) is None
    assert lost.text == "3 episodes were lost: the game `it` ended"
    assert LostEpisodes(1, other).line == "1 episode was lost: the game `it` sent NaN"
    assert lost.line == f"{lost.text} (the game's standard error ends: | no map | correct it)"
    assert (lost.warning.severity, lost.warning.code, lost.warning.help) == ("warning", "TLT0791", FAULT.help)


def test_a_lost_game_cuts_off_the_episode_without_a_reward(spec: str, tmp_path: Path) -> None:
    with no_game_is_left():
        env = surviving(partial(judged, spec, mortal(tmp_path, 2)))
        assert isinstance(env, SurvivingEnv)
        observation, info = env.reset(seed=0)
        assert FAULTS not in info and LOST not in info
        env.step(RIGHT)
        first, _ = env.reset(seed=1)
        wire = env.unwrapped
        assert isinstance(wire, WireEnv)
        pids = family(wire)
        observation, reward, terminated, truncated, info = env.step(RIGHT)
        until_gone(pids)
        assert (reward, terminated, truncated) == (0.0, False, True)
        assert all(np.array_equal(observation[key], first[key]) for key in first)
        assert info[LOST] and not info["success"] and info["verdict"]
        _, info = env.reset()
        assert info[LOST] and [fault.code for fault in info[FAULTS]] == ["TLT0791"]
        assert "now: exit" in (info[FAULTS][0].help or "")
        assert LOST not in env.step(STAY)[4]
        env.close()


def test_an_episode_that_cannot_begin_is_followed_by_another(spec: str, tmp_path: Path) -> None:
    env = surviving(partial(judged, spec, mortal(tmp_path, 1, 2, fault="reset")))
    _, info = env.reset(seed=0)
    assert [fault.code for fault in info[FAULTS]] == ["TLT0793"] * 2 and LOST not in info
    env.close()


@pytest.mark.parametrize("resets", [1, 2])
def test_a_game_that_is_always_lost_is_an_error(spec: str, tmp_path: Path, resets: int) -> None:
    with no_game_is_left():
        env = surviving(partial(judged, spec, mortal(tmp_path, "all")))
        with pytest.raises(WireError, match="ended with exit status 3 instead of answering `step`"):
            for _ in range(MOST_IN_A_ROW + 1):
                for _ in range(resets):
                    env.reset()
                env.step(STAY)
        env.close()


def test_episodes_that_are_cut_off_by_a_reset_count_as_played(spec: str, tmp_path: Path) -> None:
    env = surviving(partial(judged, spec, mortal(tmp_path, *range(2, 24, 2))))
    lost = []
    with pytest.raises(WireError, match="ended with exit status 3 instead of answering `step`"):
        for _ in range(24):
            env.reset()
            lost.append(env.step(STAY)[4].get(LOST, False))
    # Never two in a row, but the eleventh of 22 episodes is one too many.
    assert lost == [False, True] * 10 + [False]
    env.close()


def test_an_environment_of_this_process_is_not_wrapped() -> None:
    import gymnasium

    env = surviving(partial(gymnasium.make, "CartPole-v1"))
    assert not isinstance(env, SurvivingEnv)
    env.close()


@pytest.mark.parametrize("workers", [1, 2])
def test_a_vector_environment_loses_one_episode_of_one_environment(
    spec: str,
    tmp_path: Path,
    workers: int,
) -> None:
    games = [COUNTER, mortal(tmp_path, 1), COUNTER]
    functions = [partial(surviving, partial(judged, spec, game)) for game in games]
    with no_game_is_left():
        env = WorkerVectorEnv(functions, workers, timeout=HANG_S)
        env.reset(seed=0)
        pids = env.worker_pids
        *_, reward, terminated, truncated, infos = env.step(np.full(3, STAY))
        assert infos[LOST].tolist() == [False, True, False]
        assert infos["final_info"][LOST].tolist() == [False, True, False]
        assert (terminated.tolist(), truncated.tolist()) == ([False] * 3, [False, True, False])
        assert reward[1] == 0.0
        faults: Any = infos[FAULTS]
        assert [bool(of_env) for of_env in faults] == [False, True, False]
        _, _, terminated, truncated, infos = env.step(np.full(3, STAY))
        assert not (terminated | truncated).any() and LOST not in infos
        assert env.worker_pids == pids
        env.close()
