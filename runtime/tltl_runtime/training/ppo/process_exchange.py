"""The exchange between processes after an iteration, and the own state of each process."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain, zip_longest
from math import isfinite

import torch
from torch import Tensor

from tltl_runtime.training.ppo.distributed import Peers
from tltl_runtime.training.runner import Iteration, Runner
from tltlc.api import Diagnostic, TltlError, record, replace

Own = Mapping[str, Tensor]
"""The own state of a process: see :class:`~tltl_runtime.training.run.checkpoint.Checkpoint`."""


@record
class Gathered:
    """An iteration of all processes.

    Its episodes and steps are those of all processes, its losses and times those of this process.
    ``processes`` are the own states, by rank.  ``replayed`` counts the replayed decisions of all.
    """

    iteration: Iteration
    processes: tuple[Own, ...]
    replayed: int


def gathered(own: Peers, iteration: Iteration, runner: Runner) -> Gathered:
    """Gather an iteration from all processes.

    Raises TltlError, TLT0866, if any loss is not a number.
    """
    values = own.gather((iteration, own_state(runner), runner.env.replayed))
    iterations, processes, replayed = zip(*values, strict=True)
    for process_iteration in iterations:
        _check_losses(process_iteration)
    # The order in which episodes of different processes ended is unknown, so they are interleaved.
    interleaved = chain.from_iterable(zip_longest(*(process_iteration.finished for process_iteration in iterations)))
    finished = tuple(episode for episode in interleaved if episode)
    return Gathered(replace(iteration, finished=finished, steps=iteration.steps * own.count), processes, sum(replayed))


def own_state(runner: Runner) -> Own:
    """Return the own state of this process."""
    own = {"cpu": torch.get_rng_state()}
    if runner.device.startswith("cuda"):
        own["cuda"] = torch.cuda.get_rng_state(runner.device)
    if runner.env.restarts:
        own |= {name: torch.from_numpy(array) for name, array in runner.env.restarts.state().items()}
    return own


def set_generators(own: Own, runner: Runner) -> None:
    """Restore torch's random generators from :func:`own_state`."""
    torch.set_rng_state(own["cpu"])
    if runner.device.startswith("cuda") and "cuda" in own:
        torch.cuda.set_rng_state(own["cuda"], runner.device)


def _check_losses(iteration: Iteration) -> None:
    wrong = [name for name, loss in iteration.losses.items() if not isfinite(loss)]
    if wrong:
        title = f"the training has diverged: in iteration {iteration.number} the loss `{wrong[0]}` is no number"
        help_ = "train anew with a smaller `learning_rate` or `max_gradient`"
        raise TltlError([Diagnostic("TLT0866", title, help=help_)])
