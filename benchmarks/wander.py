"""A player who holds random actions: the load of the game's benchmarks, and what tries its walls."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

HELD = 6
"""Decisions for which an action is held, on average."""


def actions(rng: np.random.Generator) -> Iterator[tuple[int, ...]]:
    """Actions without end, each held for a while."""
    from tltl_runtime.stealth.snapshot import BRANCHES

    while True:
        action = tuple(int(rng.integers(size)) for size in BRANCHES)
        for _ in range(int(rng.geometric(1 / HELD))):
            yield action
