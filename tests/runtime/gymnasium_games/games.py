"""Small games for tests, written as files that a user would write."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent
from typing import Final

GRID: Final = dedent(
    '''
    """A key and a door in a corridor. Pick up the key on the left, then open the door on the right."""

    import gymnasium
    import numpy as np
    from gymnasium import spaces


    class Corridor(gymnasium.Env):
        metadata = {"render_modes": ["rgb_array"]}

        def __init__(self, length=5, render_mode=None):
            self.length = length
            self.render_mode = render_mode
            self.action_space = spaces.Discrete(3)
            self.observation_space = spaces.Dict(
                {"cell": spaces.Box(0, length - 1, (1,), np.float32), "has_key": spaces.Discrete(2),
                 "mission": spaces.Text(40)}
            )

        def _observation(self):
            return {"cell": np.array([self.cell], np.float32), "has_key": int(self.key), "mission": "open the door"}

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            self.cell, self.key, self.opened = int(self.np_random.integers(1, self.length - 1)), False, False
            return self._observation(), {}

        def step(self, action):
            self.cell = min(max(self.cell + (0, 1, -1)[action], 0), self.length - 1)
            self.key = self.key or self.cell == 0
            self.opened = self.key and self.cell == self.length - 1
            return self._observation(), float(self.opened), self.opened, False, {}

        def render(self):
            picture = np.zeros((8, 8 * self.length, 3), np.uint8)
            picture[:, 8 * self.cell : 8 * self.cell + 8] = 255
            return picture


    def make(scene, length=5, render_mode=None):
        return Corridor(length, render_mode)


    def signals(env):
        game = env.unwrapped
        return {"has_key": game.key, "door_open": game.opened, "cell": float(game.cell)}
    '''
)

SPEC: Final = """\
clock 10 Hz
signal has_key: bool
signal door_open: bool
spec fetch {
  reach has_key then door_open
  limit 20 s
}
"""

GAME: Final = """\
[game]
python = "corridor:make"
signals = "corridor:signals"
clock = "10 Hz"
observation = ["cell", "has_key"]

[[scene]]
name = "short"
options = { length = 4 }
spec = "corridor.tltl:fetch"
variants = { v1 = { options = { length = 8 } } }

[[scene]]
name = "long"
options = { length = 30 }
"""

CARTPOLE: Final = """\
[game]
gymnasium = "CartPole-v1"
signals = "pole:signals"
clock = "0.02 s"
"""

POLE: Final = """
def signals(env):
    position, _, angle, _ = env.unwrapped.state
    return {"position": position, "angle": angle}
"""


def write(folder: Path, **files: str) -> Path:
    """Write the corridor into a folder, with ``files`` in place of its own; return the path of the game file.

    ``__`` in a name of ``files`` stands for a dot.
    """
    own = {"corridor__py": GRID, "corridor__tltl": SPEC, "corridor__game__toml": GAME}
    for name, text in {**own, **files}.items():
        path = folder / name.replace("__", ".")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return folder / "corridor.game.toml"


def cartpole(folder: Path) -> Path:
    """Write the game file of CartPole-v1, and return its path."""
    write(folder, cartpole__game__toml=CARTPOLE, pole__py=POLE)
    return folder / "cartpole.game.toml"
