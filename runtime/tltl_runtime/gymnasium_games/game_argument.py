"""Games in arguments: ``FILE.game.toml``, ``FILE.game.toml:SCENE``, ``FILE.game.toml:SCENE:VARIANT``."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

from tltl_runtime.gymnasium_games.game_file import FIRST_VARIANT, SUFFIX, GameFile, GameScene, SceneVariant
from tltl_runtime.support.suggestion import suggestion
from tltlc.api import Diagnostic, TltlError, fileio, record

_ARGUMENT: Final = re.compile(r"(?P<path>.+?\.toml)(?::(?P<scene>[^:/\\]+))?(?::(?P<variant>[^:]+))?\Z", re.DOTALL)


@record
class GameArgument:
    """A game file, a scene and a variant; None where the argument names none."""

    path: Path
    scene: str | None
    variant: str | None


def parse_game(text: str) -> GameArgument:
    """Parse ``FILE.game.toml[:SCENE[:VARIANT]]``.

    Raises:
        TltlError: TLT0800, the text does not name a game file.
    """
    match = _ARGUMENT.match(text)
    if fileio.is_file(text) or match is None:
        path, scene, variant = text, None, None
    else:
        path, scene, variant = match["path"], match["scene"], match["variant"]
    if not path.endswith(".toml"):
        title, help_ = f"`{text}` is not a game file", f"name a file `NAME{SUFFIX}`, and after it `:SCENE:VARIANT`"
        if fileio.is_file(f"{text}{SUFFIX}"):
            help_ = f"did you mean the file `{text}{SUFFIX}`?"
        raise TltlError([Diagnostic("TLT0800", title, help=help_)])
    return GameArgument(Path(path), scene, variant)


def scene_of(game: GameFile, name: str | None) -> GameScene:
    """Return the scene with this name; without a name, the first one.

    Raises:
        TltlError: TLT0800, there is no such scene.
    """
    if name is None:
        return game.scenes[0]
    names = {scene.name: scene for scene in game.scenes}
    if name not in names:
        title = f"`{game.path.name}` has no scene `{name}`"
        raise TltlError([Diagnostic("TLT0800", title, help=suggestion(name, names))])
    return names[name]


def variant_of(game: GameFile, scene: str, variant: str = FIRST_VARIANT) -> SceneVariant:
    """Return a variant of a scene.

    Raises:
        TltlError: TLT0800, there is no such scene or variant, or the scene stands for a level.
    """
    variants = scene_of(game, scene).variants
    if game.levels is not None:
        title = f"the scene `{scene}` of `{game.path.name}` stands for a level of the game `{game.levels}`"
        raise TltlError([Diagnostic("TLT0800", title, help=f"name the level instead: `{scene}`")])
    if variant not in variants:
        title = f"the scene `{scene}` of `{game.path.name}` has no variant `{variant}`"
        raise TltlError([Diagnostic("TLT0800", title, help=suggestion(variant, variants))])
    return variants[variant]
