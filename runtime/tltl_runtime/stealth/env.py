"""The game as Gymnasium environments: the bare one, and those with a spec."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium import spaces

from tltl_runtime.stealth.game import BRANCHES, Game
from tltl_runtime.stealth.level_file import load_level
from tltl_runtime.stealth.observation import Senses
from tltl_runtime.stealth.offer import params
from tltl_runtime.stealth.player import DECISION
from tltl_runtime.stealth.sensors import SensorChoice
from tltl_runtime.stealth.signals import Signals
from tltl_runtime.wrapper import TltlEnv
from tltlc.automaton.fspa import Fspa
from tltlc.monitor import RewardOptions


class GameEnv(gymnasium.Env[dict[str, Any], Any]):
    """A level without a spec: what the agent senses, no reward and no end.

    Action: MultiDiscrete([3, 3, 2, 2, 2]), see :data:`~tltl_runtime.stealth.game.BRANCHES`.  Observation: that of
    :class:`~tltl_runtime.stealth.observation.Senses`.  ``level`` is the name of a shipped level or a ``.toml`` file,
    ``sensors`` what :func:`~tltl_runtime.stealth.sensors.chosen` takes.
    ``reset(seed=...)`` reproduces an episode bit for bit.

    Raises:
        TltlError: what :func:`~tltl_runtime.stealth.level_file.load_level` finds; TLT0815, where ``sensors`` say what
            the level does not have.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": [], "render_fps": round(1 / DECISION)}  # type: ignore[misc]

    def __init__(self, level: str, variant: str = "v0", sensors: SensorChoice | None = None) -> None:
        self.level = load_level(level, variant)
        self.game = Game(self.level)
        self._senses = Senses(self.level, sensors)
        self.action_space = spaces.MultiDiscrete(list(BRANCHES))
        self.observation_space = self._senses.space
        self.tltl_clock_s = DECISION

    def tltl_params(self) -> dict[str, float]:
        """The params of specs that the level knows, see :func:`tltl_runtime.stealth.offer.params`."""
        return params(self.level)

    def tltl_signals(self) -> Signals:
        """The signals of the game now."""
        return self.game.signals()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begin an episode; without a seed, one drawn from the seed before."""
        super().reset(seed=seed)
        self.game.reset(int(self.np_random.integers(2**63)))
        return self._senses.look(self.game), {}

    def step(self, action: Any) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Play one decision."""
        self.game.step(np.asarray(action).tolist())
        return self._senses.look(self.game), 0.0, False, False, {}

    def close(self) -> None:
        """Free the physics."""
        self.game.close()


def make_env(
    level: str,
    variant: str = "v0",
    spec: str | Path | Fspa | None = None,
    *,
    sensors: SensorChoice | None = None,
    reward: RewardOptions | None = None,
) -> TltlEnv:
    """A level with a spec, by default the one it was made for; errors as of :class:`GameEnv` and :class:`TltlEnv`."""
    game = GameEnv(level, variant, sensors)
    try:
        return TltlEnv(game, game.level.spec if spec is None else spec, _signals, reward=reward)
    except BaseException:
        game.close()
        raise


def _signals(env: gymnasium.Env[Any, Any]) -> Signals:
    game = env.unwrapped
    assert isinstance(game, GameEnv)
    return game.tltl_signals()


def navigation(**options: Any) -> TltlEnv:
    """``tltl/Navigation-v0``."""
    return make_env("navigation", **options)


def cover_and_hide(**options: Any) -> TltlEnv:
    """``tltl/CoverAndHide-v0``."""
    return make_env("cover_and_hide", **options)


def branching(**options: Any) -> TltlEnv:
    """``tltl/Branching-v0``."""
    return make_env("branching", **options)
