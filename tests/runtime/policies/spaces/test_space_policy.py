"""Policies for any spaces: they choose actions, are stored in files, and play in equal spaces alone."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from gymnasium import spaces
from hypothesis import given
from hypothesis import strategies as st

from tests.runtime.policies.examples import card_of, policy_of
from tests.runtime.policies.spaces.random_spaces import ACTIONS, OBSERVATIONS
from tests.runtime.policies.spaces.space_policies import card_of_spaces, policy_of_spaces, random_weights, with_layouts
from tltl_runtime.policies.compatibility import check_spaces
from tltl_runtime.policies.file import check_size, from_bytes, to_bytes
from tltl_runtime.policies.network import Network
from tltl_runtime.policies.policy import NotFiniteError, Policy
from tltl_runtime.policies.spaces.layouts import space_layouts
from tltl_runtime.policies.summary import summary, summary_text
from tltl_runtime.stealth.env import make_env
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.diagnostics.render import render

GRID = spaces.Dict(
    {
        "image": spaces.Box(0, 255, (7, 7, 3), np.uint8),
        "direction": spaces.Discrete(4),
        "body": spaces.Tuple((spaces.Box(-np.inf, np.inf, (2,), np.float64), spaces.Box(0, 9, (1,), np.float32))),
    }
)
MIXED = spaces.Dict({"go": spaces.Box(-2, 5, (2,), np.float32), "use": spaces.Discrete(3, start=1)})


@pytest.mark.hypothesis
@given(observation=OBSERVATIONS, action=ACTIONS, seed=st.integers(0, 2**31 - 1))
def test_a_policy_of_any_spaces_makes_the_round_trip_through_its_file(
    observation: spaces.Space[Any], action: spaces.Space[Any], seed: int
) -> None:
    if space_layouts(observation, action) is None:
        return
    policy = policy_of_spaces(observation, action, seed)
    data = to_bytes(policy)
    again = from_bytes(data, "bot")
    assert again.card == policy.card
    assert to_bytes(again) == data
    observation.seed(seed)
    seen = observation.sample()
    assert again.logits(seen).tobytes() == policy.logits(seen).tobytes()
    for generator in (None, np.random.default_rng(seed)):
        assert action.contains(policy.choose(seen, generator))


def test_a_policy_whose_values_the_network_takes_as_they_are_has_no_spaces_in_its_file() -> None:
    policy = policy_of(card_of())
    assert policy.card.spaces is None
    assert b'\\"spaces\\"' not in to_bytes(policy)
    assert b'\\"spaces\\"' in to_bytes(policy_of_spaces(GRID, MIXED))


def test_a_policy_of_spaces_can_be_pickled() -> None:
    policy = policy_of_spaces(GRID, MIXED)
    seen = GRID.sample()
    assert pickle.loads(pickle.dumps(policy)).logits(seen).tobytes() == policy.logits(seen).tobytes()


def test_scales_are_stored_in_single_precision() -> None:
    card = card_of_spaces(GRID, MIXED)
    assert card.spaces is not None
    weights = random_weights(card.network, card.spaces, 0)
    weights["normalizer.mean"][:] = 1e6 + 0.25
    assert (from_bytes(to_bytes(Policy(card, weights)), "bot").weights()["normalizer.mean"] == 1e6 + 0.25).all()


def test_samples_of_numbers_have_the_deviations_of_the_policy() -> None:
    action = spaces.Box(-np.inf, np.inf, (2,), np.float64)
    card = card_of_spaces(GRID, action)
    assert card.spaces is not None
    weights = random_weights(card.network, card.spaces, 1)
    weights["distribution.log_deviation"] = np.log(np.array([0.5, 2.0], np.float32))
    policy, seen, generator = Policy(card, weights), GRID.sample(), np.random.default_rng(0)
    samples = np.array([policy.choose(seen, generator) for _ in range(4000)])
    np.testing.assert_allclose(samples.mean(0), policy.choose(seen), atol=0.15)
    np.testing.assert_allclose(samples.std(0), [0.5, 2.0], rtol=0.05)


def test_an_observation_that_is_not_finite_is_named() -> None:
    seen = GRID.sample()
    seen["body"][0][0] = np.nan
    with pytest.raises(NotFiniteError, match="`body/0` of the observation has values that are not finite"):
        policy_of_spaces(GRID, MIXED).choose(seen)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"shapes": (("image", (7, 7, 3)),)}, "`card.shapes` are not those of `card.spaces`"),
        ({"branches": (2,)}, "`card.branches` contradicts `card.spaces`"),
    ],
)
def test_a_card_that_contradicts_its_spaces_is_refused(change: dict[str, Any], message: str) -> None:
    policy = policy_of_spaces(GRID, MIXED)
    with pytest.raises(TltlError, match=f"TLT0842.*{message}"):
        from_bytes(to_bytes(Policy(replace(policy.card, **change), policy.weights())), "bot")


def test_a_deviation_of_zero_is_refused() -> None:
    policy = policy_of_spaces(GRID, MIXED)
    weights = policy.weights()
    weights["normalizer.deviation"][0] = 0
    with pytest.raises(TltlError, match=r"TLT0842.*not above 0"):
        from_bytes(to_bytes(Policy(policy.card, weights)), "bot")


def test_a_network_that_is_too_large_for_a_file_is_refused() -> None:
    card = card_of_spaces(GRID, MIXED)
    check_size(card.network, card.fspa, card.sensors, card.spaces)
    with pytest.raises(TltlError, match="TLT0862"):
        check_size(Network(hidden=(16_000, 16_000)), card.fspa, card.sensors, card.spaces)


def test_a_summary_says_what_the_policy_reads_and_chooses() -> None:
    values = summary(policy_of_spaces(GRID, MIXED))
    assert values["spaces"]["action"]["parts"][1]["kind"] == "choice"
    text = summary_text(values)
    assert "body/0 (2 numbers), body/1 (1 numbers), direction (4 categories)," in text
    assert "image (7 x 7 x 3 grid of categories)" in text
    assert "chooses  go (2 numbers), use (3 choices)\n" in text
    assert "network  convolution 3 + 4, then 8 (elu)," in text
    assert "spaces" not in summary(policy_of(card_of()))


def test_a_policy_plays_in_the_spaces_of_its_training() -> None:
    card = card_of_spaces(GRID, MIXED)
    check_spaces(card, GRID, MIXED)
    other = spaces.Dict({**GRID.spaces, "direction": spaces.Discrete(5)})
    with pytest.raises(TltlError) as caught:
        check_spaces(card, other, spaces.Discrete(2))
    text = "`small` of another game: another observation `direction`, another action\n"
    assert text in render(caught.value.diagnostics)
    env = make_env("cover_and_hide")
    check_spaces(card_of(), env.observation_space, env.action_space)
    for wrong in (card, with_layouts(card, observation=card.spaces.observation[:1] if card.spaces else ())):
        with pytest.raises(TltlError, match=r"TLT0843.*another game"):
            check_spaces(wrong, env.observation_space, env.action_space)
    env.close()
