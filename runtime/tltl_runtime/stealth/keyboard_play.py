"""The stealth game as a game that a person can play with the keyboard."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, cast

from tltl_runtime.game.keyboard import Crouch, Keyboard, Recordings
from tltl_runtime.game.recorder import EpisodeRecorder
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.rendering.camera import VIEWS, View
from tltl_runtime.stealth.rendering.hud import KEYS
from tltlc.api import Diagnostic

_SIZE: Final = (640, 400)


class StealthKeyboard(Keyboard[Episode]):
    """Opens a window in which a person plays.

    The modules pygame and pybullet are imported only when play begins.
    """

    views = VIEWS
    keys = KEYS

    def play(
        self,
        env: EpisodeRecorder[Episode],
        recordings: Recordings,
        *,
        seed: int | None,
        view: str,
        crouch: Crouch,
        enough: Callable[[], bool],
        on_lost: Callable[[Diagnostic], None],
    ) -> None:
        """Open a window and play episodes of ``env`` until the player stops or ``enough()`` is true.

        ``seed`` is the seed of the first episode, ``view`` the first camera view. With ``crouch``
        ``toggle``, one press of the crouch key starts crouching, and the next press ends it.
        """
        del on_lost
        from tltl_runtime.game.window import Window
        from tltl_runtime.stealth.keyboard import KeyboardPlayer
        from tltl_runtime.stealth.rendering.render import Renderer
        from tltl_runtime.stealth.window.keys import KeyReader

        level = env.get_wrapper_attr("level")
        window = Window(f"{level.name} {level.variant}", _SIZE, side=True)
        reader = KeyReader(window, sticky_crouch=crouch == "toggle")
        renderer = Renderer(level, *_SIZE)
        try:
            KeyboardPlayer(env, window, reader, renderer, cast(View, view), recordings, enough).play(seed)
        finally:
            renderer.close()
            window.close()
