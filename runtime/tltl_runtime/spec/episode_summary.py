"""The summary of an episode, which training, evaluation and regression share."""

from __future__ import annotations

from typing import Literal

from tltlc.api import record

End = Literal["success", "violation", "limit", "stopped"]
"""How an episode ended.

``limit``: the limit of the spec or of the environment came before the verdict was settled.
``stopped``: the player left.
"""


@record
class EpisodeSummary:
    """How an episode went.

    ``index`` numbers the episodes of an evaluation or a training, from 0. ``seed`` is the seed of
    the environment's reset, or None if the episode continued the environment's random stream.
    ``progress`` is the best progress, in [0, 1]. ``reward`` is the sum of the rewards of the
    ``steps``. Training may use other rewards, so it computes this sum by :func:`progress_return`.
    ``unmet`` is the automaton state at the end, or the state before a violation.

    ``verdict`` is the verdict of the last step. ``seconds`` is the game time. ``state`` is the
    automaton state at the end. ``label`` says in English what remained to be done in the state
    ``unmet``. These four are None in training and in the cases of regression tests, whose files do
    not contain them.
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


def settled_end(success: bool, verdict: str) -> End:
    """Return how a completed episode ended; ``verdict`` is the verdict of its last step."""
    if success:
        return "success"
    return "violation" if verdict == "violated" else "limit"


def progress_return(success: bool, progress: float, steps: int, limit_steps: int | None) -> float:
    """Return the sum of an episode's rewards in the reward mode ``progress``.

    The terminal penalty is undiscounted. ``progress`` is the best progress of the episode.
    ``limit_steps`` is the spec's limit; None if the spec has no limit. See ``docs/semantics.md``,
    section 4.
    """
    if limit_steps is None:
        return progress
    return progress - (steps / limit_steps if success else 1.0)
