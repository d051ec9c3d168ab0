"""Environments that fail when an action tells them to.

They have a module of their own, which worker processes can import.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from tests.waiting import HANG_S, until
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.level import Box
from tltlc.core.record import replace

GO, EXIT, RAISE, HANG, HOLD = range(5)


class Fragile(gymnasium.Env[Any, Any]):
    """An environment that counts its steps; an episode has seven.

    The action EXIT ends the process, RAISE raises an error, and HANG never returns.
    """

    observation_space = spaces.Dict(
        {
            "count": spaces.Discrete(100),
            "pair": spaces.Tuple((spaces.Box(-1.0, 1.0, (2,), np.float32), spaces.MultiBinary(3))),
        }
    )
    action_space = spaces.Discrete(5)

    def __init__(self, dies_in_reset: bool = False) -> None:
        self.dies_in_reset = dies_in_reset
        self.seeds: list[int | None] = []

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        if self.dies_in_reset:
            os._exit(5)
        self.seeds.append(seed)
        self.count = 0
        return self._observed(), {"options": options}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        self.count += 1
        if action == EXIT:
            os._exit(3)
        if action == RAISE:
            raise RuntimeError("the bridge is out")
        while action == HANG:
            time.sleep(1000.0)
        return self._observed(), self.count, self.count == 7, False, {"count": self.count}

    def _observed(self) -> dict[str, Any]:
        numbers = self.np_random.random(2).astype(np.float32)
        return {"count": self.count, "pair": (numbers, np.array([1, 0, self.count % 2], dtype=np.int8))}


class Launched(Fragile):
    """An environment that starts a program, whose id is in the file ``program`` in ``folder``."""

    def __init__(self, folder: Path) -> None:
        super().__init__()
        self._program = subprocess.Popen([sys.executable, "-c", f"import time; time.sleep({10 * HANG_S})"])
        (folder / "program").write_text(str(self._program.pid), encoding="utf-8")

    def close(self) -> None:
        self._program.kill()


class Held(Fragile):
    """An environment that a test can hold in a step.

    The action HOLD creates a file ``held-PID`` in ``folder``. Its step ends when a file
    ``released`` exists there.
    """

    def __init__(self, folder: Path) -> None:
        super().__init__()
        self._folder = folder

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        if action == HOLD:
            (self._folder / f"held-{os.getpid()}").touch()
            until((self._folder / "released").exists, "somebody to release it")
        return super().step(action)


class Preparing(Fragile):
    """An environment with work that it can do before the next reset."""

    left = 3

    def prepare(self) -> bool:
        self.left -= self.left > 0
        return self.left > 0


class Ending(Fragile):
    """An environment that ends its process after its first step, once it has answered."""

    count = 0

    def prepare(self) -> bool:
        if self.count > 0:
            os._exit(7)
        return False


class Unmade(gymnasium.Env[Any, Any]):
    """An environment that can be created only in the process with the id ``here``."""

    observation_space = Fragile.observation_space
    action_space = Fragile.action_space

    def __init__(self, here: int) -> None:
        if os.getpid() != here:
            raise RuntimeError("no room for another")


def leaves_its_level() -> TltlEnv:
    """Return a game whose player soon leaves the level: its bounds end a metre from the start."""
    env = make_env("navigation")
    world = env.unwrapped.game.world  # type: ignore[attr-defined]
    (x, y, _), bounds = world.level.start.position, world.level.bounds
    near = Box((x - 1.0, y - 1.0, bounds.low[2]), (x + 1.0, y + 1.0, bounds.high[2]))
    world.level = replace(world.level, bounds=near)
    return env
