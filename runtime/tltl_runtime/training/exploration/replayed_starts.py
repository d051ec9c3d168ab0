"""Begin a training episode at the level's start, or in the middle of an earlier episode.

:class:`~tltl_runtime.training.exploration.reverse_curriculum.ReverseCurriculum` chooses the starts.

Equal seeds and actions give equal episodes. So replaying the first actions of an episode reaches
the same state again, and the agent continues from there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, Final

import gymnasium
import numpy as np
from numpy.typing import NDArray

from tltl_runtime.training.exploration.action_encoding import ActionEncoding, Row
from tltl_runtime.vector import WorkerVectorEnv
from tltl_runtime.vector.errors import Playing, WorkerError
from tltl_runtime.wire.surviving_env import faults_in
from tltlc.api import Diagnostic, TltlError, record, replace

OTHER_SEED: Final = "other_seed"
"""The key of a reset's info that has the seed of an episode whose game was lost on the way to its start.

The episode begins at the level's start instead, with this seed.
"""

UNREPEATED: Final = "unrepeated"
"""The key of a reset's info that is True where the episode ended on the way to its start, as it did not before.

The episode begins elsewhere, as :data:`OTHER_SEED` says.
"""

_LEAST_UNREPEATED: Final = 10
"""Fewer starts than these may be left out, however few there are in all."""


@record
class EpisodeStart:
    """The start of an episode: its seed, and ``actions`` to replay first, as rows [n, width].

    An episode may start in a segment of a demonstration. ``segment`` is then a pair: which atoms
    were true at the end of the demonstration, as a bit mask
    (:func:`~tltl_runtime.training.exploration.search.end_of`), and the index of the segment, from
    0. Otherwise ``segment`` is None. The episode is cut off after ``max_decisions`` decisions of
    the agent; None means that it is never cut off.
    """

    seed: int
    actions: Sequence[Row] = ()
    segment: tuple[int, int] | None = None
    max_decisions: int | None = None


class ReplayedStartEnv(gymnasium.Wrapper[Any, Any, Any, Any]):
    """An environment whose episodes begin after replayed actions.

    Set ``next_start`` to a seed and to the actions to replay. It keeps its value for all later
    episodes; setting it to None does nothing. Until it is first set, episodes begin as in the
    wrapped environment. ``make`` returns a new environment to wrap. It is called twice: while the
    agent plays in one environment, :meth:`prepare` replays the actions for the next episode in the
    other.
    """

    def __init__(self, make: Callable[[], gymnasium.Env[Any, Any]]) -> None:
        super().__init__(make())
        self._spare_env = make()
        self._encoding = ActionEncoding(self.env.action_space)
        self._next_start: tuple[int, NDArray[Any]] | None = None
        self._replay: Iterator[None] | None = None
        self._replayed: tuple[Any, dict[str, Any]] = {}, {}

    @property
    def next_start(self) -> tuple[int, NDArray[Any]] | None:
        """The seed of the next episodes, and the actions [n, width] to replay, squashed to their bounds.

        It is None until it is first set.
        """
        return self._next_start

    @next_start.setter
    def next_start(self, next_start: tuple[int, NDArray[Any]] | None) -> None:
        # A vector environment sets the attribute of all its environments at once, with None for most of them.
        if next_start is not None:
            self._next_start = next_start
            self._replay = self._replay_in_spare(*next_start)

    def prepare(self) -> bool:
        """Replay one action for the next episode; return False if the replay has ended."""
        return self._replay is not None and next(self._replay, self) is None

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Finish the replay, and begin the episode at its end; return observation and info there.

        ``seed`` and ``options`` are used only before ``next_start`` is first set.
        """
        if self._next_start is None:
            return self.env.reset(seed=seed, options=options)
        self._replay = self._replay or self._replay_in_spare(*self._next_start)
        while self.prepare():
            pass
        self._replay = None
        self.env, self._spare_env = self._spare_env, self.env
        return self._replayed

    def close(self) -> None:
        """Close both environments."""
        super().close()
        self._spare_env.close()

    def _replay_in_spare(self, seed: int, actions: NDArray[Any]) -> Iterator[None]:
        """Replay ``actions`` in the environment in which the agent does not play.

        This is a generator: it yields once before each action.
        """
        observation, info = self._spare_env.reset(seed=seed)
        for action in actions:
            yield
            observation, _, _, _, info = self._spare_env.step(self._encoding.value(action))
        self._replayed = observation, info


