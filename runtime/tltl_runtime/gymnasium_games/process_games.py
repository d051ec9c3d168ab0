"""Environments of games in other processes, as game files describe them."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

import gymnasium

from tltl_runtime.gymnasium_games.game_errors import CANNOT_START, guarded
from tltl_runtime.gymnasium_games.game_file import GameFile, SceneVariant
from tltl_runtime.wire.wire_game import GODOT_RL, TLTL, WireGame
from tltlc.api import Diagnostic, TltlError, replace

Signals = Callable[[Any], Any]


def env_in_process(
    wire: WireGame, game: GameFile, scene: str, variant: str, options: Mapping[str, Any], own: SceneVariant
) -> gymnasium.Env[Any, Any]:
    """Start a game in another process, or connect to it.

    The game gets the names of the scene and the variant. A game that speaks the protocol of Godot RL Agents gets the
    options in their place, as the arguments ``--KEY=VALUE``.
    """
    from tltl_runtime.wire.env import WireEnv

    given = {key: value for key, value in options.items() if key != "render_mode"}
    if wire.protocol == GODOT_RL and wire.process:
        # As Godot RL Agents does: the game reads its options from its arguments.
        wire = replace(wire, process=(*wire.process, *(f"--{key}={_argument(given[key])}" for key in given)))
        given = {}
    if given:
        title = f"a game in another process takes no option `{next(iter(given))}`"
        help_ = "leave it out: the game gets the names of the scene and of the variant"
        raise TltlError([Diagnostic(CANNOT_START, title, (own.label,), help_)])
    # A game file that names no scenes means the first one of the game.
    named = scene if game.has_scenes else None
    with guarded(game, CANNOT_START, "the game", own.label):
        return WireEnv(wire, scene=named, variant=variant, render_mode=options.get("render_mode"))


def signals_in_process(wire: WireGame, function: Signals) -> Signals:
    """Return the function from an environment to its signals, for the ``function`` that a game file names.

    If the game speaks another protocol than ``tltl``, ``function`` gets the observation in place of the environment.
    """
    return function if wire.protocol == TLTL else lambda env: function(env.get_wrapper_attr("observation"))


def _argument(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value)
