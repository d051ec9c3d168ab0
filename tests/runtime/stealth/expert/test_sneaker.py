"""Sneaking: a careful player stays unseen where that is possible, and a careless one loses the same game."""

from __future__ import annotations

from contextlib import closing

import pytest

from tests.runtime.stealth.enemy_levels import box, level
from tests.runtime.stealth.expert_episodes import played
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.expert.expert import Expert, play_episode
from tltl_runtime.stealth.expert.sneaker import Sneaker
from tltl_runtime.stealth.expert.walker import Walker
from tltl_runtime.stealth.level import Solid, Start, StealthLevel
from tltl_runtime.stealth.simulation import Simulation
from tltlc.core.record import replace

GOAL = (8.2, 7.2, 0.0)


def guarded() -> StealthLevel:
    """Return a level with a guard in the west that looks east, and a low wall along the route to crouch behind."""
    hedge = Solid("hedge", "low", box(3.0, 6.0, 10.0, 6.3, 0.0, 1.2))
    base = level(hedge, routes=(((1.5, 3.0, 0.0),),))
    return replace(base, start=Start((3.6, 7.2, 0.0)))


def play_to_goal(player: type[Sneaker] | type[Walker]) -> tuple[bool, int, int]:
    """Return whether the goal was reached unseen, the number of decisions, and the number of crouched ones."""
    with closing(Simulation(guarded())) as game:
        game.reset(0)
        agent = player(game.level)
        was_seen, crouched = False, 0
        for decision in range(60):
            snapshot = game.snapshot()
            was_seen |= any(snapshot.sees)
            crouched += snapshot.player.crouching
            x, y, _ = snapshot.player.position
            if abs(x - GOAL[0]) < 1.0 and abs(y - GOAL[1]) < 1.0:
                return not was_seen, decision, crouched
            game.step(agent.act(snapshot, GOAL))
    raise AssertionError("the goal was not reached")


def test_the_sneaker_crouches_where_only_that_hides_it() -> None:
    unseen, decisions, crouched = play_to_goal(Sneaker)
    assert unseen
    assert crouched > 0.5 * decisions


def test_the_walker_does_not_crouch_and_is_seen() -> None:
    unseen, _, crouched = play_to_goal(Walker)
    assert not unseen
    assert crouched == 0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "variant", "seeds"),
    [
        ("cover_and_hide", "v0", (0, 1)),
        ("cover_and_hide", "v1", (0,)),
        ("cover_and_hide", "v2", (0,)),
        ("branching", "v0", (1,)),
    ],
)
def test_the_careful_expert_finishes_without_a_chase(name: str, variant: str, seeds: tuple[int, ...]) -> None:
    for seed in seeds:
        episode = played(name, variant, seed)
        assert episode.success
        assert "chase" not in {mode for snapshot in episode.snapshots for mode in snapshot.modes}
        assert episode.snapshots[-1].health == 1.0


def test_the_careless_expert_loses_most_episodes_with_a_guard() -> None:
    lost = 0
    env = make_env("cover_and_hide")
    with closing(env):
        expert = Expert(env, careful=False)
        for seed in range(6):
            lost += play_episode(env, expert, seed)["verdict"] == "violated"
    assert lost >= 4
