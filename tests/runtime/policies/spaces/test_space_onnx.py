"""An exported policy of any spaces, run by onnxruntime, equals the policy."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import onnx
import pytest
from gymnasium import spaces

from tests.runtime.policies.spaces.space_policies import policy_of_spaces
from tests.runtime.policies.spaces.test_space_policy import GRID, MIXED
from tltl_runtime.policies.onnx import to_onnx
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.spaces.values import flat_action, observation_arrays

onnxruntime = pytest.importorskip("onnxruntime")

CASES: dict[str, tuple[spaces.Space[Any], spaces.Space[Any]]] = {
    "grid and numbers": (GRID, MIXED),
    "image": (spaces.Box(0, 255, (36, 40, 3), np.uint8), spaces.Discrete(4)),
    "bits": (
        spaces.Tuple((spaces.MultiBinary(3), spaces.Box(0, 1, (3, 12, 11), np.uint8))),
        spaces.Box(np.array([-1.0, 0.0, -np.inf]), np.array([2.0, np.inf, np.inf]), dtype=np.float64),
    ),
    "keys of outputs": (
        spaces.Dict({"action": spaces.Discrete(3), "logits": spaces.MultiDiscrete([2, 5])}),
        spaces.Tuple((spaces.MultiBinary(2), spaces.Discrete(3, start=-1))),
    ),
}


@pytest.fixture(name="exported", scope="module", params=CASES)
def _exported(request: pytest.FixtureRequest) -> tuple[Policy, spaces.Space[Any], bytes]:
    observation, action = CASES[request.param]
    policy = policy_of_spaces(observation, action, 3)
    return policy, observation, to_onnx(policy)


def test_the_model_plays_as_the_policy(exported: tuple[Policy, spaces.Space[Any], bytes]) -> None:
    policy, observation, model = exported
    layouts = policy.card.spaces
    assert layouts is not None
    session = onnxruntime.InferenceSession(model)
    inputs = [part.name for part in session.get_inputs()]
    names = [part.name for part in session.get_outputs()]
    observation.seed(0)
    for size in (1, 5):
        seen = [observation.sample() for _ in range(size)]
        rows = [observation_arrays(layouts.observation, value) for value in seen]
        parts = [np.stack([row[key] for row in rows]).astype(np.float32) for key in rows[0]]
        outputs = dict(zip(names, session.run(None, dict(zip(inputs, parts, strict=True))), strict=True))
        raw = np.concatenate([outputs[name] for name in ("logits", "means") if name in outputs], -1)
        flat = np.concatenate([outputs[name] for name in ("action", "numbers") if name in outputs], -1)
        for row, value in enumerate(seen):
            np.testing.assert_allclose(raw[row], policy.logits(value), rtol=1e-4, atol=1e-4)
            expected = flat_action(layouts.action, policy.choose(value))
            np.testing.assert_allclose(flat[row], expected, rtol=1e-4, atol=1e-4)


def test_the_metadata_describe_inputs_and_outputs(exported: tuple[Policy, spaces.Space[Any], bytes]) -> None:
    policy, _, model = exported
    layouts = policy.card.spaces
    assert layouts is not None
    onnx_model = onnx.load_from_string(model)
    onnx.checker.check_model(onnx_model, full_check=True)
    texts = {entry.key: entry.value for entry in onnx_model.metadata_props}
    assert len(json.loads(texts["actions"])) == layouts.action.width
    assert [*json.loads(texts["inputs"])] == [part.name for part in onnx_model.graph.input]
    if layouts.action.number_count:
        assert len(json.loads(texts["deviations"])) == layouts.action.number_count


def test_entries_of_inputs_and_actions_have_names() -> None:
    model = onnx.load_from_string(to_onnx(policy_of_spaces(GRID, MIXED)))
    texts = {entry.key: entry.value for entry in model.metadata_props}
    assert json.loads(texts["inputs"]) == {
        "body/0": ["body/0[0]", "body/0[1]"],
        "body/1": ["body/1[0]"],
        "direction": ["direction[0]"],
        "image": [],
    }
    assert json.loads(texts["actions"]) == [
        {"name": "use", "choices": ["1", "2", "3"]},
        {"name": "go[0]", "low": -2.0, "high": 5.0},
        {"name": "go[1]", "low": -2.0, "high": 5.0},
    ]


def test_an_input_does_not_have_the_name_of_an_output() -> None:
    model = onnx.load_from_string(to_onnx(policy_of_spaces(*CASES["keys of outputs"])))
    assert [part.name for part in model.graph.input] == ["observation/action", "observation/logits"]
    assert [part.name for part in model.graph.output] == ["logits", "action"]
