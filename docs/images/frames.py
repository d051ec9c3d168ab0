"""Makes the README's pictures of the levels: a moment of play in each, drawn as `tltlc replay` draws films."""

from __future__ import annotations

import sys
from pathlib import Path

from PIL import Image

from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.rendering.render import Renderer
from tltl_runtime.stealth.simulation import Simulation

SIZE = (640, 360)
MOMENTS = {
    "navigation": ["8 east south", "7 south", "4 east", "9 crouch east"],
    "cover_and_hide": ["10 crouch"],
    "branching": ["10 north", "6 east"],
}
"""What the player did before: for how many decisions, and what."""
ACTIONS = {"east": (0, 1), "west": (0, 2), "north": (1, 1), "south": (1, 2), "jump": (2, 1), "crouch": (3, 1)}
"""The branch of an action, and its number."""


def main(folder: Path) -> None:
    """Write a picture of each level."""
    for name, played in MOMENTS.items():
        game = Simulation(load_level(name))
        renderer = Renderer(game.level, *SIZE, samples=3)
        game.reset(1)
        for part in played:
            count, *words = part.split()
            action = [0] * 5
            for word in words:
                branch, number = ACTIONS[word]
                action[branch] = number
            for _ in range(int(count)):
                game.step(action)
        frame = renderer.frame(game.snapshot(), "overview")
        Image.fromarray(frame).quantize(255).save(folder / f"{name}.png", optimize=True)
        renderer.close()
        game.close()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
