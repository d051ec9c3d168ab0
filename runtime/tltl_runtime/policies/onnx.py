"""Export policies to other engines as ONNX models that describe their inputs and outputs."""

from __future__ import annotations

import json
import logging
import math
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, Final, cast

import numpy as np
import torch
from onnx import ModelProto
from onnx.helper import set_model_props
from torch import Tensor, nn

from tltl_runtime.game.registry import STEALTH, game_named
from tltl_runtime.policies.card import Card
from tltl_runtime.policies.file import card_json
from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.spaces.action_layout import ActionLayout
from tltl_runtime.policies.spaces.layouts import SpaceLayouts
from tltl_runtime.policies.spaces.refusals import name_of
from tltl_runtime.policies.spaces.space_actor import deviations
from tltl_runtime.policies.torch_actor import torch_actor
from tltl_runtime.spec.automaton_observation import automaton_entries
from tltlc.api import label_text, replace

SUFFIX: Final = ".onnx"

_OPSET: Final = 18


def to_onnx(policy: Policy) -> bytes:
    """Return the policy as an ONNX model. Equal policies give equal bytes.

    The inputs are the parts of an observation, float32 [batch, ...], named by their keys. An input
    whose key is also the name of an output is named ``observation/KEY``. The outputs are:

    - ``logits``, float32 [batch, sum(branches)], of all choices, those of the first branch first;
    - ``action``, int64 [batch, branches], the likeliest choice of each branch, counted from 0; on
      ties, the first;
    - ``means``, float32 [batch, numbers], the means of the continuous numbers of an action, before
      they are squashed to their bounds;
    - ``numbers``, float32 [batch, numbers], the means after they are squashed.

    A model lacks the first two outputs if an action has no choices, and the last two if it has no
    numbers. ``docs/policy-file.md`` describes the metadata.
    """
    card = policy.card
    inputs = {name: torch.zeros(2, *shape) for name, (_, shape) in zip(_model_inputs(card), card.shapes, strict=True)}
    return exported(policy_module(policy), inputs, output_names(card), metadata(policy), is_variadic=True)


def exported(
    module: nn.Module,
    inputs: Mapping[str, Tensor],
    outputs: Sequence[str],
    texts: Mapping[str, str],
    *,
    is_variadic: bool = False,
) -> bytes:
    """Return a torch module as an ONNX model.

    ``inputs`` are examples of its arguments by name, each with a batch of any size as its first axis. ``outputs`` are
    the names of its results, and ``texts`` the metadata. ``is_variadic`` says that ``forward`` takes ``*parts``.
    """
    batch = torch.export.Dim("batch", min=1)
    dynamic: tuple[Any, ...] = tuple({0: batch} for _ in inputs)
    with _silence_exporter():
        program = torch.onnx.export(
            module.eval(),
            tuple(inputs.values()),
            dynamo=True,
            verbose=False,
            opset_version=_OPSET,
            input_names=list(inputs),
            output_names=list(outputs),
            dynamic_shapes=(dynamic,) if is_variadic else dynamic,
        )
    model = cast(Any, program).model_proto
    _forget_source(model)
    set_model_props(model, dict(texts))
    return bytes(model.SerializeToString(deterministic=True))


def policy_module(policy: Policy) -> nn.Module:
    """Return a policy as a torch module, from the parts of an observation to the outputs of :func:`output_names`."""
    layouts = policy.card.spaces
    return _PolicyModule(policy) if layouts is None else _SpacePolicyModule(policy, layouts)


def output_names(card: Card) -> list[str]:
    """Return the names of the outputs of a policy's module, in order."""
    if card.spaces is None:
        return ["logits", "action"]
    action = card.spaces.action
    return ["logits", "action"] * bool(action.sizes) + ["means", "numbers"] * bool(action.number_count)


def _model_inputs(card: Card) -> list[str]:
    """Return the names of the model's inputs, in the order of the card's shapes.

    A name is the key of a part of the observation. If it is also the name of an output, or the name
    of another input, ``observation/`` is put before it.
    """
    taken = {*output_names(card), *(key for key, _ in card.shapes)}
    names = []
    for key, _ in card.shapes:
        name = key
        while name in output_names(card) or (name != key and name in taken):
            name = f"observation/{name}"
        names.append(name)
    return names


class _PolicyModule(nn.Module):
    """A policy as a torch module: it maps the parts of observations to logits and likeliest actions."""

    def __init__(self, policy: Policy) -> None:
        super().__init__()
        self.keys = [key for key, _ in policy.card.shapes]
        self.actor = torch_actor(policy)

    def forward(self, *parts: Tensor) -> tuple[Tensor, Tensor]:
        logits = self.actor.mlp(self.actor.get_latent(dict(zip(self.keys, parts, strict=True))))
        return logits, self.actor.distribution.deterministic_output(logits).long()


