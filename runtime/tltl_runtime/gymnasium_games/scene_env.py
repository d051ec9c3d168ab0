"""Gymnasium environments of the scenes of a game file."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from copy import deepcopy
from math import inf
from pathlib import Path
from typing import Any, Final, SupportsFloat

import gymnasium
from gymnasium import spaces

from tltl_runtime.game.geometry import Point
from tltl_runtime.game.outline import LevelOutline
from tltl_runtime.gymnasium_games.entity_positions import PLAYER, PositionsError, read_positions
from tltl_runtime.gymnasium_games.game_argument import variant_of
from tltl_runtime.gymnasium_games.game_errors import CANNOT_START, RAISES, guarded, raised
from tltl_runtime.gymnasium_games.game_file import FIRST_VARIANT, GameFile, SceneVariant, read_game_file
from tltl_runtime.gymnasium_games.game_modules import folder_first, import_function, import_module
from tltl_runtime.gymnasium_games.outline_reader import OutlineError, read_outline
from tltl_runtime.gymnasium_games.process_games import env_in_process, signals_in_process
from tltl_runtime.gymnasium_games.value_text import type_text
from tltl_runtime.spec.task import Task
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.support.sdl_driver import draw_without_screen
from tltl_runtime.support.suggestion import suggestion
from tltlc.api import Diagnostic, Fspa, Label, RewardOptions, TltlError

_OWN_OPTIONS: Final = ("max_episode_steps", "disable_env_checker", "render_mode")
"""Options of ``gymnasium.make`` itself, which the environment need not know."""

_PLAYER_HELP: Final = f"return two or three numbers for it: `{{'{PLAYER}': (1.0, 2.0)}}`"


class SceneEnv(gymnasium.Wrapper[Any, Any, Any, Any]):
    """The environment of a scene without a spec.

    The wrapper adds the method ``tltl_signals``, and the ``tltl_clock_s`` of the game file. Observations
    have only the keys that the game file keeps. ``game_file`` is the content of that file. An exception
    of the game becomes a TltlError, TLT0781.

    Raises:
        TltlError: TLT0803, the observation lacks a key that the game file keeps; TLT0780, there are no
            signals, or the observation has a key that the spec adds.
    """

    def __init__(
        self, env: gymnasium.Env[Any, Any], game: GameFile, signals: Callable[..., Any] | None, scene_label: Label
    ) -> None:
        super().__init__(env)
        self._game = self.game_file = game
        self._label = scene_label
        self._steps = 0
        if signals is None and not env.has_wrapper_attr("tltl_signals"):
            title = "the environment does not say its signals"
            help_ = 'write `signals = "MODULE:FUNCTION"`, or give the environment a method `tltl_signals()`'
            raise TltlError([Diagnostic(CANNOT_START, title, (game.labels["game"],), help_)])
        self._signals = signals
        if game.clock_s is not None:
            self.tltl_clock_s = game.clock_s
        self._keys = _kept_keys(game, env.observation_space)
        if self._keys:
            self.observation_space = spaces.Dict({key: env.observation_space[key] for key in self._keys})  # type: ignore[index]
        _check_keys(self.observation_space, scene_label)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Reset the game; raises TltlError, TLT0781, if the game raises an exception."""
        self._steps = 0
        with guarded(self._game, RAISES, "the game's `reset`", self._label):
            observation, info = self.env.reset(seed=seed, options=options)
            return self._kept(observation), info

    def step(self, action: Any) -> tuple[Any, SupportsFloat, bool, bool, dict[str, Any]]:
        """Take a step in the game; raises TltlError, TLT0781, if the game raises an exception."""
        self._steps += 1
        with guarded(self._game, RAISES, f"step {self._steps} of the episode", self._label):
            observation, reward, terminated, truncated, info = self.env.step(action)
            return self._kept(observation), reward, terminated, truncated, info

    def tltl_signals(self) -> Mapping[str, SupportsFloat]:
        """Return the signals of the current state; raises TltlError, TLT0781, if the game does not give them."""
        label = self._game.labels.get("signals", self._label)
        name = f"`{self._game.signals.text}`" if self._game.signals else "the game's `tltl_signals`"
        name += f", called after step {self._steps}," if self._steps else ", called after the reset,"
        with guarded(self._game, RAISES, name, label):
            sample = self.env.get_wrapper_attr("tltl_signals")() if self._signals is None else self._signals(self.env)
        if not isinstance(sample, Mapping):
            title = f"{name} returns {type_text(sample)}, not a mapping"
            help_ = "return the value of each signal by its name: `{'has_key': True}`"
            raise TltlError([Diagnostic(RAISES, title, (label,), help_)])
        return sample

    def render(self) -> Any:
        """Return a frame; raises TltlError, TLT0781, if the game raises an exception."""
        with guarded(self._game, RAISES, "the game's `render`", self._label):
            return self.env.render()

    def close(self) -> None:
        """End the game; raises TltlError, TLT0781, if the game raises an exception."""
        with guarded(self._game, RAISES, "the game's `close`", self._label):
            self.env.close()

    def scene_positions(self) -> dict[str, Point] | None:
        """Return the positions of the entities that are there now, by name, in metres.

        None if the game has no method ``tltl_positions``. Raises TltlError, TLT0781, if the positions
        cannot be used, or if there is no ``player`` after the reset.
        """
        if not self.env.has_wrapper_attr("tltl_positions"):
            return None
        with guarded(self._game, RAISES, "the game's `tltl_positions`", self._label):
            value = self.env.get_wrapper_attr("tltl_positions")()
        try:
            places = read_positions(value)
            if PLAYER not in places and not self._steps:
                raise PositionsError(f"gives no position of `{PLAYER}` after the reset", _PLAYER_HELP)
        except PositionsError as error:
            title = f"the game's `tltl_positions` {error}"
            raise TltlError([Diagnostic(RAISES, title, (self._label,), error.help)]) from None
        return places

    def scene_cause(self) -> str:
        """Return who or what ended the episode, as ``tltl_cause`` says; empty if it says nothing.

        Raises TltlError, TLT0781, if the game raises an exception.
        """
        with guarded(self._game, RAISES, "the game's `tltl_cause`", self._label):
            return str(self.env.get_wrapper_attr("tltl_cause")() or "")

    def scene_expert(self, task: Task) -> Callable[[Any], Any]:
        """Return the function with which the game's own expert chooses an action for an observation.

        ``tltl_expert`` gets ``task``, the spec that judges the expert, if it has a parameter of that name.
        Both this method and the function raise TltlError, TLT0781, if the game raises an exception.
        """
        with guarded(self._game, RAISES, "the game's `tltl_expert`", self._label):
            make = self.env.get_wrapper_attr("tltl_expert")
            choose = (make(task=task) if "task" in (_keywords(make) or ()) else make()).choose

        def guarded_choice(observation: Any) -> Any:
            with guarded(self._game, RAISES, "the game's expert", self._label):
                return choose(observation)

        return guarded_choice

    def scene_outline(self) -> LevelOutline | None:
        """Return the outline of the scene in this episode.

        None if the game has no method ``tltl_outline``. Raises TltlError, TLT0781, if the outline cannot
        be used.
        """
        if not self.env.has_wrapper_attr("tltl_outline"):
            return None
        with guarded(self._game, RAISES, "the game's `tltl_outline`", self._label):
            value = self.env.get_wrapper_attr("tltl_outline")()
        try:
            return read_outline(value, self._game.folder)
        except OutlineError as error:
            whose = "the game sends" if self._game.wire else "`tltl_outline` returns"
            title = f"the outline that {whose} {error}"
            raise TltlError([Diagnostic(RAISES, title, (self._label,), error.help)]) from None

    def _kept(self, observation: Any) -> Any:
        return {key: observation[key] for key in self._keys} if self._keys else observation


