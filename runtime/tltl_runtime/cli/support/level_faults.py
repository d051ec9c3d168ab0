"""Report errors in play that a level causes, such as a player who leaves it: they are not bugs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def level_faults() -> Iterator[None]:
    """Within this context, raise TltlError if a level has caused an error in play.

    In the stealth game, this is TLT0806: a player has left the level. Other errors, such as those of
    a physics engine, are bugs: they propagate.
    """
    try:
        yield
    except RuntimeError as error:
        from tltl_runtime.game.registry import level_fault

        fault = level_fault(error)
        if fault is None:
            raise
        raise fault from error
