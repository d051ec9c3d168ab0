"""Policy files: policies are read as they were written, and other content is rejected with a clear message."""

from __future__ import annotations

import json
import os
import random
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from safetensors import safe_open
from safetensors.torch import load, save

from tests.runtime.policies.examples import card_of, observation_of, policy_of
from tltl_runtime.policies.file import MAX_BYTES, check_size, from_bytes, read_policy, to_bytes, write_policy
from tltl_runtime.policies.network import Network
from tltl_runtime.policies.policy import NotFiniteError, Policy
from tltl_runtime.policies.torch_actor import arrays, new_actor
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.diagnostics.render import render

GOLDEN = Path(__file__).parents[2] / "golden" / "policy"


@pytest.fixture(name="policy", scope="module")
def _policy() -> Policy:
    return policy_of(card_of("branching", "v1"))


@settings(max_examples=10, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    level=st.sampled_from(("navigation", "cover_and_hide", "branching")),
    map_=st.sampled_from(({}, {"map": None})),
    hidden=st.lists(st.integers(1, 40), min_size=1, max_size=3),
    activation=st.sampled_from(("elu", "relu", "tanh")),
    seed=st.integers(0, 2**30),
)
def test_a_policy_is_read_unchanged_and_plays_the_same(
    level: str, map_: dict[str, None], hidden: list[int], activation: Any, seed: int
) -> None:
    policy = policy_of(card_of(level, sensors=map_, network=Network(tuple(hidden), activation)), seed)
    data = to_bytes(policy)
    again = from_bytes(data, "it")
    assert again.card == policy.card
    assert to_bytes(again) == data
    rng = np.random.default_rng(seed)
    for _ in range(5):
        observation = observation_of(policy.card, rng)
        assert again.logits(observation).tobytes() == policy.logits(observation).tobytes()


def test_a_policy_that_is_too_large_to_be_read_is_not_written(
    policy: Policy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, card = tmp_path / "policy.safetensors", policy.card
    size = len(to_bytes(policy))
    monkeypatch.setattr("tltl_runtime.policies.file.MAX_BYTES", size - 1)
    with pytest.raises(TltlError, match="TLT0862: `network` gives a policy of 1 MiB"):
        write_policy(path, policy)
    assert not path.exists()
    monkeypatch.setattr("tltl_runtime.policies.file._RECORD_BYTES", 10_000)
    with pytest.raises(TltlError, match="TLT0862"):
        check_size(card.network, card.fspa, card.sensors)
    monkeypatch.setattr("tltl_runtime.policies.file.MAX_BYTES", size + 10_000)
    check_size(card.network, card.fspa, card.sensors)


def test_convolutions_that_do_not_fit_the_map_are_refused(policy: Policy) -> None:
    card, network = policy.card, replace(policy.card.network, kernel=1, stride=8)
    with pytest.raises(TltlError, match=r"TLT0862.*a kernel of 1 and a stride of 8 do not fit a map that is"):
        check_size(network, card.fspa, card.sensors)
    check_size(replace(network, stride=1), card.fspa, card.sensors)


def test_a_policy_copies_its_weights_in_half_precision(policy: Policy) -> None:
    actor = new_actor(policy.card)
    new_policy = Policy(policy.card, arrays(actor.state_dict()))
    before = to_bytes(new_policy)
    with torch.no_grad():
        for weight in actor.parameters():
            weight.add_(1.0)
    assert to_bytes(new_policy) == before
    for name, weight in new_actor(policy.card).state_dict().items():
        kept = new_policy.weights()[name]
        assert (kept.dtype, kept.shape) == (np.float16, tuple(weight.shape))


def test_making_and_reading_policies_uses_no_random_numbers(policy: Policy) -> None:
    state = torch.get_rng_state()
    from_bytes(to_bytes(Policy(policy.card, policy.weights())), "it")
    assert torch.equal(torch.get_rng_state(), state)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), 1e6])