class _SpacePolicyModule(nn.Module):
    """A policy for spaces of any kind as a torch module; :func:`output_names` lists its outputs."""

    def __init__(self, policy: Policy, layouts: SpaceLayouts) -> None:
        super().__init__()
        self.keys = [key for key, _ in policy.card.shapes]
        self.actor = torch_actor(policy)
        self.sizes, self.number_count = list(layouts.action.sizes), layouts.action.number_count
        bounds = [(low, high) for low, high in layouts.action.bounds]
        self.low = torch.tensor([-math.inf if low is None else low for low, _ in bounds])
        self.high = torch.tensor([math.inf if high is None else high for _, high in bounds])
        self.is_bounded = torch.tensor([low is not None and high is not None for low, high in bounds])

    def forward(self, *parts: Tensor) -> tuple[Tensor, ...]:
        outputs = self.actor.mlp(self.actor.get_latent(dict(zip(self.keys, parts, strict=True))))
        logits, means = outputs.split([sum(self.sizes), self.number_count], dim=-1)
        results: tuple[Tensor, ...] = ()
        if self.sizes:
            results += (logits, torch.stack([part.argmax(-1) for part in logits.split(self.sizes, dim=-1)], -1))
        return (*results, means, self._squashed(means)) if self.number_count else results

    def _squashed(self, means: Tensor) -> Tensor:
        """Squash numbers to their bounds, like :func:`~tltl_runtime.policies.spaces.values.squashed`."""
        zero = torch.zeros(())
        low, high = (torch.where(self.is_bounded, bound, zero) for bound in (self.low, self.high))
        numbers = torch.where(self.is_bounded, low + (high - low) * (means.tanh() + 1) / 2, means)
        return numbers.maximum(self.low).minimum(self.high)


def metadata(policy: Policy) -> dict[str, str]:
    """Return the metadata of the model, by name. All values except ``spec_hash`` are JSON texts."""
    card = policy.card
    texts = {
        "inputs": dict(zip(_model_inputs(card), _entry_names(card), strict=True)),
        "actions": _choices(card) if card.spaces is None else [*_action_entries(card.spaces.action)],
        "states": [
            {"label": str(state.label), "english": label_text(card.fspa, state.id)} for state in card.fspa.states
        ],
        # The record of the training stays in the policy file: an engine has no use for it.
        "card": card_json(replace(card, training={})),
    }
    if card.spaces is not None and card.spaces.action.number_count:
        texts["deviations"] = deviations(policy.weights()).tolist()
    return {"spec_hash": spec_hash(card.fspa)} | {
        key: json.dumps(text, ensure_ascii=False, allow_nan=False) for key, text in texts.items()
    }


def _choices(card: Card) -> list[dict[str, Any]]:
    """Return the name of each branch of an action, with the names of its choices.

    Only the branches of the stealth game have names; for other branches the list is empty.
    """
    game = game_named(STEALTH)
    names = game.choices.items() if card.branches == game.branches else ()
    return [{"name": name, "choices": choices} for name, choices in names]


def _action_entries(layout: ActionLayout) -> Iterator[dict[str, Any]]:
    """Yield an entry for each component of an action, choices first: its name, with its choices or bounds."""
    for part in sorted(layout.parts, key=lambda part: part.kind == "numbers"):
        names = _element_names(name_of(part.path) or "action", part.shape)
        if part.kind == "numbers":
            for name, low, high in zip(names, part.low, part.high, strict=True):
                yield {"name": name, "low": low, "high": high}
        else:
            for name, size, start in zip(names, part.sizes, part.starts, strict=True):
                yield {"name": name, "choices": [str(start + choice) for choice in range(size)]}


def _element_names(name: str, shape: tuple[int, ...]) -> list[str]:
    """Return a name such as ``go[0][1]`` for each element of an array; for a scalar, ``name`` itself."""
    return [name + "".join(f"[{index}]" for index in indices) for indices in np.ndindex(*shape)]


def _entry_names(card: Card) -> list[list[str]]:
    """Return a list for each input of the model: the names of its entries along the axis after the batch.

    The list is empty for images and grids, except for the map of the stealth game, whose channels
    have names.
    """
    sensors = card.sensors
    names: dict[str, list[str]] = {
        "automaton": [*automaton_entries(card.fspa)],
        "progress": ["progress"],
    }
    if card.spaces is None:
        names["entities"] = [f"{name}.{axis}" for name in sensors.entities for axis in "xyz"]
        names["variables"] = list(sensors.variables)
        names["map"] = list(sensors.map.types) if sensors.map else []
        return [names[key] for key, _ in card.shapes]
    unnamed = {key: _element_names(key, shape) if len(shape) == 1 else [] for key, shape in card.shapes}
    return [names.get(key, entries) for key, entries in unnamed.items()]


def _forget_source(model: ModelProto) -> None:
    """Remove the metadata of an ONNX model that says from which source files its nodes come."""
    for part in (*model.graph.node, *model.graph.value_info, *model.graph.input, *model.graph.output):
        part.ClearField("metadata_props")
        part.ClearField("doc_string")
    model.graph.ClearField("metadata_props")
    model.graph.ClearField("doc_string")


@contextmanager
def _silence_exporter() -> Iterator[None]:
    """Silence the messages of torch's exporter inside the ``with`` block.

    They help no user, and tests check the exported model.
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
