"""Moments of episodes that a game can return to, with its methods ``tltl_snapshot`` and ``tltl_restore``."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Iterator
from typing import Any, Final

import gymnasium
from gymnasium.wrappers import TimeLimit

from tltl_runtime.spec.wrapper import SpecState, TltlEnv
from tltl_runtime.support.same_values import copied, other_name
from tltlc.api import record

_SNAPSHOT: Final = "tltl_snapshot"
_RESTORE: Final = "tltl_restore"
_RELEASE: Final = "tltl_release"
_MOST_MOMENTS: Final = 256
"""At most this many moments are kept for each environment: those that were used last."""
_MOST_BYTES: Final = 16 << 20
"""The snapshots of an environment take at most this many bytes."""
_MOST_TAKEN: Final = 4096
"""An environment that cannot release moments saves at most this many: a game in another process keeps them all."""


@record
class SavedMoment:
    """A moment of an episode: the game, its spec, and what the environment returned there.

    ``data`` is what the game saved. ``elapsed`` are the steps that wrappers of Gymnasium have counted
    towards their limits.
    """

    data: bytes
    elapsed: tuple[int | None, ...]
    spec: SpecState
    observation: Any
    info: dict[str, Any]


def has_snapshots(env: gymnasium.Env[Any, Any]) -> bool:
    """Return whether a game can save its state and return to it."""
    return env.has_wrapper_attr(_SNAPSHOT) and env.has_wrapper_attr(_RESTORE)


def save(env: TltlEnv, observation: Any, info: dict[str, Any]) -> SavedMoment:
    """Save the present moment of an episode; ``observation`` and ``info`` are those of the last step.

    Raises:
        TypeError: the game's ``tltl_snapshot`` returns no bytes.
    """
    data = env.get_wrapper_attr(_SNAPSHOT)()
    if not isinstance(data, bytes):
        raise TypeError(f"it returns a {type(data).__name__}, not bytes")
    elapsed = tuple(limit._elapsed_steps for limit in _limits(env))
    return SavedMoment(data, elapsed, env.spec_state(), copied(observation), dict(info))


def restore(env: TltlEnv, moment: SavedMoment) -> str | None:
    """Go back to a moment of the game, of which there must have been a reset.

    Return the first signal that is not as it was, None if all are. The game's ``tltl_restore`` may
    raise any exception.
    """
    env.get_wrapper_attr(_RESTORE)(moment.data)
    for limit, steps in zip(_limits(env), moment.elapsed, strict=True):
        limit._elapsed_steps = steps
    env.restore_spec_state(moment.spec)
    return other_name(dict(env.sample), moment.spec.sample)


def release_of(env: TltlEnv) -> Callable[[bytes], None] | None:
    """Return the game's method that lets a snapshot go; None if it has none."""
    return env.get_wrapper_attr(_RELEASE) if env.has_wrapper_attr(_RELEASE) else None


class SnapshotStore:
    """The saved moments of one environment, by the seed and the actions that lead to them.

    ``release`` gets the snapshot of each moment that is forgotten, once no other moment has the same one; it may
    raise any exception.
    """

    def __init__(self, release: Callable[[bytes], None] | None = None) -> None:
        self._release = release
        self._moments: OrderedDict[tuple[int, bytes], SavedMoment] = OrderedDict()
        self._bytes = self._taken = 0

    @property
    def is_used_up(self) -> bool:
        """Whether the environment has saved as many moments as it may."""
        return self._release is None and self._taken >= _MOST_TAKEN

    def add(self, seed: int, actions: bytes, moment: SavedMoment) -> None:
        """Keep a moment; forget those that were not used for the longest time if there are too many."""
        self._taken += 1
        before = self._moments.pop((seed, actions), None)
        self._moments[seed, actions] = moment
        self._bytes += len(moment.data)
        if before is not None:
            self._let_go(before)
        while len(self._moments) > _MOST_MOMENTS or (self._bytes > _MOST_BYTES and self._moments):
            self._let_go(self._moments.popitem(last=False)[1])

    def clear(self) -> None:
        """Forget all moments."""
        while self._moments:
            self._let_go(self._moments.popitem()[1])

    def nearest(self, seed: int, actions: bytes) -> tuple[bytes, SavedMoment] | None:
        """Return the last known moment on the way that ``actions`` lead, and the actions up to it."""
        known = [key for key in self._moments if key[0] == seed and actions.startswith(key[1])]
        if not known:
            return None
        key = max(known, key=lambda key: len(key[1]))
        self._moments.move_to_end(key)
        return key[1], self._moments[key]

    def _let_go(self, moment: SavedMoment) -> None:
        """Release the snapshot of a moment that is no longer kept, unless another moment has the same one."""
        self._bytes -= len(moment.data)
        if self._release is not None and all(other.data != moment.data for other in self._moments.values()):
            self._release(moment.data)


def _limits(env: gymnasium.Env[Any, Any]) -> Iterator[TimeLimit[Any, Any]]:
    while isinstance(env, gymnasium.Wrapper):
        if isinstance(env, TimeLimit):
            yield env
        env = env.env
