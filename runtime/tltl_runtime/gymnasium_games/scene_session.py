"""Let a person play a scene in a window, and record every episode."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from textwrap import wrap
from time import monotonic
from typing import Any, Final

import numpy as np

from tltl_runtime.game.hud import LONG, Bar, Hud, Line, clock_text, end_screen, goal_lines
from tltl_runtime.game.keyboard import Recordings
from tltl_runtime.game.play_session import PlaySession
from tltl_runtime.game.recorder import EpisodeRecorder
from tltl_runtime.game.window import Key, Window
from tltl_runtime.gymnasium_games.frame_strip import fitted
from tltl_runtime.gymnasium_games.key_actions import KeyActions
from tltl_runtime.gymnasium_games.key_names import COMMANDS
from tltl_runtime.gymnasium_games.scene_cause import scene_cause
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.gymnasium_games.scene_frame import scene_frame
from tltl_runtime.wire.errors import WireError
from tltlc.api import Diagnostic, formula_text, label_text, record, replace

NO_FRAMES_ADVICE: Final = "let a trained policy play: `tltlc evaluate POLICY --record all --out DIR`"
_STOP: Final = ("q", "escape")
_RESTART: Final = "r"
_STILL_WAIT: Final = 0.05
"""Seconds between two reads of the keys while the game stands still."""
_FRAME_TIME: Final = 1 / 60
"""The longest time for which the window does not respond, in seconds."""
_KEEP_INTERVAL_S: Final = 5.0
"""Seconds between two times at which an unfinished episode is written."""


@record
class _Wish:
    """What the person wants: an action, None if there is none, and whether to restart or to stop."""

    action: int | None
    restart: bool = False
    stop: bool = False


class SceneSession(PlaySession[SceneEpisode]):
    """Lets a person play episodes of a scene in ``window``.

    ``actions`` says which keys choose which actions. ``on_lost`` gets what happened if the game, in another process, is
    lost; the person may then start it again. The other arguments are those of ``PlaySession``.
    """

    def __init__(
        self,
        env: EpisodeRecorder[SceneEpisode],
        window: Window,
        actions: KeyActions,
        recordings: Recordings,
        enough: Callable[[], bool] = lambda: False,
        on_lost: Callable[[Diagnostic], None] = lambda _: None,
    ) -> None:
        super().__init__(env, recordings, enough)
        self._window, self._actions, self._on_lost = window, actions, on_lost
        self._frame = np.zeros((1, 1, 3), np.uint8)
        self._fspa = env.get_wrapper_attr("task").fspa
        self._level = env.get_wrapper_attr("level")
        # A key that chooses an action is not a command, but Escape always stops.
        self._commands: frozenset[Key] = frozenset(COMMANDS) - actions.keys | {"escape"}
        self._pending: deque[Key] = deque()
        """The keys that were pressed, and have had no effect yet, in a game that waits for keys."""
        self._steps = 0

    def _episode(self, seed: int | None) -> bool:
        try:
            return self._played(seed)
        except WireError as error:
            return self._after_loss(error.diagnostics[0])

    def _after_loss(self, fault: Diagnostic) -> bool:
        """Save what was played until the game was lost, and say so; return whether the person wants another episode."""
        self._on_lost(fault)
        file = self._save()
        below = (*wrap(fault.title, LONG), *([f"recorded: {file}"] if file else ()), "R: start it again   Esc: close")
        self._window.show(self._frame, Hud((), (), "the game was lost", "bad", below))
        wish = self._wait_still(ended=True)
        return wish.restart and not wish.stop

    def _played(self, seed: int | None) -> bool:
        """Play one episode until it ends or the person restarts or stops; return whether they want another."""
        _, info = self._env.reset(seed=seed)
        self._steps, over = 0, False
        self._show(self._start_screen(info))
        wish = self._wait_still(begins=True)
        due = kept = monotonic()
        while not (wish.stop or wish.restart or over):
            _, _, terminated, truncated, info = self._env.step(wish.action)
            self._steps, self._unsaved, over = self._steps + 1, True, terminated or truncated
            self._show(self._hud(info))
            if over:
                break
            if monotonic() - kept >= _KEEP_INTERVAL_S:
                self._recordings.keep(self._env.episode)
                kept = monotonic()
            wish = self._wait_still() if self._actions.idle is None else self._wait_until(due + self._actions.step_s)
            # The game catches up with a delay of up to one step. A longer delay is dropped.
            due = max(due + self._actions.step_s, monotonic() - self._actions.step_s)
        if over:
            file = self._save() or ""
            self._show(end_screen(self._hud(info), scene_cause(self._env.episode), file))
            wish = self._wait_still(ended=True)
        self._save()
        return wish.restart and not wish.stop

    def _wait_until(self, time: float) -> _Wish:
        """Keep the window responsive until a time of ``monotonic()``; return what the person then wants."""
        while (rest := time - monotonic()) > 0.0:
            self._window.wait(max(0.001, min(_FRAME_TIME, rest)))
        return self._wish(self._commands)

    def _wait_still(self, *, begins: bool = False, ended: bool = False) -> _Wish:
        """Wait until the person wants something, and return it.

        If the episode ``begins``, ignore a restart. If it has ``ended``, ignore actions; all command keys
        work then, even those that choose actions.
        """
        commands = frozenset(COMMANDS) if ended else self._commands
        while True:
            wish = self._wish(commands, still=True)
            if wish.stop or (wish.restart and not begins) or (wish.action is not None and not ended):
                return _Wish(wish.action, wish.restart and not begins, wish.stop)
            self._window.wait(_STILL_WAIT)

    def _wish(self, commands: frozenset[Key], *, still: bool = False) -> _Wish:
        """Read the keys and return what the person wants.

        ``commands`` are the keys that restart or stop the episode. If no key is held, a game that runs in
        real time gets its idle action; while it stands ``still``, it gets no action.
        """
        pressed = self._window.read(self._actions.keys | commands)
        if pressed.closed:
            return _Wish(None, stop=True)
        if self._actions.idle is None:
            self._pending.extend(pressed.tapped)
            return self._next_wish()
        given = commands.intersection(pressed.tapped)
        is_idle = still and pressed.held.isdisjoint(self._actions.keys)
        action = None if is_idle else self._actions.of_held(pressed.held)
        return _Wish(action, _RESTART in given, not given.isdisjoint(_STOP))

    def _next_wish(self) -> _Wish:
        """Return what the next pressed key means. Each press counts, even if several came at once."""
        if not self._pending:
            return _Wish(None)
        key = self._pending.popleft()
        return _Wish(self._actions.actions.get(frozenset([key])), key == _RESTART, key in _STOP)

    def _show(self, display: Hud) -> None:
        self._frame = fitted(scene_frame(self._env, self._level, NO_FRAMES_ADVICE), self._window.size)
        self._window.show(self._frame, display)

    def _hud(self, info: Mapping[str, Any]) -> Hud:
        """Return the head-up display; ``info`` is the info of the environment's last step or reset."""
        first = Line(f"{self._time_text()}   {info['verdict']}", "quiet")
        lines = goal_lines(label_text(self._fspa, info["state"]))
        return Hud((Bar("progress", info["progress"], "warn"),), (first, *lines))

    def _time_text(self) -> str:
        if self._env.has_wrapper_attr("tltl_clock_s"):
            step_s = float(self._env.get_wrapper_attr("tltl_clock_s"))
            return clock_text(self._steps * step_s, self._fspa, step_s)
        limit = self._fspa.limit_steps
        return f"step {self._steps}" + ("" if limit is None else f", {max(0, limit - self._steps)} left")

    def _start_screen(self, info: Mapping[str, Any]) -> Hud:
        goal = wrap(formula_text(self._fspa), LONG)
        commands = "R: again   Esc: stop" if _RESTART in self._commands else "Esc: stop"
        below = (*goal, "", *self._actions.lines, commands, "", "Press the key of an action to begin.")
        return replace(self._hud(info), title=f"{self._level.name} {self._level.variant}", below=below)