def test_weights_outside_half_precision_are_rejected(policy: Policy, value: float) -> None:
    actor = new_actor(policy.card)
    with torch.no_grad():
        actor.mlp[0].bias[3] = value
    with pytest.raises(NotFiniteError, match="not a finite number in half precision"):
        Policy(policy.card, arrays(actor.state_dict()))


def test_weights_of_another_network_are_rejected(policy: Policy) -> None:
    other_card = replace(policy.card, network=Network(hidden=(7,)))
    with pytest.raises(ValueError, match="not those of the network"):
        Policy(other_card, policy.weights())


def test_a_file_is_written_without_temporary_files(tmp_path: Path, policy: Policy) -> None:
    path = tmp_path / "bot.safetensors"
    write_policy(path, policy)
    assert [file.name for file in tmp_path.iterdir()] == [path.name]
    assert read_policy(path).card == policy.card
    with pytest.raises(TltlError, match="TLT0005"):
        write_policy(tmp_path / "nowhere" / "bot.safetensors", policy)
    with pytest.raises(TltlError, match="TLT0001"):
        read_policy(tmp_path / "none.safetensors")


def test_safetensors_alone_reads_a_policy_file(tmp_path: Path, policy: Policy) -> None:
    write_policy(tmp_path / "bot.safetensors", policy)
    with safe_open(tmp_path / "bot.safetensors", framework="np") as file:
        card = json.loads(file.metadata()["card"])
        weights = file.get_tensor("actor.mlp.0.weight")
    assert weights.dtype == np.float16
    assert np.array_equal(weights, policy.weights()["mlp.0.weight"])
    assert (card["format"], card["version"], card["level"]) == ("tltl-policy", 1, "branching")
    assert card["artefact"]["spec"]["name"] == "branching"


def test_a_record_that_is_not_json_is_rejected(policy: Policy) -> None:
    with pytest.raises(ValueError, match="JSON"):
        to_bytes(Policy(replace(policy.card, training={"loss": float("nan")}), policy.weights()))


# --- untrusted files --------------------------------------------------------------------------------

Change = Callable[[dict[str, torch.Tensor], dict[str, Any]], Any]


def edited(policy: Policy, change: Change) -> bytes:
    data = to_bytes(policy)
    tensors = dict(load(data))
    card = json.loads(header_of(data)["__metadata__"]["card"])
    text = change(tensors, card)
    return save(tensors, {"card": text if isinstance(text, str) else json.dumps(card)})


def header_of(data: bytes) -> dict[str, Any]:
    header: dict[str, Any] = json.loads(data[8 : 8 + int.from_bytes(data[:8], "little")])
    return header


def with_header(header: bytes, rest: bytes = b"") -> bytes:
    return len(header).to_bytes(8, "little") + header + rest


def message_of_refusal(data: bytes) -> str:
    with pytest.raises(TltlError) as caught:
        from_bytes(data, "bot.safetensors")
    (diagnostic,) = caught.value.diagnostics
    return render([diagnostic])


def set_card(**fields: Any) -> Change:
    return lambda _, card: card.update(fields)


def network(**fields: Any) -> Change:
    return lambda _, card: card["network"].update(fields)


def widen(card: dict[str, Any], extent: int) -> None:
    """Change the extent of the map consistently in sensors and shapes."""
    card["sensors"]["map"]["extent"] = extent
    shapes = dict(card["shapes"])
    shapes["map"][1:] = [extent, extent]
    card["shapes"] = list(shapes.items())


def without_types(card: dict[str, Any]) -> None:
    """Let the map have no channels, consistently in sensors and shapes."""
    card["sensors"]["map"]["types"] = []
    shapes = dict(card["shapes"])
    shapes["map"][0] = 0
    card["shapes"] = list(shapes.items())


def tensor(name: str, change: Callable[[torch.Tensor], torch.Tensor]) -> Change:
    return lambda tensors, _: tensors.update({name: change(tensors[name])})


