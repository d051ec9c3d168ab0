"""Export policies as ONNX models with the names that the players of two other trainers expect.

Facts, from their public sources:

- Godot RL Agents (``addons/godot_rl_agents/onnx/csharp/ONNXInference.cs`` and ``sync.gd`` of its plugin): the inputs
  are ``obs``, float32 [batch, numbers], and ``state_ins``, float32 [batch], the outputs ``output`` and ``state_outs``.
  ``output`` has, for each action in the order of ``get_action_space``, the logits of a discrete one or the numbers of
  a continuous one. The player chooses the greatest logit above 0, or else the first choice, so the logits are moved
  above 0 here.
- ML-Agents (``TensorNames.cs`` and the model loader of ``com.unity.ml-agents``, version 3 of its models): the inputs
  are ``obs_0``, ``obs_1`` and so on, float32 [batch, numbers], one for each sensor, and ``action_masks``, float32
  [batch, choices], 1 for each choice that is allowed. The outputs are ``version_number`` (3), ``memory_size`` (0), and
  for each kind of actions, ``continuous`` and ``discrete``: ``KIND_actions``, ``KIND_action_output_shape`` and
  ``deterministic_KIND_actions``.

Such a player knows only the observation of the game. A game therefore appends what the monitor of the spec says: the
observation that a model takes has all parts of the policy's observation one after the other.
"""

from __future__ import annotations

import json
from math import prod
from typing import Final

import torch
from torch import Tensor, nn

from tltl_runtime.policies.card import Card
from tltl_runtime.policies.onnx import exported, metadata, output_names, policy_module
from tltl_runtime.policies.policy import Policy
from tltlc.api import Diagnostic, TltlError

GODOT_RL: Final = "godot-rl"
ML_AGENTS: Final = "ml-agents"
PLAYERS: Final = (GODOT_RL, ML_AGENTS)
"""The names of the players."""

_VERSION: Final = 3.0
_MASKED: Final = -1e8


def to_player_onnx(policy: Policy, player: str) -> bytes:
    """Return the policy as an ONNX model for one of :data:`PLAYERS`, which plays its likeliest actions.

    The metadata are those of :func:`~tltl_runtime.policies.onnx.to_onnx`, but ``inputs`` has one entry.

    Raises:
        TltlError: TLT0844, a part of the observation is no vector.
    """
    card = policy.card
    for key, shape in card.shapes:
        if len(shape) != 1:
            title = f"the policy observes `{key}`, which is no vector, and the players of {player} get vectors"
            raise TltlError(
                [Diagnostic("TLT0844", title, help="train an agent that does not observe it, or export without --for")]
            )
    texts = metadata(policy)
    names = [name for part in json.loads(texts["inputs"]).values() for name in part]
    key = "obs" if player == GODOT_RL else "obs_0"
    texts["inputs"] = json.dumps({key: names}, ensure_ascii=False)
    seen = torch.zeros(2, sum(prod(shape) for _, shape in card.shapes))
    if player == GODOT_RL:
        return exported(
            _GodotRlModule(policy), {key: seen, "state_ins": torch.zeros(2)}, ["output", "state_outs"], texts
        )
    module = _MlAgentsModule(policy)
    masks = {"action_masks": torch.ones(2, sum(module.sizes))} if module.sizes else {}
    return exported(module, {key: seen, **masks}, module.names, texts)


class _FlatModule(nn.Module):
    """A policy whose observation is one vector."""

    def __init__(self, policy: Policy) -> None:
        super().__init__()
        self.widths = [shape[0] for _, shape in policy.card.shapes]
        self.policy = policy_module(policy)
        self.outputs = output_names(policy.card)
        self.sizes = _sizes(policy.card)

    def results(self, seen: Tensor) -> dict[str, Tensor]:
        """Return the outputs of the policy by name."""
        return dict(zip(self.outputs, self.policy(*seen.split(self.widths, dim=-1)), strict=True))


class _GodotRlModule(_FlatModule):
    def __init__(self, policy: Policy) -> None:
        super().__init__(policy)
        spaces = policy.card.spaces
        parts = [] if spaces is None else [(sum(part.sizes), len(part.low)) for part in spaces.action.parts]
        self.parts = parts or [(sum(self.sizes), 0)]

    def forward(self, obs: Tensor, state_ins: Tensor) -> tuple[Tensor, Tensor]:
        results = self.results(obs)
        columns, logits, numbers = [], 0, 0
        for choices, count in self.parts:
            if choices:
                part = results["logits"][:, logits : logits + choices]
                columns.append(part - part.amin(-1, keepdim=True) + 1.0)
            else:
                columns.append(results["numbers"][:, numbers : numbers + count])
            logits, numbers = logits + choices, numbers + count
        return torch.cat(columns, -1), state_ins * 1.0


class _MlAgentsModule(_FlatModule):
    version: Tensor
    memory: Tensor
    number_shape: Tensor
    choice_shape: Tensor

    def __init__(self, policy: Policy) -> None:
        super().__init__(policy)
        spaces = policy.card.spaces
        self.number_count = 0 if spaces is None else spaces.action.number_count
        kinds = ["continuous"] * bool(self.number_count) + ["discrete"] * bool(self.sizes)
        self.names = ["version_number", "memory_size"]
        for kind in kinds:
            self.names += [f"{kind}_actions", f"{kind}_action_output_shape", f"deterministic_{kind}_actions"]
        self.register_buffer("version", torch.tensor([_VERSION]))
        self.register_buffer("memory", torch.tensor([0.0]))
        self.register_buffer("number_shape", torch.tensor([float(self.number_count)]))
        self.register_buffer("choice_shape", torch.tensor([[float(size) for size in self.sizes]]))

    def forward(self, seen: Tensor, masks: Tensor | None = None) -> tuple[Tensor, ...]:
        results = self.results(seen)
        outputs: tuple[Tensor, ...] = (self.version * 1.0, self.memory * 1.0)
        if self.number_count:
            outputs += (results["numbers"], self.number_shape * 1.0, results["numbers"] * 1.0)
        if masks is not None:
            allowed = results["logits"] + (1.0 - masks) * _MASKED
            choices = torch.stack([part.argmax(-1) for part in allowed.split(self.sizes, dim=-1)], -1)
            outputs += (choices, self.choice_shape * 1.0, choices * 1)
        return outputs


def _sizes(card: Card) -> list[int]:
    return list(card.branches if card.spaces is None else card.spaces.action.sizes)
