"""The counter, which dies in some episodes: python mortal.py FAULT FILE EPISODE….

FILE counts the episodes over all processes of the game. In the episodes with these numbers, from 1, the
first step has the FAULT: ``exit``, ``crash``, ``hang`` or ``garbage``. ``all`` stands for all numbers. The
fault ``reset`` is an error in place of the answer to a reset. So is ``seed``, where the numbers are those
of seeds. With the fault ``snapshot`` or ``restore``, the first such request of all processes ends the game.
With the fault ``chance``, all episodes begin by chance, whatever the seed. With its first fault, the game
makes the file FILE.fault.
"""

from __future__ import annotations

import os
import secrets
import signal
import sys
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[4]))

from tests.runtime.wire.games.counter import Counter, tltl_client  # type: ignore[attr-defined]


class Mortal(Counter):
    """A counter with a fault in some episodes."""

    def __init__(self, fault: str, file: Path, numbers: list[str]) -> None:
        super().__init__()
        self.fault, self.file, self.numbers = fault, file, numbers
        self.is_last = False

    def reset(self, scene: str | None, variant: str, seed: int | None) -> dict[str, Any]:
        """Count the episode."""
        # Several games may count at once: each appends a byte, and knows where its own byte is.
        with self.file.open("ab", buffering=0) as file:
            file.write(b"x")
            number = file.tell()
        self.is_last = str(seed if self.fault == "seed" else number) in self.numbers or "all" in self.numbers
        if self.is_last and self.fault in ("reset", "seed"):
            raise tltl_client.Refusal("no such map")
        if self.fault == "chance":
            seed = secrets.randbelow(4)
        return super().reset(scene, variant, seed)

    def snapshot(self) -> int:
        """Keep the state, or end."""
        self.end_once("snapshot")
        return super().snapshot()

    def restore(self, id: int) -> dict[str, Any]:  # noqa: A002
        """Return to a snapshot, or end."""
        self.end_once("restore")
        return super().restore(id)

    def end_once(self, fault: str) -> None:
        """End if this is the fault, and its first time."""
        mark = self.file.with_suffix(".fault")
        if self.fault == fault and not mark.exists():
            mark.touch()
            os._exit(3)

    def step(self, action: int) -> dict[str, Any]:
        """Have the fault, if it is time."""
        if not self.is_last:
            return super().step(action)
        print(f"now: {self.fault}", file=sys.stderr, flush=True)
        self.file.with_suffix(".fault").touch()
        if self.fault == "exit":
            # Not `sys.exit`: the client must not tidy up.
            os._exit(3)
        if self.fault == "crash":
            os.kill(os.getpid(), signal.SIGSEGV)
        if self.fault == "hang":
            time.sleep(3600)
        return {"state": {"signals": "none"}}


if __name__ == "__main__":
    tltl_client.play(Mortal(sys.argv[1], Path(sys.argv[2]), sys.argv[3:]))
