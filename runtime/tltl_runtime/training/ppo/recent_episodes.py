"""The last episodes of a training: whether all meet the spec, and how good the policy is."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Iterable, Sequence
from typing import Any

from tltl_runtime.spec.episode_summary import EpisodeSummary, progress_return
from tltl_runtime.training.files.report import EpisodeWindow, Score
from tltlc.api import traces

_STANDSTILL_STEPS = 100_000
"""The training stands still if the pass rate has not risen for this many steps."""
_MIN_EPISODES = 50
"""A pass rate counts as risen only if its window has at least this many episodes."""
_RISE = 0.05
"""A pass rate counts as risen only if it is greater than the best one by at least this."""
_BETWEEN = 0.1, 0.8
"""A standstill is detected only if the best pass rate is between these numbers.

Below the first, the reverse curriculum has not reached the level's start yet. From the second on,
little is left to find.
"""


class RecentEpisodes:
    """The last ``windows * episodes`` episodes of a training.

    ``limit_steps`` is the spec's limit in steps; None if it has no limit. ``unbroken`` counts the
    successive episodes, up to the last one, that met the spec, at most ``windows * episodes``. When
    it has reached this maximum, the training tests the policy in new episodes. If the policy fails
    there, ``unbroken`` starts at 0 again.
    """

    def __init__(self, windows: int, episodes: int, limit_steps: int | None) -> None:
        self._window_episodes = episodes
        self._limit_steps = limit_steps
        self._count = windows * episodes
        self._episodes: deque[EpisodeSummary] = deque(maxlen=self._count)
        self.unbroken = 0

    def add(self, finished: Iterable[EpisodeSummary]) -> None:
        """Add episodes, in the order in which they ended."""
        for episode in finished:
            self._episodes.append(episode)
            self.unbroken = min(self.unbroken + 1, self._count) if episode.success else 0

    def reset_unbroken(self) -> None:
        """Set ``unbroken`` to 0, because the policy failed when it was tested in new episodes."""
        self.unbroken = 0

    @property
    def all_met(self) -> bool:
        """Whether the last ``windows * episodes`` episodes all met the spec.

        Only episodes since the last call of :meth:`reset_unbroken` count.
        """
        return self.unbroken == self._count

    @property
    def window(self) -> EpisodeWindow:
        """The statistics of the episodes that are kept, at most ``windows * episodes``."""
        return self._window(tuple(self._episodes))

    @property
    def score(self) -> Score | None:
        """The pass rate, mean progress and mean reward of the last ``episodes`` episodes.

        It is None as long as fewer than ``episodes`` episodes have ended.
        """
        if len(self._episodes) < self._window_episodes:
            return None
        window = self._window(tuple(self._episodes)[-self._window_episodes :])
        return window.pass_rate, window.progress, window.reward

    def state(self) -> list[tuple[Any, ...]]:
        """Return the episodes as tuples of plain values, for :meth:`load`."""
        return [
            (episode.success, episode.progress, episode.steps, episode.unmet, episode.end == "violation")
            for episode in self._episodes
        ]

    def load(self, state: Iterable[Sequence[Any]], unbroken: int) -> None:
        """Replace the episodes by those that :meth:`state` returned; restore ``unbroken``."""
        self._episodes.clear()
        self._episodes.extend(self._summary(index, *fields) for index, fields in enumerate(state))
        self.unbroken = unbroken

    def _window(self, episodes: tuple[EpisodeSummary, ...]) -> EpisodeWindow:
        count = len(episodes)
        ends = Counter(episode.unmet for episode in episodes)
        violated = Counter(episode.unmet for episode in episodes if episode.end == "violation")
        return EpisodeWindow(
            count=count,
            successes=sum(episode.success for episode in episodes),
            progress=sum(episode.progress for episode in episodes) / max(count, 1),
            reward=sum(episode.reward for episode in episodes) / max(count, 1),
            steps=sum(episode.steps for episode in episodes) / max(count, 1),
            states={state: ended / count for state, ended in sorted(ends.items())},
            violated={state: ended / count for state, ended in sorted(violated.items())},
            causes=_causes(episodes),
        )

    def _summary(
        self, index: int, success: bool, progress: float, steps: int, unmet: int, violated: bool
    ) -> EpisodeSummary:
        """Return the summary of the episode with this index, from the values that :meth:`state` stored."""
        return EpisodeSummary(
            index=index,
            seed=None,
            success=success,
            end="success" if success else "violation" if violated else "limit",
            progress=progress,
            reward=progress_return(success, progress, steps, self._limit_steps),
            steps=steps,
            unmet=unmet,
        )


def _causes(episodes: Sequence[EpisodeSummary]) -> tuple[traces.CauseGroup, ...]:
    """Return groups of episodes that broke the same clauses; none if one of them has no known cause."""
    violated = [episode for episode in episodes if episode.end == "violation"]
    causes = [(str(episode.index), episode.cause) for episode in violated if episode.cause is not None]
    return traces.group_causes(causes) if len(causes) == len(violated) else ()


class Standstill:
    """Detects a standstill: the agent succeeds sometimes, but its pass rate no longer rises.

    ``best`` is the greatest pass rate so far, in [0, 1]. ``since`` is the number of steps at which
    that rate was reached, or at which the last standstill was detected.
    """

    def __init__(self, best: float = 0.0, since: int = 0) -> None:
        self._best, self._since = best, since

    def add(self, window: EpisodeWindow, steps: int) -> bool:
        """Add the statistics of the last episodes; return whether there is a standstill now.

        ``steps`` counts the decisions of all environments so far. The next standstill can be
        detected only ``_STANDSTILL_STEPS`` steps after this one.
        """
        if window.count >= _MIN_EPISODES and window.pass_rate >= self._best + _RISE:
            self._best, self._since = window.pass_rate, steps
        low, high = _BETWEEN
        if not low <= self._best < high or steps - self._since < _STANDSTILL_STEPS:
            return False
        self._since = steps
        return True

    def state(self) -> tuple[float, int]:
        """Return ``best`` and ``since``, with which a new :class:`Standstill` continues from here."""
        return self._best, self._since
