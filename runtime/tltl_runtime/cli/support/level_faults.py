"""Report a player who leaves the level: it is an error of the level, not a bug."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def level_faults() -> Iterator[None]:
    """Within this context, raise TltlError, TLT0806, if a player has left the level.

    Other errors of the physics engine are bugs: they propagate.
    """
    try:
        yield
    except RuntimeError as error:
        from tltl_runtime.stealth.world.physics_errors import player_fault

        fault = player_fault(error)
        if fault is None:
            raise
        raise fault from error
