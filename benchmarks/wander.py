"""A player who holds random actions; it plays in the benchmarks of the game's speed and safety."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

HELD = 6
"""The mean number of decisions for which an action is held."""


def actions(rng: np.random.Generator) -> Iterator[tuple[int, ...]]:
    """Yield actions without end, each held for a geometrically distributed number of decisions."""
    from tltl_runtime.stealth.snapshot import BRANCHES

    while True:
        action = tuple(int(rng.integers(size)) for size in BRANCHES)
        for _ in range(int(rng.geometric(1 / HELD))):
            yield action
