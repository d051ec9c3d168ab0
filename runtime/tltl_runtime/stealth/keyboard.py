"""A person plays a level in a window, in real time, and every episode is recorded."""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic
from typing import Any, Final, Protocol

from tltl_runtime.stealth.env import GameEnv
from tltl_runtime.stealth.recording import RecordEpisode
from tltl_runtime.stealth.recordings.cause import cause
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.rendering.camera import VIEWS, View
from tltl_runtime.stealth.rendering.hud import Hud, beginning, ending, hud
from tltl_runtime.stealth.rendering.interpolation import between
from tltl_runtime.stealth.rendering.render import Renderer
from tltl_runtime.stealth.snapshot import Snapshot
from tltl_runtime.stealth.window.window import Keys, Window
from tltl_runtime.stealth.world.player import DECISION


class Recordings(Protocol):
    """Where episodes go."""

    def keep(self, episode: Episode) -> None:
        """Write an episode that goes on, until it is saved."""

    def save(self, episode: Episode) -> str:
        """Write an episode that is over and return the name of its file."""


_IDLE: Final = (0, 0, 0, 0, 0)
_STANDING: Final = 0.05
"""Seconds between two looks at the keys while the game stands still."""
_KEPT: Final = 33
"""Decisions, about five seconds, after which what was played is kept."""
_SOON: Final = 1 / 60
"""Seconds between two pictures, at least."""


class KeyboardPlayer:
    """Plays episodes of ``env`` in ``window``, drawn by ``renderer``; what was played is handed to ``recordings``.

    It ends when the player stops, or where it is ``enough`` after an episode.

    Each episode is saved once: at its end, when it is begun again, and when it is stopped in whatever way, an
    exception such as KeyboardInterrupt included.  While it goes on, what there is is kept every few seconds.
    """

    def __init__(
        self,
        env: RecordEpisode,
        window: Window,
        renderer: Renderer,
        view: View,
        recordings: Recordings,
        enough: Callable[[], bool] = lambda: False,
    ) -> None:
        game = env.unwrapped
        assert isinstance(game, GameEnv)
        self._env, self._game, self._window, self._renderer = env, game.game, window, renderer
        self._recordings, self._enough = recordings, enough
        self._view = view
        self._unsaved = False

    def play(self, seed: int | None) -> None:
        """Play until the player stops; the first episode begins with ``seed``."""
        going = True
        try:
            while going:
                going = self._episode(seed) and not self._enough()
                seed = None
        finally:
            self._save()

    def _episode(self, seed: int | None) -> bool:
        """Play one episode and tell whether another is wanted."""
        _, info = self._env.reset(seed=seed)
        snapshot, fspa = self._game.snapshot(), self._env.episode.fspa
        keys = self._still(snapshot, beginning(hud(snapshot, info, fspa), self._game.level, fspa), begins=True)
        over = False
        due = monotonic()
        while not (keys.stop or keys.restart or over):
            _, _, terminated, truncated, info = self._env.step(list(keys.action))
            self._unsaved, over = True, terminated or truncated
            before, snapshot = snapshot, self._game.snapshot()
            if self._game.steps % _KEPT == 0 and not over:
                self._recordings.keep(self._env.episode)
            keys = self._move(before, snapshot, hud(snapshot, info, fspa), due)
            # A picture too many is made up for; a machine that is too slow for the game is not waited for.
            due = max(due + DECISION, monotonic() - DECISION)
        if over:
            keys = self._end(snapshot, info)
        self._save()
        return keys.restart and not keys.stop

    def _move(self, before: Snapshot, after: Snapshot, shown: Hud, began: float) -> Keys:
        """Show the way from one snapshot to the next until the decision that ``began`` then is over; the keys then.

        At least one picture is shown, however long it takes.
        """
        while True:
            self._show(between(before, after, min(1.0, (monotonic() - began) / DECISION)), shown)
            self._window.wait(_SOON)
            if monotonic() - began >= DECISION:
                return self._keys()

    def _end(self, snapshot: Snapshot, info: dict[str, Any]) -> Keys:
        """The end screen, until the player stops or plays again."""
        episode = self._env.episode
        file = self._save() or ""
        return self._still(snapshot, ending(hud(snapshot, info, episode.fspa), cause(episode), file))

    def _still(self, snapshot: Snapshot, shown: Hud, begins: bool = False) -> Keys:
        """Stand still until the player stops or begins again; where it ``begins``, until any key is held."""
        view = None
        while True:
            if view != self._view:
                self._show(snapshot, shown)
                view = self._view
            keys = self._keys()
            if keys.stop or keys.restart or (begins and keys.action != _IDLE):
                return Keys(keys.action, keys.restart and not begins, keys.stop)
            self._window.wait(_STANDING)

    def _keys(self) -> Keys:
        keys = self._window.keys()
        if keys.view:
            self._view = VIEWS[(VIEWS.index(self._view) + 1) % len(VIEWS)]
        return keys

    def _show(self, snapshot: Snapshot, shown: Hud) -> None:
        names = self._renderer.names(snapshot, self._view)
        self._window.show(self._renderer.frame(snapshot, self._view), shown, names)

    def _save(self) -> str | None:
        """Save what was played and is not saved yet."""
        if not self._unsaved:
            return None
        file = self._recordings.save(self._env.episode)
        # Not before: where saving is interrupted, it is done again.
        self._unsaved = False
        return file
