"""What a training says of itself after each iteration."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from tltl_runtime.training.exploration.search import Searched
from tltl_runtime.training.imitation.imitation_data import Imitated
from tltl_runtime.training.runner import Iteration
from tltlc.core.record import record

StopReason = Literal["met", "steps", "minutes"]


@record
class Window:
    """The last episodes, ``count`` of them, ``successes`` among these.

    Means: ``progress`` in [0, 1], ``reward`` with the undiscounted terminal penalty whatever the training counts, and
    length in ``steps``; all are 0 where there is no episode.  ``states`` has the share of episodes, in [0, 1], by the
    number of the automaton's state in which they ended, or were before they violated the spec; ``violated`` has that of
    the latter alone.  States where none ended are left out.
    """

    count: int
    successes: int
    progress: float
    reward: float
    steps: float
    states: Mapping[int, float]
    violated: Mapping[int, float]

    @property
    def pass_rate(self) -> float:
        """The share of successes, in [0, 1]; 0 where there is no episode."""
        return self.successes / self.count if self.count else 0.0


@record
class Confirmation:
    """What a policy that had met the spec throughout the windows did then: it met it in ``met`` fresh episodes, and
    failed in the next one unless these are all ``of`` them.
    """

    met: int
    of: int

    @property
    def passed(self) -> bool:
        """Whether there was no failure."""
        return self.met == self.of


@record
class Report:
    """An iteration, and where the training stands after it.

    ``steps`` are all decisions so far, of all environments and processes; ``seconds`` the training time so far, over
    resumptions.  ``unbroken`` is how many of the last episodes met the spec in a row, counted anew after a
    ``confirmation`` that failed; None where none was due.  ``best_pass_rate`` is that of the policy that is kept, None
    as long as there is none, and ``best_steps`` the steps after which it had its weights.  ``stop`` says why the
    training ends here, None where it goes on; ``checkpointed`` whether a checkpoint of this iteration was written.
    ``searched`` is what the search before it found, None where there was none, its decisions not among the ``steps``;
    nor are those that were ``replayed`` to begin where others had been.  ``imitated`` tells of the demonstrations, None
    where nothing is imitated.
    """

    iteration: Iteration
    steps: int
    seconds: float
    window: Window
    unbroken: int
    confirmation: Confirmation | None
    best_pass_rate: float | None
    best_steps: int | None
    stop: StopReason | None
    checkpointed: bool
    searched: Searched | None
    replayed: int
    imitated: Imitated | None
