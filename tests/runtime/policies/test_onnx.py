"""An exported policy, run by onnxruntime, equals the policy, and describes its inputs and outputs."""

from __future__ import annotations

import json

import numpy as np
import onnx
import pytest

from tests.runtime.policies.examples import card_of, observation_of, policy_of
from tltl_runtime.policies.file import read_policy
from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.policies.network import Network
from tltl_runtime.policies.onnx import to_onnx
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.shipped import shipped_policies
from tltlc.automaton.text import label_text
from tltlc.pipeline import decode_artefact

onnxruntime = pytest.importorskip("onnxruntime")


@pytest.fixture(name="policy", scope="module")
def _policy() -> Policy:
    return policy_of(card_of("cover_and_hide", network=Network()))


@pytest.fixture(name="model", scope="module")
def _model(policy: Policy) -> bytes:
    return to_onnx(policy)


def check_alike(policy: Policy, model: bytes, seeds: int) -> None:
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    session = onnxruntime.InferenceSession(model, options)
    assert [model_input.name for model_input in session.get_inputs()] == [key for key, _ in policy.card.shapes]
    for seed in range(seeds):
        for size in (1, 7):
            observation = observation_of(policy.card, np.random.default_rng(seed), (size,))
            logits, action = session.run(None, {key: values.astype(np.float32) for key, values in observation.items()})
            assert (logits.dtype, action.dtype, action.shape) == (np.float32, np.int64, (size, 5))
            for row in range(size):
                row_observation = {key: values[row] for key, values in observation.items()}
                np.testing.assert_allclose(logits[row], policy.logits(row_observation), rtol=2e-6, atol=1e-5)
                assert action[row].tolist() == policy.choose(row_observation).tolist()


def test_the_model_plays_as_the_policy(policy: Policy, model: bytes) -> None:
    check_alike(policy, model, 30)


@pytest.mark.parametrize("level", sorted(shipped_policies()))
def test_the_model_of_a_trained_policy_plays_as_the_policy(level: str) -> None:
    policy = read_policy(shipped_policies()[level])
    check_alike(policy, to_onnx(policy), 10)


@pytest.mark.parametrize(
    ("network", "map_"),
    [(Network((16,), "mish"), {"map": None}), (Network((8, 8, 8), "selu", (3,), kernel=5, stride=1), {})],
    ids=["no_map", "map"],
)
def test_other_kinds_of_networks_are_exported(network: Network, map_: dict[str, None]) -> None:
    policy = policy_of(card_of("navigation", sensors=map_, network=network))
    check_alike(policy, to_onnx(policy), 5)


def test_the_metadata_describe_inputs_and_outputs(policy: Policy, model: bytes) -> None:
    onnx_model = onnx.load_from_string(model)
    onnx.checker.check_model(onnx_model, full_check=True)
    texts = {entry.key: entry.value for entry in onnx_model.metadata_props}
    inputs, actions = json.loads(texts["inputs"]), json.loads(texts["actions"])
    shapes = dict(policy.card.shapes)
    for key, names in inputs.items():
        assert len(names) == shapes[key][0]
    assert list(inputs) == list(shapes)
    assert inputs["entities"][:4] == ["s1.x", "s1.y", "s1.z", "s2.x"]
    assert [len(action["choices"]) for action in actions] == list(policy.card.branches)
    state = policy.card.fspa.states[-1]
    assert json.loads(texts["states"])[-1] == {
        "label": str(state.label),
        "english": label_text(policy.card.fspa, state.id),
    }
    fspa = decode_artefact(json.loads(texts["card"])["artefact"], "card")
    assert fspa == policy.card.fspa
    assert texts["spec_hash"] == spec_hash(fspa)


def test_equal_policies_give_equal_models_without_paths(policy: Policy, model: bytes) -> None:
    assert to_onnx(policy) == model
    assert b".py" not in model and b"/lib/" not in model
