"""The games that the runtime plays, by name, and the game that a level belongs to."""

from __future__ import annotations

import os
import sys
from importlib import import_module
from pathlib import Path
from typing import Any, Final

from tltl_runtime.game.game import Game
from tltl_runtime.game.level_name import is_scene
from tltl_runtime.game.recording_archive import SCENE_FORMAT, STEALTH_FORMAT, format_of
from tltlc.api import TltlError

STEALTH: Final = "stealth"
GYMNASIUM: Final = "gymnasium"
"""The name that stands for all games that game files (``NAME.game.toml``) describe."""

LEVEL_GAMES: Final = (STEALTH,)
"""The games that a game file can name with ``levels``: its scenes then stand for their levels."""

_MODULES: Final = {
    STEALTH: "tltl_runtime.stealth.stealth_game",
    GYMNASIUM: "tltl_runtime.gymnasium_games.gymnasium_game",
}
"""The modules of the games. The variable ``GAME`` of a module is the game.

They are imported only when they are needed, so that commands, evaluation, training and regression
tests do not depend on a particular game.
"""

_GAMES_BY_FORMAT: Final = {STEALTH_FORMAT: STEALTH, SCENE_FORMAT: GYMNASIUM}


def game_named(name: str) -> Game[Any, Any]:
    """Return the game with this name.

    The levels and recordings of the stealth game can be read even if its physics engine is not
    installed.

    Raises:
        KeyError: there is no such game.
    """
    game: Game[Any, Any] = import_module(_MODULES[name]).GAME
    return game


def shipped_levels() -> tuple[str, ...]:
    """Return the names of the levels that come with the package, which are of the stealth game."""
    return game_named(STEALTH).level_files.names()


def game_of(level: str) -> Game[Any, Any]:
    """Return the game that a level belongs to; ``level`` is its name or the path of its file.

    The level need not exist.
    """
    return game_named(GYMNASIUM if is_scene(level) else STEALTH)


def game_of_recording(path: str | os.PathLike[str]) -> Game[Any, Any]:
    """Return the game whose episode is recorded in a file.

    If the file is missing or no recording, return a game whose method ``read_episode`` raises the
    error.
    """
    return game_named(_GAMES_BY_FORMAT.get(format_of(Path(path)) or "", STEALTH))


def level_fault(error: RuntimeError) -> TltlError | None:
    """Return the error to report if a level has caused ``error`` in play, else None.

    Only the games that this process has imported are asked, because no other can have raised ``error``.
    """
    games = [game_named(name) for name, module in _MODULES.items() if module in sys.modules]
    return next(filter(None, (game.level_fault(error) for game in games)), None)
