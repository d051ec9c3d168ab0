"""The counter, which listens, and whose episodes have one step: python fickle.py PORT EPISODE….

The step reaches the goal, except in the episodes with these numbers, from 1.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[4]))

from tests.runtime.wire.games.counter import Counter, tltl_client  # type: ignore[attr-defined]


class Fickle(Counter):
    """A counter that decides by the number of the episode whether the goal is reached."""

    def __init__(self, barred: list[str]) -> None:
        super().__init__()
        self.barred, self.count = barred, 0

    def reset(self, scene: str | None, variant: str, seed: int | None) -> dict[str, Any]:
        """Count the episode."""
        self.count += 1
        return super().reset(scene, variant, seed)

    def state(self) -> dict[str, Any]:
        """Return the message about the state."""
        message, ended = super().state(), self.moves > 0
        at_goal = ended and str(self.count) not in self.barred
        return {**message, "signals": {**message["signals"], "at_goal": at_goal}, "ended": ended}


if __name__ == "__main__":
    game = Fickle(sys.argv[2:])
    while True:
        tltl_client.play(game, tltl_client.listen(tltl_client.game_hello(game), int(sys.argv[1])))
