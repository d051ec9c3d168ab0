"""The scenes of game files that stand for levels: ``levels = "stealth"`` in ``[game]``.

Commands and suites replace such a scene by its level as soon as they read its name. So everything
else sees the level alone, whichever name the user wrote.
"""

from __future__ import annotations

from pathlib import Path

from tltl_runtime.game.level_name import is_scene, split_level, split_scene
from tltlc.api import TltlError, fileio


def level_of_scene(argument: str) -> str:
    """Return the level ``LEVEL[:VARIANT]`` that the scene ``FILE.game.toml[:SCENE[:VARIANT]]`` stands for.

    The level is the file ``SCENE.toml`` beside the game file or, if there is none, the level of that name
    that comes with the game. The variant may have overlays (``v0+OVERLAY``). Any other argument is returned
    as it is, also if the game file has errors, which reading it again will report.
    """
    place, variant = split_level(argument)
    if not is_scene(place):
        return argument
    # Imported here, because most arguments of most commands are no scenes.
    from tltl_runtime.gymnasium_games.game_argument import scene_of
    from tltl_runtime.gymnasium_games.game_file import read_game_file

    path, name = split_scene(place)
    try:
        game = read_game_file(Path(path))
        if game.levels is None:
            return argument
        scene = scene_of(game, name)
    except TltlError:
        return argument
    file = game.folder / f"{scene.name}.toml"
    level = str(file) if fileio.is_file(file) else scene.name
    return level if variant is None else f"{level}:{variant}"
