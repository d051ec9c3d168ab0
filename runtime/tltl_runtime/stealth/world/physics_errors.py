"""Turn physics errors that a level causes into diagnostics of the level."""

from __future__ import annotations

from tltlc.api import Diagnostic, TltlError


def player_fault(error: RuntimeError) -> TltlError | None:
    """Return TLT0806 if ``error`` is a WorldError about the player, else None.

    In a level that was read from a file, it means that the player has left the bounds. The level is
    not at fault for other errors of the physics.
    """
    # Import this late, because it loads the physics.
    from tltl_runtime.stealth.world.physics import WorldError

    if not isinstance(error, WorldError) or error.body != "player":
        return None
    help_ = "make its bounds higher than a jump (1 m) leads; `tltlc check --level` says how high that is"
    return TltlError([Diagnostic("TLT0806", str(error), help=help_)])
