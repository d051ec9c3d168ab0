"""An episode of a policy: its seeds, its figures, and what failing costs."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest

from tests.runtime.evaluation.untrained import untrained
from tltl_runtime.evaluation.play import Played, episode_seed, play
from tltl_runtime.policies.policy import Policy
from tltl_runtime.stealth.env import make_env
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.monitor import RewardOptions

LATE = "import stealth\nspec late { limit 50 steps\n reach seen\n keep before(1 s) }"
AT_ONCE = "import stealth\nspec at_once { limit 50 steps\n reach alive }"


@pytest.fixture(scope="module")
def policy() -> Policy:
    return untrained()


def test_seeds_are_those_of_numpy() -> None:
    (word,) = np.random.SeedSequence(3, spawn_key=(7, 0)).generate_state(1)
    assert episode_seed(3, 7) == int(word) >> 1
    seeds = {episode_seed(seed, index) for seed in range(20) for index in range(200)}
    assert len(seeds) == 4000
    assert all(0 <= seed < 2**31 for seed in seeds)


def test_an_episode_does_not_depend_on_those_before_it(policy: Policy) -> None:
    env = make_env("cover_and_hide", "v0", policy.card.fspa, reward=RewardOptions())
    several = [play(policy, env, 3, index, sampled=True) for index in range(8)]
    env.close()
    alone = make_env("cover_and_hide", "v0", policy.card.fspa, reward=RewardOptions())
    again = play(policy, alone, 3, 7, sampled=True)
    assert again == several[7]
    assert len({each.progress for each in several}) == 8
    assert play(policy, alone, 4, 7, sampled=True) != again
    argmax = play(policy, alone, 3, 7, sampled=False)
    assert argmax.seed == again.seed
    assert argmax.progress != again.progress
    alone.close()


def test_running_out_of_time(policy: Policy) -> None:
    env = make_env("cover_and_hide", "v0", policy.card.fspa, reward=RewardOptions())
    found = play(policy, env, 3, 0, sampled=True)
    env.close()
    assert (found.success, found.end, found.verdict, found.steps) == (False, "limit", "pending", 20)
    assert found.seconds == pytest.approx(3.0)
    assert (found.state, found.unmet) == (0, 0)
    assert found.label == "Reach near(exit), and keep alive throughout."
    assert found.reward == pytest.approx(found.progress - 1.0)


def played(spec: str) -> Played:
    policy = untrained(spec)
    env = make_env("cover_and_hide", "v0", policy.card.fspa, reward=RewardOptions())
    found = play(policy, env, 3, 0, sampled=True)
    env.close()
    return found


def test_a_violation_costs_what_was_left_and_tells_what_remained() -> None:
    found = played(LATE)
    assert (found.success, found.end, found.verdict, found.steps) == (False, "violation", "violated", 7)
    assert found.reward == pytest.approx(found.progress - 1.0)
    assert found.state != found.unmet == 0
    assert found.label == "Reach seen, and keep before(1) throughout."


def test_a_success_costs_its_steps() -> None:
    found = played(AT_ONCE)
    assert (found.success, found.end, found.progress, found.steps) == (True, "success", 1.0, 1)
    assert found.reward == pytest.approx(1.0 - 1 / 50)


class Blinded(gymnasium.ObservationWrapper[Any, Any, Any]):
    """Senses no number at all from the third decision on."""

    def __init__(self, env: gymnasium.Env[Any, Any]) -> None:
        super().__init__(env)
        self._left = 3

    def observation(self, observation: dict[str, Any]) -> dict[str, Any]:
        self._left -= 1
        return observation if self._left > 0 else {**observation, "entities": observation["entities"] * np.nan}


def refusal(policy: Policy, blinded: bool) -> tuple[str, str]:
    env: gymnasium.Env[Any, Any] = make_env("cover_and_hide", "v0", policy.card.fspa, reward=RewardOptions())
    with pytest.raises(TltlError) as found:
        play(policy, Blinded(env) if blinded else env, 3, 5, sampled=False)
    env.close()
    (diagnostic,) = found.value.diagnostics
    return diagnostic.code, diagnostic.title


def test_an_observation_without_numbers(policy: Policy) -> None:
    where = f"episode 5 of seed 3 (seed {episode_seed(3, 5)} of the level), step 3"
    said = f"{where}: `entities` of the observation has values that are no finite numbers"
    assert refusal(policy, blinded=True) == ("TLT0854", said)


def test_a_network_whose_sums_overflow() -> None:
    huge = untrained()
    for weights in huge.actor.parameters():
        weights.mul_(1e30)
    where = f"episode 5 of seed 3 (seed {episode_seed(3, 5)} of the level), step 1"
    said = f"{where}: the policy's network gives values that are no finite numbers"
    assert refusal(huge, blinded=False) == ("TLT0854", said)
