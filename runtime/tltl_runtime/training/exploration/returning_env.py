"""An environment of any game for a search: it returns to earlier moments, and says in which cell it is."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any, Final

import gymnasium
import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.game import Game
from tltl_runtime.policies.spaces.values import flat_action
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.training.exploration.action_encoding import ActionEncoding
from tltl_runtime.training.exploration.cells import CellGrid, cell_of
from tltl_runtime.training.exploration.replayed_starts import OTHER_SEED, UNREPEATED
from tltl_runtime.training.exploration.snapshots import SnapshotStore, release_of, restore, save
from tltl_runtime.wire.errors import REPORTED, WireError

_SNAPSHOT_INTERVAL: Final = 16
"""An episode is saved each time it has gone on for this many steps."""


class ReturningEnv(gymnasium.Wrapper[Any, Any, Any, Any]):
    """An environment whose episodes begin where a seed and some actions lead.

    ``next_start`` is used as in :class:`~tltl_runtime.training.exploration.replayed_starts.ReplayedStartEnv`,
    but there is only one environment, because a game may need much memory or a process of its own.
    With ``snapshots``, the game saves its state from time to time; a reset then returns to the last
    saved moment on the way, and replays only the remaining actions.

    If a game in another process is lost on the way, the next reset begins at the level's start with
    another seed. Its info has this seed, as ``OTHER_SEED``. The snapshots of a lost game are forgotten. If
    the episode ends on the way, so that the game does not play it again, the same reset begins with
    another seed; its info also has ``UNREPEATED``.

    ``info`` gains ``cell``, by ``grid``; without a ``grid``, the environment gives its own. ``game`` says
    where the player is. ``make`` makes the environment.
    """

    def __init__(
        self, make: Callable[[], TltlEnv], *, game: Game[Any, Any], grid: CellGrid | None, snapshots: bool = False
    ) -> None:
        self._play = make()
        super().__init__(self._play)
        self._game, self._grid = game, grid
        self._encoding = ActionEncoding(self._play.action_space)
        self._store = SnapshotStore(release_of(self._play)) if snapshots else None
        self._next_start: tuple[int, NDArray[Any]] | None = None
        self._seed, self._actions, self._unsaved = 0, b"", 0
        self._has_begun = self._is_elsewhere = False

    @property
    def next_start(self) -> tuple[int, NDArray[Any]] | None:
        """The seed of the next episodes and the flat actions [n, width] that lead to their starts.

        It is None until it is first set.
        """
        return self._next_start

    @next_start.setter
    def next_start(self, next_start: tuple[int, NDArray[Any]] | None) -> None:
        # A vector environment sets the attribute of all its environments at once, with None for most of them.
        if next_start is not None:
            self._next_start, self._is_elsewhere = next_start, False

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begin an episode where ``next_start`` leads; return observation and info there.

        ``seed`` and ``options`` are used only before ``next_start`` is first set.

        Raises:
            WireError: the game is lost on the way.
        """
        if self._next_start is None:
            observation, info = self._play.reset(seed=seed, options=options)
            return observation, self._with_cell(info)
        self._seed, flat = self._next_start
        unrepeated: dict[str, Any] = {}
        try:
            arrival = self._go_to_start([self._encoding.value(action) for action in flat])
            if arrival is None:
                self._seed = self._begin_elsewhere(flat)
                unrepeated = {UNREPEATED: True}
                arrival = self._nearest(())[:2]
        except WireError:
            # The game may be lost on this way each time.
            self._begin_elsewhere(flat)
            self._forget_snapshots()
            raise
        observation, info = arrival
        elsewhere = {OTHER_SEED: self._seed} if self._is_elsewhere else {}
        return observation, {**self._with_cell(info), **elsewhere, **unrepeated}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Take a step; ``info`` says in which cell the player then is. Raises WireError if the game is lost."""
        try:
            observation, reward, terminated, truncated, info = self._play.step(action)
            if self._next_start is not None and not (terminated or truncated):
                self._record(action, observation, info)
        except WireError:
            self._forget_snapshots()
            raise
        return observation, reward, terminated, truncated, self._with_cell(info)

    def _begin_elsewhere(self, flat: NDArray[Any]) -> int:
        """Let the next episodes begin at the level's start, with another seed; return this seed."""
        seed = _other_seed(self._seed)
        self._next_start, self._is_elsewhere = (seed, flat[:0]), True
        return seed

    def _go_to_start(self, values: Sequence[Any]) -> tuple[Any, dict[str, Any]] | None:
        """Go where the actions ``values`` lead from the seed; return the observation and the info there.

        None if the episode ends on the way.
        """
        observation, info, done = self._nearest(values)
        for value in values[done:]:
            observation, _, terminated, truncated, info = self._play.step(value)
            if terminated or truncated:
                return None
            self._record(value, observation, info)
        if self._unsaved:
            self._save(observation, info)
        return observation, info

    def _nearest(self, actions: Sequence[Any]) -> tuple[Any, dict[str, Any], int]:
        """Go to the nearest known moment before the end of ``actions``, or to the start.

        Return the observation and the info there, and how many actions lead there. If the game does not
        return to a snapshot, warn with TLT0784, and use no snapshots from now on.

        Raises:
            WireError: the game is lost.
        """
        saved = None
        if self._store is not None and self._has_begun:
            saved = self._store.nearest(self._seed, b"".join(map(self._bytes, actions)))
        if saved is not None:
            self._actions, moment = saved
            problem = None
            try:
                problem = restore(self._play, moment)
            except WireError as error:
                if error.diagnostics[0].code != REPORTED:
                    raise
                problem = error.diagnostics[0].title
            except Exception as error:  # The code of the game may raise anything.
                problem = str(error) or type(error).__name__
            if problem is None:
                self._unsaved = 0
                return moment.observation, moment.info, moment.spec.monitor.steps
            store, self._store = self._store, None
            warnings.warn(
                f"TLT0784: the game did not return to a snapshot ({problem}): actions are replayed from now on",
                stacklevel=2,
            )
            if store is not None:
                store.clear()
        observation, info = self._play.reset(seed=self._seed)
        self._actions, self._unsaved, self._has_begun = b"", 0, True
        return observation, info, 0

    def _record(self, action: Any, observation: Any, info: dict[str, Any]) -> None:
        """Add an action to those of the episode, and save the episode if it is time."""
        if self._store is None:
            return
        self._actions += self._bytes(action)
        self._unsaved += 1
        if self._unsaved >= _SNAPSHOT_INTERVAL:
            self._save(observation, info)

    def _save(self, observation: Any, info: dict[str, Any]) -> None:
        if self._store is not None and not self._store.is_used_up:
            self._store.add(self._seed, self._actions, save(self._play, observation, info))
            self._unsaved = 0

    def _forget_snapshots(self) -> None:
        """Forget the snapshots of a game that was lost: the next reset starts it again."""
        if self._store is not None:
            self._store = SnapshotStore(release_of(self._play))

    def _bytes(self, action: Any) -> bytes:
        return flat_action(self._encoding.layout, action).tobytes()

    def _with_cell(self, info: dict[str, Any]) -> dict[str, Any]:
        if self._grid is None:
            return info
        position = None if self._grid.side is None else self._game.player_position(self._play)
        return {**info, "cell": cell_of(self._grid, position, self._play.sample)}


def _other_seed(seed: int) -> int:
    return int(np.random.default_rng(seed).integers(2**31))
