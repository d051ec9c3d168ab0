"""Scenes as games that a person can play with the keyboard."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from tltl_runtime.game.keyboard import Crouch, Keyboard, Recordings
from tltl_runtime.game.recorder import EpisodeRecorder
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltlc.api import Diagnostic

_SIZE: Final = (960, 600)


class SceneKeyboard(Keyboard[SceneEpisode]):
    """Opens a window in which a person plays a scene. It imports pygame only then."""

    views = ("game",)
    keys = (
        "those that `keys` in the game file names, or those of the environment's `get_keys_to_action()`,",
        "or 1 to 9: the actions in their order   R: again   Esc: stop",
    )
    render_mode = "rgb_array"

    def play(
        self,
        env: EpisodeRecorder[SceneEpisode],
        recordings: Recordings,
        *,
        seed: int | None,
        view: str,
        crouch: Crouch,
        enough: Callable[[], bool],
        on_lost: Callable[[Diagnostic], None],
    ) -> None:
        """Open a window and play episodes of ``env`` until the player stops or ``enough()`` is true.

        Raises:
            TltlError: those of ``Keyboard.play``; TLT0731, the game renders no pictures, or keys cannot
                choose its actions; TLT0803, the game file names more or fewer keys than there are
                actions; TLT0781, the game raises an exception.
        """
        from tltl_runtime.game.window import Window
        from tltl_runtime.gymnasium_games.key_actions import key_actions
        from tltl_runtime.gymnasium_games.scene_frame import scene_frame
        from tltl_runtime.gymnasium_games.scene_session import NO_FRAMES_ADVICE, SceneSession

        del view, crouch
        level = env.get_wrapper_attr("level")
        actions = key_actions(env, level)
        # Draw first: if there are no pictures, the error comes before the window opens.
        scene_frame(env, level, NO_FRAMES_ADVICE)
        window = Window(f"{level.name} {level.variant}", _SIZE, side=True)
        try:
            SceneSession(env, window, actions, recordings, enough, on_lost).play(seed)
        finally:
            window.close()
