"""The summary of a recorded episode agrees with what the environment reported."""

from __future__ import annotations

from contextlib import closing

import pytest

from tltl_runtime.game.episode_summary import summary_of
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.expert.expert import Expert
from tltl_runtime.stealth.recordings.figures import opened_barriers, seen_steps, was_chased


@pytest.mark.parametrize(("level", "careful"), [("navigation", True), ("cover_and_hide", False)])
def test_a_summary_agrees_with_the_environment(level: str, careful: bool) -> None:
    with closing(RecordEpisode(make_env(level))) as env:
        expert = Expert(env, careful)
        env.reset(seed=1)
        expert.reset()
        game = env.get_wrapper_attr("game")
        total, steps, expected_seen_steps, chased, over = 0.0, 0, int(any(game.enemies.sees)), False, False
        while not over:
            _, reward, terminated, truncated, info = env.step(expert.act())
            over = terminated or truncated
            total, steps = total + reward, steps + 1
            expected_seen_steps += any(game.enemies.sees)
            chased |= "chase" in game.enemies.modes
        episode = env.episode
        result = summary_of(episode, 3)
        opened = tuple(barrier.name for barrier, is_open in zip(game.level.barriers, game.open, strict=True) if is_open)
    assert result.reward == pytest.approx(total)
    assert (result.success, result.verdict, result.progress) == (info["success"], info["verdict"], info["progress"])
    assert (result.steps, result.seconds) == (steps, pytest.approx(steps * 0.15))
    assert episode.snapshots[-1].health == game.health
    assert (result.index, result.seed) == (3, 1)
    assert (result.state, result.unmet) == (info["state"], info["unmet"])
    assert (seen_steps(episode), was_chased(episode), opened_barriers(episode)) == (expected_seen_steps, chased, opened)
    assert (result.end, chased) == (("success", False) if careful else ("violation", True))
