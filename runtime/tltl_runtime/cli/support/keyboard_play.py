"""Let a person play a level in a window, for the commands ``tltlc play`` and ``tltlc record``."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click

from tltlc.api import cli

if TYPE_CHECKING:
    from tltl_runtime.stealth.episode_recorder import RecordEpisode
    from tltl_runtime.stealth.keyboard import Recordings
    from tltl_runtime.stealth.rendering.camera import View

Function = TypeVar("Function", bound=Callable[..., Any])

_CROUCHES: Final = ("hold", "toggle")
_SIZE: Final = (640, 400)


def keyboard_options(function: Function) -> Function:
    """Add the options ``--view`` and ``--crouch`` to a command."""
    from tltl_runtime.stealth.rendering.camera import VIEWS

    crouch = click.option(
        "--crouch",
        type=click.Choice(_CROUCHES),
        default="hold",
        show_default=True,
        help="Whether the key C must be held to crouch, or toggles it.",
    )
    view = click.option(
        "--view",
        type=click.Choice(VIEWS),
        default="third_person",
        show_default=True,
        help="Where the camera is when the window opens.",
    )
    return view(crouch(function))


def play_at_keyboard(
    env: RecordEpisode,
    recordings: Callable[[str], Recordings],
    *,
    seed: int | None,
    view: View,
    crouch: str,
    enough: Callable[[], bool] = lambda: False,
) -> None:
    """Open a window and play episodes of ``env`` until the player stops.

    Playing also ends if ``enough`` returns true after an episode. ``recordings`` takes the name
    LEVEL-VARIANT, and returns the object that stores the episodes. ``seed`` is the seed of the
    first episode. ``crouch`` is ``hold`` or ``toggle``. Warnings about unreachable goals are
    printed to standard error before the window opens.

    Raises:
        TltlError: TLT0830, no window can be opened; TLT0730, pygame is not installed.
    """
    from tltl_runtime.stealth.capabilities.feasible import reach_warnings
    from tltl_runtime.stealth.keyboard import KeyboardPlayer
    from tltl_runtime.stealth.rendering.render import Renderer
    from tltl_runtime.stealth.window.window import Window

    level = env.get_wrapper_attr("level")
    receiver = recordings(f"{level.name}-{level.variant}")
    # Reset first: if the level lacks something that the spec needs, the error comes before the window opens.
    env.reset()
    cli.show(reach_warnings(level, env.get_wrapper_attr("task").fspa), "text", sys.stderr)
    window = Window(f"{level.name} {level.variant}", _SIZE, side=True, sticky_crouch=crouch == "toggle")
    renderer = Renderer(level, *_SIZE)
    try:
        KeyboardPlayer(env, window, renderer, view, receiver, enough).play(seed)
    finally:
        renderer.close()
        window.close()
