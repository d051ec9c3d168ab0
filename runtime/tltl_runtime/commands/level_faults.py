"""What a level does to its player in the physics, told as a fault of the level."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


@contextmanager
def level_faults() -> Iterator[None]:
    """TLT0806 where a player has left the level; other errors of the physics pass, since they are ours."""
    try:
        yield
    except RuntimeError as error:
        # Not before it is needed: it loads the physics.
        from tltl_runtime.stealth.world.physics import WorldError

        if not isinstance(error, WorldError) or error.body != "player":
            raise
        help_ = "make its bounds higher than a jump leads, 1 m; `tltlc check --level` tells where one gets"
        raise TltlError([Diagnostic("TLT0806", str(error), help=help_)]) from error
