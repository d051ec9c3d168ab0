"""What is counted of an episode is what the environment said of it."""

from __future__ import annotations

from contextlib import closing

import pytest

from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.expert.expert import Expert
from tltl_runtime.stealth.recording import RecordEpisode
from tltl_runtime.stealth.recordings.outcome import outcome


@pytest.mark.parametrize(("level", "careful"), [("navigation", True), ("cover_and_hide", False)])
def test_it_agrees_with_the_environment(level: str, careful: bool) -> None:
    with closing(RecordEpisode(make_env(level))) as env:
        expert = Expert(env, careful)
        env.reset(seed=1)
        expert.reset()
        game = env.get_wrapper_attr("game")
        total, steps, seen, chased, over = 0.0, 0, int(any(game.enemies.sees)), False, False
        while not over:
            _, reward, terminated, truncated, info = env.step(expert.act())
            over = terminated or truncated
            total, steps = total + reward, steps + 1
            seen += any(game.enemies.sees)
            chased |= "chase" in game.enemies.modes
        went = outcome(env.episode)
        opened = tuple(each.name for each, is_open in zip(game.level.barriers, game.open, strict=True) if is_open)
    assert went.reward == pytest.approx(total)
    assert (went.success, went.verdict, went.progress) == (info["success"], info["verdict"], info["progress"])
    assert (went.steps, went.seconds, went.health) == (steps, pytest.approx(steps * 0.15), game.health)
    assert (went.seen_steps, went.chased, went.opened) == (seen, chased, opened)
    assert (went.end, went.chased) == (("success", False) if careful else ("violation", True))
