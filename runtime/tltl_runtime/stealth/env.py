"""The game as Gymnasium environments: the bare one, and those with a spec."""

from __future__ import annotations

import os
from collections.abc import Mapping
from math import ceil
from pathlib import Path
from typing import Any, ClassVar, Final

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.error import ClosedEnvironmentError
from numpy.typing import NDArray

from tltl_runtime.spec.task import read_spec
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.stealth.capabilities.capabilities import check_supply
from tltl_runtime.stealth.capabilities.spec_places import SpecPlaces
from tltl_runtime.stealth.capabilities.vocabulary import params as level_params
from tltl_runtime.stealth.game import Game
from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.observation.observation import Senses
from tltl_runtime.stealth.observation.sensors import SensorChoice
from tltl_runtime.stealth.rendering.camera import View
from tltl_runtime.stealth.signals import Signals
from tltl_runtime.stealth.snapshot import ACTIONS, BRANCHES
from tltl_runtime.stealth.window.screen import MODES, Screen
from tltl_runtime.stealth.world.player import DECISION
from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.monitor import RewardOptions

_CELL: Final = 0.5
"""Width of the cells of ``info``, in metres."""


class GameEnv(gymnasium.Env[dict[str, Any], Any]):
    """A level without a spec: what the agent senses, no reward and no end.

    Action: MultiDiscrete([3, 3, 2, 2, 2]), see :data:`~tltl_runtime.stealth.snapshot.BRANCHES`; ``action`` is the last
    one that was played.  Observation: that of :class:`~tltl_runtime.stealth.observation.observation.Senses`.
    ``level`` is
    the name of a shipped level or a ``.toml`` file, ``sensors`` what
    :func:`~tltl_runtime.stealth.observation.sensors.chosen` takes.  ``reset(seed=...)`` reproduces an episode bit for
    bit;
    ``game.seed`` is the seed to give for that, drawn where a reset was given none.  ``info["cell"]`` is the number of
    the cell, half a metre wide in each direction, in which the player stands, -1 in the air.

    ``render_mode`` ``rgb_array`` makes :meth:`render` return pictures of ``render_size`` (width, height), each from 16
    to 4096 pixels, ``human`` shows them in a window as the episode goes on, a decision taking its time;
    ``render_view`` is one of ``third_person top_down overview``.

    Raises:
        TltlError: what :func:`~tltl_runtime.stealth.levels.file.load_level` finds; TLT0815, where ``sensors`` say what
            the level does not have.
        ValueError: there is no such render mode, view or size; of ``step``: there is no such action.
        TypeError: an argument is of another type; copying or pickling a running game.
        ClosedEnvironmentError: of ``reset``, ``step`` and ``render`` after ``close``.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": list(MODES), "render_fps": round(1 / DECISION)}  # type: ignore[misc]

    def __init__(
        self,
        level: str | os.PathLike[str],
        variant: str = "v0",
        sensors: SensorChoice | None = None,
        render_mode: str | None = None,
        render_view: View = "third_person",
        render_size: tuple[int, int] = (640, 480),
    ) -> None:
        for name, given in (("level", level), ("variant", variant)):
            if not isinstance(given, (str, os.PathLike)):
                raise TypeError(f"a {name} is named by a text, not by {given!r:.60}")
        self.level = load_level(os.fspath(level), variant)
        self._screen = Screen(self.level, render_mode, render_view, render_size)
        self.render_mode = render_mode
        self.game = Game(self.level)
        self._senses = Senses(self.level, sensors)
        self.action_space = spaces.MultiDiscrete(list(BRANCHES))
        self.observation_space = self._senses.space
        self.tltl_clock_s = DECISION
        self.action: list[int] = []
        self._closed = False

    def tltl_params(self) -> dict[str, float]:
        """The params of specs that the level knows, see :func:`tltl_runtime.stealth.capabilities.vocabulary.params`."""
        return level_params(self.level)

    def tltl_signals(self) -> Signals:
        """The signals of the game now."""
        return self.game.signals()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begin an episode; without a seed, one drawn from the seed before."""
        self._check_open()
        super().reset(seed=seed)
        self.game.reset(int(self.np_random.integers(2**31)) if seed is None else seed)
        self._show()
        return self._senses.look(self.game), {"cell": self._cell()}

    def step(self, action: Any) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Play one decision."""
        self._check_open()
        self.action = _numbers(action)
        self.game.step(self.action)
        self._show()
        return self._senses.look(self.game), 0.0, False, False, {"cell": self._cell()}

    def render(self) -> NDArray[np.uint8] | None:
        """The picture of this moment, (height, width, 3), or None where it is shown in a window.

        Without a screen for the window, one warning is given.  Raises TltlError: TLT0730, without pygame.
        """
        self._check_open()
        if self.render_mode is None:
            gymnasium.logger.warn("there are no pictures without a render mode: make(..., render_mode='rgb_array')")
        return self._screen.render(self.game.snapshot())

    def close(self) -> None:
        """Free the physics and the pictures, and close the window."""
        self._closed = True
        self._screen.close()
        self.game.close()

    def _cell(self) -> int:
        player = self.game.world.player
        if not player.grounded:
            return -1
        number = 0
        for at, least, most in zip(player.position, self.level.bounds.low, self.level.bounds.high, strict=True):
            width = ceil((most - least) / _CELL)
            number = number * width + min(max(int((at - least) / _CELL), 0), width - 1)
        return number

    def _check_open(self) -> None:
        if self._closed:
            raise ClosedEnvironmentError("this environment is closed: make another one")

    def _show(self) -> None:
        if self.render_mode == "human":
            self._screen.render(self.game.snapshot())


def _numbers(action: Any) -> list[int]:
    """The numbers of an action: whole ones, one for each branch and in its range."""
    given = np.asarray(action)
    numbers: list[int] = given.tolist()
    if given.dtype.kind not in "iub" or given.shape != (len(BRANCHES),) or tuple(numbers) not in ACTIONS:
        wanted = "five whole numbers of MultiDiscrete([3 3 2 2 2]): x, y, jump, crouch, sprint"
        raise ValueError(f"an action is {wanted}; {action!r:.80} is none")
    return numbers


def make_env(
    level: str | os.PathLike[str],
    variant: str = "v0",
    spec: str | Path | Fspa | None = None,
    *,
    sensors: SensorChoice | None = None,
    reward: RewardOptions | None = None,
    params: Mapping[str, float] | None = None,
    **render: Any,
) -> TltlEnv:
    """A level with a spec, by default the one it was made for; options and errors of the two envs that it is made of.

    ``render`` takes the ``render_mode``, ``render_view`` and ``render_size`` of :class:`GameEnv`.  Raises TltlError
    for all that the spec asks of the level and does not get, see
    :func:`~tltl_runtime.stealth.capabilities.capabilities.check_supply`; TLT0721, where there is no spec at all.
    """
    game = GameEnv(level, variant, sensors, **render)
    try:
        wanted = spec_of(game.level) if spec is None else spec
        env = TltlEnv(game, wanted, reward=reward, params=params)
        check_fit(game.level, env.task.fspa, wanted)
        return env
    except BaseException:
        game.close()
        raise


def spec_of(level: Level) -> str:
    """The path of the spec that a level is made for; raises TltlError, TLT0721, where it is made for none."""
    if not level.spec:
        title, help_ = f"the level `{level.name}` is made for no spec", "say which one: `FILE.tltl:NAME`"
        raise TltlError([Diagnostic("TLT0721", title, help=help_)])
    return level.spec


def check_fit(level: Level, fspa: Fspa, spec: str | Path | Fspa) -> None:
    """Raise as one TltlError what a spec asks of a level and does not get, where it stands in the spec's source."""
    if _unmet(level, fspa, SpecPlaces(None)):
        raise TltlError(_unmet(level, fspa, SpecPlaces(read_spec(spec)[1])))


def _unmet(level: Level, fspa: Fspa, places: SpecPlaces) -> list[Diagnostic]:
    return [each for each in check_supply(level, fspa, places) if each.severity == "error"]


# Gymnasium looks here for the render modes of what makes an environment.
make_env.metadata = GameEnv.metadata  # type: ignore[attr-defined]
