"""A small game that says where things are, written as files that a user would write."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent
from typing import Final

CODE: Final = dedent(
    '''
    """A key, a door and a guard who walks: fetch the key, pass the door, and leave by the exit."""

    import gymnasium
    import numpy as np
    from gymnasium import spaces

    MOVES = ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1))
    WIDTH, HEIGHT, WALL, DOOR = 10, 6, 5, 2


    class Vault(gymnasium.Env):
        observation_space = spaces.Box(-10, 10, (5,), np.float32)
        action_space = spaces.Discrete(5)

        def __init__(self, outline=None, image=False):
            self.shown, self.image = outline, image

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            self.player = (1, int(self.np_random.integers(1, HEIGHT - 1)))
            self.key = (int(self.np_random.integers(2, 5)), 4)
            self.guard, self.step_y, self.caught = (7, int(self.np_random.integers(1, HEIGHT - 1))), 1, False
            return self.see(), {}

        def step(self, action):
            x, y = (at + by for at, by in zip(self.player, MOVES[action]))
            if 0 <= x < WIDTH and 0 <= y < HEIGHT and (x != WALL or (y == DOOR and self.key is None)):
                self.player = (x, y)
            if self.player == self.key:
                self.key = None
            if not 0 < self.guard[1] + self.step_y < HEIGHT - 1:
                self.step_y = -self.step_y
            self.guard = (7, self.guard[1] + self.step_y)
            self.caught = self.player == self.guard
            return self.see(), 0.0, self.caught, False, {}

        def see(self):
            return np.array([*self.player, *self.guard, self.key is None], np.float32)

        def tltl_signals(self):
            return {"has_key": self.key is None, "at_exit": self.player == (9, 3), "caught": self.caught}

        def tltl_cause(self):
            return "guard_1" if self.caught else ""

        def tltl_positions(self):
            def middle(cell):
                return None if cell is None else (cell[0] + 0.5, cell[1] + 0.5)

            return {"player": middle(self.player), "key": middle(self.key), "guard_1": middle(self.guard),
                    "exit": (9.5, 3.5)}

        def tltl_outline(self):
            if self.shown is not None:
                return self.shown
            outline = {
                "bounds": ((0, 0), (WIDTH, HEIGHT)),
                "boxes": {"wall": [((5, 0), (6, 2)), ((5, 3), (6, 6))], "shelf": ((0, 5), (4, 6))},
                "polygons": {"carpet": [(6.5, 0.5), (9.5, 0.5), (8, 2.5)]},
                "regions": {"hall": ((0, 0), (5, 6)), "inner_vault": ((6, 0), (10, 6))},
            }
            if self.image:
                squares = (np.indices((2 * HEIGHT, 2 * WIDTH)).sum(axis=0) % 2 * 20 + 220).astype(np.uint8)
                outline["image"] = {"pixels": np.stack([squares] * 3, axis=2), "extent": (0, 0, WIDTH, HEIGHT)}
            return outline


    def make(scene, outline=None, image=False):
        return Vault(outline, image)
    '''
)

GAME: Final = """\
[game]
python = "vault:make"
clock = "2 Hz"

[[scene]]
name = "plain"
spec = "vault.tltl:fetch"

[[scene]]
name = "tiled"
options = { image = true }
spec = "vault.tltl:fetch"
"""

SPEC: Final = """\
clock 2 Hz
signal has_key: bool
signal at_exit: bool
signal caught: bool
spec fetch {
  reach has_key then at_exit
  avoid caught
  limit 20 s
}
"""

EAST, WEST, NORTH, SOUTH = 1, 2, 3, 4


def write(folder: Path, **files: str) -> Path:
    """Write the game into a folder, with ``files`` in place of its own; return the path of the game file.

    ``__`` in a name of ``files`` stands for a dot.
    """
    for name, text in {"vault__py": CODE, "vault__tltl": SPEC, "vault__game__toml": GAME, **files}.items():
        (folder / name.replace("__", ".")).write_text(text, encoding="utf-8")
    return folder / "vault.game.toml"


def way(player: tuple[int, int], key: tuple[int, int]) -> list[int]:
    """Return the actions of a player who fetches the key and goes to the exit without looking at the guard."""
    return _to(player, key) + _to(key, (4, 2)) + [EAST] * 2 + _to((6, 2), (6, 3)) + [EAST] * 3


def _to(start: tuple[int, int], goal: tuple[int, int]) -> list[int]:
    east, north = goal[0] - start[0], goal[1] - start[1]
    return [EAST if east > 0 else WEST] * abs(east) + [NORTH if north > 0 else SOUTH] * abs(north)
