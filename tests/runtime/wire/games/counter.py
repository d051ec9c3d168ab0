"""The game of the conformance script in Python; ``tests/runtime/wire/conversation.py`` describes it.

Usage: python counter.py [--listen PORT]
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, ClassVar

sys.path.insert(0, str(Path(__file__).parents[4] / "runtime" / "tltl_runtime" / "wire" / "clients"))

import tltl_client  # type: ignore[import-not-found]

GOALS = {"short": 5, "long": 10}


class Counter:
    """Count up to the goal, and in the variant ``trap`` never down to 0."""

    hello: ClassVar[dict[str, Any]] = {
        "name": "counter",
        "clock_hz": 10,
        "signals": {"position": {"range": [0, 10]}, "moves": {"range": [0, None]}, "at_goal": {"type": "bool"}},
        "params": {"goal": 10},
        "actions": {"type": "discrete", "n": 3},
        "observation": {"type": "box", "low": 0, "high": 10, "shape": [1], "dtype": "float32"},
        "scenes": ["short", "long"],
        "capabilities": ["seed", "positions"],
    }

    def __init__(self) -> None:
        self.goal, self.has_trap, self.position, self.moves = 5, False, 1, 0
        self.snapshots: list[tuple[int, bool, int, int] | None] = []

    def reset(self, scene: str | None, variant: str, seed: int | None) -> dict[str, Any]:
        """Begin at 1 + seed mod 4."""
        if scene is not None and scene not in GOALS:
            raise tltl_client.Refusal(f"there is no scene `{scene}`")
        if variant not in ("v0", "trap"):
            raise tltl_client.Refusal(f"there is no variant `{variant}`")
        self.goal, self.has_trap = GOALS[scene or "short"], variant == "trap"
        self.position, self.moves = 1 + (seed or 0) % 4, 0
        return self.state()

    def step(self, action: int) -> dict[str, Any]:
        """Move left (0), stay (1) or move right (2)."""
        self.position = min(max(self.position + int(action) - 1, 0), 10)
        self.moves += 1
        return self.state()

    def snapshot(self) -> int:
        """Keep the state; the ids are 1, 2, 3 and so on."""
        self.snapshots.append((self.goal, self.has_trap, self.position, self.moves))
        return len(self.snapshots)

    def restore(self, id: int) -> dict[str, Any]:  # noqa: A002
        """Return to a snapshot."""
        self.goal, self.has_trap, self.position, self.moves = self._kept(id)
        return self.state()

    def release_snapshot(self, id: int) -> None:  # noqa: A002
        """Forget a snapshot."""
        self._kept(id)
        self.snapshots[id - 1] = None

    def _kept(self, id: int) -> tuple[int, bool, int, int]:  # noqa: A002
        kept = self.snapshots[id - 1] if isinstance(id, int) and 1 <= id <= len(self.snapshots) else None
        if kept is None:
            raise tltl_client.Refusal(f"there is no snapshot {id}")
        return kept

    def screenshot(self) -> dict[str, Any]:
        """Draw a row of 11 black pixels; that of the player is white."""
        pixels = bytearray(33)
        pixels[3 * self.position : 3 * self.position + 3] = b"\xff\xff\xff"
        picture: dict[str, Any] = tltl_client.array(bytes(pixels), "uint8", [1, 11, 3])
        return picture

    def outline(self) -> dict[str, Any]:
        """Say what maps show: the edges of the row, the goal, and the trap if there is one."""
        if self.has_trap and self.goal == GOALS["short"]:
            raise tltl_client.Refusal("there is no outline of the trap in `short`")
        return {
            "bounds": [[-1, -2], [11, 3]],
            "boxes": {"edge": [[[-1, -1], [-0.5, 2]], [[10.5, -1], [11, 2]]]},
            "polygons": {"trap": [[-0.5, -1], [0.5, -1], [0, 2]]} if self.has_trap else {},
            "regions": {"goal": [[self.goal - 0.5, -1], [10.5, 2]]},
            "image": {"pixels": tltl_client.array(b"\xff\xff\xff", "uint8", [1, 1, 3]), "extent": [-0.5, -1, 10.5, 2]},
        }

    def state(self) -> dict[str, Any]:
        """Return the message about the state."""
        at_goal, trapped = self.position >= self.goal, self.has_trap and self.position == 0
        message: dict[str, Any] = tltl_client.state(
            signals={"position": self.position, "moves": self.moves, "at_goal": at_goal},
            observation=[self.position],
            ended=at_goal or trapped,
            cause="goal" if at_goal else "trap" if trapped else None,
            positions={"player": [self.position, 0]},
        )
        return message


if __name__ == "__main__":
    game = Counter()
    if sys.argv[1:2] == ["--listen"]:
        while True:
            try:
                tltl_client.play(game, tltl_client.listen(tltl_client.game_hello(game), int(sys.argv[2])))
            except tltl_client.Disconnected as error:
                sys.exit(str(error))
    tltl_client.play(game)