def with_value(value: float) -> Callable[[torch.Tensor], torch.Tensor]:
    def spoil(weights: torch.Tensor) -> torch.Tensor:
        copy = weights.clone()
        copy.view(-1)[-1] = value
        return copy

    return spoil


BIAS = "actor.mlp.0.bias"


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (set_card(format="other"), "TLT0840.*the weights of something else"),
        (lambda *_: "[]", "TLT0840.*the weights of something else"),
        (lambda *_: "{", "TLT0842.*its card is not JSON"),
        (lambda *_: "[" * 100_000, "TLT0842.*its card is not JSON"),
        (set_card(version=2), "TLT0841.*version 2.*use a newer tltlc"),
        (set_card(version=0), "TLT0841.*version 0.*train the policy again"),
        (set_card(version=True), "TLT0841.*version True"),
        (set_card(level=3), "TLT0842.*`card.level` is 3, but a text was expected"),
        (set_card(more=3), "TLT0842.*`more`"),
        (lambda _, card: card.__delitem__("sensors"), "TLT0842.*lacks the key `sensors`"),
        (set_card(level_hash="x"), "TLT0842.*`card.level_hash` is not a hash"),
        (set_card(params={"level_size": float("nan")}), "TLT0842.*`card.params.level_size` is nan"),
        (set_card(training={"curve": [[1, float("inf")]]}), r"TLT0842.*`card.training.curve\[0\]\[1\]` is inf"),
        (set_card(artefact=None), "TLT0601"),
        (set_card(artefact={"format": "fspa", "version": 9}), "TLT0602"),
        (
            set_card(artefact={"format": "fspa", "version": float("nan")}),
            "TLT0601.*`bot.safetensors/artefact` is not JSON: NaN is not a finite number",
        ),
        (set_card(fspa=3), "TLT0842.*`fspa`"),
        (set_card(branches=[]), "TLT0842.*`card.branches`"),
        (set_card(branches=[3, 3, 2, 2, 0]), "TLT0842.*`card.branches`"),
        (set_card(branches=[10**9]), "TLT0842.*`card.branches`"),
        (set_card(branches=[3, 3, 2, 2, 3]), r"TLT0842.*`actor.mlp.4.bias` is F16 of shape \[12\], not .*\[13\]"),
        (set_card(shapes=[]), "TLT0842.*`card.shapes`"),
        (set_card(shapes=[["automaton", [6]], ["progress", [1]]]), "TLT0842.*not those of its spec and its sensors"),
        (lambda _, card: card["shapes"].append(["progress", [1]]), "TLT0842.*`card.shapes`"),
        (lambda _, card: card["sensors"]["map"].update(extent=10**9), "TLT0842.*`card.shapes`"),
        (lambda _, card: widen(card, 10**9), "TLT0842.*`card.shapes`"),
        (lambda _, card: widen(card, -1), "TLT0842.*`card.shapes`"),
        (lambda _, card: widen(card, 0), "TLT0842.*`card.shapes`"),
        (lambda _, card: without_types(card), "TLT0842.*`card.shapes`"),
        (network(hidden=[]), "TLT0842.*`card.network`: hidden must be 1 to 16 layers"),
        (network(hidden=[10**9]), "TLT0842.*`card.network`: hidden"),
        (network(hidden=[1] * 10**5), "TLT0842.*`card.network`: hidden"),
        (network(hidden=[16_384] * 16), "TLT0842.*`actor.mlp.0.bias`"),
        (network(activation="eval"), "TLT0842.*activation"),
        (network(kernel=0), "TLT0842.*kernel"),
        (network(stride=0), "TLT0842.*stride"),
        (lambda tensors, _: tensors.__delitem__(BIAS), f"TLT0842.*the tensor `{BIAS}` is missing"),
        (lambda tensors, _: tensors.update(more=torch.zeros(1)), "TLT0842.*does not use the tensor"),
        (tensor(BIAS, lambda values: values.float()), f"TLT0842.*`{BIAS}` is F32"),
        (tensor(BIAS, lambda values: values[:-1].clone()), f"TLT0842.*`{BIAS}` is F16 of shape"),
        (tensor(BIAS, with_value(float("nan"))), f"TLT0842.*`{BIAS}` has values that are not finite numbers"),
        (tensor(BIAS, with_value(float("-inf"))), f"TLT0842.*`{BIAS}` has values"),
    ],
)
def test_an_edited_file_is_rejected_with_the_reason(policy: Policy, change: Change, text: str) -> None:
    assert re.search(text, message_of_refusal(edited(policy, change)), re.DOTALL)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\x80\x04\x95",
        b"\xff" * 8,
        (1 << 62).to_bytes(8, "little") + b"{}",
        with_header(b"[]"),
        with_header(b"{}"),
        with_header(b'{"__metadata__": []}'),
        with_header(b'{"a":' * 100_000),
        with_header(b"\xff\xfe"),
    ],
)
def test_data_that_is_no_policy_is_rejected(data: bytes) -> None:
    assert "TLT0840" in message_of_refusal(data)


