"""The games that the runtime plays, by name, and the game that a level belongs to."""

from __future__ import annotations

import os
import sys
from importlib import import_module
from typing import Any, Final

from tltl_runtime.game.game import Game
from tltlc.api import TltlError

STEALTH: Final = "stealth"

_MODULES: Final = {STEALTH: "tltl_runtime.stealth.stealth_game"}
"""The modules of the games. The ``GAME`` in a module is the game.

They are imported by their names, so that commands, evaluation, training and regression tests need
not import a particular game. The maps of ``regression.report.page.stealth`` still import the stealth
game themselves.
"""


def game_named(name: str) -> Game[Any, Any]:
    """Return the game with this name.

    The levels and recordings of the stealth game can be read even if its physics engine is not
    installed.

    Raises:
        KeyError: there is no such game.
    """
    game: Game[Any, Any] = import_module(_MODULES[name]).GAME
    return game


def game_of(level: str) -> Game[Any, Any]:
    """Return the game that a level belongs to; ``level`` is its name or the path of its file.

    The level need not exist.
    """
    del level  # All levels are of the stealth game.
    return game_named(STEALTH)


def game_of_recording(path: str | os.PathLike[str]) -> Game[Any, Any]:
    """Return the game whose episode is recorded in a file, which need not exist."""
    del path  # All recordings are of the stealth game.
    return game_named(STEALTH)


def level_fault(error: RuntimeError) -> TltlError | None:
    """Return the error to report if a level has caused ``error`` in play, else None.

    Only the games that this process has loaded are asked: no other can have raised it.
    """
    games = [game_named(name) for name, module in _MODULES.items() if module in sys.modules]
    return next(filter(None, (game.level_fault(error) for game in games)), None)
