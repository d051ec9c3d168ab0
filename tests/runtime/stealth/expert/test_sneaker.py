"""Sneaking: unseen where that is possible, and the same game without care is lost."""

from __future__ import annotations

from contextlib import closing

import pytest

from tests.runtime.stealth.enemy_levels import box, level
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.expert.expert import Expert, play_episode
from tltl_runtime.stealth.expert.sneaker import Sneaker
from tltl_runtime.stealth.expert.walker import Walker
from tltl_runtime.stealth.game import Game
from tltl_runtime.stealth.level import Level, Solid, Start
from tltl_runtime.stealth.recording import RecordEpisode
from tltlc.core.record import replace

GOAL = (8.2, 7.2, 0.0)


def guarded() -> Level:
    """A guard that stands in the west and looks east, and a low wall all along the way behind which one can crouch."""
    hedge = Solid("hedge", "low", box(3.0, 6.0, 10.0, 6.3, 0.0, 1.2))
    made = level(hedge, routes=(((1.5, 3.0, 0.0),),))
    return replace(made, start=Start((3.6, 7.2, 0.0)))


def passed(player: type[Sneaker] | type[Walker]) -> tuple[bool, int, int]:
    """Whether the goal was reached unseen, after how many decisions, and in how many of them crouched."""
    with closing(Game(guarded())) as game:
        game.reset(0)
        playing = player(game.level)
        seen, crouched = False, 0
        for decision in range(60):
            snapshot = game.snapshot()
            seen |= any(snapshot.sees)
            crouched += snapshot.player.crouching
            x, y, _ = snapshot.player.position
            if abs(x - GOAL[0]) < 1.0 and abs(y - GOAL[1]) < 1.0:
                return not seen, decision, crouched
            game.step(playing.act(snapshot, GOAL))
    raise AssertionError("the goal was not reached")


def test_it_crouches_where_only_that_hides() -> None:
    unseen, decisions, crouched = passed(Sneaker)
    assert unseen
    assert crouched > 0.5 * decisions


def test_who_does_not_mind_runs_and_is_seen() -> None:
    unseen, _, crouched = passed(Walker)
    assert not unseen
    assert crouched == 0


@pytest.mark.parametrize(
    ("name", "variant", "seeds"),
    [
        ("cover_and_hide", "v0", (0, 1)),
        ("cover_and_hide", "v1", (0,)),
        ("cover_and_hide", "v2", (0,)),
        ("branching", "v0", (1,)),
    ],
)
def test_the_careful_expert_finishes_and_nobody_chases_it(name: str, variant: str, seeds: tuple[int, ...]) -> None:
    env = RecordEpisode(make_env(name, variant))
    with closing(env):
        expert = Expert(env)
        for seed in seeds:
            assert play_episode(env, expert, seed)["success"]
            episode = env.episode
            assert "chase" not in {mode for shot in episode.snapshots for mode in shot.modes}
            assert episode.snapshots[-1].health == 1.0


def test_the_careless_one_fails_in_most_episodes_where_a_guard_is() -> None:
    lost = 0
    env = make_env("cover_and_hide")
    with closing(env):
        expert = Expert(env, careful=False)
        for seed in range(6):
            lost += play_episode(env, expert, seed)["verdict"] == "violated"
    assert lost >= 4