def make_scene_env(
    game_file: Path,
    scene: str,
    variant: str = FIRST_VARIANT,
    spec: str | Path | Fspa | None = None,
    *,
    reward: RewardOptions | None = None,
    params: Mapping[str, float] | None = None,
    render_mode: str | None = None,
    allow_outside: bool = False,
) -> TltlEnv:
    """Make an environment of a scene with a spec, by default the spec that the scene is made for.

    ``reward`` and ``params`` are those of :class:`TltlEnv`. The Python modules that the game file
    names are imported. For worker processes, use ``functools.partial(make_scene_env, …)``.

    Raises:
        TltlError: the errors of :func:`read_game_file`, :func:`make_base_env` and ``TltlEnv``;
            TLT0800, there is no such scene or variant; TLT0721, there is no spec.
    """
    game = read_game_file(game_file, allow_outside=allow_outside)
    env = make_base_env(game, scene, variant, render_mode=render_mode)
    try:
        return TltlEnv(env, scene_spec(game, scene, variant) if spec is None else spec, reward=reward, params=params)
    except BaseException:
        env.close()
        raise


def scene_spec(game: GameFile, scene: str, variant: str = FIRST_VARIANT) -> str:
    """Return the spec that a scene is made for, as the argument ``FILE.tltl:NAME``.

    Raises:
        TltlError: TLT0721, the scene is made for no spec.
    """
    own = variant_of(game, scene, variant)
    if own.spec is None:
        title = f"the scene `{scene}` does not name a spec"
        help_ = 'name one in the command, or in the scene: `spec = "FILE.tltl:NAME"`'
        raise TltlError([Diagnostic("TLT0721", title, (own.label,), help_)])
    return own.spec.text


