"""The scripted expert finishes every level that can be finished, with the actions of a player."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from tests.runtime.stealth.expert_episodes import played
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.expert.expert import Expert, play_episode
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.snapshot import BRANCHES

TOWER = """
doc = "Two platforms, a gap of 2.5 m, and a third."
spec = "tower.tltl:tower"
[bounds]
at = [8.0, 4.0, -0.5]
size = [16.0, 8.0, 6.5]
[start]
at = [1.0, 2.0, 0.0]
spread = 0.3
[variants]
v0 = []
[[platform]]
name = "low"
at = [3.5, 4.0, 0.0]
size = [2.0, 7.0, 1.0]
[[platform]]
name = "high"
at = [5.5, 6.0, 0.0]
size = [2.0, 3.0, 1.9]
[[platform]]
name = "far"
at = [10.5, 6.0, 0.0]
size = [3.0, 3.0, 1.9]
[[switch]]
name = "top"
at = [10.8, 6.0, 1.9]
[[exit]]
name = "out"
at = [14.5, 1.0, 0.0]
"""

BLOCK = """
doc = "A start on top of a barrier that is shut, too wide for one step to lead off it."
spec = "block.tltl:block"
[bounds]
at = [8.0, 4.0, -0.5]
size = [16.0, 8.0, 6.5]
[start]
at = [5.0, 4.0, 1.0]
[variants]
v0 = []
[[barrier]]
name = "gate"
at = [5.0, 4.0, 0.0]
size = [4.0, 4.0, 1.0]
opened_by = ["lever"]
[[switch]]
name = "lever"
at = [14.5, 7.0, 0.0]
[[exit]]
name = "out"
at = [14.5, 1.0, 0.0]
"""


@contextmanager
def _expert(level: str, variant: str = "v0", careful: bool = True) -> Iterator[tuple[RecordEpisode, Expert]]:
    env = RecordEpisode(make_env(level, variant))
    try:
        yield env, Expert(env, careful)
    finally:
        env.close()


def _play(env: RecordEpisode, expert: Expert, seed: int) -> Episode:
    play_episode(env, expert, seed)
    return env.episode


def _left_is_open(episode: Episode) -> bool:
    names = [barrier.name for barrier in episode.level.barriers]
    return episode.snapshots[-1].open[names.index("left")]


@pytest.mark.parametrize(("variant", "seed"), [("v0", 0), ("v1", 0)])
def test_the_expert_finishes_navigation(variant: str, seed: int) -> None:
    episode = played("navigation", variant, seed)
    assert episode.success
    # It climbed the stairs to the platform, and crouched through the gap.
    assert max(snapshot.player.position[2] for snapshot in episode.snapshots) > 1.4
    assert any(snapshot.player.crouching for snapshot in episode.snapshots)


def test_the_expert_goes_as_far_as_it_can_if_the_route_is_blocked() -> None:
    with _expert("navigation", "v2") as (env, expert):
        env.reset(seed=0)
        expert.reset()
        for _ in range(60):
            env.step(expert.act())
        # It reached the block in the corridor. The corridor begins at x = 8, the block 3.6 to 4.4 m further east.
        assert env.episode.states[-1] == 1
        assert 11.0 < env.episode.snapshots[-1].player.position[0] < 11.6


@pytest.mark.slow
def test_the_expert_takes_the_open_branch() -> None:
    final_y = {}
    for seed in range(20):
        episode = played("branching", seed=seed)
        assert episode.success
        final_y["left" if _left_is_open(episode) else "right"] = episode.snapshots[-1].player.position[1]
        if len(final_y) == 2:
            break
    assert final_y["right"] < 9.6 < final_y["left"]


@pytest.mark.slow
def test_the_expert_passes_rising_bars() -> None:
    episode = played("branching", "v1", 1)
    assert _left_is_open(episode), "the branch with the bars"
    assert episode.success
    assert max(snapshot.player.position[2] for snapshot in episode.snapshots) > 0.4


def test_a_seed_repeats_an_episode_after_other_episodes() -> None:
    with _expert("cover_and_hide", careful=False) as (env, expert):
        first = _play(env, expert, 3)
        _play(env, expert, 4)
        second = _play(env, expert, 3)
    assert np.array_equal(first.actions, second.actions)
    assert (first.actions < np.array(BRANCHES)).all()


def test_the_expert_stands_still_if_the_spec_has_no_goal() -> None:
    env = make_env("cover_and_hide", spec="import stealth\nspec hidden_at_once { limit 9 steps\n keep alive }")
    expert = Expert(env)
    env.reset(seed=0)
    assert expert.act() == (0, 0, 0, 0, 0)
    env.close()


def test_the_expert_finishes_a_level_that_is_not_shipped(tmp_path: Path) -> None:
    """The route goes up two steps of a metre, across a gap that only a sprint can cross, and down again."""
    (tmp_path / "tower.tltl").write_text(
        "import spatial\nentity top, out\nspec tower { limit 100 steps\n reach near(top) then near(out) }\n"
    )
    (tmp_path / "tower.toml").write_text(TOWER)
    with _expert(str(tmp_path / "tower.toml")) as (env, expert):
        episode = _play(env, expert, 0)
    assert episode.success and len(episode.actions) < 60


def test_the_expert_climbs_down_from_a_shut_barrier(tmp_path: Path) -> None:
    (tmp_path / "block.tltl").write_text(
        "import spatial\nentity out\nspec block { limit 40 steps\n reach near(out) }\n"
    )
    (tmp_path / "block.toml").write_text(BLOCK)
    with _expert(str(tmp_path / "block.toml")) as (env, expert):
        episode = _play(env, expert, 0)
    assert episode.success


def test_the_expert_presses_switches_that_open_its_route() -> None:
    """The spec does not name these switches."""
    spec = "import stealth\nclock 0.15 s\nentity exit\nspec leave { limit 60 s  reach near(exit)  keep alive }\n"
    env = make_env("cover_and_hide", spec=spec)
    assert play_episode(env, Expert(env), 0)["success"]
    assert env.unwrapped.game.active == [True, True]  # type: ignore[attr-defined]
    env.close()
