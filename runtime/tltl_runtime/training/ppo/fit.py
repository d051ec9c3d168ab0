"""Take up a checkpoint whose tensors fit the networks, optimisers and generators of the training, and no other."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, isfinite
from typing import Any, Final

import torch
from torch import Tensor, nn
from torch.optim import Optimizer

from tltl_runtime.support.record_json import RecordJsonError
from tltl_runtime.training.run.checkpoint import Checkpoint
from tltl_runtime.training.runner import Runner

_NETWORK: Final = "_state_dict"
"""The end of the names under which an algorithm saves its networks and optimisers."""


def take_up(checkpoint: Checkpoint, runner: Runner, states: int) -> None:
    """Give a new runner the weights and the optimisers of a checkpoint; the spec's automaton has this many ``states``.

    Raises RecordJsonError where they do not fit, or where a process could not go on with its random numbers.
    """
    made = runner.alg.save()
    for name, wanted in made.items():
        if name not in checkpoint.algorithm:
            raise RecordJsonError(f"it lacks a part: '{name}'")
        _check_part(checkpoint.algorithm[name], wanted, f"algorithm.{name}")
    if checkpoint.best:
        _check_weights(checkpoint.best.actor, made["actor_state_dict"], "best.actor")
    for own in checkpoint.processes:
        _check_generators(own, runner.device)
    if any(state >= states for _, _, _, state, _ in checkpoint.window):
        raise RecordJsonError("`window` holds a state that the spec does not have")
    try:
        runner.take_up(checkpoint.algorithm)
    except Exception as error:
        # Algorithms of users and torch raise exceptions of many classes.
        raise RecordJsonError(f"its `algorithm` is damaged ({type(error).__name__})") from None
    for each in vars(runner.alg).values():
        if isinstance(each, Optimizer):
            _check_moments(each)


def _check_part(found: object, wanted: object, where: str) -> None:
    """Raise RecordJsonError where a part of what an algorithm has saved is not like that of a new one.

    Parts of an algorithm of the user's own that are neither networks nor optimisers nor numbers pass unseen.
    """
    if isinstance(wanted, Mapping) and wanted.keys() == {"state", "param_groups"}:
        _check_optimizer(found, wanted, where)
    elif isinstance(wanted, Mapping) and where.endswith(_NETWORK):
        if all(isinstance(each, Tensor) for each in wanted.values()):
            _check_weights(found, wanted, where)
    elif isinstance(wanted, (int, float)) and not (_kind(found) == _kind(wanted) and _is_limit(found)):
        raise RecordJsonError(f"`{where}` is {found!r:.60}, and a number from 0 on was expected")


def _is_limit(value: Any) -> bool:
    """Whether it is a number from 0 on; a limit that nobody gave is infinite."""
    return value == inf or _is_count(value)


def _is_count(value: Any) -> bool:
    return isfinite(value) and 0 <= value < 2**63


def _check_optimizer(found: object, wanted: Mapping[str, Any], where: str) -> None:
    """Raise RecordJsonError for an optimiser of other weights or options, or whose averages are no tensors."""
    if not isinstance(found, Mapping) or found.keys() != wanted.keys():
        raise RecordJsonError(f"`{where}` is no state of an optimizer")
    state, groups = found["state"], found["param_groups"]
    if not isinstance(groups, list) or len(groups) != len(wanted["param_groups"]):
        raise RecordJsonError(f"`{where}.param_groups` is of another optimizer")
    for group, options in zip(groups, wanted["param_groups"], strict=True):
        if not isinstance(group, Mapping) or not _are_numbers(group.get("params"), options["params"]):
            raise RecordJsonError(f"`{where}.param_groups` is of another optimizer")
        _check_options(group, options)
    numbers = {each for group in wanted["param_groups"] for each in group["params"]}
    if not isinstance(state, Mapping) or not state.keys() <= numbers:
        raise RecordJsonError(f"`{where}.state` is of another optimizer")
    for number, averages in state.items():
        if not isinstance(averages, Mapping) or not all(map(_is_moment, averages.values())):
            raise RecordJsonError(f"`{where}.state.{number}` holds what is no average")


def _check_options(found: Mapping[str, Any], wanted: Mapping[str, Any]) -> None:
    """Raise RecordJsonError where an option is missing or of another kind; a newer torch may have written more."""
    for name, option in wanted.items():
        if name not in found or not _is_like(found[name], option):
            raise RecordJsonError(f"an optimizer in it has other options: `{name}`")


def _is_like(found: Any, wanted: object) -> bool:
    """Whether an option is as it must be: a single number may differ, as the learning rate does in a training."""
    if isinstance(wanted, (tuple, list)):
        return isinstance(found, (tuple, list)) and list(map(_plain, found)) == list(wanted)
    if wanted is None:
        # An optimiser may set a switch that nobody gave.
        return _kind(found) == "switch"
    if _kind(wanted) == "number":
        return _kind(found) == "number" and _is_count(found)
    return type(found) is type(wanted) and (not isinstance(wanted, bool) or found == wanted)


def _are_numbers(found: Any, wanted: list[int]) -> bool:
    return isinstance(found, list) and all(type(each) is int for each in found) and found == wanted


def _plain(value: object) -> object:
    """A value that can be compared: tensors cannot."""
    return value if isinstance(value, (int, float)) else None


def _is_moment(value: object) -> bool:
    return isinstance(value, Tensor) and value.is_floating_point() and bool(torch.isfinite(value).all())


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
    if found.is_floating_point() and not torch.isfinite(found).all():
        raise RecordJsonError(f"`{where}` holds what is no finite number")


def _check_generators(own: Mapping[str, Tensor], device: str) -> None:
    """Raise RecordJsonError where a process cannot take up its generators of random numbers."""
    states = {"cpu": own.get("cpu"), **({device: own["cuda"]} if device.startswith("cuda") and "cuda" in own else {})}
    for where, state in states.items():
        try:
            torch.Generator(where).set_state(state)  # type: ignore[arg-type]
        except (RuntimeError, TypeError):
            raise RecordJsonError("a state of random numbers in `processes` is none") from None


def _kind(value: object) -> str:
    """The kind of an option; an optimiser may change a switch that nobody gave from None to a truth value."""
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
                    # Adam takes the root of these averages, and divides by what it computes from the steps.
                    if name in ("step", "exp_avg_sq", "max_exp_avg_sq") and (found < 0).any():
                        raise RecordJsonError(f"`algorithm.{name}` holds a number below 0")


def _moments(optimizer: Optimizer) -> set[str]:
    """The names of what an optimiser of this class and these options keeps for a weight."""
    weight = nn.Parameter(torch.zeros(1))
    weight.grad = torch.zeros(1)
    make: Any = type(optimizer)
    trial: Optimizer = make([{**optimizer.param_groups[0], "params": [weight], "fused": None}])
    trial.step()
    return set(trial.state[weight])
