"""The game that the runtime plays."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Final

from tltl_runtime.game.game import Game

_MODULE: Final = "tltl_runtime.stealth.stealth_game"
"""The module whose ``GAME`` is the game.

It is imported by its name, so that evaluation, training and regression tests need not import a
particular game. To put another game in its place, write a module with a ``GAME`` and name it here.
The commands in ``tltl_runtime.cli``, and the maps of ``regression.report.page.stealth``, still
import the stealth game themselves.
"""


def registered_game() -> Game[Any, Any]:
    """Return the game. Its levels and recordings can be read even if its physics engine is not installed."""
    game: Game[Any, Any] = import_module(_MODULE).GAME
    return game
