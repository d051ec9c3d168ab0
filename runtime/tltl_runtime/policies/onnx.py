"""Export policies to other engines as ONNX models that describe their inputs and outputs."""

from __future__ import annotations

import json
import logging
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any, Final, cast

import torch
from onnx import ModelProto
from onnx.helper import set_model_props
from torch import Tensor, nn

from tltl_runtime.game.registry import STEALTH, game_named
from tltl_runtime.policies.card import Card
from tltl_runtime.policies.file import card_json
from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.torch_actor import torch_actor
from tltlc.api import label_text, replace

SUFFIX: Final = ".onnx"

_OPSET: Final = 18


def to_onnx(policy: Policy) -> bytes:
    """Return the policy as an ONNX model. Equal policies give equal bytes.

    The inputs are the parts of an observation, named by their keys, float32 [batch, ...]. The
    outputs are ``logits``, float32 [batch, sum(branches)], the first branch first; and ``action``,
    int64 [batch, branches], the likeliest choice of each branch, the first one on ties.
    ``docs/policy-file.md`` describes the metadata.
    """
    keys = [key for key, _ in policy.card.shapes]
    batch = torch.export.Dim("batch", min=1)
    with _silence_exporter():
        program = torch.onnx.export(
            _PolicyModule(policy).eval(),
            tuple(torch.zeros(2, *shape) for _, shape in policy.card.shapes),
            dynamo=True,
            verbose=False,
            opset_version=_OPSET,
            input_names=keys,
            output_names=["logits", "action"],
            dynamic_shapes=(tuple({0: batch} for _ in keys),),
        )
    model = cast(Any, program).model_proto
    _forget_source(model)
    set_model_props(model, _metadata(policy.card))
    return bytes(model.SerializeToString(deterministic=True))


class _PolicyModule(nn.Module):
    """The policy as a module: it maps parts of observations to logits and likeliest actions."""

    def __init__(self, policy: Policy) -> None:
        super().__init__()
        self.keys = [key for key, _ in policy.card.shapes]
        self.actor = torch_actor(policy)

    def forward(self, *parts: Tensor) -> tuple[Tensor, Tensor]:
        logits = self.actor.mlp(self.actor.get_latent(dict(zip(self.keys, parts, strict=True))))
        return logits, self.actor.distribution.deterministic_output(logits).long()


def _metadata(card: Card) -> dict[str, str]:
    """Return the metadata of the model. All values but ``spec_hash`` are JSON."""
    game = game_named(STEALTH)
    names = list(game.choices.items()) if card.branches == game.branches else []
    texts = {
        "inputs": _input_names(card),
        "actions": [{"name": name, "choices": choices} for name, choices in names],
        "states": [
            {"label": str(state.label), "english": label_text(card.fspa, state.id)} for state in card.fspa.states
        ],
        # The record of the training stays in the policy file: an engine has no use for it.
        "card": card_json(replace(card, training={})),
    }
    return {"spec_hash": spec_hash(card.fspa)} | {
        key: json.dumps(text, ensure_ascii=False, allow_nan=False) for key, text in texts.items()
    }


def _input_names(card: Card) -> dict[str, list[str]]:
    """Return, for each input of the model, the names of its entries along the axis after the batch."""
    sensors = card.sensors
    names: Mapping[str, list[str]] = {
        "automaton": [f"state {state.id}" for state in card.fspa.states],
        "progress": ["progress"],
        "entities": [f"{name}.{axis}" for name in sensors.entities for axis in "xyz"],
        "variables": list(sensors.variables),
        "map": list(sensors.map.types) if sensors.map else [],
    }
    return {key: names[key] for key, _ in card.shapes}


def _forget_source(model: ModelProto) -> None:
    """Remove from an ONNX model the metadata that names the source files of each node."""
    for part in (*model.graph.node, *model.graph.value_info, *model.graph.input, *model.graph.output):
        part.ClearField("metadata_props")
        part.ClearField("doc_string")
    model.graph.ClearField("metadata_props")
    model.graph.ClearField("doc_string")


@contextmanager
def _silence_exporter() -> Iterator[None]:
    """Silence the messages of torch's exporter within this context.

    Nobody needs them: tests check the exported model.
    """
    log = logging.getLogger("torch.onnx")
    before = log.level
    log.setLevel(logging.ERROR)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        log.setLevel(before)
