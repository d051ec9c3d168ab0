"""The reset distribution: where episodes begin.

They begin at the level's start, or in the middle of an earlier episode.
Equal seeds and actions give equal episodes, so replaying the actions of an episode reaches the same
state again.  The agent then continues from there.
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
from tltlc.api import record, replace

Actions = list[list[int]]


@record
class EpisodeStart:
    """The start of an episode: its seed, and ``actions`` [n, branches] to replay first.

    ``part`` locates the start on a way: the end of the way and the index of the part.  It is None
    if the start is on no way.  The episode is cut off after ``most`` decisions of the agent; None:
    never.
    """

    seed: int
    actions: Sequence[Sequence[int]] = ()
    part: tuple[int, int] | None = None
    most: int | None = None


class Replayed(gymnasium.Wrapper[Any, Any, Any, Any]):
    """An environment whose episodes begin with ``begin``: a seed, and actions that are replayed.

    ``begin`` stays as it is until it is set to another value; setting it to None does nothing.
    Until it is first set, episodes begin as in the wrapped environment.  There are two environments
    of ``make``: while the agent plays in one, :meth:`prepare` brings the other one to the start of
    the next episode.
    """

    def __init__(self, make: Callable[[], gymnasium.Env[Any, Any]]) -> None:
        super().__init__(make())
        self._other = make()
        self._begin: tuple[int, NDArray[np.int8]] | None = None
        self._bringing: Iterator[None] | None = None
        self._brought: tuple[Any, dict[str, Any]] = {}, {}

    @property
    def begin(self) -> tuple[int, NDArray[np.int8]] | None:
        """The seed and the replayed actions of the next episodes."""
        return self._begin

    @begin.setter
    def begin(self, begin: tuple[int, NDArray[np.int8]] | None) -> None:
        # A vector environment sets the attribute of all its environments at once, with None for most of them.
        if begin is not None:
            self._begin = begin
            self._bringing = self._bring(*begin)

    def prepare(self) -> bool:
        """Take a step of the replay towards the next start; return False once nothing is left."""
        return self._bringing is not None and next(self._bringing, self) is None

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begin an episode and finish the replay.  The replay does not end the episode."""
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
        """Replay ``actions`` in the other environment, one per step of the generator."""
        observation, info = self._other.reset(seed=seed)
        for action in actions:
            yield
            observation, _, _, _, info = self._other.step(action)
        self._brought = observation, info


class Episodes:
    """The current episode of each environment of ``env``: its start and all actions so far.

    The environments are :class:`Replayed`; ``draw`` draws the start of each next episode.  The
    constructor begins the first episodes: ``observation`` is their first observation.  ``replayed``
    counts the replayed decisions.

    All methods raise WorkerError, with the seeds of the starts, if a worker is lost.
    """

    def __init__(self, env: WorkerVectorEnv, draw: Callable[[], EpisodeStart]) -> None:
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
        """Record actions [num_envs, branches] and step all environments; return their results."""
        for past_actions, action in zip(self.actions, actions.tolist(), strict=True):
            past_actions.append(action)
        with self._telling():
            return self._env.step(actions)

    def turn(self, over: NDArray[np.bool_]) -> None:
        """Record that the next episodes have begun in the environments of the mask ``over``."""
        rows = np.flatnonzero(over).tolist()
        if rows:
            self._go_on(rows)
            self._tell(rows)

    def cut(self, over: NDArray[np.bool_]) -> Any:
        """Cut off the episodes of the mask ``over``, begin the next; return all observations."""
        rows = np.flatnonzero(over).tolist()
        self._go_on(rows)
        with self._telling():
            observation, _ = self._env.reset(options={"reset_mask": over})
        self._tell(rows)
        return observation

    def is_spent(self, row: int) -> bool:
        """Whether the agent has made all decisions that the start of the episode allows."""
        start = self.starts[row]
        return start.most is not None and len(self.actions[row]) - len(start.actions) >= start.most

    def _go_on(self, rows: Iterable[int]) -> None:
        """Go on to the next episodes of these environments, and draw the starts after them."""
        for row in rows:
            start = self.starts[row] = self._next[row]
            self.actions[row] = [list(action) for action in start.actions]
            self.replayed += len(start.actions)
            self._next[row] = self._draw()

    @contextmanager
    def _telling(self) -> Iterator[None]:
        """Add the seeds of the starts and the replayed steps to the error about a lost worker."""
        try:
            yield
        except WorkerError as error:
            raise WorkerError(error.loss, tuple(map(self._placed, error.playing))) from error

    def _placed(self, playing: Playing) -> Playing:
        """Return ``playing`` with the actual seed and step, which the environment does not know."""
        row = playing.env
        return replace(playing, seed=self.starts[row].seed, episode=1, step=len(self.actions[row]))

    def _tell(self, rows: Iterable[int]) -> None:
        """Send the environments of these rows the starts of their next episodes."""
        begin: list[tuple[int, NDArray[np.int8]] | None] = [None] * self._env.num_envs
        for row in rows:
            begin[row] = self._next[row].seed, np.array(self._next[row].actions, dtype=np.int8)
        with self._telling():
            self._env.set_attr("begin", begin)
