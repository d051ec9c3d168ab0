"""What the processes of a training tell each other after an iteration, and what each of them has for itself."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain, zip_longest
from math import isfinite

import torch
from torch import Tensor

from tltl_runtime.training.ppo.distributed import Peers
from tltl_runtime.training.runner import Iteration, Runner
from tltlc.core.record import record, replace
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

Own = Mapping[str, Tensor]
"""What a process has for itself: see :class:`~tltl_runtime.training.run.checkpoint.Checkpoint`."""


@record
class Gathered:
    """An iteration of all processes: its episodes and steps are theirs together, its losses and times this one's.

    ``processes`` are what each has for itself, by rank; ``replayed`` counts the decisions that they have played again.
    """

    iteration: Iteration
    processes: tuple[Own, ...]
    replayed: int


def gathered(own: Peers, iteration: Iteration, runner: Runner) -> Gathered:
    """What all processes tell after an iteration; raises TltlError, TLT0866, where a loss of any is no number."""
    told = own.gather((iteration, own_state(runner), runner.env.replayed))
    iterations, processes, replayed = zip(*told, strict=True)
    for each in iterations:
        _check_losses(each)
    # In which order the episodes of different processes ended nobody knows.
    by_turns = chain.from_iterable(zip_longest(*(each.finished for each in iterations)))
    finished = tuple(each for each in by_turns if each)
    return Gathered(replace(iteration, finished=finished, steps=iteration.steps * own.count), processes, sum(replayed))


def own_state(runner: Runner) -> Own:
    """What this process has for itself."""
    own = {"cpu": torch.get_rng_state()}
    if runner.device.startswith("cuda"):
        own["cuda"] = torch.cuda.get_rng_state(runner.device)
    if runner.env.restarts:
        own |= {name: torch.from_numpy(each) for name, each in runner.env.restarts.state().items()}
    return own


def set_generators(own: Own, runner: Runner) -> None:
    """Set torch's generators of random numbers to where :func:`own_state` found them."""
    torch.set_rng_state(own["cpu"])
    if runner.device.startswith("cuda") and "cuda" in own:
        torch.cuda.set_rng_state(own["cuda"], runner.device)


def _check_losses(iteration: Iteration) -> None:
    wrong = [name for name, loss in iteration.losses.items() if not isfinite(loss)]
    if wrong:
        title = f"the training has diverged: in iteration {iteration.number} the loss `{wrong[0]}` is no number"
        help_ = "train anew with a smaller `learning_rate` or `max_gradient`"
        raise TltlError([Diagnostic("TLT0866", title, help=help_)])
