"""Name a level or a scene in messages, in the way in which users name it in commands."""

from __future__ import annotations

from pathlib import Path

from tltl_runtime.game.level_name import is_scene, level_file, with_level_file
from tltl_runtime.game.registry import game_of
from tltl_runtime.support.path_text import path_text


def place_title(level: str, variant: str) -> str:
    """Return the title of a variant of a level: ``vault:v1``, ``mine/vault.toml:v1``, ``lake.game.toml:small:v1``.

    ``level`` is the name of a level or the path of its file. If it is a game file without a scene, the title
    has the first scene of the file. Raises TltlError if this file cannot be read.
    """
    file = level_file(level)
    if file is None:
        return f"{level}:{variant}"
    if is_scene(level):
        level = f"{file}:{game_of(level).level_files.level_name(level)}"
    return f"{with_level_file(level, Path(path_text(file)))}:{variant}"
