"""What is done in one decision of the game, and what there is to see after it; it needs no physics."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from typing import Final

from tltl_runtime.stealth.enemies.enemy import CROUCHED_HEAD, STANDING_HEAD, PlayerView
from tltl_runtime.stealth.level import Box, Level, Point, fixed_places
from tltl_runtime.stealth.world.player import PlayerState
from tltlc.core.record import record

CHOICES: Final[Mapping[str, tuple[str, ...]]] = {
    "x": ("stay", "greater", "smaller"),
    "y": ("stay", "greater", "smaller"),
    "jump": ("no", "yes"),
    "crouch": ("no", "yes"),
    "sprint": ("no", "yes"),
}
"""The branches of an action by name, and what their choices are called; greater: towards greater values."""

BRANCHES: Final = tuple(map(len, CHOICES.values()))
"""How many choices each branch has: (3, 3, 2, 2, 2)."""

ACTIONS: Final = frozenset(product(*map(range, BRANCHES)))
"""All that there are."""


@record
class Snapshot:
    """What there is to see at one moment, for logs and pictures; tuples are in the level's order.

    ``modes`` are those of the enemies (``patrol``, ``chase``, ``search``, ``return``), ``sees`` whether the player is
    in their sight.
    """

    time: float
    player: PlayerState
    health: float
    enemies: tuple[Point, ...]
    yaws: tuple[float, ...]
    modes: tuple[str, ...]
    sees: tuple[bool, ...]
    movers: tuple[Point, ...]
    active: tuple[bool, ...]
    open: tuple[bool, ...]


def places(level: Level, shot: Snapshot) -> dict[str, Point]:
    """Where each entity of a level is at that moment, by name."""
    enemies = {enemy.name: place for enemy, place in zip(level.enemies, shot.enemies, strict=True)}
    movers = {mover.name: place for mover, place in zip(level.movers, shot.movers, strict=True)}
    return fixed_places(level) | enemies | movers


def player_view(player: PlayerState) -> PlayerView:
    """What enemies can know of the player."""
    head = CROUCHED_HEAD if player.crouching else STANDING_HEAD
    return PlayerView(player.position, head)


def touches(feet: Point, radius: float, height: float, box: Box) -> bool:
    """Whether an upright box around the body meets ``box``."""
    (x, y, z), (x0, y0, z0), (x1, y1, z1) = feet, box.low, box.high
    return x0 - radius < x < x1 + radius and y0 - radius < y < y1 + radius and z0 - height < z < z1
