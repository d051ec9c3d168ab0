"""Report errors that a level causes while it is played, such as a player who leaves it. They are not bugs of tltlc."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def level_faults() -> Iterator[None]:
    """Within this context, raise TltlError in place of a RuntimeError that a level has caused.

    In the stealth game, this is TLT0806, a player has left the level, or TLT0807, there is no room at
    the start. Other errors, such as those of a physics engine, are bugs and propagate.
    """
    try:
        yield
    except RuntimeError as error:
        from tltl_runtime.game.registry import level_fault

        fault = level_fault(error)
        if fault is None:
            raise
        raise fault from error
