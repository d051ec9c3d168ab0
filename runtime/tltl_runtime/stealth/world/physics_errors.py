"""Turn physics errors that a level causes into diagnostics of the level."""

from __future__ import annotations

import sys
from typing import Final

from tltlc.api import Diagnostic, TltlError

_PHYSICS: Final = "tltl_runtime.stealth.world.physics"
"""The module of the physics, which raises the errors. It is slow to import, and may lack pybullet."""


def player_fault(error: RuntimeError) -> TltlError | None:
    """Return the diagnostic TLT0806 if ``error`` is a WorldError about the player, else None.

    For a level that was read from a file, such an error means that the player has left the level's
    bounds; this is a fault of the level. Other errors of the physics are not the level's fault.
    """
    if _PHYSICS not in sys.modules:
        return None
    from tltl_runtime.stealth.world.physics import WorldError

    if not isinstance(error, WorldError) or error.body != "player":
        return None
    help_ = "make its bounds higher than a jump (1 m) leads; `tltlc check --level` says how high that is"
    return TltlError([Diagnostic("TLT0806", str(error), help=help_)])
