"""Environments of games in other processes, as game files describe them."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import gymnasium

from tltl_runtime.gymnasium_games.game_argument import scene_of
from tltl_runtime.gymnasium_games.game_errors import CANNOT_START, guarded
from tltl_runtime.gymnasium_games.game_file import GameFile, SceneVariant
from tltl_runtime.support.suggestion import suggestion
from tltl_runtime.wire.wire_game import GODOT_RL, ML_AGENTS, TLTL, WireGame
from tltlc.api import Diagnostic, TltlError, replace

Signals = Callable[[Any], Any]


def env_in_process(
    wire: WireGame, game: GameFile, scene: str, variant: str, options: Mapping[str, Any], own: SceneVariant
) -> gymnasium.Env[Any, Any]:
    """Start a game in another process, or connect to it.

    The game gets the names of the scene and the variant. A game that speaks another protocol gets the options in their
    place: with that of Godot RL Agents as the arguments ``--KEY=VALUE``, with that of ML-Agents as environment
    parameters.

    Raises:
        TltlError: TLT0803, the game has no such scene, or an environment parameter is no number; TLT0731, the game
            sends no pictures, which ``render_mode`` needs; TLT0780, the game takes no options.
        WireError: the game does not start, or its ``hello`` is wrong.
    """
    from tltl_runtime.wire.env import NoPicturesError, UnknownSceneError, WireEnv

    given = {key: value for key, value in options.items() if key != "render_mode"}
    if wire.protocol == GODOT_RL and wire.process:
        # As Godot RL Agents does: the game reads its options from its arguments.
        wire = replace(wire, process=(*wire.process, *(f"--{key}={_argument(given[key])}" for key in given)))
        given = {}
    elif wire.protocol == ML_AGENTS:
        wire = replace(wire, parameters=tuple((key, _parameter(key, given[key], own)) for key in given))
        given = {}
    if given:
        title = f"a game in another process takes no option `{next(iter(given))}`"
        help_ = "leave it out: the game gets the names of the scene and of the variant"
        label = own.option_labels.get(next(iter(given)), own.label)
        raise TltlError([Diagnostic(CANNOT_START, title, (label,), help_)])
    # A game file that names no scenes means the first one of the game.
    named = scene if game.has_scenes else None
    try:
        with guarded(game, CANNOT_START, "the game", own.label, unless=(UnknownSceneError, NoPicturesError)):
            return WireEnv(wire, scene=named, variant=variant, render_mode=options.get("render_mode"))
    except UnknownSceneError as error:
        raise _unknown_scene_error(game, scene, error.scenes) from error
    except NoPicturesError as error:
        raise _no_pictures_error(wire, game, scene) from error


def _unknown_scene_error(game: GameFile, scene: str, scenes: Sequence[str]) -> TltlError:
    title = f"the game has no scene `{scene}`"
    declared = "it declares " + ", ".join(f"`{name}`" for name in scenes)
    close = suggestion(scene, scenes, "")
    help_ = f"{close} ({declared})" if close.startswith("did you") else declared
    return TltlError([Diagnostic("TLT0803", title, (scene_of(game, scene).label,), help_)])


def _no_pictures_error(wire: WireGame, game: GameFile, scene: str) -> TltlError:
    title = f"the game of `{scene}` sends no pictures"
    help_ = (
        "declare the capability `screenshot` in its `hello`, and answer each request `screenshot` with a picture: see "
        "docs/wire.md"
    )
    if wire.protocol != TLTL:
        help_ = f"the protocol `{wire.protocol}` has no pictures: use the protocol `{TLTL}` for them"
    return TltlError([Diagnostic("TLT0731", title, (game.labels["process" if wire.process else "connect"],), help_)])


def signals_in_process(wire: WireGame, function: Signals) -> Signals:
    """Return the function from an environment to its signals, for the ``function`` that a game file names.

    If the game speaks another protocol than ``tltl``, ``function`` gets the observation in place of the environment.
    """
    return function if wire.protocol == TLTL else lambda env: function(env.get_wrapper_attr("observation"))


def _parameter(key: str, value: Any, own: SceneVariant) -> float:
    """Return the value of an environment parameter; raises TltlError, TLT0803, if it is no number."""
    if not isinstance(value, (int, float)) or not key.isascii():
        title, help_ = (
            f"the environment parameter `{key}` must be a number",
            "ML-Agents has parameters of no other type",
        )
        raise TltlError([Diagnostic("TLT0803", title, (own.option_labels.get(key, own.label),), help_)])
    return float(value)


def _argument(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value)
