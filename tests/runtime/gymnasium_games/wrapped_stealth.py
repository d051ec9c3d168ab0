"""The levels of the stealth game as scenes of a game file with ``python``, as a user could wrap any environment."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import gymnasium

from tltl_runtime.spec.task import Task
from tltl_runtime.stealth.env import GameEnv
from tltl_runtime.stealth.expert.expert import Expert
from tltl_runtime.stealth.level import Box
from tltl_runtime.stealth.snapshot import places

GAME = (
    '[game]\npython = "wrapped_stealth:make"\n\n[[scene]]\nname = "navigation"\n\n[[scene]]\nname = "cover_and_hide"\n'
)


class Scene(gymnasium.Wrapper[Any, Any, Any, Any]):
    """A level of the stealth game. Its signals, params and clock are those of the environment."""

    def tltl_positions(self) -> dict[str, Any]:
        """Return where the player and everything else with a name is."""
        shot = self.unwrapped.game.snapshot()  # type: ignore[attr-defined]
        return {"player": shot.player.position, **places(self.unwrapped.level, shot)}  # type: ignore[attr-defined]

    def tltl_outline(self) -> dict[str, Any]:
        """Return the walls, and the regions that the level names."""
        level = self.unwrapped.level  # type: ignore[attr-defined]
        return {
            "bounds": corners(level.bounds),
            "boxes": {solid.name: corners(solid.box) for solid in level.solids if solid.kind != "floor"},
            "regions": {region.name: corners(region.box) for region in level.regions},
        }

    def tltl_cause(self) -> str | None:
        """Return the nearest enemy that sees the player if the player is dead."""
        shot = self.unwrapped.game.snapshot()  # type: ignore[attr-defined]
        if shot.health > 0:
            return None
        names = [enemy.name for enemy in self.unwrapped.level.enemies]  # type: ignore[attr-defined]
        near = [
            (math.dist(place, shot.player.position), name)
            for name, place, sees in zip(names, shot.enemies, shot.sees, strict=True)
            if sees
        ]
        return min(near)[1] if near else "a laser"

    def tltl_expert(self, task: Task) -> Player:
        """Return the scripted expert, which plays by the automaton of ``task``."""
        return Player(self, task)


class Player:
    """The scripted expert, which knows of the spec only its task and the state in the observation."""

    def __init__(self, scene: Scene, task: Task) -> None:
        self._scene = scene
        self._known: dict[str, Any] = {"task": task, "game": scene.unwrapped.game}  # type: ignore[attr-defined]
        self._expert = Expert(self)  # type: ignore[arg-type]

    def get_wrapper_attr(self, name: str) -> Any:
        """Return what the expert asks its environment for."""
        return self._known[name]

    def choose(self, observation: dict[str, Any]) -> Any:
        """Return the next action of the expert."""
        game = self._known["game"]
        if game.time == 0.0:
            self._expert.reset()
        self._known["taken"] = SimpleNamespace(state=int(observation["automaton"].argmax()))
        self._known["sample"] = game.signals()
        return self._expert.act()


def corners(box: Box) -> tuple[Any, Any]:
    """Return two opposite corners of a box."""
    return box.low, box.high


def make(scene: str, variant: str = "v0", render_mode: str | None = None) -> Scene:
    """Make the environment of a level in one of its variants."""
    return Scene(GameEnv(scene, variant, render_mode=render_mode))
