"""Let a person play a level in a window, for the commands ``tltlc play`` and ``tltlc record``."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click

from tltl_runtime.game.capability_error import capability_error
from tltlc.api import cli

if TYPE_CHECKING:
    from tltl_runtime.game.keyboard import Crouch, Keyboard, Recordings
    from tltl_runtime.game.level import Level
    from tltl_runtime.game.recorder import EpisodeRecorder
    from tltlc.api import Diagnostic

Function = TypeVar("Function", bound=Callable[..., Any])

_CROUCHES: Final = ("hold", "toggle")
_VIEWS: Final = ("third_person", "top_down", "overview")
"""The views of the stealth game. They are repeated here, so that the options do not import the game."""


def keyboard_options(function: Function) -> Function:
    """Add the options ``--view`` and ``--crouch`` to a command."""
    crouch = click.option(
        "--crouch",
        type=click.Choice(_CROUCHES),
        default="hold",
        show_default=True,
        help="In the stealth game: whether the key C must be held to crouch, or toggles it.",
    )
    view = click.option(
        "--view",
        type=click.Choice(_VIEWS),
        default="third_person",
        show_default=True,
        help="In the stealth game: where the camera is when the window opens.",
    )
    return view(crouch(function))


def keyboard_of(level: Level) -> Keyboard[Any]:
    """Return the object that lets a person play a level's game; raises TltlError, TLT0731, if there is none."""
    keyboard = level.game.keyboard
    if keyboard is None:
        advice = "let a trained policy play: `tltlc evaluate POLICY --record all --out DIR`"
        raise capability_error(level, "has no window in which a person can play", advice)
    return keyboard


def play_at_keyboard(
    env: EpisodeRecorder[Any],
    level: Level,
    recordings: Callable[[str], Recordings],
    *,
    seed: int | None,
    view: str,
    crouch: Crouch,
    enough: Callable[[], bool] = lambda: False,
) -> None:
    """Open a window and play episodes of ``env``, on ``level``, until the player stops.

    Playing also ends if ``enough`` returns true after an episode. ``recordings`` takes the name
    LEVEL-VARIANT, and returns the object that stores the episodes. ``seed`` is the seed of the
    first episode; None means a new one. If the game has no such ``view``, the window shows the game's
    first view. Warnings about unreachable goals are printed to standard error before the window opens.

    Raises:
        TltlError: TLT0830, no window can be opened; TLT0730, a package is not installed; TLT0731, no
            person can play the game.
    """
    keyboard = keyboard_of(level)
    receiver = recordings(f"{level.name}-{level.variant}")
    # Reset first: if the level lacks something that the spec needs, the error comes before the window opens.
    env.reset()
    cli.show(level.game.play_warnings(level, env.get_wrapper_attr("task").fspa), "text", sys.stderr)
    shown = view if view in keyboard.views else keyboard.views[0]
    keyboard.play(env, receiver, seed=seed, view=shown, crouch=crouch, enough=enough, on_lost=_show_loss)


def _show_loss(fault: Diagnostic) -> None:
    """Print a warning about an episode that was lost with its game."""
    from tltl_runtime.wire.lost_episodes import LostEpisodes

    cli.show([LostEpisodes(1, fault).warning], "text", sys.stderr)
