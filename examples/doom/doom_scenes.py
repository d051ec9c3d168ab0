"""Scenes of Doom for tltlc: how each is made, its signals, where things are, and what ends an episode.

ViZDoom runs the engine and has the scenes; the pictures and monsters are those of Freedoom.
"""

import math
import os
from pathlib import Path

import gymnasium
import numpy as np
from vizdoom import GameVariable, scenarios_path
from vizdoom.gymnasium_wrapper.base_gymnasium_env import VizdoomEnv

TICS = 4
"""A step is so many of the engine's tics, of which a second has 35."""
UNIT = 32
"""Doom's units in a metre: a player is one metre wide."""
WALL = 0.1
"""Half the thickness in which walls are drawn, in metres."""
BLOCK = 4
"""The player sees the picture of 160 by 120 pixels in blocks of so many by so many."""
VIEW = math.radians(45)
"""The player sees what is at most so far to its left and right."""


class Doom(gymnasium.Wrapper):
    """A scene of Doom with a small picture and two numbers to observe: the health and the ammunition."""

    def __init__(self, env):
        super().__init__(env)
        screen = gymnasium.spaces.Box(0, 255, (120 // BLOCK, 160 // BLOCK, 3), np.uint8)
        self.observation_space = gymnasium.spaces.Dict(
            screen=screen, numbers=gymnasium.spaces.Box(0, 1, (2,), np.float32)
        )

    def reset(self, **options):
        """Begin an episode."""
        observation, info = self.env.reset(**options)
        self._look()
        self.first_ammo = self.number("SELECTED_WEAPON_AMMO")
        return self._small(observation), {**info, "cell": self._cell()}

    def step(self, action):
        """Press a button for four tics."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        self._look()
        return self._small(observation), reward, terminated, truncated, {**info, "cell": self._cell()}

    def number(self, name):
        """Return a variable of the game, such as HEALTH."""
        return self.unwrapped.game.get_game_variable(getattr(GameVariable, name))

    def tltl_signals(self):
        """Return what specs speak of, in metres, radians and counts since the reset."""
        fired = self.first_ammo - self.number("SELECTED_WEAPON_AMMO")
        return {
            "alive": not self.number("DEAD"),
            "kills": self.number("KILLCOUNT"),
            "missed": max(0.0, fired - self.number("HITCOUNT")),
            "off_target": min([VIEW, *map(self._angle_to, self.monsters)]),
            "has_armor": self.number("ARMOR") > 0,
            "x": self.number("POSITION_X") / UNIT,
            "y": self.number("POSITION_Y") / UNIT,
        }

    def tltl_positions(self):
        """Return where the player, the monsters and the armor are."""
        return {"player": self._player(), **{name: place(thing) for name, thing in self.things.items()}}

    def tltl_outline(self):
        """Return the walls, and the rooms by their numbers if the scene has more than one."""
        walls, slanted, regions = [], {}, {}
        for number, sector in enumerate(self.sectors, 1):
            lines = [[value / UNIT for value in (line.x1, line.y1, line.x2, line.y2)] for line in sector.lines]
            xs, ys = [x for line in lines for x in line[::2]], [y for line in lines for y in line[1::2]]
            regions[f"room_{number}"] = ((min(xs), min(ys)), (max(xs), max(ys)))
            for line, (x1, y1, x2, y2) in zip(sector.lines, lines, strict=True):
                if line.is_blocking and (x1 == x2 or y1 == y2):
                    west, east, south, north = min(x1, x2), max(x1, x2), min(y1, y2), max(y1, y2)
                    walls.append(((west - WALL, south - WALL), (east + WALL, north + WALL)))
                elif line.is_blocking:
                    slanted[f"wall_{len(slanted) + 1}"] = strip((x1, y1), (x2, y2))
        return {
            "boxes": {"wall": walls} if walls else {},
            "polygons": slanted,
            "regions": regions if len(regions) > 1 else {},
        }

    def tltl_cause(self):
        """Return the nearest monster if the player is dead."""
        if not self.number("DEAD"):
            return None
        near = sorted(self.monsters, key=lambda name: math.dist(place(self.things[name]), self._player()))
        return near[0] if near else "a wound"

    def _look(self):
        """Remember the things of the scene. After the last step the engine says no more where they are."""
        state = self.unwrapped.state
        if state is None:
            return
        things = [thing for thing in state.objects if thing.category in ("Monster", "Armor")]
        self.sectors = state.sectors
        self.things = {f"{thing.name}_{thing.id}": thing for thing in sorted(things, key=lambda thing: thing.id)}
        self.monsters = [name for name, thing in self.things.items() if thing.category == "Monster"]

    def _player(self):
        return self.number("POSITION_X") / UNIT, self.number("POSITION_Y") / UNIT

    def _cell(self):
        """Return a number for the player's square metre, the direction it faces, and its kills.

        The search for demonstrations goes to each cell that it has found, and on from there.
        """
        x, y = (int(coordinate + 128) for coordinate in self._player())
        direction = int(self.number("ANGLE") // 45) % 8
        return ((x * 256 + y) * 8 + direction) * 16 + min(15, int(self.number("KILLCOUNT")))

    def _angle_to(self, name):
        """Return the angle between the player's view and a thing, in radians, in [0, pi]."""
        (x, y), (to_x, to_y) = self._player(), place(self.things[name])
        turn = math.atan2(to_y - y, to_x - x) - math.radians(self.number("ANGLE"))
        return abs(math.remainder(turn, 2 * math.pi))

    def _small(self, observation):
        """Return the picture, averaged over blocks of pixels, with the health and the ammunition."""
        screen = observation["screen"]
        height, width, colours = self.observation_space["screen"].shape
        blocks = screen.reshape(height, BLOCK, width, BLOCK, colours).mean(axis=(1, 3))
        numbers = [self.number("HEALTH") / 100, self.number("SELECTED_WEAPON_AMMO") / 50]
        return {"screen": blocks.astype(np.uint8), "numbers": np.clip(numbers, 0, 1).astype(np.float32)}


def place(thing):
    """Return where a thing is, in metres."""
    return thing.position_x / UNIT, thing.position_y / UNIT


def strip(start, end):
    """Return the corners of a thin strip from one point to another."""
    length = math.dist(start, end)
    across = WALL * (start[1] - end[1]) / length, WALL * (end[0] - start[0]) / length
    return [
        (start[0] + across[0], start[1] + across[1]),
        (end[0] + across[0], end[1] + across[1]),
        (end[0] - across[0], end[1] - across[1]),
        (start[0] - across[0], start[1] - across[1]),
    ]


def make(scene, config, render_mode=None, **settings):
    """Make the scene of a config file of ViZDoom; ``settings`` are those of such files, such as ``doom_skill``."""
    return Doom(
        VizdoomEnv(
            str(Path(scenarios_path, f"{config}.cfg")),
            frame_skip=TICS,
            max_buttons_pressed=1,
            render_mode=render_mode,
            screen_resolution="RES_160X120",
            screen_format="RGB24",
            objects_info_enabled=True,
            sectors_info_enabled=True,
            episode_timeout=0,  # the limits of the specs end episodes
            doom_config_path=os.devnull,  # the engine keeps no settings
            **settings,
        )
    )
