"""Exchange results between the processes of a training, and get and set the state of a process."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain, zip_longest
from math import isfinite

import torch
from torch import Tensor

from tltl_runtime.training.ppo.distributed import ProcessGroup
from tltl_runtime.training.runner import Iteration, Runner
from tltl_runtime.wire.lost_episodes import together
from tltlc.api import Diagnostic, TltlError, record, replace

ProcessState = Mapping[str, Tensor]
"""The state of a process: tensors by name, for its random generators and its curriculum.

A :class:`~tltl_runtime.training.files.checkpoint.Checkpoint` has one for each process.
"""


@record
class GatheredIteration:
    """The result of an iteration in all processes.

    ``iteration`` has the episodes and steps of all processes, and the losses and times of this
    process. ``processes`` are the states of all processes, by rank. ``replayed`` is how many
    decisions all processes have replayed since they started, to reach states in which episodes start.
    """

    iteration: Iteration
    processes: tuple[ProcessState, ...]
    replayed: int


def gather_iteration(group: ProcessGroup, iteration: Iteration, runner: Runner) -> GatheredIteration:
    """Collect the results of an iteration from all processes; all of them must call this function.

    Raises TltlError, TLT0866, if a loss of any process is not a finite number.
    """
    values = group.gather((iteration, process_state(runner), runner.env.replayed))
    iterations, processes, replayed = zip(*values, strict=True)
    for process_iteration in iterations:
        _check_losses(process_iteration)
    # The order in which episodes of different processes ended is unknown, so they are interleaved.
    interleaved = chain.from_iterable(zip_longest(*(process_iteration.finished for process_iteration in iterations)))
    finished = tuple(episode for episode in interleaved if episode)
    lost = together(process_iteration.lost for process_iteration in iterations)
    iteration = replace(iteration, finished=finished, steps=iteration.steps * group.count, lost=lost)
    return GatheredIteration(iteration, processes, sum(replayed))


def process_state(runner: Runner) -> ProcessState:
    """Return the state of this process: its random generators and its curriculum."""
    state = {"cpu": torch.get_rng_state()}
    if runner.device.startswith("cuda"):
        state["cuda"] = torch.cuda.get_rng_state(runner.device)
    if runner.env.curriculum:
        state |= {name: torch.from_numpy(array) for name, array in runner.env.curriculum.state().items()}
    return state


def set_generators(state: ProcessState, runner: Runner) -> None:
    """Restore torch's random generators from the state of a process."""
    torch.set_rng_state(state["cpu"])
    if runner.device.startswith("cuda") and "cuda" in state:
        torch.cuda.set_rng_state(state["cuda"], runner.device)


def _check_losses(iteration: Iteration) -> None:
    invalid = [name for name, loss in iteration.losses.items() if not isfinite(loss)]
    if invalid:
        title = (
            f"the training has diverged: in iteration {iteration.number} the loss `{invalid[0]}` is not a finite number"
        )
        help_ = "train again with a smaller `learning_rate` or `max_gradient`"
        raise TltlError([Diagnostic("TLT0866", title, help=help_)])
