"""The streams of random numbers of a training, none of which hangs on how much another one has given."""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from tltl_runtime.training.ppo.distributed import Peers
from tltl_runtime.training.run.run import Run


class Purpose(IntEnum):
    """What a process draws numbers for; the values are part of what makes equal trainings equal."""

    TORCH = 0
    ENVIRONMENTS = 1
    SEARCH = 2
    STARTS = 3
    CONFIRMATION = 4
    INITIAL = 5


def stream(run: Run, own: Peers, purpose: Purpose, iteration: int = 0) -> np.random.SeedSequence:
    """The seed of what process ``own`` draws for a purpose from an iteration on."""
    return np.random.SeedSequence(run.seed, spawn_key=(own.rank, int(purpose), iteration))
