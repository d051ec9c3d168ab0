"""The random streams of a training, which are independent of each other."""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from tltl_runtime.training.files.run_file import TrainingRun
from tltl_runtime.training.ppo.distributed import ProcessGroup


class Purpose(IntEnum):
    """The purpose of a random stream, such as the seeds of the environments.

    Do not change the values: equal seeds must give equal trainings.
    """

    TORCH = 0
    ENVIRONMENTS = 1
    SEARCH = 2
    STARTS = 3
    CONFIRMATION = 4
    INITIAL = 5


def stream(
    run: TrainingRun, group: ProcessGroup, purpose: Purpose, iteration: int = 0, part: int = 0
) -> np.random.SeedSequence:
    """Return the seed of a random stream, one for each process, purpose, iteration and part.

    ``iteration`` is the iteration after which the stream begins, and ``part``, from 0, is the part of
    a search that was stopped and goes on. So a training that is resumed does not repeat the random
    numbers that it used before.
    """
    key = (group.rank, int(purpose), iteration)
    return np.random.SeedSequence(run.seed, spawn_key=(*key, part) if part else key)
