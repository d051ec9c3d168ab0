"""Make the first checkpoint of a training, and restore checkpoints; refuse one that does not fit."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, isfinite
from typing import Any, Final

import torch
from torch import Tensor, nn
from torch.optim import Optimizer

from tltl_runtime.support.record_json import RecordJsonError
from tltl_runtime.training.files.checkpoint import Checkpoint, deep_copy
from tltl_runtime.training.files.run_file import TrainingRun, identity
from tltl_runtime.training.ppo.recent_episodes import Standstill
from tltl_runtime.training.runner import Runner

_NETWORK: Final = "_state_dict"
"""The suffix of the names under which an algorithm saves its networks and optimisers."""


def first_checkpoint(run: TrainingRun, runner: Runner) -> Checkpoint:
    """Return the checkpoint before the first iteration, without the states of the processes."""
    return Checkpoint(
        run=identity(run),
        iteration=0,
        losses={},
        steps=0,
        seconds=0.0,
        replayed=0,
        searched=None,
        algorithm=deep_copy(runner.alg.save()),
        processes=(),
        window=(),
        unbroken=0,
        best=None,
        met=False,
        standstill=Standstill().state(),
    )


def restore_checkpoint(checkpoint: Checkpoint, runner: Runner, states: int) -> None:
    """Check a checkpoint, and load its weights and optimisers into a new runner.

    ``states`` is the number of states of the spec's automaton.

    Raises:
        RecordJsonError: the checkpoint does not fit the runner, or the random generator of a
            process cannot be restored.
    """
    initial = runner.alg.save()
    for name, expected in initial.items():
        if name not in checkpoint.algorithm:
            raise RecordJsonError(f"a part is missing: '{name}'")
        _check_part(checkpoint.algorithm[name], expected, f"algorithm.{name}")
    if checkpoint.best:
        _check_weights(checkpoint.best.actor, initial["actor_state_dict"], "best.actor")
    for process in checkpoint.processes:
        _check_generators(process, runner.device)
    if any(state >= states for _, _, _, state, _ in checkpoint.window):
        raise RecordJsonError("`window` contains a state that the spec does not have")
    try:
        runner.load_algorithm(checkpoint.algorithm)
    except Exception as error:
        # torch and the algorithms of users raise exceptions of many classes.
        raise RecordJsonError(f"its `algorithm` is damaged ({type(error).__name__})") from None
    for attribute in vars(runner.alg).values():
        if isinstance(attribute, Optimizer):
            _check_moments(attribute)


def _check_part(saved: object, expected: object, where: str) -> None:
    """Raise RecordJsonError unless a saved part of an algorithm fits the same part of a new algorithm.

    A part is a network, an optimiser or a number. Parts of other kinds, which an algorithm of a
    user may have, are not checked. ``where`` names the part in messages.
    """
    if isinstance(expected, Mapping) and expected.keys() == {"state", "param_groups"}:
        _check_optimizer(saved, expected, where)
    elif isinstance(expected, Mapping) and where.endswith(_NETWORK):
        if all(isinstance(value, Tensor) for value in expected.values()):
            _check_weights(saved, expected, where)
    elif isinstance(expected, (int, float)) and not (_kind(saved) == _kind(expected) and _is_limit(saved)):
        raise RecordJsonError(f"`{where}` is {saved!r:.60}, but a number from 0 to {2**63 - 1:,} was expected")


def _is_limit(value: Any) -> bool:
    """Whether a number is from 0 to 2**63 - 1, or infinite, which means no limit."""
    return value == inf or _is_count(value)


def _is_count(value: Any) -> bool:
    return isfinite(value) and 0 <= value < 2**63


def _check_optimizer(saved: object, expected: Mapping[str, Any], where: str) -> None:
    """Raise RecordJsonError unless the saved state of an optimiser fits that of a new optimiser.

    The saved state must be for the same weights, its options must fit, and the averages that it
    keeps for each weight must be tensors of finite numbers. ``where`` names the state in messages.
    """
    if not isinstance(saved, Mapping) or saved.keys() != expected.keys():
        raise RecordJsonError(f"`{where}` is not the state of an optimizer")
    state, groups = saved["state"], saved["param_groups"]
    if not isinstance(groups, list) or len(groups) != len(expected["param_groups"]):
        raise RecordJsonError(f"`{where}.param_groups` is of another optimizer")
    for group, options in zip(groups, expected["param_groups"], strict=True):
        if not isinstance(group, Mapping) or not _are_numbers(group.get("params"), options["params"]):
            raise RecordJsonError(f"`{where}.param_groups` is of another optimizer")
        _check_options(group, options)
    numbers = {number for group in expected["param_groups"] for number in group["params"]}
    if not isinstance(state, Mapping) or not state.keys() <= numbers:
        raise RecordJsonError(f"`{where}.state` is of another optimizer")
    for number, averages in state.items():
        if not isinstance(averages, Mapping) or not all(map(_is_moment, averages.values())):
            raise RecordJsonError(f"`{where}.state.{number}` contains a value that is not a tensor of finite numbers")


def _check_options(saved: Mapping[str, Any], expected: Mapping[str, Any]) -> None:
    """Raise RecordJsonError if a saved option of an optimiser is missing or does not fit.

    ``expected`` are the options of a new optimiser. ``saved`` may have more options, which a newer
    torch has added.
    """
    for name, option in expected.items():
        if name not in saved or not _option_fits(saved[name], option):
            raise RecordJsonError(f"an optimizer in it has other options: `{name}`")


def _option_fits(saved: Any, expected: object) -> bool:
    """Whether the saved value of an optimiser's option fits the ``expected`` one.

    Single numbers may differ, because a training may change the learning rate.
    """
    if isinstance(expected, (tuple, list)):
        return isinstance(saved, (tuple, list)) and list(map(_number_or_none, saved)) == list(expected)
    if expected is None:
        # An optimiser may set a switch whose default is None.
        return _kind(saved) == "switch"
    if _kind(expected) == "number":
        return _kind(saved) == "number" and _is_count(saved)
    return type(saved) is type(expected) and (not isinstance(expected, bool) or saved == expected)


def _are_numbers(saved: Any, expected: list[int]) -> bool:
    return isinstance(saved, list) and all(type(number) is int for number in saved) and saved == expected


def _number_or_none(value: object) -> object:
    """Return ``value`` if it is a number, else None, because a tensor cannot simply be compared."""
    return value if isinstance(value, (int, float)) else None


def _is_moment(value: object) -> bool:
    return isinstance(value, Tensor) and value.is_floating_point() and bool(torch.isfinite(value).all())


def _check_weights(saved: object, expected: Mapping[str, Tensor], where: str) -> None:
    """Raise RecordJsonError unless saved weights have the expected names, shapes and types."""
    if not isinstance(saved, Mapping) or saved.keys() != expected.keys():
        raise RecordJsonError(f"`{where}` is of another network")
    for name, tensor in expected.items():
        _check_tensor(saved[name], tensor.shape, tensor.dtype, f"{where}.{name}")


def _check_tensor(saved: object, shape: torch.Size, dtype: torch.dtype, where: str) -> None:
    if not isinstance(saved, Tensor) or saved.dtype != dtype:
        raise RecordJsonError(f"`{where}` is not a tensor of {str(dtype).removeprefix('torch.')}")
    if saved.shape != shape:
        raise RecordJsonError(f"`{where}` has the shape {list(saved.shape)}, and the network needs {list(shape)}")
    if saved.is_floating_point() and not torch.isfinite(saved).all():
        raise RecordJsonError(f"`{where}` contains a value that is not a finite number")


def _check_generators(process: Mapping[str, Tensor], device: str) -> None:
    """Raise RecordJsonError if the random generators of a process cannot be restored."""
    states = {
        "cpu": process.get("cpu"),
        **({device: process["cuda"]} if device.startswith("cuda") and "cuda" in process else {}),
    }
    for where, state in states.items():
        try:
            torch.Generator(where).set_state(state)  # type: ignore[arg-type]
        except (RuntimeError, TypeError):
            raise RecordJsonError("the state of a random generator in `processes` is invalid") from None


def _kind(value: object) -> str:
    """Return the kind of an optimiser's option: ``switch``, ``number``, or the name of its type.

    None counts as a switch: an optimiser may change it to a bool.
    """
    if value is None or isinstance(value, bool):
        return "switch"
    return "number" if isinstance(value, (int, float)) else type(value).__name__


def _check_moments(optimizer: Optimizer) -> None:
    """Raise RecordJsonError if the averages of a restored optimiser do not fit its weights.

    Adam, for example, keeps averages of the gradients of each weight.
    """
    names = _moments(optimizer)
    for group in optimizer.param_groups:
        for weights in group["params"]:
            # Weights that have had no gradient yet have no averages.
            if state := optimizer.state.get(weights):
                if state.keys() != names:
                    raise RecordJsonError("an optimizer in it has other averages")
                for name, average in state.items():
                    shape = torch.Size() if name == "step" else weights.shape
                    _check_tensor(average, shape, torch.float32, f"algorithm.{name}")
                    # Adam takes the root of these averages, and divides by a function of the steps.
                    if name in ("step", "exp_avg_sq", "max_exp_avg_sq") and (average < 0).any():
                        raise RecordJsonError(f"`algorithm.{name}` contains a number below 0")


def _moments(optimizer: Optimizer) -> set[str]:
    """Return the names of the averages that an optimiser keeps for each weight.

    Adam, for example, keeps ``exp_avg``, ``exp_avg_sq`` and ``step``. To find the names, a new
    optimiser of the same class and options takes one step.
    """
    weight = nn.Parameter(torch.zeros(1))
    weight.grad = torch.zeros(1)
    make: Any = type(optimizer)
    trial: Optimizer = make([{**optimizer.param_groups[0], "params": [weight], "fused": None}])
    trial.step()
    return set(trial.state[weight])
