"""The games that the runtime plays, by name, and the game that a level belongs to."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Final

from tltl_runtime.game.game import Game

STEALTH: Final = "stealth"

_MODULES: Final = {STEALTH: "tltl_runtime.stealth.stealth_game"}
"""The modules of the games. The ``GAME`` in a module is the game.

They are imported by their names, so that evaluation, training and regression tests need not import
a particular game. The commands in ``tltl_runtime.cli``, and the maps of
``regression.report.page.stealth``, still import the stealth game themselves.
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
