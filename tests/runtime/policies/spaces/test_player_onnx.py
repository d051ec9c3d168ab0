"""An exported policy with the names of another player, run by onnxruntime, equals the policy."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import pytest
from gymnasium import spaces

from tests.interfaces.cli.conftest import tltlc  # noqa: F401
from tests.runtime.policies.examples import card_of, observation_of, policy_of
from tests.runtime.policies.spaces.space_policies import policy_of_spaces
from tltl_runtime.policies.file import write_policy
from tltl_runtime.policies.onnx_players import PLAYERS, to_player_onnx
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.spaces.values import flat_action, observation_arrays
from tltlc.api import TltlError

onnxruntime = pytest.importorskip("onnxruntime")

OBSERVATION = spaces.Dict({"obs": spaces.Box(-np.inf, np.inf, (3,)), "level": spaces.Discrete(4)})
BOX, CHOICE, ROW = spaces.Box(-1, 1, (2,)), spaces.Discrete(3), spaces.MultiDiscrete([2, 4])
ACTIONS: dict[str, spaces.Space[Any]] = {
    "choice": CHOICE,
    "row": ROW,
    "numbers": BOX,
    "both": spaces.Dict({"aim": BOX, "move": CHOICE, "turn": BOX, "use": ROW}),
}


@pytest.fixture(name="policy", params=ACTIONS)
def _policy(request: pytest.FixtureRequest) -> Policy:
    return policy_of_spaces(OBSERVATION, ACTIONS[request.param], 3)


def rows(policy: Policy, count: int) -> tuple[list[Any], np.ndarray[Any, Any]]:
    """Return observations, and the same as rows of one array."""
    layouts = policy.card.spaces
    assert layouts is not None
    OBSERVATION.seed(0)
    seen = [OBSERVATION.sample() for _ in range(count)]
    arrays = [observation_arrays(layouts.observation, value) for value in seen]
    return seen, np.stack([np.concatenate([*array.values()]) for array in arrays]).astype(np.float32)


def run(model: bytes, **inputs: Any) -> dict[str, Any]:
    onnx.checker.check_model(onnx.load_from_string(model), full_check=True)
    session = onnxruntime.InferenceSession(model)
    assert {part.name for part in session.get_inputs()} == set(inputs)
    return dict(zip([part.name for part in session.get_outputs()], session.run(None, inputs), strict=True))


def chosen(policy: Policy, value: Any) -> np.ndarray[Any, Any]:
    """Return the flat action of the policy, choices first."""
    layouts = policy.card.spaces
    assert layouts is not None
    return flat_action(layouts.action, policy.choose(value))


def test_the_model_for_godot_rl_plays_as_the_policy(policy: Policy) -> None:
    layouts = policy.card.spaces
    assert layouts is not None
    seen, array = rows(policy, 20)
    outputs = run(to_player_onnx(policy, "godot-rl"), obs=array, state_ins=np.zeros(20, np.float32))
    assert outputs["state_outs"].tolist() == [0] * 20
    for value, row in zip(seen, outputs["output"].tolist(), strict=True):
        choices, numbers = [], []
        for part in layouts.action.parts:
            for size in part.sizes:
                logits, row = row[:size], row[size:]
                # As `_extract_action_dict` of the plugin does.
                best, index = 0.0, 0
                for place, logit in enumerate(logits):
                    if logit > best:
                        best, index = logit, place
                choices.append(index)
            numbers += row[: len(part.low)]
            row = row[len(part.low) :]
        assert row == []
        np.testing.assert_allclose([*choices, *numbers], chosen(policy, value), rtol=1e-4, atol=1e-4)


def test_the_model_for_ml_agents_plays_as_the_policy(policy: Policy) -> None:
    layouts = policy.card.spaces
    assert layouts is not None
    sizes, count = layouts.action.sizes, layouts.action.number_count
    seen, array = rows(policy, 20)
    model = to_player_onnx(policy, "ml-agents")
    masks = {"action_masks": np.ones((20, sum(sizes)), np.float32)} if sizes else {}
    outputs = run(model, obs_0=array, **masks)
    assert (outputs["version_number"].tolist(), outputs["memory_size"].tolist()) == ([3], [0])
    for value, *parts in zip(
        seen, *(outputs[name] for name in outputs if name.startswith("deterministic")), strict=True
    ):
        flat = np.concatenate(parts[::-1])  # choices first
        np.testing.assert_allclose(flat, chosen(policy, value), rtol=1e-4, atol=1e-4)
    if count:
        assert outputs["continuous_action_output_shape"].tolist() == [count]
        np.testing.assert_array_equal(outputs["continuous_actions"], outputs["deterministic_continuous_actions"])
    if sizes:
        assert outputs["discrete_action_output_shape"].tolist() == [list(sizes)]
        masks["action_masks"][:, 0] = 0
        assert (run(model, obs_0=array, **masks)["discrete_actions"][:, 0] > 0).all()


@pytest.mark.parametrize("player", PLAYERS)
def test_a_policy_of_the_stealth_game_needs_no_map(player: str) -> None:
    with pytest.raises(TltlError, match="TLT0844: the policy observes `map`, which is no vector"):
        to_player_onnx(policy_of(card_of("cover_and_hide")), player)
    policy = policy_of(card_of("navigation", sensors={"map": None}))
    value = observation_of(policy.card, np.random.default_rng(0), (1,))
    array = np.concatenate([value[key] for key, _ in policy.card.shapes], -1).astype(np.float32)
    key, extra = ("obs", {"state_ins": np.zeros(1, np.float32)})
    if player == "ml-agents":
        key, extra = ("obs_0", {"action_masks": np.ones((1, sum(policy.card.branches)), np.float32)})
    outputs = run(to_player_onnx(policy, player), **{key: array}, **extra)
    if player == "ml-agents":
        row = {name: values[0] for name, values in value.items()}
        assert outputs["discrete_actions"][0].tolist() == policy.choose(row).tolist()


def test_the_option_writes_the_model(tltlc: Any, tmp_path: Path) -> None:  # noqa: F811
    path = tmp_path / "bot.safetensors"
    write_policy(path, policy_of_spaces(OBSERVATION, CHOICE))
    written = tltlc("inspect", path, "-o", tmp_path / "bot.onnx", "--for", "ml-agents")
    assert written.status == 0, written.err
    texts = onnxruntime.InferenceSession(tmp_path / "bot.onnx").get_modelmeta().custom_metadata_map
    assert json.loads(texts["inputs"]) == {"obs_0": ["level[0]", "obs[0]", "obs[1]", "obs[2]"]}
    assert "--for is for the model that -o writes" in tltlc("inspect", path, "--for", "godot-rl").err
