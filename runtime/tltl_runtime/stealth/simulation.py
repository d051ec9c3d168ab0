"""The simulation of one level, step by step, without a spec, a reward or an end of the episode.

The same level, seed and actions give the same episode, bit for bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import dist

import numpy as np

from tltl_runtime.stealth.enemies.enemy import Enemies
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.signals import Signals, readers
from tltl_runtime.stealth.snapshot import Snapshot, player_view, touches
from tltl_runtime.stealth.world.physics import World
from tltl_runtime.stealth.world.player import DECISION


class Simulation:
    """The simulation of a level: call ``reset``, then ``step`` repeatedly.

    ``health`` is in [0, 1], ``time`` in seconds since the reset. ``active`` has a bool for each
    switch, and ``open`` a bool for each barrier, in the order of the level. The simulation
    continues at zero health: the spec decides when an episode is over.

    Raises:
        WorldError: the start leaves the player no room, or the bodies in the physics differ from
            the level; from ``step``: the player leaves the level.
    """

    def __init__(self, level: StealthLevel) -> None:
        self.level = level
        self.world = World(level)
        self.enemies = Enemies(level)
        self.readers = readers(level)
        self._unlocks = {unlock.switch: unlock.barriers for unlock in level.unlocks}
        self._lasers = [index for index, barrier in enumerate(level.barriers) if barrier.kind == "laser"]
        self._barriers = {barrier.name: index for index, barrier in enumerate(level.barriers)}
        self.reset(0)

    def close(self) -> None:
        """Release the physics; the simulation cannot be used afterwards."""
        self.world.close()

    def reset(self, seed: int) -> None:
        """Begin an episode. ``seed`` determines everything in it that is random."""
        self.seed = seed
        # Separate random streams: how many numbers the enemies draw must not decide which barrier opens.
        start, patrols, self._unlocking = np.random.default_rng(seed).spawn(3)
        self.world.reset(start)
        self.enemies.reset(patrols)
        self.steps = 0
        self.health = 1.0
        self.active = [False] * len(self.level.switches)
        self.open = [False] * len(self.level.barriers)

    def step(self, action: Sequence[int]) -> None:
        """Play ``action`` for :data:`~tltl_runtime.stealth.world.player.DECISION` seconds.

        For each branch of :data:`~tltl_runtime.stealth.snapshot.CHOICES`, ``action`` has the index
        of a choice.
        """
        self.world.step(action)
        self.enemies.step(DECISION, player_view(self.world.player), self.world.mover_boxes())
        self.steps += 1
        self.health = max(0.0, self.health - self.enemies.damage - self._burns() * DECISION)
        self._press_switches()

    @property
    def time(self) -> float:
        """The game time, in seconds since the reset."""
        return self.steps * DECISION

    def signals(self) -> Signals:
        """Return the current signals, the values of the game that specs can read, by name.

        A signal is computed when it is read, so read it before the next step.
        """
        return Signals(self)

    def snapshot(self) -> Snapshot:
        """Return the visible state of the game at this moment."""
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
        """Activate the switches that the player has reached, and open their barriers."""
        feet = self.world.player.position
        pressed = False
        for index, switch in enumerate(self.level.switches):
            if not self.active[index] and dist(feet, switch.position) <= switch.radius:
                self.active[index] = pressed = True
                choices = self._unlocks.get(switch.name)
                if choices:
                    self._open(self._barriers[choices[int(self._unlocking.integers(len(choices)))]])
        if pressed:
            self._open_barriers()

    def _open_barriers(self) -> None:
        """Open the barriers whose switches are all active."""
        active = {switch.name for switch, is_active in zip(self.level.switches, self.active, strict=True) if is_active}
        for index, barrier in enumerate(self.level.barriers):
            if not self.open[index] and barrier.opened_by and active.issuperset(barrier.opened_by):
                self._open(index)

    def _open(self, barrier: int) -> None:
        self.open[barrier] = True
        self.world.set_open(barrier, True)
        self.enemies.set_open(barrier, True)

    def _burns(self) -> float:
        """Return the health per second that shut lasers take from the player at its current position."""
        lasers = [self.level.barriers[index] for index in self._lasers if not self.open[index]]
        if not lasers:
            return 0.0
        player, kind = self.world.player, self.world.kind
        height = kind.crouched_height if player.crouching else kind.height
        return sum(laser.damage for laser in lasers if touches(player.position, kind.radius, height, laser.box))
