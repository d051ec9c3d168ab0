"""The options that name what is played: a level of the stealth game, or a scene of a game file."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, Final, TypeVar

import click

from tltl_runtime.game.level_name import is_scene, split_level
from tltl_runtime.gymnasium_games.level_scenes import level_of_scene

Function = TypeVar("Function", bound=Callable[..., Any])

_GAME: Final = "FILE.game.toml[:SCENE[:VARIANT]]"


def level_options(help_text: str) -> Callable[[Function], Function]:
    """Return a decorator that adds the options ``--level`` and ``--game`` to a command.

    At most one of them may be given. The command gets its value as ``level``; None without both. For a
    scene that stands for a level, ``level`` is that level.
    """

    def decorate(command: Function) -> Function:
        @wraps(command)
        def with_level(*args: Any, level: str | None, game: str | None, **options: Any) -> Any:
            if level is not None and game is not None:
                raise click.UsageError("give --level or --game, not both", click.get_current_context())
            place = level if game is None else game
            return command(*args, level=place and level_of_scene(place), **options)

        with_game = game_option("The scene of your own game, instead of a level.")(with_level)
        return click.option("--level", metavar="LEVEL[:VARIANT]", help=help_text)(with_game)  # type: ignore[return-value]

    return decorate


def game_option(help_text: str) -> Callable[[Function], Function]:
    """Return a decorator that adds the option ``--game`` to a command, which gets its value as ``game``.

    The form of the value is checked, but not whether the file exists.
    """
    return click.option("--game", metavar=_GAME, callback=_check_game, help=help_text)


def _check_game(ctx: click.Context, parameter: click.Parameter, game: str | None) -> str | None:
    if game is not None and not is_scene(split_level(game)[0]):
        raise click.BadParameter(
            f"`{game}` is not a game file: name a file `NAME.game.toml`, and after it `:SCENE:VARIANT`"
        )
    return game
