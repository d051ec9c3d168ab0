"""Where episodes of a training begin: at the level's start, or in the midst of an episode that was played before.

Same seed and actions give the same episode, so that whatever was reached once is reached again by playing those
actions again.  The agent's own decisions follow.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from tltl_runtime.vector import WorkerVectorEnv
from tltl_runtime.vector.errors import Playing, WorkerError
from tltlc.core.record import record, replace

Actions = list[list[int]]


@record
class Start:
    """The seed of an episode and the ``actions`` that are played before the agent's first, [n, branches].

    ``part`` says where on a way this is, the way's end and the number of its part, None: on none.  After
    ``most`` decisions of the agent the episode is cut off, None: nowhere.
    """

    seed: int
    actions: Sequence[Sequence[int]] = ()
    part: tuple[int, int] | None = None
    most: int | None = None


class Replayed(gymnasium.Wrapper[Any, Any, Any, Any]):
    """An environment whose episodes begin with ``begin``: a seed, and actions that are played at once.

    It stays what it is until it is set again, to anything but None; before, they begin as the environment's own do.
    Of what ``make`` gives there are two: while one is played, the other one is brought to where the next episode
    begins, by :meth:`prepare`.
    """

    def __init__(self, make: Callable[[], gymnasium.Env[Any, Any]]) -> None:
        super().__init__(make())
        self._other = make()
        self._begin: tuple[int, NDArray[np.int8]] | None = None
        self._bringing: Iterator[None] | None = None
        self._brought: tuple[Any, dict[str, Any]] = {}, {}

    @property
    def begin(self) -> tuple[int, NDArray[np.int8]] | None:
        """What the next episodes begin with."""
        return self._begin

    @begin.setter
    def begin(self, begin: tuple[int, NDArray[np.int8]] | None) -> None:
        # A vector environment sets all of its environments at once, and few of them begin anew.
        if begin is not None:
            self._begin = begin
            self._bringing = self._bring(*begin)

    def prepare(self) -> bool:
        """Play a decision of what comes before the next episode's beginning; whether there was one to play."""
        return self._bringing is not None and next(self._bringing, self) is None

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begin an episode, and play what is to be played again; that does not end it."""
        if self._begin is None:
            return self.env.reset(seed=seed, options=options)
        self._bringing = self._bringing or self._bring(*self._begin)
        while self.prepare():
            pass
        self._bringing = None
        self.env, self._other = self._other, self.env
        return self._brought

    def close(self) -> None:
        """Close both environments."""
        super().close()
        self._other.close()

    def _bring(self, seed: int, actions: NDArray[np.int8]) -> Iterator[None]:
        """Bring the other environment to where ``actions`` lead."""
        observation, info = self._other.reset(seed=seed)
        for action in actions:
            yield
            observation, _, _, _, info = self._other.step(action)
        self._brought = observation, info


class Episodes:
    """What each environment of ``env`` plays, with all actions so far; the next starts are those that ``draw`` gives.

    The environments are :class:`Replayed`.  ``observation`` is that of the first episodes, which begin here;
    ``replayed`` counts the decisions that were played again.

    What it does raises WorkerError where a worker was lost, with the seeds of the starts.
    """

    def __init__(self, env: WorkerVectorEnv, draw: Callable[[], Start]) -> None:
        self._env = env
        self._draw = draw
        self._next = [draw() for _ in range(env.num_envs)]
        self.starts = list(self._next)
        self.actions: list[Actions] = [[] for _ in self._next]
        self.replayed = 0
        self._tell(range(env.num_envs))
        with self._telling():
            self.observation, _ = env.reset()
        self.turn(np.ones(env.num_envs, dtype=np.bool_))

    def step(self, actions: NDArray[np.int64]) -> tuple[Any, ...]:
        """Step all environments with the actions [num_envs, branches], and note these; what the environments give."""
        for known, action in zip(self.actions, actions.tolist(), strict=True):
            known.append(action)
        with self._telling():
            return self._env.step(actions)

    def turn(self, over: NDArray[np.bool_]) -> None:
        """Take note that in these environments the next episodes have begun."""
        rows = np.flatnonzero(over).tolist()
        if rows:
            self._go_on(rows)
            self._tell(rows)

    def cut(self, over: NDArray[np.bool_]) -> Any:
        """Break off the episodes of these environments and begin the next ones; the observation of all."""
        rows = np.flatnonzero(over).tolist()
        self._go_on(rows)
        with self._telling():
            observation, _ = self._env.reset(options={"reset_mask": over})
        self._tell(rows)
        return observation

    def is_spent(self, row: int) -> bool:
        """Whether the agent has had as many decisions as the start of the episode in this environment gave it."""
        start = self.starts[row]
        return start.most is not None and len(self.actions[row]) - len(start.actions) >= start.most

    def _go_on(self, rows: Iterable[int]) -> None:
        """Go on to the next episodes of these environments."""
        for row in rows:
            start = self.starts[row] = self._next[row]
            self.actions[row] = [list(action) for action in start.actions]
            self.replayed += len(start.actions)
            self._next[row] = self._draw()

    @contextmanager
    def _telling(self) -> Iterator[None]:
        """Tell of a worker that is lost the seeds of the starts, and steps with those played again."""
        try:
            yield
        except WorkerError as error:
            raise WorkerError(error.loss, tuple(map(self._placed, error.playing))) from error

    def _placed(self, playing: Playing) -> Playing:
        """What is played, as this knows it: the environment was not told of the seeds."""
        row = playing.env
        return replace(playing, seed=self.starts[row].seed, episode=1, step=len(self.actions[row]))

    def _tell(self, rows: Iterable[int]) -> None:
        """Tell the environments of these rows what their next episodes begin with."""
        begin: list[tuple[int, NDArray[np.int8]] | None] = [None] * self._env.num_envs
        for row in rows:
            begin[row] = self._next[row].seed, np.array(self._next[row].actions, dtype=np.int8)
        with self._telling():
            self._env.set_attr("begin", begin)
