"""An episode of a policy: its seeds, its figures, and the cost of failing."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest

from tests.runtime.evaluation.untrained import untrained
from tltl_runtime.evaluation.play import episode_seed, play
from tltl_runtime.policies.actor import weight_shapes
from tltl_runtime.policies.network import Network
from tltl_runtime.policies.policy import Policy
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.stealth.env import make_env
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.monitor import RewardOptions

LATE = "import stealth\nspec late { limit 50 steps\n reach seen\n keep before(1 s) }"
AT_ONCE = "import stealth\nspec at_once { limit 50 steps\n reach alive }"


@pytest.fixture(scope="module")
def policy() -> Policy:
    return untrained()


def test_seeds_are_from_the_seed_sequence_of_numpy() -> None:
    (word,) = np.random.SeedSequence(3, spawn_key=(7, 0)).generate_state(1)
    assert episode_seed(3, 7) == int(word) >> 1
    seeds = {episode_seed(seed, index) for seed in range(20) for index in range(200)}
    assert len(seeds) == 4000
    assert all(0 <= seed < 2**31 for seed in seeds)


def test_an_episode_does_not_depend_on_earlier_episodes(policy: Policy) -> None:
    env = make_env("cover_and_hide", "v0", policy.card.fspa, reward=RewardOptions())
    results = [play(policy, env, 3, index, sampled=True) for index in range(8)]
    env.close()
    single_env = make_env("cover_and_hide", "v0", policy.card.fspa, reward=RewardOptions())
    again = play(policy, single_env, 3, 7, sampled=True)
    assert again == results[7]
    assert len({result.progress for result in results}) == 8
    assert play(policy, single_env, 4, 7, sampled=True) != again
    argmax = play(policy, single_env, 3, 7, sampled=False)
    assert argmax.seed == again.seed
    assert argmax.progress != again.progress
    single_env.close()


def test_an_episode_that_runs_out_of_time_ends_at_its_limit(policy: Policy) -> None:
    env = make_env("cover_and_hide", "v0", policy.card.fspa, reward=RewardOptions())
    result = play(policy, env, 3, 0, sampled=True)
    env.close()
    assert (result.success, result.end, result.verdict, result.steps) == (False, "limit", "pending", 20)
    assert result.seconds == pytest.approx(3.0)
    assert (result.state, result.unmet) == (0, 0)
    assert result.label == "Reach near(exit), and keep alive throughout."
    assert result.reward == pytest.approx(result.progress - 1.0)


def played_summary(spec: str) -> EpisodeSummary:
    policy = untrained(spec)
    env = make_env("cover_and_hide", "v0", policy.card.fspa, reward=RewardOptions())
    result = play(policy, env, 3, 0, sampled=True)
    env.close()
    return result


def test_a_violation_costs_one_and_states_what_remained() -> None:
    result = played_summary(LATE)
    assert (result.success, result.end, result.verdict, result.steps) == (False, "violation", "violated", 7)
    assert result.reward == pytest.approx(result.progress - 1.0)
    assert result.state != result.unmet == 0
    assert result.label == "Reach seen, and keep before(1) throughout."


def test_a_success_costs_its_steps() -> None:
    result = played_summary(AT_ONCE)
    assert (result.success, result.end, result.progress, result.steps) == (True, "success", 1.0, 1)
    assert result.reward == pytest.approx(1.0 - 1 / 50)


class Blinded(gymnasium.ObservationWrapper[Any, Any, Any]):
    """A wrapper whose observations contain NaN from the third decision on."""

    def __init__(self, env: gymnasium.Env[Any, Any]) -> None:
        super().__init__(env)
        self._left = 3

    def observation(self, observation: dict[str, Any]) -> dict[str, Any]:
        self._left -= 1
        return observation if self._left > 0 else {**observation, "entities": observation["entities"] * np.nan}


def diagnostic_of(policy: Policy, blinded: bool) -> tuple[str, str]:
    env: gymnasium.Env[Any, Any] = make_env("cover_and_hide", "v0", policy.card.fspa, reward=RewardOptions())
    with pytest.raises(TltlError) as caught:
        play(policy, Blinded(env) if blinded else env, 3, 5, sampled=False)
    env.close()
    (diagnostic,) = caught.value.diagnostics
    return diagnostic.code, diagnostic.title


def test_nan_in_an_observation_is_reported(policy: Policy) -> None:
    where = f"episode 5 of seed 3 (seed {episode_seed(3, 5)} of the level), step 3"
    title = f"{where}: `entities` of the observation has values that are not finite numbers"
    assert diagnostic_of(policy, blinded=True) == ("TLT0854", title)


def test_a_network_that_overflows_is_reported() -> None:
    card = replace(untrained().card, network=Network(hidden=(8,) * 9, channels=(4,)))
    shapes = weight_shapes(card.network, dict(card.shapes), card.branches)
    huge = Policy(card, {name: np.full(shape, 6e4) for name, shape in shapes.items()})
    where = f"episode 5 of seed 3 (seed {episode_seed(3, 5)} of the level), step 1"
    title = f"{where}: the policy's network gives values that are not finite numbers"
    assert diagnostic_of(huge, blinded=False) == ("TLT0854", title)
