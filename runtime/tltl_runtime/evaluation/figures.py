"""The figures (statistics) of an evaluation, and where failed episodes ended."""

from __future__ import annotations

from collections.abc import Sequence

from tltl_runtime.evaluation.player import LostEpisode
from tltl_runtime.evaluation.statistics import Spread, spread_of, wilson
from tltl_runtime.spec.episode_summary import End, EpisodeSummary
from tltlc.api import record, traces


@record
class FailureGroup:
    """Failed episodes that ended in the same way and in the same state.

    ``state`` is the automaton's state at the end, or its state before the violation. ``label`` says
    what remained to be done in that state. ``episodes`` are the indices of the episodes, and ``count``
    is their number. ``share`` is their share of all episodes of the evaluation, in [0, 1].
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

    ``pass_rate`` is the share of successful episodes, in [0, 1]; ``pass_interval`` is its 95 % Wilson
    interval. The other fields are means and standard deviations over the episodes: ``progress`` of the
    best progress of each episode, in [0, 1], ``reward`` of the undiscounted return, and ``steps`` of
    the number of decisions.
    """

    episodes: int
    pass_rate: float
    pass_interval: tuple[float, float]
    progress: Spread
    reward: Spread
    steps: Spread


@record
class Evaluation:
    """The result of an evaluation: the statistics, the groups of failed episodes, and all episodes.

    ``causes`` are groups of failed episodes that broke, or did not meet, the same clauses of the spec; the
    names of their traces are the indices of the episodes. Episodes without a cause are in no group.
    ``lost`` are the episodes that were lost with their games; the statistics are without them.
    """

    figures: Figures
    ended: tuple[FailureGroup, ...]
    episodes: tuple[EpisodeSummary, ...]
    lost: tuple[LostEpisode, ...] = ()
    causes: tuple[traces.CauseGroup, ...] = ()


def figures_of(episodes: Sequence[EpisodeSummary]) -> Figures:
    """Return the statistics of ``episodes``.

    Raises:
        ValueError: there are no episodes.
    """
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


def evaluation_of(episodes: Sequence[EpisodeSummary], lost: Sequence[LostEpisode] = ()) -> Evaluation:
    """Return the statistics, the groups of failures and the summaries of ``episodes``, and those that were ``lost``.

    Raises:
        ValueError: there are no episodes.
    """
    causes = traces.group_causes((str(episode.index), episode.cause) for episode in episodes if episode.cause)
    return Evaluation(figures_of(episodes), _failure_groups(episodes), tuple(episodes), tuple(lost), causes)


def _failure_groups(episodes: Sequence[EpisodeSummary]) -> tuple[FailureGroup, ...]:
    """Group the failed episodes by how and in which state they ended; return the largest group first."""
    groups: dict[tuple[int, str, End], list[int]] = {}
    for episode in episodes:
        if not episode.success:
            groups.setdefault((episode.unmet, episode.label or "", episode.end), []).append(episode.index)
    ended = [
        FailureGroup(state, label, end, len(indices), len(indices) / len(episodes), tuple(indices))
        for (state, label, end), indices in groups.items()
    ]
    return tuple(sorted(ended, key=lambda group: (-group.count, group.state, group.end)))
