"""Read where an environment says that its entities are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isnan
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.geometry import Point
from tltl_runtime.game.outline import GREATEST, LONGEST_NAME
from tltl_runtime.gymnasium_games.value_text import type_text
from tltlc.api import record

PLAYER: Final = "player"
MOST_ENTITIES: Final = 1_000
"""The most entities of an episode."""

_STILL_M: Final = 1e-6
"""An entity that moves by no more than this many metres counts as still."""


class PositionsError(ValueError):
    """Raised for positions that cannot be used.

    The text says what is wrong with them, and ``help`` how to correct it.
    """

    def __init__(self, problem: str, help_: str) -> None:
        super().__init__(problem)
        self.help = help_


def read_positions(value: object) -> dict[str, Point]:
    """Return the positions in ``value``, which a game gives, by name and in metres; without a z, z is 0.

    An entity whose position is None or not-a-number is gone, and is left out.

    Raises:
        PositionsError: the value is not a mapping from names to positions, or has too many entities.
    """
    if not isinstance(value, Mapping):
        help_ = "return a mapping from names to positions: `{'player': (1.0, 2.0)}`"
        raise PositionsError(f"returns {type_text(value)}, not a mapping", help_)
    if len(value) > MOST_ENTITIES:
        title = f"names {len(value):,} entities, and at most {MOST_ENTITIES:,} are allowed"
        raise PositionsError(title, "leave some out")
    points = {str(name): _point(str(name), place) for name, place in value.items() if place is not None}
    return {name: point for name, point in points.items() if not any(map(isnan, point))}


def _point(name: str, place: Any) -> Point:
    if not 0 < len(name) <= LONGEST_NAME:
        raise PositionsError(f"names an entity {name!r:.40}", f"give it from 1 to {LONGEST_NAME} characters")
    try:
        numbers = [float(number) for number in place]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) not in (2, 3) or any(abs(number) > GREATEST for number in numbers):
        help_ = f"give two or three finite numbers: `{{{name!r}: (1.0, 2.0)}}`"
        raise PositionsError(f"gives no position of `{name}`", help_)
    x, y, z = (*numbers, 0.0)[:3]
    return x, y, z


@record
class EntityPositions:
    """The ``names`` of k entities, without the player, and their ``places`` at n + 1 moments.

    ``places`` is (n + 1, k, 3), in metres, and not-a-number where an entity is gone.
    """

    names: tuple[str, ...]
    places: NDArray[np.float64]

    def still(self) -> dict[str, Point]:
        """Return the places of the entities that never move while they are there, by name."""
        places: dict[str, Point] = {}
        for column, name in enumerate(self.names):
            rows = self.places[~np.isnan(self.places[:, column, 0]), column]
            if len(rows) and np.ptp(rows, axis=0).max() <= _STILL_M:
                x, y, z = rows[0].tolist()
                places[name] = (x, y, z)
        return places


def entity_positions(moments: Sequence[Mapping[str, Point]]) -> EntityPositions:
    """Return the positions of the entities of an episode, without the player.

    ``moments`` has the positions of all entities by name, at the reset and after each step. The entities
    are in the order in which they first appear.

    Raises:
        PositionsError: there are more than ``MOST_ENTITIES``.
    """
    names = tuple(dict.fromkeys(name for moment in moments for name in moment if name != PLAYER))
    if len(names) > MOST_ENTITIES:
        title = f"has named {len(names):,} entities in an episode, and at most {MOST_ENTITIES:,} are allowed"
        raise PositionsError(title, "give an entity the same name throughout an episode")
    gone = (np.nan,) * 3
    places = [[moment.get(name, gone) for name in names] for moment in moments]
    return EntityPositions(names, np.array(places, dtype=np.float64).reshape(len(moments), len(names), 3))
