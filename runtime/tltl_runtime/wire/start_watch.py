"""Watch a game that is starting: give it up if it cannot run, and tell a person why it takes long."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Final

from tltl_runtime.wire.error_lines import has_unreadable_script, last_message, script_error
from tltl_runtime.wire.game_process import GameProcess
from tltlc.api import record

LONG_S: Final = 5.0
"""A line says that a game is still starting after this many seconds, and again if the game has written more."""

GRACE_S: Final = 5.0
"""Seconds in which a game says ``hello`` in spite of a script that cannot be read."""


@record
class SlowStart:
    """A game that has not said ``hello`` yet.

    ``name`` is that of the game. It has been starting for ``waited_s`` seconds and may do so for ``start_s``.
    ``last_line`` is an error in one of its scripts, else the last message that it wrote to standard error, in one
    line; empty if there is none.
    """

    name: str
    waited_s: float
    start_s: float
    last_line: str


Tell = Callable[[SlowStart], None]
_tell: ContextVar[Tell] = ContextVar("_tell", default=lambda _: None)


@contextmanager
def telling_slow_starts(tell: Tell) -> Iterator[None]:
    """Within this context, call ``tell`` when a game is still starting after some seconds."""
    token = _tell.set(tell)
    try:
        yield
    finally:
        _tell.reset(token)


class StartWatch:
    """Watches the process of the game ``name``, which may start for ``start_s`` seconds."""

    def __init__(self, name: str, process: GameProcess, start_s: float) -> None:
        self._name, self._process, self._start_s = name, process, start_s
        self._begin = self._told = time.monotonic()
        self._last_line: str | None = None
        self._unreadable_since: float | None = None
        self._is_starting = True
        self.gave_up = False
        """Whether the game was given up because a script cannot be read."""

    def end(self) -> None:
        """End the watch: the game has said ``hello``."""
        self._is_starting = self.gave_up = False

    def is_over(self) -> bool:
        """Whether the game has ended, or is given up. A wait for the game calls this again and again."""
        if self._process.has_ended():
            return True
        if self._is_starting:
            lines = self._process.lines_so_far()
            self._tell_if_slow(lines)
            self.gave_up = self._cannot_run(lines)
        return self.gave_up

    def _cannot_run(self, lines: list[str]) -> bool:
        if self._unreadable_since is None and has_unreadable_script(lines):
            self._unreadable_since = time.monotonic()
        return self._unreadable_since is not None and time.monotonic() - self._unreadable_since >= GRACE_S

    def _tell_if_slow(self, lines: list[str]) -> None:
        now = time.monotonic()
        if now - self._told < LONG_S:
            return
        last_line = script_error(lines) or last_message(lines)
        if last_line != self._last_line:
            self._told, self._last_line = now, last_line
            _tell.get()(SlowStart(self._name, now - self._begin, self._start_s, last_line))
