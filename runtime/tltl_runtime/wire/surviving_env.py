"""An environment that goes on with the next episode if its game, in another process, is lost."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

import gymnasium

from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.lost_episodes import LossLimit
from tltlc.api import Diagnostic

LOST: Final = "lost"
"""The key of the info that is True at the end of a lost episode, and at the reset after it."""

FAULTS: Final = "faults"
"""The key of a reset's info that has the diagnostics of the games that were lost since the last reset."""

_MOST: Final = 10
"""So many episodes may always be lost; in long trainings, a tenth of all."""


class SurvivingEnv(gymnasium.Wrapper[Any, Any, Any, Any]):
    """A wrapper that cuts off an episode whose game is lost, as if a limit of time had ended it.

    ``env`` is a :class:`WireEnv` with wrappers. The step in which the game is lost has the reward 0, the
    last observation, and True as ``lost`` in its info. The next :meth:`reset` starts the game again. Its
    info has, as ``faults``, the diagnostics of all games that were lost since the last reset. So does
    ``infos`` of a vector environment, which also has ``lost``, as if a worker had been lost.
    """

    def __init__(self, env: gymnasium.Env[Any, Any]) -> None:
        super().__init__(env)
        self._limit = LossLimit(_MOST)
        self._faults: list[Diagnostic] = []
        self._last: tuple[Any, dict[str, Any]] = None, {}
        self._is_played = False
        """Whether the episode has had a step, and has neither ended nor been lost."""

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begin an episode. If the game is lost before the episode has begun, begin the next one.

        An episode that this reset cuts off after a step or more counts as played.

        Raises:
            WireError: too many episodes were lost, or too many in a row.
        """
        if self._is_played:
            self._limit.add_played()
            self._is_played = False
        was_lost = bool(self._faults)
        while True:
            try:
                observation, info = self._last = self.env.reset(seed=seed, options=options)
                break
            except WireError as error:
                self._add(error)
                # The game may be lost with this seed each time: go on with the next one.
                seed = None
        if not self._faults:
            return observation, info
        faults, self._faults = tuple(self._faults), []
        return observation, {**info, FAULTS: faults, **({LOST: True} if was_lost else {})}

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Take a step; if the game is lost, cut off the episode.

        Raises:
            WireError: too many episodes were lost, or too many in a row.
        """
        try:
            observation, reward, terminated, truncated, info = self.env.step(action)
        except WireError as error:
            self._is_played = False
            self._add(error)
            observation, info = self._last
            return observation, 0.0, False, True, {**info, LOST: True}
        self._last = observation, info
        self._is_played = not (terminated or truncated)
        if not self._is_played:
            self._limit.add_played()
        return observation, reward, terminated, truncated, info

    def _add(self, error: WireError) -> None:
        self._limit.add_lost(error.diagnostics[0])
        self._faults.append(error.diagnostics[0])


def faults_in(infos: Mapping[str, Any]) -> list[Diagnostic]:
    """Return what happened to the games that were lost, as the infos of a vector environment say it."""
    return [fault for faults in infos.get(FAULTS, ()) for fault in faults or ()]


def surviving(make: Callable[[], gymnasium.Env[Any, Any]]) -> gymnasium.Env[Any, Any]:
    """Return the environment that ``make`` makes; as a :class:`SurvivingEnv` if its game is in another process."""
    env = make()
    return SurvivingEnv(env) if isinstance(env.unwrapped, WireEnv) else env