def make_base_env(
    game: GameFile, scene: str, variant: str = FIRST_VARIANT, *, render_mode: str | None = None
) -> SceneEnv:
    """Make an environment of a scene without a spec.

    Raises:
        TltlError: TLT0731, the environment has no such ``render_mode``; TLT0800, there is no such scene or
            variant; TLT0730, a package is not installed; TLT0780, the environment cannot be made; TLT0803,
            the observation lacks a key that the game file keeps; the errors of a game in another process.
    """
    own = variant_of(game, scene, variant)
    if render_mode == "rgb_array":
        draw_without_screen()
    options = deepcopy(dict(own.options)) | ({} if render_mode is None else {"render_mode": render_mode})
    with folder_first(game):
        for module in game.modules:
            import_module(game, module, "import")
        if game.wire is not None:
            env = env_in_process(game.wire, game, scene, variant, options, own)
        elif game.python is not None:
            env = _from_function(game, import_function(game, game.python, "python"), scene, options, own)
        else:
            env = _from_id(game, scene, options, own, render_mode)
        try:
            signals = import_function(game, game.signals, "signals") if game.signals else None
            if signals is not None and game.wire is not None:
                signals = signals_in_process(game.wire, signals)
            _check_offers(game, env, own)
            return SceneEnv(env, game, signals, own.label)
        except BaseException:
            env.close()
            raise


def _from_function(
    game: GameFile, function: Callable[..., Any], scene: str, options: dict[str, Any], own: SceneVariant
) -> gymnasium.Env[Any, Any]:
    assert game.python is not None
    name = f"`{game.python.text}`"
    keywords = _keywords(function)
    takes_mode = keywords is None or "render_mode" in keywords
    if "render_mode" in options and "render_mode" not in own.options and not takes_mode:
        advice = f"give {name} an argument `render_mode`, and pass it on to the environment"
        raise _no_pictures_error(scene, game.labels["python"], advice)
    _check_options(name, function, 1, options, own)
    with guarded(game, CANNOT_START, name, own.label):
        env = function(scene, **options)
    if not isinstance(env, gymnasium.Env):
        title = f"{name} returns {type_text(env)}, not a gymnasium.Env"
        help_ = "return an environment of the package `gymnasium`"
        raise TltlError([Diagnostic(CANNOT_START, title, (game.labels["python"],), help_)])
    return env


def _from_id(
    game: GameFile, scene: str, options: dict[str, Any], own: SceneVariant, render_mode: str | None
) -> gymnasium.Env[Any, Any]:
    id_, label = game.gymnasium or "", game.labels["gymnasium"]
    module, colon, name = id_.partition(":")
    if colon:
        import_module(game, module, "gymnasium")
    entry = name if colon else id_
    registered = gymnasium.registry.get(entry)
    if registered is None:
        title = f"no environment is registered as `{entry}`"
        close = suggestion(entry, gymnasium.registry, "")
        help_ = close if close.startswith("did you") else 'name the module that registers it: `import = ["MODULE"]`'
        raise TltlError([Diagnostic(CANNOT_START, title, (label,), help_)])
    what = f"the environment `{entry}`"
    with guarded(game, CANNOT_START, what, own.label):
        try:
            creator: Any = registered.entry_point
            if isinstance(creator, str):
                creator = gymnasium.envs.registration.load_env_creator(creator)
            modes = (getattr(creator, "metadata", None) or {}).get("render_modes")
            if render_mode is not None and modes is not None and render_mode not in modes:
                advice = f'write a method `render()` for it, and `{render_mode}` in its `metadata["render_modes"]`'
                raise _no_pictures_error(scene, label, advice)
            known = {key: value for key, value in options.items() if key not in _OWN_OPTIONS}
            if creator is not None:
                _check_options(what, creator, 0, known, own)
            return gymnasium.make(entry, **{"disable_env_checker": True, **options})
        except TypeError as error:
            # `gymnasium.make` replaces a TypeError of the environment by one with a long message: report the first.
            raise TltlError([raised(game, CANNOT_START, what, error.__cause__ or error, own.label)]) from error
        except ModuleNotFoundError as error:
            missing = (error.name or "").partition(".")[0]
            title = f"the module `{missing}` is not installed, and {what} needs it"
            raise TltlError([Diagnostic("TLT0730", title, (label,), f"install it: `pip install {missing}`")]) from error
        except gymnasium.error.DependencyNotInstalled as error:
            title = f"{what} needs a package that is not installed"
            raise TltlError([Diagnostic("TLT0730", title, (label,), str(error))]) from error


