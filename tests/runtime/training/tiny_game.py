"""A small game with nested observations and actions, which an agent learns in seconds.

The player moves along a line to a target, and presses the button that a light shows. The target is
measured in thousands, so that only a scaled observation is of use.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, ClassVar

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces

from tltl_runtime.game.game import Game
from tltl_runtime.game.level_name import Variant
from tltl_runtime.game.recording_path import SUFFIX
from tltl_runtime.game.sensors import NO_SENSORS
from tltl_runtime.policies.spaces.action_layout import action_layout
from tltl_runtime.policies.spaces.values import flat_action
from tltl_runtime.spec.task import load_task
from tltl_runtime.spec.wrapper import TltlEnv
from tltlc.core.record import replace

if TYPE_CHECKING:
    from tltl_runtime.training.files.run_file import TrainingRun

SPEC = """\
signal gap in [0, 2]
signal pressed in [0, 1]
predicate there in [-1, 1] = clamp(1 - gap / 0.2, -1, 1)
predicate right in [-1, 1] = 2 * pressed - 1
spec press_there { limit 8 steps  reach there and right }
"""
SPEC_WITH_MEMORY = """\
clock 10 Hz
signal gap in [0, 2]
predicate there in [-1, 1] = clamp(1 - gap / 0.3, -1, 1)
spec stay_there { limit 10 steps  reach time_holding(there) >= 0.2 s  keep times(there) <= 2 }
"""
HIDDEN_TEXT = "text"
"""The variant whose observation has a text, which no policy can read."""
ENDLESS = "endless"
"""The variant whose target is infinitely far in some episodes."""
WITH_CELLS = "cells"
"""The variant that says in which cell the player is."""


class LineEnv(gymnasium.Env[Any, Any]):
    """A line from -1 to 1. In each step the player moves by up to 0.5, and may press one of two buttons."""

    tltl_clock_s = 0.1
    level: Any = None

    def __init__(self, variant: str = "v0") -> None:
        self._has_cells, self._is_endless = variant == WITH_CELLS, variant == ENDLESS
        parts: dict[str, spaces.Space[Any]] = {
            "light": spaces.Discrete(2, start=1),
            "body": spaces.Tuple((spaces.Box(-1, 1, (1,), np.float32), spaces.MultiBinary(1))),
            "target": spaces.Box(-np.inf, np.inf, (1,), np.float64),
        }
        self._has_text = variant == HIDDEN_TEXT
        if self._has_text:
            parts["mission"] = spaces.Text(9)
        self.observation_space = spaces.Dict(parts)
        self.action_space = spaces.Dict(
            {"press": spaces.Discrete(3, start=-1), "move": spaces.Tuple((spaces.Box(-0.5, 0.5, (1,), np.float32),))}
        )
        self._x, self._target, self._light, self._pressed = 0.0, 0.0, 0, -1

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        self._x, self._pressed = 0.0, -1
        self._target, self._light = float(self.np_random.uniform(-0.9, 0.9)), int(self.np_random.integers(2))
        return self._observation(), self._info()

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        assert self.action_space.contains(action), action
        self._x = float(np.clip(self._x + action["move"][0][0], -1, 1))
        self._pressed = int(action["press"])
        return self._observation(), 0.0, False, False, self._info()

    def tltl_signals(self) -> dict[str, float]:
        return {"gap": abs(self._x - self._target), "pressed": float(self._pressed == self._light)}

    def _observation(self) -> dict[str, Any]:
        observation: dict[str, Any] = {
            "light": np.int64(self._light + 1),
            "body": (np.array([self._x], np.float32), np.array([self._pressed >= 0], np.int8)),
            "target": np.array([np.inf if self._is_endless and self._target > 0.7 else 1000 * self._target + 5000]),
        }
        return observation | ({"mission": "go"} if self._has_text else {})

    def _info(self) -> dict[str, Any]:
        return {"cell": round(10 * self._x) + 10} if self._has_cells else {}


class LineGame(Game[Any, Any]):
    """The game of :class:`LineEnv`, which has one level in three variants and nothing else."""

    choices: ClassVar[dict[str, tuple[str, ...]]] = {}  # type: ignore[misc]
    modules = (__name__,)

    def load_level(self, name: str, variant: str | Variant = "v0") -> Any:
        text = variant if isinstance(variant, str) else variant.text
        return SimpleNamespace(name=name, variant=text, game=self, spec=None, sensors=NO_SENSORS, files=())

    def level_hash(self, level: Any) -> str:
        return "0" * 64

    def params(self, level: Any) -> dict[str, float]:
        return {}

    def check_fit(self, level: Any, fspa: Any, spec: Any) -> None:
        pass

    def missing_sensors(self, level: Any, sensors: Any) -> Iterator[str]:
        yield from ()

    def make_env(self, level: Any, variant: Any = "v0", spec: Any = None, **options: Any) -> TltlEnv:
        text = variant if isinstance(variant, str) else variant.text
        line = LineEnv(text)
        line.level = self.load_level(level, text)
        return TltlEnv(line, spec or SPEC, reward=options.get("reward"), params=options.get("params"))

    def recorder(self, env: Any, player: str = "unknown") -> Any:
        raise NotImplementedError

    def read_episode(self, path: Path) -> Any:
        recording = json.loads(path.read_text(encoding="utf-8"))
        level = self.load_level("line")
        return SimpleNamespace(**{**recording, "actions": np.array(recording["actions"])}, level=level)


# Methods that these tests never call.
LineGame.__abstractmethods__ = frozenset()  # type: ignore[attr-defined]
GAME = LineGame()


def write_demonstrations(folder: Path, count: int) -> Path:
    """Record episodes that meet the spec, and return their folder; a recording has flat actions."""
    folder.mkdir()
    env = GAME.make_env("line")
    layout = action_layout(env.action_space)
    for seed in range(count):
        env.reset(seed=seed)
        line: Any = env.unwrapped
        actions, is_over = [], False
        while not is_over:
            move = np.array([np.clip(line._target - line._x, -0.5, 0.5)], np.float32)
            action = {"press": line._light, "move": (move,)}
            actions.append(flat_action(layout, action).tolist())
            *_, is_over, _, _ = env.step(action)
        recording = {"seed": seed, "player": "me", "actions": actions}
        (folder / f"{seed}{SUFFIX}").write_text(json.dumps(recording), encoding="utf-8")
    return folder


@contextmanager
def only_game() -> Iterator[None]:
    """Within this context, all levels are of this game."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("tltl_runtime.game.registry._MODULES", {"stealth": __name__})
        yield


def line_run(folder: Path, variant: str = "v0", spec: str = SPEC, **changes: Any) -> TrainingRun:
    """Return a training on the line by a spec; ``changes`` override settings, as in ``runs.run_in``."""
    # Workers import this module, and need not import what learns.
    from tests.runtime.training.runs import SMALL
    from tltl_runtime.training.files.run_file import TrainingRun
    from tltl_runtime.training.files.settings import read_settings

    settings = read_settings()
    ways = read_settings().exploration.ways if variant == WITH_CELLS else 0
    defaults = {**SMALL, "exploration.ways": ways}
    for name, value in {**defaults, **{name.replace("__", "."): value for name, value in changes.items()}}.items():
        table, _, key = name.rpartition(".")
        changed = {table: replace(getattr(settings, table), **{key: value})} if table else {key: value}
        settings = replace(settings, **changed)
    return TrainingRun(folder, load_task(spec).fspa, {}, "line", Variant(variant), NO_SENSORS, settings, 3)
