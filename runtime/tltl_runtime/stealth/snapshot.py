"""The actions and the visible state of the game.

Importing this module does not load the physics.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from typing import Final

from tltl_runtime.stealth.enemies.enemy import CROUCHED_HEAD, STANDING_HEAD, PlayerView
from tltl_runtime.stealth.level import Box, Point, StealthLevel, fixed_places
from tltl_runtime.stealth.world.player import PlayerState
from tltlc.api import record

CHOICES: Final[Mapping[str, tuple[str, ...]]] = {
    "x": ("stay", "greater", "smaller"),
    "y": ("stay", "greater", "smaller"),
    "jump": ("no", "yes"),
    "crouch": ("no", "yes"),
    "sprint": ("no", "yes"),
}
"""The branches of an action, each with the names of its choices.

``greater`` moves the player towards greater coordinates, ``smaller`` towards smaller ones.
"""

BRANCHES: Final = tuple(map(len, CHOICES.values()))
"""The number of choices of each branch: (3, 3, 2, 2, 2)."""

ACTIONS: Final = frozenset(product(*map(range, BRANCHES)))
"""All valid actions: for each branch, the index of a choice."""


@record
class Snapshot:
    """The visible state at one moment, for recordings and pictures.

    ``time`` is in seconds since the reset, ``health`` in [0, 1]. All tuples are in the order of the
    level. ``enemies`` are the positions of the enemies' feet, ``yaws`` their yaws in radians,
    ``modes`` their modes (``patrol``, ``chase``, ``search``, ``return``), and ``sees`` says which
    of them see the player. ``movers`` are the centres of the movers. ``active`` and ``open`` say
    which switches are active and which barriers are open.
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


def places(level: StealthLevel, shot: Snapshot) -> dict[str, Point]:
    """Return the positions of the entities of a level in a snapshot, by name."""
    enemies = {enemy.name: place for enemy, place in zip(level.enemies, shot.enemies, strict=True)}
    movers = {mover.name: place for mover, place in zip(level.movers, shot.movers, strict=True)}
    return fixed_places(level) | enemies | movers


def player_view(player: PlayerState) -> PlayerView:
    """Return the part of the player's state that enemies can perceive."""
    head = CROUCHED_HEAD if player.crouching else STANDING_HEAD
    return PlayerView(player.position, head)


def touches(feet: Point, radius: float, height: float, box: Box) -> bool:
    """Whether the upright bounding box of a body overlaps ``box``.

    The body stands at ``feet``. It is ``height`` metres tall and extends ``radius`` metres to each
    side.
    """
    (x, y, z), (x0, y0, z0), (x1, y1, z1) = feet, box.low, box.high
    return x0 - radius < x < x1 + radius and y0 - radius < y < y1 + radius and z0 - height < z < z1
