"""Let a person play a level in a window in real time, and record every episode."""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic
from typing import Any, Final

from tltl_runtime.game.hud import Hud, end_screen
from tltl_runtime.game.keyboard import Recordings
from tltl_runtime.game.play_session import PlaySession
from tltl_runtime.game.recorder import EpisodeRecorder
from tltl_runtime.game.window import Window
from tltl_runtime.stealth.env import GameEnv
from tltl_runtime.stealth.recordings.cause import cause
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.rendering.camera import VIEWS, View
from tltl_runtime.stealth.rendering.hud import hud, start_screen
from tltl_runtime.stealth.rendering.interpolation import interpolate
from tltl_runtime.stealth.rendering.render import Renderer
from tltl_runtime.stealth.snapshot import Snapshot
from tltl_runtime.stealth.window.keys import KeyReader, Keys
from tltl_runtime.stealth.world.player import DECISION

_IDLE: Final = (0, 0, 0, 0, 0)
_STILL_WAIT: Final = 0.05
"""Seconds between two reads of the keys while the game stands still."""
_KEEP_INTERVAL: Final = 33
"""An unfinished episode is written after every 33 time steps, about every five seconds."""
_FRAME_TIME: Final = 1 / 60
"""The shortest time between two frames, in seconds."""


class KeyboardPlayer(PlaySession[Episode]):
    """Lets a person play episodes of a level in ``window``, in real time.

    ``reader`` reads the keys of the window. ``renderer`` draws the frames; ``view`` is the first
    camera view. The other arguments are those of ``PlaySession``.
    """

    def __init__(
        self,
        env: EpisodeRecorder[Episode],
        window: Window,
        reader: KeyReader,
        renderer: Renderer,
        view: View,
        recordings: Recordings,
        enough: Callable[[], bool] = lambda: False,
    ) -> None:
        game = env.unwrapped
        assert isinstance(game, GameEnv)
        super().__init__(env, recordings, enough)
        self._game, self._window, self._reader, self._renderer = game.game, window, reader, renderer
        self._view = view

    def _episode(self, seed: int | None) -> bool:
        _, info = self._env.reset(seed=seed)
        snapshot, fspa = self._game.snapshot(), self._env.episode.fspa
        keys = self._show_still(snapshot, start_screen(hud(snapshot, info, fspa), self._game.level, fspa), begins=True)
        over = False
        due = monotonic()
        while not (keys.stop or keys.restart or over):
            _, _, terminated, truncated, info = self._env.step(list(keys.action))
            self._unsaved, over = True, terminated or truncated
            before, snapshot = snapshot, self._game.snapshot()
            if self._game.steps % _KEEP_INTERVAL == 0 and not over:
                self._recordings.keep(self._env.episode)
            keys = self._animate(before, snapshot, hud(snapshot, info, fspa), due)
            # The game makes up for a delay of up to one time step, and ignores the rest of a longer delay.
            due = max(due + DECISION, monotonic() - DECISION)
        if over:
            keys = self._end(snapshot, info)
        self._save()
        return keys.restart and not keys.stop

    def _animate(self, before: Snapshot, after: Snapshot, display: Hud, start: float) -> Keys:
        """Draw the motion between two snapshots until the current time step is over.

        The step started at ``start``, a time of ``monotonic()``. Draw at least one frame, even if
        the step is over by then. Return the input at the end of the step.
        """
        while True:
            self._show(interpolate(before, after, min(1.0, (monotonic() - start) / DECISION)), display)
            self._window.wait(_FRAME_TIME)
            if monotonic() - start >= DECISION:
                return self._keys()

    def _end(self, snapshot: Snapshot, info: dict[str, Any]) -> Keys:
        """Save the episode, and show the end screen until the person stops or restarts.

        Return the input of that moment.
        """
        episode = self._env.episode
        file = self._save() or ""
        return self._show_still(snapshot, end_screen(hud(snapshot, info, episode.fspa), cause(episode), file))

    def _show_still(self, snapshot: Snapshot, display: Hud, begins: bool = False) -> Keys:
        """Show a still frame until the person stops or restarts; return the input of that moment.

        If ``begins``, the episode has not begun yet: a key of any action also ends the frame, and
        ``restart`` is False in the result.
        """
        view = None
        while True:
            if view != self._view:
                self._show(snapshot, display)
                view = self._view
            keys = self._keys()
            if keys.stop or keys.restart or (begins and keys.action != _IDLE):
                return Keys(keys.action, keys.restart and not begins, keys.stop)
            self._window.wait(_STILL_WAIT)

    def _keys(self) -> Keys:
        keys = self._reader.keys()
        if keys.view:
            self._view = VIEWS[(VIEWS.index(self._view) + 1) % len(VIEWS)]
        return keys

    def _show(self, snapshot: Snapshot, display: Hud) -> None:
        names = self._renderer.names(snapshot, self._view)
        self._window.show(self._renderer.frame(snapshot, self._view), display, names)
