"""The game: one level, played decision by decision; it knows no spec, no reward and no end.

Same level, seed and actions give the same episode, bit for bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import dist

import numpy as np

from tltl_runtime.stealth.enemies.enemy import Enemies
from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.signals import Signals, readers
from tltl_runtime.stealth.snapshot import Snapshot, player_view, touches
from tltl_runtime.stealth.world.physics import World
from tltl_runtime.stealth.world.player import DECISION


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
        self._lasers = [index for index, barrier in enumerate(level.barriers) if barrier.kind == "laser"]
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

    def step(self, action: Sequence[int]) -> None:
        """Play one decision of :data:`~tltl_runtime.stealth.world.player.DECISION` seconds: one number per branch."""
        self.world.step(action)
        self.enemies.step(DECISION, player_view(self.world.player), self.world.mover_boxes())
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

    def _press_switches(self) -> None:
        """Activate the switches that the player has come to, and open what they open."""
        feet = self.world.player.position
        pressed = False
        for index, switch in enumerate(self.level.switches):
            if not self.active[index] and dist(feet, switch.position) <= switch.radius:
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
        lasers = [self.level.barriers[index] for index in self._lasers if not self.open[index]]
        if not lasers:
            return 0.0
        player, kind = self.world.player, self.world.kind
        height = kind.crouched_height if player.crouching else kind.height
        return sum(each.damage for each in lasers if touches(player.position, kind.radius, height, each.box))
