"""Handmade reports of a training."""

from __future__ import annotations

from collections.abc import Mapping

from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.training.files.report import Confirmation, EpisodeWindow, StopReason, TrainingReport
from tltl_runtime.training.runner import Iteration


def a_report(
    number: int = 1,
    *,
    count: int = 50,
    successes: int = 40,
    states: Mapping[int, float] | None = None,
    finished: tuple[EpisodeSummary, ...] = (),
    stop: StopReason | None = None,
    confirmation: Confirmation | None = None,
    checkpointed: bool = False,
) -> TrainingReport:
    """Return the report of iteration ``number``: 4096 steps, at 2048 steps per second.

    ``count`` is the number of episodes of which ``successes`` met the spec.
    """
    progress = 0.5 + successes / count / 2 if count else 0.0
    return TrainingReport(
        iteration=Iteration(number, 4096, finished, {"value": 0.25, "entropy": 3.5}, 1.5, 0.5),
        steps=4096 * number,
        seconds=2.0 * number,
        window=EpisodeWindow(
            count,
            successes,
            progress,
            progress - 0.25,
            130.0,
            states or ({4: 0.8, 1: 0.2} if count else {}),
            violated={1: 0.15} if count else {},
        ),
        unbroken=successes if successes == count else 0,
        confirmation=confirmation,
        best_pass_rate=successes / count if count else None,
        best_steps=4096 * (number - 1) if count else None,
        stop=stop,
        checkpointed=checkpointed,
        searched=None,
        replayed=0,
        imitated=None,
    )


def an_episode(success: bool) -> EpisodeSummary:
    if success:
        return EpisodeSummary(0, None, True, "success", 1.0, 0.5, 100, 4)
    return EpisodeSummary(0, None, False, "violation", 0.4, -0.6, 100, 1)