class EpisodesInProgress:
    """The current episode of each environment of ``env``: its start and all actions so far.

    The environments of ``env`` are :class:`ReplayedStartEnv`. ``draw`` is called for the start of
    each new episode. The constructor begins the first episodes; ``observation`` is the batch of
    their first observations. ``starts`` and ``actions`` have an entry for each environment: the
    start of its current episode, and all actions of the episode, including the replayed ones. If an
    environment says with ``OTHER_SEED`` that its episode begins elsewhere, ``starts`` has that start.
    ``replayed`` counts all replayed actions. What happens to games that are lost is added to ``faults``.
    ``unrepeated`` has the starts to which the game did not lead again, because their episodes ended on the way.

    Raises:
        WorkerError: from any method, a worker was lost; the error names the seeds of the episodes.
        TltlError: TLT0783, from any method, the game has not led to most of the starts again.
    """

    def __init__(
        self, env: WorkerVectorEnv, draw: Callable[[], EpisodeStart], faults: list[Diagnostic] | None = None
    ) -> None:
        self._env = env
        self.faults: list[Diagnostic] = [] if faults is None else faults
        self._draw = draw
        self._encoding = ActionEncoding(env.single_action_space)
        self._next = [draw() for _ in range(env.num_envs)]
        self.starts = list(self._next)
        self.actions: list[list[Row]] = [[] for _ in self._next]
        self.replayed = 0
        self.unrepeated: list[EpisodeStart] = []
        self._returns = 0
        self._other_seeds: dict[int, int] = {}
        self._ended_on_the_way: set[int] = set()
        self._send_starts(range(env.num_envs))
        with self._starts_in_errors():
            self.observation, infos = env.reset()
        self._note_losses(infos)
        self.start_next(np.ones(env.num_envs, dtype=np.bool_))

    def step(self, actions: NDArray[Any]) -> tuple[Any, ...]:
        """Record actions, given as rows [num_envs, width], and step all environments with them.

        Return what the vector environment's ``step`` returns: observation, reward, terminated,
        truncated and infos.
        """
        for past_actions, action in zip(self.actions, actions.tolist(), strict=True):
            past_actions.append(action)
        with self._starts_in_errors():
            results = self._env.step(self._encoding.values(actions))
        self._note_losses(results[-1])
        return results

    def start_next(self, mask: NDArray[np.bool_]) -> None:
        """Record that the environments in ``mask`` [num_envs] have begun their next episodes.

        Then draw the starts of the episodes after these, and send them to the environments.
        """
        rows = np.flatnonzero(mask).tolist()
        if rows:
            self._advance(rows)
            self._begin_elsewhere()
            self._send_starts(rows)

    def cut_off(self, mask: NDArray[np.bool_]) -> Any:
        """Cut off the episodes in ``mask`` [num_envs] and begin the next ones.

        Return the observations of all environments.
        """
        rows = np.flatnonzero(mask).tolist()
        self._advance(rows)
        with self._starts_in_errors():
            observation, infos = self._env.reset(options={"reset_mask": mask})
        self._note_losses(infos)
        self._begin_elsewhere()
        self._send_starts(rows)
        return observation

    def is_spent(self, row: int) -> bool:
        """Whether the episode in environment ``row`` has used up its ``max_decisions``."""
        start = self.starts[row]
        return start.max_decisions is not None and len(self.actions[row]) - len(start.actions) >= start.max_decisions

    def _advance(self, rows: Iterable[int]) -> None:
        """Make the next episode of each environment in ``rows`` the current one.

        Then draw the starts of the episodes after these.
        """
        for row in rows:
            start = self.starts[row] = self._next[row]
            self.actions[row] = [list(action) for action in start.actions]
            self.replayed += len(start.actions)
            self._returns += bool(len(start.actions))
            self._next[row] = self._draw()

    def _note_losses(self, infos: Mapping[str, Any]) -> None:
        """Note which games were lost, and which of the episodes that have just begun begin elsewhere."""
        self.faults += faults_in(infos)
        self._other_seeds = _other_seeds(infos)
        self._ended_on_the_way = {*np.flatnonzero(infos.get(f"_{UNREPEATED}", ())).tolist()}

    def _begin_elsewhere(self) -> None:
        """Set the starts of the episodes that ended, or whose games were lost, on the way."""
        for row, seed in self._other_seeds.items():
            if row in self._ended_on_the_way:
                self.unrepeated.append(self.starts[row])
            self.starts[row], self.actions[row] = EpisodeStart(seed), []
        self._other_seeds, self._ended_on_the_way = {}, set()
        if len(self.unrepeated) >= _LEAST_UNREPEATED and 2 * len(self.unrepeated) > self._returns:
            raise _not_repeated_error(len(self.unrepeated), self._returns, self.unrepeated[-1])

    @contextmanager
    def _starts_in_errors(self) -> Iterator[None]:
        """If the ``with`` block raises a WorkerError, add the seeds and steps of the episodes to it."""
        try:
            yield
        except WorkerError as error:
            raise WorkerError(error.loss, tuple(map(self._with_start, error.playing))) from error

    def _with_start(self, playing: Playing) -> Playing:
        """Correct the seed, episode number and step of an episode that a lost worker was playing.

        Workers do not know them, because each episode begins with replayed actions.
        """
        row = playing.env
        return replace(playing, seed=self.starts[row].seed, episode=1, step=len(self.actions[row]))

    def _send_starts(self, rows: Iterable[int]) -> None:
        """Send each environment in ``rows`` the start of its next episode."""
        next_starts: list[tuple[int, NDArray[Any]] | None] = [None] * self._env.num_envs
        for row in rows:
            next_starts[row] = self._next[row].seed, self._encoding.flat(self._next[row].actions)
        with self._starts_in_errors():
            self._env.set_attr("next_start", next_starts)


def _not_repeated_error(count: int, returns: int, last: EpisodeStart) -> TltlError:
    example = f"the episode of seed {last.seed} ends within {len(last.actions)} actions that did not end it before"
    title = f"the game does not repeat its episodes: {count} of {returns} ended on the way, where they did not before"
    help_ = (
        f"{example}; begin a new training, with equal plays for equal seeds and actions, or with `ways = 0` under "
        "`[exploration]`: no search"
    )
    return TltlError([Diagnostic("TLT0783", title, help=help_)])


def _other_seeds(infos: Mapping[str, Any]) -> dict[int, int]:
    """Return the seeds of the episodes that begin elsewhere than they should, by environment."""
    return {row: int(infos[OTHER_SEED][row]) for row in np.flatnonzero(infos.get(f"_{OTHER_SEED}", ())).tolist()}
