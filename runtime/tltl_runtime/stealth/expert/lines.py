"""Lines of sight: at which places an enemy sees a standing or a crouched player.

The places are those of :class:`~tltl_runtime.stealth.expert.lattice.Lattice`.
"""

from __future__ import annotations

from collections import OrderedDict
from functools import lru_cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.enemies.enemy import CHEST, CROUCHED_HEAD, EYES, STANDING_HEAD
from tltl_runtime.stealth.expert.lattice import lattice_of
from tltl_runtime.stealth.level import StealthLevel

ROUNDED: Final = 0.2
"""The positions of enemies are rounded to multiples of this, in metres, for the cache."""
_MOST_CACHED: Final = 4096
_ASIDE: Final = 0.15
"""Each place is tested at five points: its middle, and this far to each side, in metres."""


@lru_cache(maxsize=64)
def lines_of(level: StealthLevel, shut: frozenset[int]) -> LinesOfSight:
    """Return the lines of sight of a level while the barriers with the indices ``shut`` are shut.

    They are cached per process.
    """
    return LinesOfSight(level, shut)


class LinesOfSight:
    """Lines of sight to the places of a lattice, computed on demand. Moving boxes do not block them."""

    def __init__(self, level: StealthLevel, shut: frozenset[int]) -> None:
        boxes = [solid.box for solid in level.solids if solid.box.high[2] > 0.0]
        boxes += [level.barriers[index].box for index in sorted(shut) if level.barriers[index].kind == "solid"]
        self._low = np.array([box.low for box in boxes], dtype=np.float32).reshape(-1, 3, 1)
        self._high = np.array([box.high for box in boxes], dtype=np.float32).reshape(-1, 3, 1)
        places = lattice_of(level, shut).places
        steps = np.array(((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1))) * _ASIDE
        self._targets = (places[None] + steps[:, None]).astype(np.float32).reshape(-1, 2)
        self._cache: OrderedDict[tuple[int, int], NDArray[np.float32]] = OrderedDict()

    def visible_shares(self, x: float, y: float) -> NDArray[np.float32]:
        """Return how well an enemy with its eyes at ``x``, ``y`` sees a player at each place.

        The position of the eyes is rounded to multiples of 0.2 m. The result is float32 [2,
        places], first for a standing, then for a crouched player. Each place has five points: its
        middle and four around it. The value is the share of these points, in [0, 1], at which the
        enemy would see the player.
        """
        key = (round(x / ROUNDED), round(y / ROUNDED))
        shares = self._cache.get(key)
        if shares is None:
            shares = self._cache[key] = self._look(key[0] * ROUNDED, key[1] * ROUNDED)
            if len(self._cache) > _MOST_CACHED:
                self._cache.popitem(last=False)
        return shares

    def _look(self, x: float, y: float) -> NDArray[np.float32]:
        eye = np.array((x, y), dtype=np.float32)
        delta = (self._targets - eye).T
        inverse = 1.0 / np.where(np.abs(delta) < 1e-6, np.float32(1e-6), delta)
        enter: Any = np.float32(0)
        leave: Any = np.float32(1)
        for axis in (0, 1):
            a = (self._low[:, axis] - eye[axis]) * inverse[axis]
            b = (self._high[:, axis] - eye[axis]) * inverse[axis]
            enter, leave = np.maximum(enter, np.minimum(a, b)), np.minimum(leave, np.maximum(a, b))
        meets = enter < leave
        low, high = self._low[:, 2], self._high[:, 2]
        seen = np.zeros((2, len(self._targets)), dtype=bool)
        for stance, head in enumerate((STANDING_HEAD, CROUCHED_HEAD)):
            for height in (head, CHEST * head):
                fall = height - EYES
                over = (EYES + fall * leave < high) & (EYES + fall * enter > low)
                seen[stance] |= ~(meets & over).any(0)
        share: NDArray[np.float32] = seen.reshape(2, 5, -1).mean(1, dtype=np.float32)
        return share
