"""The game: one level, played decision by decision; it knows no spec, no reward and no end.

Same level, seed and actions give the same episode, bit for bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from tltl_runtime.stealth.enemies.enemy import CROUCHED_HEAD, STANDING_HEAD, Enemies, PlayerView
from tltl_runtime.stealth.level import Box, Level, Point
from tltl_runtime.stealth.signals import Signals, readers
from tltl_runtime.stealth.world.geometry import around
from tltl_runtime.stealth.world.physics import World
from tltl_runtime.stealth.world.player import DECISION, PlayerState
from tltlc.record import record

BRANCHES: Final = (3, 3, 2, 2, 2)
"""Of an action: x and y (0 stay, 1 towards greater, 2 towards smaller values), jump, crouch, sprint."""


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


class Game:
    """A level that is played: ``reset``, then ``step`` after ``step``.

    ``health`` is in [0, 1], ``time`` in seconds since the reset; ``active`` and ``open`` say which switches and
    barriers are.  The game goes on without health: the spec decides what is over.

    Raises:
        WorldError: the level leaves the player no room, or a body leaves the level.
    """

    def __init__(self, level: Level) -> None:
        self.level = level
        self.world = World(level)
        self.enemies = Enemies(level)
        self.readers = readers(level)
        self._unlocks = {unlock.switch: unlock.barriers for unlock in level.unlocks}
        self._sizes = [mover.size for mover in level.movers]
        self._barriers = {barrier.name: index for index, barrier in enumerate(level.barriers)}
        self.reset(0)

    def close(self) -> None:
        """Give up the physics; the game is of no use afterwards."""
        self.world.close()

    def reset(self, seed: int) -> None:
        """Begin the episode of this seed."""
        self.seed = seed
        # Each has its own numbers: what opens does not hang on how often a guard has drawn.
        start, patrols, self._unlocking = np.random.default_rng(seed).spawn(3)
        self.world.reset(start)
        self.enemies.reset(patrols)
        self.steps = 0
        self.health = 1.0
        self.active = [False] * len(self.level.switches)
        self.open = [False] * len(self.level.barriers)
        self._mover_boxes = self._boxes_of_movers()

    def step(self, action: Sequence[int]) -> None:
        """Play one decision of :data:`~tltl_runtime.stealth.world.player.DECISION` seconds: one number per branch."""
        self.world.step(action)
        self._mover_boxes = self._boxes_of_movers()
        self.enemies.step(DECISION, player_view(self.world.player), self._mover_boxes)
        self.steps += 1
        self.health = max(0.0, self.health - self.enemies.damage - self._burns() * DECISION)
        self._press_switches()

    @property
    def time(self) -> float:
        """Seconds since the reset."""
        return self.steps * DECISION

    def signals(self) -> Signals:
        """The signals that specs may use, by name; they stay those of this moment only until the next step."""
        return Signals(self)

    def mover_boxes(self) -> list[Box]:
        """Where the moving obstacles are now."""
        return self._mover_boxes

    def snapshot(self) -> Snapshot:
        """What there is to see now."""
        enemies = self.enemies
        return Snapshot(
            time=self.time,
            player=self.world.player,
            health=self.health,
            enemies=enemies.positions,
            yaws=enemies.yaws,
            modes=tuple(map(str, enemies.modes)),
            sees=enemies.sees,
            movers=self.world.mover_positions(),
            active=tuple(self.active),
            open=tuple(self.open),
        )

    def _boxes_of_movers(self) -> list[Box]:
        positions = self.world.mover_positions()
        return [Box(*around(centre, size)) for centre, size in zip(positions, self._sizes, strict=True)]

    def _press_switches(self) -> None:
        """Activate the switches that the player has come to, and open what they open."""
        feet = self.world.player.position
        pressed = False
        for index, switch in enumerate(self.level.switches):
            if not self.active[index] and _distance(feet, switch.position) <= switch.radius:
                self.active[index] = pressed = True
                choices = self._unlocks.get(switch.name)
                if choices:
                    self._open(self._barriers[choices[int(self._unlocking.integers(len(choices)))]])
        if pressed:
            self._open_what_is_bound()

    def _open_what_is_bound(self) -> None:
        """Open the barriers all of whose switches are active."""
        active = {switch.name for switch, is_active in zip(self.level.switches, self.active, strict=True) if is_active}
        for index, barrier in enumerate(self.level.barriers):
            if not self.open[index] and barrier.opened_by and active.issuperset(barrier.opened_by):
                self._open(index)

    def _open(self, barrier: int) -> None:
        self.open[barrier] = True
        self.world.set_open(barrier, True)
        self.enemies.set_open(barrier, True)

    def _burns(self) -> float:
        """The health a second that lasers take from where the player's body is."""
        player, kind = self.world.player, self.world.kind
        height = kind.crouched_height if player.crouching else kind.height
        return sum(
            barrier.damage
            for barrier, is_open in zip(self.level.barriers, self.open, strict=True)
            if barrier.kind == "laser" and not is_open and touches(player.position, kind.radius, height, barrier.box)
        )


def player_view(player: PlayerState) -> PlayerView:
    """What enemies can know of the player."""
    head = CROUCHED_HEAD if player.crouching else STANDING_HEAD
    return PlayerView(player.position, head, player.crouching, player.velocity)


def _distance(a: Point, b: Point) -> float:
    return float(((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2) ** 0.5)


def touches(feet: Point, radius: float, height: float, box: Box) -> bool:
    """Whether an upright box around the body meets ``box``."""
    return (
        all(box.low[axis] - radius < feet[axis] < box.high[axis] + radius for axis in (0, 1))
        and box.low[2] - height < feet[2] < box.high[2]
    )
