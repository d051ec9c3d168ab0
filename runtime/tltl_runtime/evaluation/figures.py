"""The figures (statistics) of an evaluation, and where failed episodes ended."""

from __future__ import annotations

from collections.abc import Sequence

from tltl_runtime.evaluation.statistics import Spread, spread_of, wilson
from tltl_runtime.spec.episode_summary import End, EpisodeSummary
from tltlc.api import record


@record
class FailureGroup:
    """Failed episodes that ended in the same way and in the same state.

    ``state`` is the automaton state at the end, or before the violation. ``label`` says what
    remained to be done in that state. ``share`` is the share among all episodes that were played,
    in [0, 1]. ``episodes`` are the indices of the failed episodes, and ``count`` is their number.
    """

    state: int
    label: str
    end: End
    count: int
    share: float
    episodes: tuple[int, ...]


@record
class Figures:
    """The statistics of ``episodes`` episodes.

    ``pass_rate`` is in [0, 1]; ``pass_interval`` is its 95 % Wilson interval. Each other field has
    a mean and a standard deviation over the episodes. ``progress`` is about the best progress of
    each episode, in [0, 1], ``reward`` about its undiscounted return, and ``steps`` about its
    number of decisions.
    """

    episodes: int
    pass_rate: float
    pass_interval: tuple[float, float]
    progress: Spread
    reward: Spread
    steps: Spread


@record
class Evaluation:
    """The result of an evaluation: the figures, how failed episodes ended, and all episodes."""

    figures: Figures
    ended: tuple[FailureGroup, ...]
    episodes: tuple[EpisodeSummary, ...]


def figures_of(episodes: Sequence[EpisodeSummary]) -> Figures:
    """Return the statistics of some episodes. Raises ValueError if there are none."""
    passed = sum(episode.success for episode in episodes)
    # Compute this first: without episodes, it raises an error with a clear message.
    interval = wilson(passed, len(episodes))
    return Figures(
        episodes=len(episodes),
        pass_rate=passed / len(episodes),
        pass_interval=interval,
        progress=spread_of([episode.progress for episode in episodes]),
        reward=spread_of([episode.reward for episode in episodes]),
        steps=spread_of([float(episode.steps) for episode in episodes]),
    )


def evaluation_of(episodes: Sequence[EpisodeSummary]) -> Evaluation:
    """Return the statistics, failures and summaries of some episodes. Raises ValueError if there are none."""
    return Evaluation(figures_of(episodes), _failure_groups(episodes), tuple(episodes))


def _failure_groups(episodes: Sequence[EpisodeSummary]) -> tuple[FailureGroup, ...]:
    """Group the failed episodes by how and in which state they ended, the largest group first."""
    groups: dict[tuple[int, str, End], list[int]] = {}
    for episode in episodes:
        if not episode.success:
            groups.setdefault((episode.unmet, episode.label or "", episode.end), []).append(episode.index)
    ended = [
        FailureGroup(state, label, end, len(indices), len(indices) / len(episodes), tuple(indices))
        for (state, label, end), indices in groups.items()
    ]
    return tuple(sorted(ended, key=lambda group: (-group.count, group.state, group.end)))
