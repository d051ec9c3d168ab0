"""Take up a checkpoint whose tensors fit the networks, optimisers and generators of the training, and no other."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import torch
from torch import Tensor, nn
from torch.optim import Optimizer

from tltl_runtime.record_json import RecordJsonError
from tltl_runtime.training.checkpoint import Checkpoint
from tltl_runtime.training.runner import Runner

_NETWORK: Final = "_state_dict"
"""The end of the names under which an algorithm saves its networks and optimisers."""


def take_up(checkpoint: Checkpoint, runner: Runner) -> None:
    """Give a new runner the weights and the optimisers of a checkpoint.

    Raises RecordJsonError where they do not fit, or where a process could not go on with its random numbers.
    """
    made = runner.alg.save()
    for name, wanted in made.items():
        if name not in checkpoint.algorithm:
            raise RecordJsonError(f"it lacks a part: '{name}'")
        if name.endswith(_NETWORK) and all(isinstance(each, Tensor) for each in wanted.values()):
            _check_weights(checkpoint.algorithm[name], wanted, f"algorithm.{name}")
    if checkpoint.best:
        _check_weights(checkpoint.best.actor, made["actor_state_dict"], "best.actor")
    for own in checkpoint.processes:
        _check_generators(own, runner.device)
    optimizers = [each for each in vars(runner.alg).values() if isinstance(each, Optimizer)]
    options = [_options(each) for each in optimizers]
    try:
        runner.take_up(checkpoint.algorithm)
    except (AttributeError, IndexError, KeyError, RuntimeError, TypeError, ValueError) as error:
        raise RecordJsonError(f"its `algorithm` is damaged ({type(error).__name__})") from None
    for before, each in zip(options, optimizers, strict=True):
        # A newer torch may have written more of them.
        if not all(group.items() <= now.items() for group, now in zip(before, _options(each), strict=True)):
            raise RecordJsonError("an optimizer in it has other options")
    for each in optimizers:
        _check_moments(each)


def _check_weights(found: object, wanted: Mapping[str, Tensor], where: str) -> None:
    """Raise RecordJsonError where these are no tensors of the same names, shapes and types."""
    if not isinstance(found, Mapping) or found.keys() != wanted.keys():
        raise RecordJsonError(f"`{where}` is of another network")
    for name, tensor in wanted.items():
        _check_tensor(found[name], tensor.shape, tensor.dtype, f"{where}.{name}")


def _check_tensor(found: object, shape: torch.Size, dtype: torch.dtype, where: str) -> None:
    if not isinstance(found, Tensor) or found.dtype != dtype:
        raise RecordJsonError(f"`{where}` is no tensor of {str(dtype).removeprefix('torch.')}")
    if found.shape != shape:
        raise RecordJsonError(f"`{where}` has the shape {list(found.shape)}, and the network needs {list(shape)}")


def _check_generators(own: Mapping[str, Tensor], device: str) -> None:
    """Raise RecordJsonError where a process cannot take up its generators of random numbers."""
    states = {"cpu": own.get("cpu"), **({device: own["cuda"]} if device.startswith("cuda") and "cuda" in own else {})}
    for where, state in states.items():
        try:
            torch.Generator(where).set_state(state)  # type: ignore[arg-type]
        except (RuntimeError, TypeError):
            raise RecordJsonError("a state of random numbers in `processes` is none") from None


def _options(optimizer: Optimizer) -> list[dict[str, object]]:
    """The names of an optimiser's options and the kinds of their values, for each group of weights."""
    return [{name: _kind(value) for name, value in group.items()} for group in optimizer.param_groups]


def _kind(value: object) -> object:
    if isinstance(value, (tuple, list)):
        return [_kind(each) for each in value]
    # Optimisers set switches that nobody gave, from None to a truth.
    if value is None or isinstance(value, bool):
        return "switch"
    return "number" if isinstance(value, (int, float)) else type(value).__name__


def _check_moments(optimizer: Optimizer) -> None:
    """Raise RecordJsonError where the averages of an optimiser that was taken up are not those of its weights."""
    names = _moments(optimizer)
    for group in optimizer.param_groups:
        for weights in group["params"]:
            # What has had no gradient yet has no averages.
            if state := optimizer.state.get(weights):
                if state.keys() != names:
                    raise RecordJsonError("an optimizer in it has other averages")
                for name, found in state.items():
                    shape = torch.Size() if name == "step" else weights.shape
                    _check_tensor(found, shape, torch.float32, f"algorithm.{name}")


def _moments(optimizer: Optimizer) -> set[str]:
    """The names of what an optimiser of this class and these options keeps for a weight."""
    weight = nn.Parameter(torch.zeros(1))
    weight.grad = torch.zeros(1)
    make: Any = type(optimizer)
    trial: Optimizer = make([{**optimizer.param_groups[0], "params": [weight], "fused": None}])
    trial.step()
    return set(trial.state[weight])