def test_data_that_is_larger_than_any_policy_is_rejected() -> None:
    assert "TLT0840" in message_of_refusal(b"\0" * (MAX_BYTES + 1))


def test_a_truncated_file_is_rejected(policy: Policy) -> None:
    data = to_bytes(policy)
    for end in (*range(60), *random.Random(1).sample(range(len(data)), 60), len(data) - 1):
        assert "TLT0840" in message_of_refusal(data[:end])
    assert "TLT0840" in message_of_refusal(data + b"\0")


@pytest.mark.parametrize("offsets", [[0, 2], [-1, 3], [10**30, 10**30 + 2], "x", None])
def test_overlapping_or_outside_tensors_are_rejected(policy: Policy, offsets: Any) -> None:
    data = to_bytes(policy)
    header = header_of(data)
    header[BIAS]["data_offsets"] = offsets
    rest = data[8 + int.from_bytes(data[:8], "little") :]
    assert "TLT0840" in message_of_refusal(with_header(json.dumps(header).encode(), rest))


@settings(
    max_examples=100, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture]
)
@given(data=st.data())
def test_a_changed_byte_is_rejected_or_gives_a_valid_policy(policy: Policy, data: st.DataObject) -> None:
    written = bytearray(to_bytes(policy))
    length = 8 + int.from_bytes(written[:8], "little")
    place = data.draw(st.one_of(st.integers(0, length - 1), st.integers(0, len(written) - 1)))
    written[place] ^= data.draw(st.integers(1, 255))
    try:
        read = from_bytes(bytes(written), "it")
    except TltlError:
        return
    assert np.isfinite(read.logits(observation_of(read.card, np.random.default_rng(0)))).all()


# --- messages ---------------------------------------------------------------------------------------

MESSAGES: dict[str, Callable[[Policy], str]] = {
    "TLT0840": lambda policy: message_of_refusal(to_bytes(policy)[:-40]),
    "TLT0840_other": lambda policy: message_of_refusal(save({"weight": torch.zeros(2)})),
    "TLT0841": lambda policy: message_of_refusal(edited(policy, set_card(version=2))),
    "TLT0842": lambda policy: message_of_refusal(edited(policy, tensor(BIAS, with_value(float("nan"))))),
    "TLT0842_card": lambda policy: message_of_refusal(edited(policy, set_card(level=3))),
}


@pytest.mark.parametrize("name", MESSAGES)
def test_an_invalid_file_gives_the_expected_message(policy: Policy, name: str) -> None:
    message, expected = MESSAGES[name](policy), GOLDEN / f"{name}.txt"
    if os.environ.get("UPDATE_GOLDEN") == "1":
        expected.write_text(message, encoding="utf-8")
    assert message == expected.read_text(encoding="utf-8")
