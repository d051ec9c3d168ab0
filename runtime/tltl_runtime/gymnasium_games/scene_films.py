"""The films of episodes of scenes: the environment renders them while the episode is played again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import closing
from typing import Final

import numpy as np

from tltl_runtime.game.films import Films, Picture
from tltl_runtime.game.moments import moment_text
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltlc.api import Diagnostic, Notation, TltlError, label_text

_ADVICE: Final = (
    "let `render()` return an array, height x width x 3, or write the signals instead: "
    "`tltlc replay RECORDING -o NAME.csv`"
)


class SceneFilms(Films[SceneEpisode]):
    """Draws the frames that the environment renders, with a strip that says what remains to be done."""

    views = ("game",)

    def frames(
        self, episode: SceneEpisode, times: Sequence[float], view: str, size: tuple[int, int], notation: Notation
    ) -> Iterator[Picture]:
        """Play the episode again, and yield a picture for each time.

        Raises:
            TltlError: TLT0731, the environment renders no pictures; TLT0800, it is unknown where the scene
                is; TLT0824, the episode differs when it is played again; the errors of
                :func:`~tltl_runtime.gymnasium_games.scene_replay.replayed_env`.
        """
        del view
        from tltl_runtime.gymnasium_games.frame_strip import with_strip
        from tltl_runtime.gymnasium_games.scene_frame import scene_frame
        from tltl_runtime.gymnasium_games.scene_replay import play_again, replayed_env

        if not episode.level.place:
            title = f"a film of `{episode.level.name}` needs its game, which plays the episode again"
            help_ = f"say where the game is: `--game {episode.level.game_name}.game.toml`"
            raise TltlError([Diagnostic("TLT0800", title, help=help_)])
        wanted = np.searchsorted(episode.times, np.array(times) + 1e-9, side="right") - 1
        with closing(replayed_env(episode, "rgb_array")) as env:
            for row, difference in enumerate(play_again(env, episode)):
                if difference is not None:
                    raise TltlError([difference])
                count = int(np.count_nonzero(wanted == row))
                if not count:
                    continue
                frame = scene_frame(env, episode.level, _ADVICE)
                state = int(episode.states[row])
                moment = moment_text(episode.times, row)
                text = f"{moment}  state {state}: {label_text(episode.fspa, state, notation)}"
                picture = with_strip(frame, text, size)
                yield from (picture for _ in range(count))
