"""Turn physics errors that a level causes into diagnostics of the level."""

from __future__ import annotations

import sys
from typing import Final

from tltlc.api import Diagnostic, TltlError

_PHYSICS: Final = "tltl_runtime.stealth.world.physics"
"""The module of the physics, which raises the errors. It is slow to import, and may lack pybullet."""


def player_fault(error: RuntimeError) -> TltlError | None:
    """Return a diagnostic of the level if ``error`` is a WorldError about the player, else None.

    It is TLT0806 if the player has left the level's bounds, and TLT0807 if there is no room for the
    player at the start. Other errors of the physics are not the level's fault.
    """
    if _PHYSICS not in sys.modules:
        return None
    from tltl_runtime.stealth.world.physics import NoRoomError, WorldError

    if isinstance(error, NoRoomError):
        help_ = "move the start away from what stands there, or reduce its `spread`"
        return TltlError([Diagnostic("TLT0807", str(error), help=help_)])
    if not isinstance(error, WorldError) or error.body != "player":
        return None
    help_ = "make its bounds higher than a jump (1 m) leads; `tltlc check --level` says how high that is"
    return TltlError([Diagnostic("TLT0806", str(error), help=help_)])
