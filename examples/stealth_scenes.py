"""The levels of the stealth game as scenes of a game file: where things are, and what ends an episode."""

import math

import gymnasium

from tltl_runtime.stealth.env import GameEnv
from tltl_runtime.stealth.snapshot import places


class Scene(gymnasium.Wrapper):
    """A level of the stealth game. Its signals, params and clock are those of the environment."""

    def tltl_positions(self):
        """Return where the player and everything else with a name is."""
        shot = self.unwrapped.game.snapshot()
        return {"player": shot.player.position, **places(self.unwrapped.level, shot)}

    def tltl_outline(self):
        """Return the walls, and the regions that the level names."""
        level = self.unwrapped.level
        return {
            "bounds": corners(level.bounds),
            "boxes": {solid.name: corners(solid.box) for solid in level.solids if solid.kind != "floor"},
            "regions": {region.name: corners(region.box) for region in level.regions},
        }

    def tltl_cause(self):
        """Return the nearest enemy that sees the player if the player is dead."""
        shot = self.unwrapped.game.snapshot()
        if shot.health > 0:
            return None
        names = [enemy.name for enemy in self.unwrapped.level.enemies]
        near = [
            (math.dist(place, shot.player.position), name)
            for name, place, sees in zip(names, shot.enemies, shot.sees, strict=True)
            if sees
        ]
        return min(near)[1] if near else "a laser"


def corners(box):
    """Return two opposite corners of a box."""
    return box.low, box.high


def make(scene, variant="v0", render_mode=None):
    """Make the environment of a level in one of its variants."""
    return Scene(GameEnv(scene, variant, render_mode=render_mode))
