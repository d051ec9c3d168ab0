"""A player that knows the way and fears nobody."""

from __future__ import annotations

import numpy as np

from tltl_runtime.stealth.game import Snapshot
from tltl_runtime.stealth.level import Level, Point
from tltl_runtime.stealth.player import DECISION, PlayerKind
from tltl_runtime.stealth.routes import routes_of

Action = tuple[int, int, int, int, int]

STAY: Action = (0, 0, 0, 0, 0)


class Walker:
    """Finds the way to a goal, whatever enemies do: ``act`` gives the next action, decision by decision."""

    def __init__(self, level: Level, kind: PlayerKind | None = None) -> None:
        self.level = level
        self.kind = kind or PlayerKind()

    def reset(self) -> None:
        """Forget the episode before."""

    def act(self, snapshot: Snapshot, goal: Point) -> Action:
        """The next action on the way to ``goal``."""
        shut = frozenset(index for index, is_open in enumerate(snapshot.open) if not is_open)
        field = routes_of(self.level, shut).field(goal)
        x, y, z = snapshot.player.position
        moves = [(a, b) for a in range(3) for b in range(3)]
        step = np.array([(0.0, 1.0, -1.0)[a] for a, _ in moves]), np.array([(0.0, 1.0, -1.0)[b] for _, b in moves])
        length = self.kind.walk_speed * DECISION / np.maximum(np.hypot(*step), 1.0)
        seconds = field.at(x + step[0] * length, y + step[1] * length, np.full(9, z))
        a, b = moves[int(np.argmin(seconds))]
        return (a, b, 0, 0, 0)