def _no_pictures_error(scene: str, label: Label, advice: str) -> TltlError:
    """Return the error TLT0731, which says that the environment of a scene renders no pictures."""
    title = f"the game of `{scene}` renders no pictures (`render_mode` `rgb_array`)"
    return TltlError([Diagnostic("TLT0731", title, (label,), advice)])


def _keywords(function: Callable[..., Any], positional: int = 0) -> list[str] | None:
    """Return the names of a function's keyword arguments after the first ``positional`` ones; None if it takes any.

    A function of C code may have a signature that Python does not know; it counts as one that takes any.
    """
    try:
        parameters = list(inspect.signature(function).parameters.values())
    except (TypeError, ValueError):
        return None
    if any(parameter.kind == parameter.VAR_KEYWORD for parameter in parameters):
        return None
    by_name = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
    return [parameter.name for parameter in parameters[positional:] if parameter.kind in by_name]


def _check_options(
    what: str, function: Callable[..., Any], positional: int, options: Mapping[str, Any], own: SceneVariant
) -> None:
    """Raise TltlError, TLT0780, if a function does not take one of the ``options`` as a keyword argument.

    ``what`` is the name of the function in the message. The function gets ``positional`` other
    arguments first, which no option can set.
    """
    names = _keywords(function, positional)
    if names is None:
        return
    unknown = [key for key in options if key not in names]
    if unknown:
        title = f"{what} takes no option `{unknown[0]}`"
        help_ = suggestion(unknown[0], names) if names else "leave it out"
        label = own.option_labels.get(unknown[0], own.label)
        raise TltlError([Diagnostic(CANNOT_START, title, (label,), help_)])


def _check_offers(game: GameFile, env: gymnasium.Env[Any, Any], own: SceneVariant) -> None:
    """Raise TltlError, TLT0780, if ``tltl_clock_s`` or the result of ``tltl_params`` has a wrong value.

    The clock must be a number above 0, the params a mapping from names to numbers.
    """
    clock_s = env.get_wrapper_attr("tltl_clock_s") if env.has_wrapper_attr("tltl_clock_s") else 1.0
    if not isinstance(clock_s, (int, float)) or not 0.0 < clock_s < inf:
        title = f"the game's `tltl_clock_s` is {clock_s!r:.40}, not the seconds of a step"
        raise TltlError([Diagnostic(CANNOT_START, title, (own.label,), "give it a number above zero, e.g. 0.05")])
    if not env.has_wrapper_attr("tltl_params"):
        return
    name = "the game's `tltl_params`"
    with guarded(game, CANNOT_START, name, own.label):
        params = env.get_wrapper_attr("tltl_params")()
        if not isinstance(params, Mapping):
            raise TypeError(f"it returns {type_text(params)}, not a mapping from names to numbers")
        for value in params.values():
            float(value)


def _kept_keys(game: GameFile, space: spaces.Space[Any]) -> tuple[str, ...]:
    """Return the keys of the observation that the game file keeps; empty for all.

    Raises:
        TltlError: TLT0803, the observation has no such key.
    """
    if not game.observation:
        return ()
    label = game.labels["observation"]
    if not isinstance(space, spaces.Dict):
        title = f"the observation is a {type(space).__name__}, which has no keys"
        raise TltlError([Diagnostic("TLT0803", title, (label,), "leave out `observation`: it is for Dict spaces")])
    unknown = [key for key in game.observation if key not in space.spaces]
    if unknown:
        title = f"the observation has no key `{unknown[0]}`"
        raise TltlError([Diagnostic("TLT0803", title, (label,), suggestion(unknown[0], space.spaces))])
    return tuple(dict.fromkeys(game.observation))


def _check_keys(space: spaces.Space[Any], label: Label) -> None:
    """Raise TltlError, TLT0780, if a Dict observation has a key that a spec adds to it."""
    conflicts = {"automaton", "progress"} & (space.spaces.keys() if isinstance(space, spaces.Dict) else set())
    if conflicts:
        title = f"the observation has the key `{min(conflicts)}`, which the spec adds to it"
        help_ = 'rename it in the game, or name the keys to keep: `observation = ["KEY"]` in `[game]`'
        raise TltlError([Diagnostic(CANNOT_START, title, (label,), help_)])
