"""The summary of an episode, which training, evaluation and regression share."""

from __future__ import annotations

from typing import Literal

from tltlc.api import record, traces

End = Literal["success", "violation", "limit", "stopped"]
"""How an episode ended.

``limit``: the limit of the spec or of the environment came before the verdict was settled.
``stopped``: the player left.
"""


@record
class EpisodeSummary:
    """The outcome of an episode.

    ``index`` numbers the episodes of an evaluation or a training, from 0. ``seed`` is the seed of
    the environment's reset, or None if the episode continued the environment's random stream or is
    a recorded trace. ``progress`` is the best progress, in [0, 1]. ``reward`` is the sum of the
    rewards of all ``steps`` in the reward mode ``progress``, even if a training uses another mode.
    ``unmet`` is the automaton's state at the end, or its state before a violation.

    ``verdict`` is the verdict of the last step. ``seconds`` is the game time; a step
    counts as 1 s if the game has no clock. ``state`` is the automaton's state at the end. ``label``
    says in English what remained to be done in the state ``unmet``. These four are None in training
    and in the cases of regression tests, whose files do not contain them.

    ``cause`` says which clauses of the spec a failed episode broke or did not meet. It is None for a
    success, and if the episode was not judged by clauses.
    """

    index: int
    seed: int | None
    success: bool
    end: End
    progress: float
    reward: float
    steps: int
    unmet: int
    verdict: str | None = None
    seconds: float | None = None
    state: int | None = None
    label: str | None = None
    cause: traces.RejectionCause | None = None


def settled_end(success: bool, verdict: str) -> End:
    """Return how a completed episode ended. ``verdict`` is the verdict of its last step."""
    if success:
        return "success"
    return "violation" if verdict == "violated" else "limit"


def progress_return(success: bool, progress: float, steps: int, limit_steps: int | None) -> float:
    """Return the sum of an episode's rewards in the reward mode ``progress``.

    ``progress`` is the best progress of the episode. The sum is ``progress - steps / limit_steps`` for
    a success and ``progress - 1`` for a failure, which pays for all steps up to the limit.
    ``limit_steps`` is the spec's limit. If it is None, the spec has no limit, and the sum is
    ``progress``. See ``docs/semantics.md``, section 4.
    """
    if limit_steps is None:
        return progress
    return progress - (steps / limit_steps if success else 1.0)
