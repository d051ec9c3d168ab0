"""Scenes of MiniGrid for tltlc: how each is made, its signals, where things are, and what ends an episode."""

import gymnasium

IDS = {
    "doorkey": "MiniGrid-DoorKey-8x8-v0",
    "rooms": "MiniGrid-MultiRoom-N2-S4-v0",
    "lava": "MiniGrid-LavaCrossingS9N{rivers}-v0",
}
"""The environment of each scene; what is in braces is an option of the scene."""


class Scene(gymnasium.Wrapper):
    """A MiniGrid environment that says where things are. Cells are squares of one metre; y points north."""

    def tltl_positions(self):
        """Return the middle of the cell of the player, the key, the door and the goal."""
        game = self.unwrapped
        places = {"player": self._middle(*game.agent_pos)}
        for x in range(game.width):
            for y in range(game.height):
                thing = game.grid.get(x, y)
                if thing is not None and thing.type in ("key", "door", "goal"):
                    places.setdefault(thing.type, self._middle(x, y))
        return places

    def tltl_outline(self):
        """Return the walls as boxes, and the cells of lava as polygons."""
        game = self.unwrapped
        walls, lava = [], {}
        for x in range(game.width):
            for y in range(game.height):
                thing, south = game.grid.get(x, y), game.height - 1 - y
                if thing is not None and thing.type == "wall":
                    walls.append(((x, south), (x + 1, south + 1)))
                if thing is not None and thing.type == "lava":
                    lava[f"lava_{len(lava) + 1}"] = [(x, south), (x + 1, south), (x + 1, south + 1), (x, south + 1)]
        return {"bounds": ((0, 0), (game.width, game.height)), "boxes": {"wall": walls}, "polygons": lava}

    def tltl_cause(self):
        """Return `lava` if the player stands in it."""
        game = self.unwrapped
        thing = game.grid.get(*game.agent_pos)
        return "lava" if thing is not None and thing.type == "lava" else None

    def _middle(self, x, y):
        return x + 0.5, self.unwrapped.height - y - 0.5


def make(scene, rivers=1, **options):
    """Make the environment of a scene; ``options`` are those of the environment."""
    return Scene(gymnasium.make(IDS[scene].format(rivers=rivers), **options))


def signals(env):
    """Return what specs speak of: whether the player has the key, opened a door, stands on the goal or in lava."""
    game = env.unwrapped
    under = game.grid.get(*game.agent_pos)
    doors = [thing for thing in game.grid.grid if thing is not None and thing.type == "door"]
    return {
        "has_key": game.carrying is not None and game.carrying.type == "key",
        "door_open": any(door.is_open for door in doors),
        "at_goal": under is not None and under.type == "goal",
        "in_lava": under is not None and under.type == "lava",
    }
