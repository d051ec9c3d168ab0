"""A maze with a key and a door, in which chance alone hardly ever opens the door.

Written as files that a user would write. The variants say where the player is, save their state, save
too little of it, or draw their own random numbers.
"""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent
from typing import Final

CODE: Final = dedent(
    '''
    """Fetch the key at one end of a winding corridor, and carry it to the door at the other end."""

    import pickle
    import random

    import gymnasium
    import numpy as np
    from gymnasium import spaces

    MOVES = ((0, 1), (1, 0), (0, -1), (-1, 0))
    # The way from the key, cell 0, to the door, the last cell; the player starts in the middle.
    WAY = [(x, 0) for x in range(8)] + [(7, 1), (7, 2)] + [(x, 2) for x in range(6, -1, -1)]


    class Maze(gymnasium.Env):
        observation_space = spaces.Box(0, 20, (2,), np.float32)
        action_space = spaces.Discrete(4)

        def __init__(self, drifts=False):
            self.drifts = drifts

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            self.at, self.key, self.opened = int(self.np_random.integers(7, 10)), False, False
            return self.see(), {}

        def step(self, action):
            (x, y), (east, north) = WAY[self.at], MOVES[action]
            if self.drifts and random.random() < 0.3:
                east, north = 0, 0
            if (x + east, y + north) in WAY:
                self.at = WAY.index((x + east, y + north))
            self.key = self.key or self.at == 0
            self.opened = self.key and self.at == len(WAY) - 1
            return self.see(), 0.0, self.opened, False, {}

        def see(self):
            return np.array([self.at, self.key], np.float32)

        def tltl_signals(self):
            return {"has_key": self.key, "opened": self.opened, "place": float(self.at)}


    class Placed(Maze):
        def tltl_positions(self):
            return {"player": WAY[self.at]}


    class Outlined(Placed):
        def tltl_outline(self):
            return {"bounds": ((0, 0), (8, 3))}


    class Saving(Placed):
        restored = 0

        def tltl_snapshot(self):
            return pickle.dumps((self.at, self.key, self.opened, self.np_random.bit_generator.state))

        def tltl_restore(self, data):
            type(self).restored += 1
            self.at, self.key, self.opened, self.np_random.bit_generator.state = pickle.loads(data)


    class Lying(Saving):
        """Forgets where the player was."""

        def tltl_restore(self, data):
            at = self.at
            super().tltl_restore(data)
            self.at = at


    class Failing(Saving):
        def tltl_restore(self, data):
            raise OSError("the disk is full")


    KINDS = {kind.__name__.lower(): kind for kind in (Maze, Placed, Outlined, Saving, Lying, Failing)}


    def make(scene, drifts=False):
        # A limit of Gymnasium, which counts the steps of an episode itself.
        return gymnasium.wrappers.TimeLimit(KINDS[scene](drifts), 150)
    '''
)

SPEC: Final = """\
clock 10 Hz
signal has_key: bool
signal opened: bool
signal place in [-1, 17]
spec fetch {
  reach has_key then opened
  avoid place < 0
  limit 120 steps
}
"""

GAME: Final = '[game]\npython = "maze:make"\nclock = "10 Hz"\n' + "".join(
    f'\n[[scene]]\nname = "{name}"\nspec = "maze.tltl:fetch"\n'
    "variants = { drifting = { options = { drifts = true } } }\n"
    for name in ("maze", "placed", "outlined", "saving", "lying", "failing")
)


def write(folder: Path) -> Path:
    """Write the maze into a folder, and return the path of its game file."""
    files = {"maze.py": CODE, "maze.tltl": SPEC, "maze.game.toml": GAME}
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder / "maze.game.toml"
