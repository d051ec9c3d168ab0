"""The last episodes of a training: whether they meet the spec, and how well the policy is that played them."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Iterable, Sequence
from typing import Any

from tltl_runtime.training.ppo.environment import Finished
from tltl_runtime.training.run.report import Window

Score = tuple[float, float, float]
"""How good a policy is, the greater the better: pass rate, mean progress, mean reward."""

_STANDSTILL_STEPS = 100_000
_ENOUGH = 50
"""Episodes whose share of successes is one that can be told to rise."""
_RISE = 0.05
_BETWEEN = 0.1, 0.8
"""Below these pass rates the ways have not led to the level's start yet, and above them little is left to be found."""


class Windows:
    """The last ``windows * episodes`` episodes; ``limit_steps`` is the spec's, None where it has none.

    ``unbroken`` is how many of them, up to the last one, met the spec without a failure in between, of the policy in a
    confirmation neither.
    """

    def __init__(self, windows: int, episodes: int, limit_steps: int | None) -> None:
        self._episodes = episodes
        self._limit_steps = limit_steps
        self._count = windows * episodes
        self._last: deque[Finished] = deque(maxlen=self._count)
        self.unbroken = 0

    def add(self, finished: Iterable[Finished]) -> None:
        """Take episodes in the order of their ends."""
        for each in finished:
            self._last.append(each)
            self.unbroken = min(self.unbroken + 1, self._count) if each.success else 0

    def refuse(self) -> None:
        """Begin to count anew: the policy has failed in its confirmation."""
        self.unbroken = 0

    @property
    def met(self) -> bool:
        """Whether the spec was met throughout all of the windows."""
        return self.unbroken == self._count

    @property
    def window(self) -> Window:
        """All of the last episodes together."""
        return self._window(tuple(self._last))

    @property
    def score(self) -> Score | None:
        """That of the last window; None before there was a whole one."""
        if len(self._last) < self._episodes:
            return None
        window = self._window(tuple(self._last)[-self._episodes :])
        return window.pass_rate, window.progress, window.reward

    def state(self) -> list[tuple[Any, ...]]:
        """The episodes as plain values, for :meth:`load`."""
        return [(each.success, each.progress, each.steps, each.state, each.violated) for each in self._last]

    def load(self, state: Iterable[Sequence[Any]], unbroken: int) -> None:
        """Take up what :meth:`state` gave."""
        self._last.extend(Finished(*each) for each in state)
        self.unbroken = unbroken

    def _window(self, episodes: tuple[Finished, ...]) -> Window:
        count = len(episodes)
        ends = Counter(each.state for each in episodes)
        violated = Counter(each.state for each in episodes if each.violated)
        return Window(
            count=count,
            successes=sum(each.success for each in episodes),
            progress=sum(each.progress for each in episodes) / max(count, 1),
            reward=sum(self._reward(each) for each in episodes) / max(count, 1),
            steps=sum(each.steps for each in episodes) / max(count, 1),
            states={state: ended / count for state, ended in sorted(ends.items())},
            violated={state: ended / count for state, ended in sorted(violated.items())},
        )

    def _reward(self, episode: Finished) -> float:
        """The sum of rewards of mode ``progress`` with the undiscounted terminal penalty (semantics, section 4)."""
        if self._limit_steps is None:
            return episode.progress
        return episode.progress - (episode.steps / self._limit_steps if episode.success else 1.0)


class Standstill:
    """Whether a training has come to a standstill: it succeeds now and then, and its pass rate rises no more.

    ``best`` is the greatest pass rate so far, in [0, 1], and ``since`` the steps after which it was one.
    """

    def __init__(self, best: float = 0.0, since: int = 0) -> None:
        self._best, self._since = best, since

    def add(self, window: Window, steps: int) -> bool:
        """Take the window after so many ``steps`` of all environments; True where it is one, and then counts anew."""
        if window.count >= _ENOUGH and window.pass_rate >= self._best + _RISE:
            self._best, self._since = window.pass_rate, steps
        low, high = _BETWEEN
        if not low <= self._best < high or steps - self._since < _STANDSTILL_STEPS:
            return False
        self._since = steps
        return True

    def state(self) -> tuple[float, int]:
        """What :class:`Standstill` is made of to go on from here."""
        return self._best, self._since
