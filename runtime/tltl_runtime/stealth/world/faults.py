"""What a level does to its player in the physics, as a fault of the level."""

from __future__ import annotations

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


def player_fault(error: RuntimeError) -> TltlError | None:
    """TLT0806 where a player has left the level; None for other errors of the physics, since these are ours."""
    # Not before it is needed: it loads the physics.
    from tltl_runtime.stealth.world.physics import WorldError

    if not isinstance(error, WorldError) or error.body != "player":
        return None
    help_ = "make its bounds higher than a jump leads, 1 m; `tltlc check --level` tells where one gets"
    return TltlError([Diagnostic("TLT0806", str(error), help=help_)])
