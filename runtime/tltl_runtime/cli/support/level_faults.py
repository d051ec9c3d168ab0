"""What a level does to its player in the physics, told as a fault of the level."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def level_faults() -> Iterator[None]:
    """TLT0806 where a player has left the level; other errors of the physics pass, since they are ours."""
    try:
        yield
    except RuntimeError as error:
        from tltl_runtime.stealth.world.faults import player_fault

        fault = player_fault(error)
        if fault is None:
            raise
        raise fault from error
