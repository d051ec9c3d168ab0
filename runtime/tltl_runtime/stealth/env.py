"""Gymnasium environments of the stealth game: one without a spec, and one with a spec."""

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

from tltl_runtime.game.level import default_spec
from tltl_runtime.game.level_name import Variant
from tltl_runtime.game.sensors import SensorChoice
from tltl_runtime.spec.spec_places import SpecPlaces
from tltl_runtime.spec.task import read_spec
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.stealth.capabilities.capabilities import check_capabilities
from tltl_runtime.stealth.capabilities.vocabulary import params as level_params
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.observation.observation import Observer
from tltl_runtime.stealth.rendering.camera import View
from tltl_runtime.stealth.signals import Signals
from tltl_runtime.stealth.simulation import Simulation
from tltl_runtime.stealth.snapshot import ACTIONS, BRANCHES
from tltl_runtime.stealth.window.screen import MODES, Screen
from tltl_runtime.stealth.world.player import DECISION
from tltlc.api import Diagnostic, Fspa, RewardOptions, TltlError

_CELL: Final = 0.5
"""The side of a cell, in metres; ``info["cell"]`` is the number of the player's cell."""


class GameEnv(gymnasium.Env[dict[str, Any], Any]):
    """A level without a spec: the reward is always 0, and no episode ends.

    ``level`` is the name of a shipped level or the path of a ``.toml`` file. ``variant`` is the
    name of one of the level's variants, as in
    :func:`~tltl_runtime.stealth.levels.file.load_level`. ``sensors`` chooses what the agent
    observes, see :func:`~tltl_runtime.stealth.observation.sensors.choose_sensors`.

    An action has a number for each of :data:`~tltl_runtime.stealth.snapshot.BRANCHES`: it is an
    element of MultiDiscrete([3, 3, 2, 2, 2]). The attribute ``action`` is the last action played.
    :class:`~tltl_runtime.stealth.observation.observation.Observer` describes the observations.

    ``reset(seed=...)`` reproduces an episode bit for bit. A reset without a seed draws a seed. The
    attribute ``game`` is the running game, and ``game.seed`` the seed of its episode. The level is
    divided into cells, cubes with sides of half a metre. ``info["cell"]`` is the number of the cell
    that contains the player's feet, or -1 while the player is in the air.

    With ``render_mode`` ``rgb_array``, :meth:`render` returns pictures of ``render_size`` (width,
    height), each from 16 to 4096 pixels. With ``human``, a window shows the episode in real time.
    ``render_view`` is ``third_person``, ``top_down`` or ``overview``.

    Raises:
        TltlError: the errors of :func:`~tltl_runtime.stealth.levels.file.load_level`; TLT0815,
            ``sensors`` is invalid, or names something that the level does not have.
        ValueError: the render mode or view is unknown, or the size is invalid; from ``step``: the
            action is invalid.
        TypeError: an argument has a wrong type; also when a running game is copied or pickled.
        ClosedEnvironmentError: ``reset``, ``step`` or ``render`` is called after ``close``.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": list(MODES), "render_fps": round(1 / DECISION)}  # type: ignore[misc]

    def __init__(
        self,
        level: str | os.PathLike[str],
        variant: str | Variant = "v0",
        sensors: SensorChoice | None = None,
        render_mode: str | None = None,
        render_view: View = "third_person",
        render_size: tuple[int, int] = (640, 480),
    ) -> None:
        if not isinstance(level, (str, os.PathLike)):
            raise TypeError(f"the level must be a text or a path, not {level!r:.60}")
        if not isinstance(variant, (str, Variant)):
            raise TypeError(f"the variant must be a text, not {variant!r:.60}")
        self.level = load_level(os.fspath(level), variant)
        self._screen = Screen(self.level, render_mode, render_view, render_size)
        self.render_mode = render_mode
        self.game = Simulation(self.level)
        self._observer = Observer(self.level, sensors)
        self.action_space = spaces.MultiDiscrete(list(BRANCHES))
        self.observation_space = self._observer.space
        self.tltl_clock_s = DECISION
        self.action: list[int] = []
        self._closed = False

    def tltl_params(self) -> dict[str, float]:
        """Return the values that the level defines for parameters of specs, in SI units, by name.

        An example is ``{"level_size": 31.2}``, in metres.
        """
        return level_params(self.level)

    def tltl_signals(self) -> Signals:
        """Return the current values of the game that specs can read, by signal name."""
        return self.game.signals()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begin an episode; return the first observation, and ``info``.

        ``seed`` determines everything in the episode that is random. Without it, a seed is drawn
        from a generator, which the last given seed initialised. ``options`` are ignored.
        """
        self._check_open()
        super().reset(seed=seed)
        self.game.reset(int(self.np_random.integers(2**31)) if seed is None else seed)
        self._show()
        return self._observer.look(self.game), {"cell": self._cell()}

    def step(self, action: Any) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Play ``action`` for one time step, 0.15 s. The reward is always 0; the episode never ends."""
        self._check_open()
        self.action = _action_list(action)
        self.game.step(self.action)
        self._show()
        return self._observer.look(self.game), 0.0, False, False, {"cell": self._cell()}

    def render(self) -> NDArray[np.uint8] | None:
        """Return the current picture, (height, width, 3), or show it in the window and return None.

        Without a render mode, warn and return None. In the mode ``human``, if no window can be
        opened, warn once and show nothing.

        Raises:
            TltlError: TLT0730, pygame is missing.
        """
        self._check_open()
        if self.render_mode is None:
            gymnasium.logger.warn("there are no pictures without a render mode: use make(..., render_mode='rgb_array')")
        return self._screen.render(self.game.snapshot())

    def close(self) -> None:
        """Release the physics and the renderer, and close the window."""
        self._closed = True
        self._screen.close()
        self.game.close()

    def _cell(self) -> int:
        player = self.game.world.player
        if not player.grounded:
            return -1
        number = 0
        for coordinate, low, high in zip(player.position, self.level.bounds.low, self.level.bounds.high, strict=True):
            width = ceil((high - low) / _CELL)
            number = number * width + min(max(int((coordinate - low) / _CELL), 0), width - 1)
        return number

    def _check_open(self) -> None:
        if self._closed:
            raise ClosedEnvironmentError("this environment is closed: make another one")

    def _show(self) -> None:
        if self.render_mode == "human":
            self._screen.render(self.game.snapshot())


def _action_list(action: Any) -> list[int]:
    """Return an action as a list of five whole numbers.

    Raises ValueError unless the action is an element of MultiDiscrete([3, 3, 2, 2, 2]).
    """
    array = np.asarray(action)
    numbers: list[int] = array.tolist()
    if array.dtype.kind not in "iub" or array.shape != (len(BRANCHES),) or tuple(numbers) not in ACTIONS:
        expected = "expected five whole numbers of MultiDiscrete([3 3 2 2 2]): x, y, jump, crouch, sprint"
        raise ValueError(f"{action!r:.80} is not an action: {expected}")
    return numbers


def make_env(
    level: str | os.PathLike[str],
    variant: str | Variant = "v0",
    spec: str | Path | Fspa | None = None,
    *,
    sensors: SensorChoice | None = None,
    reward: RewardOptions | None = None,
    params: Mapping[str, float] | None = None,
    **render: Any,
) -> TltlEnv:
    """Make an environment of a level with a spec, by default the spec that the level names.

    The arguments have the same meaning as in :class:`GameEnv` and :class:`TltlEnv`, and the errors
    of these classes can occur. ``render`` takes the ``render_mode``, ``render_view`` and
    ``render_size`` of :class:`GameEnv`.

    Raises:
        TltlError: the spec needs something that the level does not supply, see
            :func:`~tltl_runtime.stealth.capabilities.capabilities.check_capabilities`; TLT0721,
            ``spec`` is None, and the level names no spec.
    """
    game = GameEnv(level, variant, sensors, **render)
    try:
        chosen_spec = default_spec(game.level) if spec is None else spec
        env = TltlEnv(game, chosen_spec, reward=reward, params=params)
        check_fit(game.level, env.task.fspa, chosen_spec)
        return env
    except BaseException:
        game.close()
        raise


def check_fit(level: StealthLevel, fspa: Fspa, spec: str | Path | Fspa) -> None:
    """Raise a TltlError if a spec needs something that a level lacks, such as a signal.

    The error lists everything that is lacking, with the places in the source of ``spec``. ``fspa``
    is the automaton of ``spec``.
    """
    if _capability_errors(level, fspa, SpecPlaces(None)):
        raise TltlError(_capability_errors(level, fspa, SpecPlaces(read_spec(spec)[1])))


def _capability_errors(level: StealthLevel, fspa: Fspa, places: SpecPlaces) -> list[Diagnostic]:
    return [diagnostic for diagnostic in check_capabilities(level, fspa, places) if diagnostic.severity == "error"]


# `gymnasium.make` reads the render modes from the attribute `metadata` of this function.
make_env.metadata = GameEnv.metadata  # type: ignore[attr-defined]
